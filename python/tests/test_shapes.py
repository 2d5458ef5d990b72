"""Shapes, forces, units, two bodies, and keys that vary."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import roughcontact as rc

SPHERE = {"shape": "sphere", "radius": "10mm", "cell": "1mm", "grid": 256, "boundary": "free", "e_star": "115GPa"}
MAP = 1e-6 * (np.sin(np.arange(32) / 2.0)[:, None] + np.cos(np.arange(32) ** 1.3)[None])
PATCH = {"cell": 1e-3, "e_star": 1e9, "pressure": 1e5, "boundary": "free"}


def test_a_sphere_under_a_force_is_hertzs_and_that_of_the_command(command, tmp_path):
    result = rc.solve(**SPHERE, force="10N")
    a = (0.75 * 10 * 0.01 / 115e9) ** (1 / 3)
    assert abs(result.area_fraction - math.pi * a**2 / 1e-6) < result.area_fraction_error
    assert abs(result.penetration - a**2 / 0.01) < result.penetration_error_bar
    flags = [word for key, value in SPHERE.items() for word in (f"--{key.replace('_', '-')}", value)]
    done = command("solve", *flags, "--force", "10N", "--quiet", "--out", tmp_path / "rc")
    assert done.returncode == 0, done.stderr
    assert np.array_equal(result.pressure, np.load(tmp_path / "rc/pressure.npy"))


@pytest.mark.parametrize("more", [{"shape": "sphere", "radius": 20e-3}, {"add": "other.npy"}])
def test_a_sum_is_saved_and_repeated(more, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.save("other.npy", MAP)
    np.save("map.npy", MAP)
    x = (np.arange(32) + 0.5) / 32 * 1e-3 - 0.5e-3
    expected = MAP + (MAP[:, ::-1] if "add" in more else -(x**2 + x[:, None] ** 2) / 40e-3)
    for heights in (MAP, "map.npy"):
        result = rc.solve(heights, **PATCH, **more)
        result.save("saved")
        assert np.allclose(np.load("saved/heights.npy"), expected, rtol=0, atol=1e-20)
        again = rc.solve(scene="saved/scene.toml")
        assert np.array_equal(again.pressure, result.pressure)


def test_the_other_body_may_be_an_array():
    assert np.array_equal(rc.solve(MAP, add=2 * MAP, **PATCH).pressure, rc.solve(MAP + 2 * MAP[:, ::-1], **PATCH).pressure)
    keys = {name: value for name, value in PATCH.items() if name != "pressure"}
    assert rc.sweep(MAP, add=2 * MAP, pressures=[1e5], **keys)["area_fraction"][0] > 0
    with pytest.raises(ValueError, match=r"add: must have the shape of the heights, \(32, 32\), not \(32, 30\)"):
        rc.solve(MAP, add=MAP[:, :30], **PATCH)


def test_units_that_do_not_fit_are_named():
    with pytest.raises(ValueError, match="pressure: must be a pressure in Pa.*not '5mm', which is a length"):
        rc.solve(waves=4, pressure="5mm")
    with pytest.raises(ValueError, match="'1mm', which is a length"):
        rc.sweep(waves=4, pressures="1mm,2mm")


def test_two_bodies_have_one_modulus():
    keys = {"waves": 4, "grid": 64, "pressure": "1MPa", "method": "uniform"}
    two = rc.solve(**keys, young="2GPa", poisson=0.3, young2="0.5GPa", poisson2=0.4)
    one = rc.solve(**keys, e_star=1 / (0.91 / 2e9 + 0.84 / 0.5e9))
    assert two.area_fraction == pytest.approx(one.area_fraction, rel=1e-9)


def test_varied_keys_are_columns_and_rows_those_of_the_command(command, tmp_path):
    keys = {"waves": 4, "grid": 64}
    table = rc.sweep(**keys, pressures="100kPa,200kPa", vary={"hardness": ["5MPa", 1e7]}, out=tmp_path / "py")
    assert table["hardness"].tolist() == [5e6, 5e6, 1e7, 1e7]
    flags = ["--waves", 4, "--grid", 64, "--pressures", "1e5,2e5", "--vary", "hardness=5MPa,10MPa"]
    done = command("sweep", *flags, "--quiet", "--out", tmp_path / "py", "--resume")
    assert done.returncode == 0, done.stderr
    lines = (tmp_path / "py/sweep.jsonl").read_text().splitlines()[1:]
    assert [json.loads(line)["cells"]["area_fraction"] for line in lines] == table["area_fraction"].tolist()
    forces = rc.sweep(**keys, vary={"force": ["10N", 20]})
    assert forces["force"].tolist() == [10, 20]
    assert np.allclose(forces["mean_pressure"], [1e5, 2e5], rtol=1e-9)
    more = rc.sweep(**keys, pressures="100kPa,200kPa", vary={"hardness": "5MPa,7MPa,10MPa"}, out=tmp_path / "py", resume=True)
    assert len(more) == 6
