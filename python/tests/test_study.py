"""Studies of measured maps."""

import numpy as np
import pytest

import roughcontact as rc
from roughcontact._keys import plain

CELL = {"cell": 1e-2, "cell_y": 7.5e-3}


@pytest.fixture
def scan(tmp_path):
    """A file with a tilt, a hole and a spike: 64 x 48 points."""
    heights = rc.surface(waves=8, grid=64, seed=5)[:48] * 0.1 + 1e-7 * np.arange(64)
    heights[20:23, 30:34] = np.nan
    heights[8, 8] += 1e-4
    path = tmp_path / "scan.npy"
    np.save(path, heights)
    return path


def test_a_study_has_the_rows_and_ranges_of_the_command_line(scan, tmp_path, command):
    study = rc.study(scan, pressures=[2e6, 4e6], **CELL, e_star=1e9, despike=6.0, out=tmp_path / "here")
    words = ["study", scan, "--pressures", "2MPa,4e6", "--cell", "1e-2", "--cell-y", "7.5e-3", "--e-star", "1e9", "--despike", "6", "--quiet"]
    assert command(*words, "--out", tmp_path / "there").returncode == 0
    kept = ["here", "there"]
    here, there = ((tmp_path / name / "study.csv").read_text().splitlines() for name in kept)
    assert len(here) == len(there) == len(study.rows) + 1
    names, areas = study.rows["treatment"], study.rows["area_fraction"]
    column = there[0].split(",").index("area_fraction")
    assert [float(line.split(",")[column]) for line in there[1:]] == areas.tolist()
    assert {"as prepared", "fill nearest", "level quadratic", "free patch", "every second point"} <= set(names)
    ranges = [row for row in study.ranges if row["result"] == "area_fraction"]
    assert [row["pressure"] for row in ranges] == [2e6, 4e6]
    for row in ranges:
        at = areas[study.rows["control_value"] == row["pressure"]]
        assert (row["treatment_low"], row["treatment_high"], row["value"]) == (at.min(), at.max(), at[0])
    with pytest.raises(ValueError, match="resume=True"):
        rc.study(scan, pressures=[2e6, 4e6], **CELL, e_star=1e9, despike=6.0, out=tmp_path / "here")


def test_a_study_takes_the_flags_of_a_treatment_and_refuses_bad_input(scan):
    study = rc.study(scan, pressures="4MPa", cell="10mm", cell_y="7.5mm", e_star="1GPa", periodic=False, boundary="free", level=False)
    assert not any(step.startswith(("periodic", "level")) for step in study.treatments[0]["steps"])
    assert len(study.rows) == len(study.treatments)
    with pytest.raises(ValueError, match="e_star"):
        rc.study(scan, pressures=[1e6], **CELL)
    with pytest.raises(ValueError, match="strict"):
        rc.study(scan, pressures=[1e6], **CELL, e_star=1e9, despike=False, strict=True)


def test_a_pair_of_numbers_of_points_is_a_grid():
    assert plain({"resample": (512, 256)}) == {"resample": "512x256"}
