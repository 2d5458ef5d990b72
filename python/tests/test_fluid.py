"""A contact under the pressure of a fluid."""

import pickle

import numpy as np
import pytest
import roughcontact as rc

SCENE = dict(waves=8, grid=64, e_star=1e9, pressure=1e6)


def fluid(mean):
    x = (np.arange(64) + 0.5) / 64
    return np.outer(1 + 0.5 * np.cos(2 * np.pi * x), 1 + 0.8 * np.sin(2 * np.pi * x)) * mean


def test_fluid_and_contact_bear_the_load_together(tmp_path):
    pressure = fluid(4e5)
    result = rc.solve(**SCENE, fluid_pressure=pressure, method="uniform")
    assert result.mean_pressure == pytest.approx(1e6, rel=1e-9)
    assert result.mean_fluid_pressure == pytest.approx(4e5, rel=1e-9)
    assert result.mean_contact_pressure == pytest.approx(result.pressure.mean(), rel=1e-9)
    assert result.fluid_pressure.tobytes() == pressure.tobytes() and not result.fluid_pressure.flags.writeable
    assert result.area_fraction < rc.solve(**SCENE, method="uniform").area_fraction
    copy = pickle.loads(pickle.dumps(result))
    assert copy.fluid_pressure.tobytes() == pressure.tobytes() and copy.summary == result.summary
    np.savetxt(tmp_path / "fluid.txt", pressure, fmt="%.17g")
    for path in ("fluid.txt", "saved/fluid_pressure.npy"):
        result.save(tmp_path / "saved")
        again = rc.solve(**SCENE, fluid_pressure=tmp_path / path, method="uniform")
        assert again.pressure.tobytes() == result.pressure.tobytes(), path
    assert rc.solve(scene=tmp_path / "saved" / "scene.toml").gap.tobytes() == result.gap.tobytes()
    # The elastic energy is that of both pressures: with the displacement v, the gap is v - h up to a constant.
    total = result.pressure + pressure
    v = result.gap + rc.Surface(waves=8, grid=64).heights()
    energy = 0.5 * ((total * (v - v.mean())).mean()) * result.sides[0] ** 2
    # The overlaps that the tolerance leaves are cut from the gap.
    assert result.elastic_energy == pytest.approx(energy, rel=1e-3)


def test_a_loop_of_a_flow_and_a_contact_converges():
    """A fluid of a pressure that falls with the gap, as in a loop with a solver of Reynolds' equation."""
    pressure, areas = np.zeros((64, 64)), []
    for _ in range(12):
        result = rc.solve(**SCENE, fluid_pressure=pressure)
        pressure = 0.5 * pressure + 0.5 * 3e5 / (1 + result.gap / 1e-5)
        areas.append(result.area_fraction)
    assert abs(areas[-1] / areas[-2] - 1) < 1e-3 < abs(areas[1] / areas[0] - 1), areas


@pytest.mark.parametrize(
    ("pressure", "message"),
    [
        (np.zeros((32, 64)), "fluid_pressure: 64 x 32 values, but the solve has 64 x 64 elements"),
        (-fluid(1.0), "fluid_pressure: row 0, column 0 .* at least 0"),
        (fluid(np.nan), "fluid_pressure: row 0, column 0 .* is NaN"),
        (fluid(2e6), "fluid_pressure: its mean, 2.000000e6 Pa, already bears"),
        (np.zeros(64), "fluid_pressure: must be a 2-D array"),
    ],
)
def test_what_is_no_pressure_of_a_fluid_is_refused(pressure, message):
    with pytest.raises(ValueError, match=message):
        rc.solve(**SCENE, fluid_pressure=pressure)


def test_derivatives_are_those_of_a_contact_without_a_fluid():
    result = rc.solve(**SCENE, fluid_pressure=fluid(1e5), method="uniform")
    with pytest.raises(ValueError, match="fluid"):
        result.gradient("penetration")
    with pytest.raises(ValueError, match="displacement"):
        result.displacement
