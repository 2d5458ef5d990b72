"""A surface that slides over a solid that relaxes."""

import csv

import numpy as np
import pytest

import roughcontact as rc
from roughcontact import _core

SCENE = {"waves": 8, "grid": 64, "seed": 2, "cell": 0.01, "pressure": 4e5}


def test_all_forms_of_a_material_are_one(tmp_path):
    (tmp_path / "rubber.csv").write_text("g, tau\n3, 1e-3\n6, 0.1\n")
    (tmp_path / "in_pascals.csv").write_text("E (MPa), tau (ms)\n1200, 1\n2400, 100\n")
    forms = [
        [(3, 1e-3), (6, 0.1)],
        ((3, 1e-3), (6, 0.1)),
        ([3, 6], [1e-3, 0.1]),
        (np.array([3, 6]), np.array([1e-3, 0.1])),
        np.array([[3, 1e-3], [6, 0.1]]),
        tmp_path / "rubber.csv",
    ]
    first, *others = [rc.solve(**SCENE, speed="1cm/s", prony=form) for form in forms]
    assert first.friction > 10 * first.friction_error > 0 and first.dissipated_power == pytest.approx(first.friction * 4e5 * 0.01)
    assert first.max_loss_tangent > 0.1 and first.friction_bound > 0 and abs(first.lateral_friction) < first.friction
    assert all(other.friction == first.friction for other in others)
    in_pascals = rc.solve(**SCENE, young=4e8, poisson=0.45, speed=0.01, prony=tmp_path / "in_pascals.csv")
    assert in_pascals.friction == pytest.approx(first.friction, rel=1e-9)
    single = rc.solve(**SCENE, speed=0.01, glassy_ratio=4, relaxation_time="1ms")
    assert single.friction == rc.solve(**SCENE, speed=0.01, prony=(3, 1e-3)).friction
    fractional = rc.solve(**SCENE, speed=0.01, fractional={"alpha": 1, "glassy_ratio": 4, "tau": 1e-3})
    assert fractional.friction == pytest.approx(single.friction, rel=1e-3)


def test_the_opposite_direction_is_that_of_the_mirrored_map():
    heights = rc.surface(waves=8, grid=64, seed=2)
    solid = {"cell": 0.01, "e_star": 5e8, "pressure": 4e5, "speed": 0.01, "glassy_ratio": 10, "relaxation_time": 1e-2}
    one = rc.solve(heights, **solid, direction=180)
    other = rc.solve(heights[:, ::-1].copy(), **solid)
    assert one.friction == pytest.approx(other.friction, rel=1e-3)
    assert rc.solve(heights, **{**solid, "speed": 0}).friction == 0.0
    assert rc.solve(heights, cell=0.01, e_star=5e8, pressure=4e5).friction is None


def test_a_sweep_over_speeds_has_the_numbers_of_each_solve():
    solid = {"glassy_ratio": 10, "relaxation_time": 1e-2}
    keys = {key: value for key, value in SCENE.items() if key not in ("pressure", "seed")}
    table = rc.sweep(**keys, seeds=[2], pressures=[4e5], **solid, vary={"speed": [0, 1e-3, 1e-1]})
    assert table["speed"].tolist() == [0, 1e-3, 1e-1]
    assert table["friction"].tolist()[1:] == [rc.solve(**SCENE, **solid, speed=speed).friction for speed in (1e-3, 1e-1)]
    assert table["friction"][0] == 0.0


