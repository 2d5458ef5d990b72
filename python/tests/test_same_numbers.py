"""The numbers are those of the command line, bit by bit."""

import csv
import json

import numpy as np
import pytest
from conftest import of_the_contact

import roughcontact as rc

CASES = {
    "uniform": {"method": "uniform", "pressure": 2e5},
    "adaptive": {"method": "adaptive", "pressure": 1e5, "border_level": 1},
    "penetration": {"penetration": 1.2e-5},
    "gauss-seidel": {"method": "gauss-seidel", "grid": 32, "waves": 4, "pressure": 1e5, "tolerance": 1e-3},
    "spectral": {"kernel": "spectral", "pressure": 1e6, "tolerance": 1e-8},
    "leakage": {"pressure": 2e5, "leakage": True},
    "layer": {"pressure": 4e5, "layer_thickness": 3e-4, "layer_poisson": 0.3},
    "sliding": {"pressure": 4e5, "speed": 0.01, "direction": 30, "fractional": "0.3,10,0.02"},
    "shear": {"pressure": 4e5, "poisson": 0.5, "friction": 0.3, "shear_pressure": 5e4, "shear_angle": 30},
    "patch": {"pressure": 1e5, "boundary": "free"},
    "chosen grid": {"area_error": 0.05, "grid": None, "pressure": 1e6},
}


def words(keys):
    given = {f"--{key.replace('_', '-')}": value for key, value in keys.items() if value is not None}
    return [word for key, value in given.items() for word in ([key] if value is True else [key, str(value)])]


def assert_same_files(result, folder, tmp_path):
    """Every file but the picture and the summary, byte by byte; they are written by the same code, from the same numbers."""
    ours = tmp_path / "ours"
    result.save(ours)
    names = sorted(path.name for path in folder.iterdir())
    assert sorted(path.name for path in ours.iterdir()) == names
    for name in names:
        if name != "summary.json":
            assert (ours / name).read_bytes() == (folder / name).read_bytes(), name


@pytest.mark.parametrize("name", CASES)
def test_a_generated_surface_has_the_numbers_of_the_command_line(name, solved_by_command, tmp_path):
    keys = {"waves": 8, "seed": 3, "grid": 128, **CASES[name]}
    summary, folder = solved_by_command(tmp_path / "rc", *words(keys))
    result = rc.solve(**keys)
    assert of_the_contact(result.summary) == of_the_contact(summary)
    assert np.load(folder / "pressure.npy").tobytes() == result.pressure.tobytes()
    assert np.load(folder / "gap.npy").tobytes() == result.gap.tobytes()
    assert_same_files(result, folder, tmp_path)


@pytest.mark.parametrize("method", ["uniform", "adaptive"])
def test_an_array_has_the_numbers_of_its_file(method, solved_by_command, heights, tmp_path):
    np.save(tmp_path / "map.npy", heights)
    keys = {"cell": 0.0123, "young": 3.7e9, "poisson": 0.3, "pressure": 1e6, "method": method}
    summary, folder = solved_by_command(tmp_path / "rc", "--heights", tmp_path / "map.npy", *words(keys))
    result = rc.solve(heights, **keys)
    assert of_the_contact(result.summary) == of_the_contact(summary)
    assert_same_files(result, folder, tmp_path)


def test_a_rectangular_map_has_the_numbers_of_its_file(solved_by_command, heights, tmp_path):
    part = np.ascontiguousarray(heights[:48])
    np.save(tmp_path / "map.npy", part)
    keys = {"cell": 0.01, "cell_y": 0.0075, "e_star": 1e9, "penetration": 1e-5}
    summary, folder = solved_by_command(tmp_path / "rc", "--heights", tmp_path / "map.npy", *words(keys))
    result = rc.solve(part, **keys)
    assert of_the_contact(result.summary) == of_the_contact(summary)
    assert result.sides == (0.01, 0.0075)
    assert_same_files(result, folder, tmp_path)


@pytest.mark.parametrize("control", ["pressures", "penetrations"])
def test_a_sweep_has_the_rows_of_the_command_line(control, command, tmp_path):
    loads = {"pressures": "1e4:1e6:4", "penetrations": "2e-6:2e-5:3:linear"}[control]
    line = ("sweep", "--waves", 8, "--grid", 64, f"--{control}", loads, "--seeds", "1..2")
    done = command(*line, "--out", tmp_path / "sweep", "--quiet", "--json")
    assert done.returncode == 0, done.stderr
    table = rc.sweep(waves=8, grid=64, seeds="1..2", **{control: loads})
    rows = [of_the_contact(row) for row in json.loads(done.stdout)]
    assert [of_the_contact(row) for row in table] == rows
    # The table as a file has the same cells.
    table.to_csv(tmp_path / "ours.csv")
    with open(tmp_path / "ours.csv", newline="") as ours, open(tmp_path / "sweep" / "sweep.csv", newline="") as theirs:
        ours, theirs = list(csv.DictReader(ours)), list(csv.DictReader(theirs))
    for one, other in zip(ours, theirs, strict=True):
        for key in ("seed", "control_value", "area_fraction", "mean_gap", "contact_stiffness"):
            assert float(one[key]) == float(other[key]), key


