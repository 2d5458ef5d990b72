"""Derivatives with respect to the heights."""

import pickle

import numpy as np
import pytest

import roughcontact as rc

SCENE = {"cell": 1e-3, "e_star": 1e9, "method": "uniform", "tolerance": 1e-13}


@pytest.fixture(scope="module")
def map_of_heights():
    return rc.surface(waves=4, grid=32, seed=3, cell=1e-3)


@pytest.mark.parametrize("fixed", ["pressure", "penetration"])
@pytest.mark.parametrize("name", ["elastic_energy", "mean_pressure", "penetration", "mean_gap"])
def test_gradients_are_central_differences_in_si_units(map_of_heights, name, fixed):
    loaded = rc.solve(map_of_heights, pressure=1e6, **SCENE)
    if name.endswith(fixed):
        with pytest.raises(ValueError, match="held fixed"):
            loaded.gradient(name, fixed)
        return
    control = {"pressure": 1e6} if fixed == "pressure" else {"penetration": loaded.penetration}
    result = rc.solve(map_of_heights, **control, **SCENE)
    gradient = result.gradient(name)
    # Whatever was given, the contact is the same.
    assert loaded.gradient(name, fixed) == pytest.approx(gradient, rel=1e-5, abs=1e-6 * np.abs(gradient).max())
    step = 1e-4 * np.ptp(map_of_heights)
    for at in (np.argmax(result.pressure), np.argmin(result.pressure), np.argmax(map_of_heights)):
        values = []
        for sign in (1, -1):
            changed = map_of_heights.copy()
            changed.flat[at] += sign * step
            other = rc.solve(changed, **control, **SCENE)
            assert np.array_equal(other.contact, result.contact), "the contact changes"
            values.append(getattr(other, name))
        difference = (values[0] - values[1]) / (2 * step)
        # The certificates leave 1e-13 of the range of heights, 1e-9 of the step.
        assert gradient.flat[at] == pytest.approx(difference, abs=1e-6 * np.abs(gradient).max())


def test_the_energy_is_a_function_of_the_pressure(map_of_heights):
    result = rc.solve(map_of_heights, pressure=1e6, **SCENE)
    area = 1e-6 / result.pressure.size
    energy = result.gradient("elastic_energy")
    assert result.gradient_of(result.displacement * area) == pytest.approx(energy, abs=1e-6 * np.abs(energy).max())
    # The mean pressure is given.
    assert np.abs(result.gradient_of(np.ones_like(energy))).max() < 1e-6 * np.abs(result.gradient_of(result.pressure)).max()


def test_the_adaptive_method_has_the_same_gradients():
    surface = rc.Surface(waves=4, grid=256, seed=3, cell=1e-3)
    keys = {"pressure": 1e6, "e_star": 1e9, "tolerance": 1e-8}
    adaptive, uniform = (rc.solve(surface, method=method, **keys) for method in ("adaptive", "uniform"))
    assert np.array_equal(adaptive.contact, uniform.contact)
    for name in ("elastic_energy", "penetration", "mean_gap"):
        expected = uniform.gradient(name)
        assert adaptive.gradient(name) == pytest.approx(expected, abs=1e-5 * np.abs(expected).max())


def test_what_has_no_gradient_says_why(map_of_heights):
    result = rc.solve(map_of_heights, pressure=1e6, **SCENE)
    with pytest.raises(ValueError, match="area_fraction has none, because the elements in contact are held fixed"):
        result.gradient("area_fraction")
    with pytest.raises(ValueError, match="must be that of elastic_energy, mean_pressure, penetration or mean_gap"):
        result.gradient("friction")
    with pytest.raises(ValueError, match='fixed: must be "pressure" or "penetration"'):
        result.gradient("mean_gap", fixed="load")
    with pytest.raises(ValueError, match=r"df_dp: must have the shape of the pressure, \(32, 32\)"):
        result.gradient_of(np.ones(32))
    with pytest.raises(ValueError, match="read or unpickled"):
        pickle.loads(pickle.dumps(result)).gradient("mean_gap")
    divided = rc.solve(rc.Surface(waves=4, grid=64), pressure=1e6, border_level=1)
    with pytest.raises(ValueError, match="a gradient cannot be combined with a border level"):
        divided.gradient("mean_gap")
    hard = rc.solve(map_of_heights, pressure=1e6, hardness=2e8, **{**SCENE, "tolerance": 1e-6})
    with pytest.raises(ValueError, match="a gradient cannot be combined with a hardness"):
        hard.gradient("mean_gap")