def _same_rows(table, folder):
    """The cells of a table and of sweep.csv, but for times and memory."""
    with open(folder / "sweep.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(table)
    for name in ("control_value", "mean_pressure", "area_fraction", "penetration", "mean_gap", "contact_conductance"):
        assert [float(row[name]) for row in rows] == table[name].tolist(), name
    return rows


def test_lists_of_speeds_and_times_are_those_of_the_command_line(tmp_path):
    keys = {"seeds": [2], **{key: value for key, value in SCENE.items() if key not in ("pressure", "seed")}}
    words = "sweep --waves 8 --grid 64 --seeds 2 --cell 0.01 --pressure 4e5 --prony [[3,0.001],[6,0.1]] --quiet".split()
    solid = {"prony": [(3, 1e-3), (6, 0.1)]}
    _core.run(["rc", *words, "--speeds", "1mm/s:0.1:3", "--out", str(tmp_path / "speeds")])
    for speeds in ("1mm/s:0.1:3", ["1mm/s", 1e-2, np.float64(0.1)]):
        table = rc.sweep(**keys, pressures=[4e5], **solid, speeds=speeds)
        rows = _same_rows(table, tmp_path / "speeds")
        assert [float(row["friction"]) for row in rows] == table["friction"].tolist()
        assert table["speed"].tolist() == pytest.approx([1e-3, 1e-2, 1e-1], rel=1e-15)
    _core.run(["rc", *words, "--times", "1ms:1s:3", "--out", str(tmp_path / "times")])
    table = rc.sweep(**keys, pressures=[4e5], **solid, times=["1ms", 0.0316227766016838, 1.0], out=tmp_path / "python")
    assert table["time"][0] == 1e-3 and (np.diff(table["area_fraction"]) > 0).all()
    table = rc.sweep(**keys, pressures=[4e5], **solid, times="1ms:1s:3")
    rows = _same_rows(table, tmp_path / "times")
    assert [float(row["least_pressure_rise"]) for row in rows] == table["least_pressure_rise"].tolist()
    assert (table["least_pressure_rise"] > 1).all() and "max_pressure" not in table[0] and "max_pressure" not in rows[0]
    # Each continues the rows of the other.
    again = rc.sweep(**keys, pressures=[4e5], **solid, times="1ms:1s:3", out=tmp_path / "times", resume=True)
    assert again["area_fraction"].tolist() == table["area_fraction"].tolist()
    # The load may be a force.
    by_force = rc.sweep(**keys, force=40.0, **solid, times="1ms:1s:3")
    assert by_force["area_fraction"].tolist() == pytest.approx(table["area_fraction"].tolist(), rel=1e-9)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"speeds": [1, -1], "pressures": [4e5]}, "give direction 180|--direction 180"),
        ({"speeds": [1, 2], "speed": 1, "pressures": [4e5]}, "speeds: is given with speed"),
        ({"speeds": "1,2Pa", "pressures": [4e5]}, "speeds: must be a speed in m/s"),
        ({"times": [0, 1], "pressures": [4e5]}, "times: each time must be above 0"),
        ({"times": [], "pressures": [4e5]}, "times: none is given"),
        ({"times": [1, 2], "speeds": [1, 2], "pressures": [4e5]}, "times: the surface is at rest"),
        ({"times": [1, 2], "pressures": [4e5, 1e5]}, "times: after the load falls"),
        ({"times": [1, 2], "penetrations": [1e-6]}, "times: a solid creeps under a constant load"),
        ({"times": [1, 2], "pressures": [4e5], "keep_results": True}, "times: the pressure after a time"),
    ],
)
def test_lists_that_cannot_be_are_refused_in_one_line(keys, message):
    scene = {key: value for key, value in SCENE.items() if key not in ("pressure", "seed")}
    with pytest.raises(ValueError, match=message) as refused:
        rc.sweep(**scene, glassy_ratio=10, relaxation_time=1e-2, **keys)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"speed": 1}, "speed: sliding changes nothing without a material"),
        ({"prony": [(1, 1)]}, "prony: a material that relaxes needs speed"),
        ({"speed": 1, "prony": [(1, 1, 1)]}, "prony: must be a file"),
        ({"speed": 1, "prony": ([1, 2], [1])}, "prony: must be a file"),
        ({"speed": 1, "prony": [(1, 0)]}, "prony: term 1"),
        ({"speed": 1, "fractional": {"alpha": 1}}, "fractional: must have"),
        ({"speed": -1, "prony": [(1, 1)]}, "give direction 180"),
    ],
)
def test_what_cannot_slide_is_refused_in_one_line(keys, message):
    with pytest.raises(ValueError, match=message) as refused:
        rc.solve(**SCENE, **keys)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("direction", "ahead"), [(0, (1, 0)), (90, (0, 1)), (180, (-1, 0))])
def test_contact_moves_to_the_leading_side_of_a_summit(direction, ahead):
    x = (np.arange(64) + 0.5) / 64 - 0.5
    heights = -1e-6 * (x[None, :] ** 2 + x[:, None] ** 2)
    solid = {"e_star": 1e7, "glassy_ratio": 10, "relaxation_time": 1e-2}
    result = rc.solve(heights, cell=1e-3, pressure=1e3, speed=1e-3, direction=direction, **solid)
    p = result.pressure / result.pressure.sum()
    centre = np.array([(p * x[None, :]).sum(), (p * x[:, None]).sum()])
    assert centre @ ahead > 1e-3 and abs(centre @ [ahead[1], ahead[0]]) < 1e-6
    assert result.friction > 0 and abs(result.lateral_friction) < 1e-6 * result.friction