def test_a_sweep_of_flows_has_the_rows_of_the_command_line(command, tmp_path):
    line = ("sweep", "--waves", 8, "--grid", 64, "--pressures", "1e5,2e8", "--leakage", "--quiet", "--json")
    done = command(*line, "--out", tmp_path / "sweep")
    assert done.returncode == 0, done.stderr
    table = rc.sweep(waves=8, grid=64, pressures=[1e5, 2e8], leakage=True)
    assert [of_the_contact(row) for row in table] == [of_the_contact(row) for row in json.loads(done.stdout)]
    assert table["permeance_x"][0] > 0.0 and table["permeance_x"][1] == 0.0


def test_a_surface_is_that_of_the_command_line(command, tmp_path):
    done = command("surface", "--waves", 8, "--hurst", 0.3, "--grid", 100, "--out", tmp_path / "s.npy", "--json")
    assert done.returncode == 0, done.stderr
    surface = rc.Surface(waves=8, hurst=0.3, grid=100)
    assert surface.heights().tobytes() == np.load(tmp_path / "s.npy").tobytes()
    assert rc.inspect(surface) == json.loads(done.stdout)


def test_inspect_says_what_the_command_line_says(command, heights, result, tmp_path):
    np.save(tmp_path / "map.npy", heights)
    done = command("inspect", tmp_path / "map.npy", "--cell", 0.01, "--json")
    assert rc.inspect(heights, cell=0.01) == json.loads(done.stdout)
    assert rc.inspect(tmp_path / "map.npy", cell=0.01) == json.loads(done.stdout)
    result.save(tmp_path / "result")
    done = command("inspect", tmp_path / "result", "--json")
    assert rc.inspect(result) == rc.inspect(tmp_path / "result") == json.loads(done.stdout)


def test_treatments_are_those_of_the_command_line(command, heights, tmp_path):
    tilted = heights + 1e-6 * np.arange(64)
    tilted[3, 4] = np.nan
    np.save(tmp_path / "map.npy", tilted)
    flags = ("--cell", 0.01, "--crop", 48, "--fill", "laplace", "--level", "plane", "--periodic", "mirror")
    done = command("surface", "--heights", tmp_path / "map.npy", *flags, "--out", tmp_path / "t.npy")
    assert done.returncode == 0, done.stderr
    ours = rc.prepare(tilted, cell=0.01, crop="48", level="plane", fill="laplace", periodic="mirror")
    assert ours.heights.tobytes() == np.load(tmp_path / "t.npy").tobytes()
    assert ours.sides == pytest.approx((0.015, 0.015), rel=1e-12)


def test_refused_input_has_the_sentence_of_the_command_line(command, heights, tmp_path):
    np.save(tmp_path / "map.npy", heights)
    cases = [
        {"cell": 0.01, "pressure": 1e6},
        {"e_star": 1e9, "pressure": 1e6},
        {"cell": 0.01, "young": 1e9, "pressure": 1e6},
        {"cell": -0.01, "e_star": 1e9, "pressure": 1e6},
        {"cell": 0.01, "e_star": 1e9, "pressure": -1.0},
        {"cell": 0.01, "e_star": 1e9, "penetration": 1.0},
        {"cell": 0.01, "e_star": 1e9},
        {"cell": 0.01, "e_star": 1e9, "pressure": 1e6, "threads": 0},
        {"cell": 0.01, "e_star": 1e9, "pressure": 1e6, "waves": 8},
        {"cell": 0.01, "e_star": 1e9, "pressure": 1e6, "memory_limit": "100kB"},
        {"cell": 0.01, "e_star": 1e9, "pressure": 1e6, "method": "adaptive", "kernel": "spectral"},
    ]
    for keys in cases:
        flags = [word if "=" in word else word for word in words(keys)]
        done = command("solve", "--heights", tmp_path / "map.npy", *flags)
        assert done.returncode == 2, (keys, done.stderr)
        with pytest.raises(ValueError) as refused:
            rc.solve(heights, **keys)
        # Flags are keywords here.
        assert f"error: {refused.value}\n" == done.stderr.replace("--", ""), keys
