"""A hardness: pressures between zero and a greatest one."""

import pickle

import numpy as np
import pytest

import roughcontact as rc

SCENE = {"waves": 8, "grid": 128, "e_star": 1e9, "pressure": 1e6}


def test_a_hardness_bounds_the_pressure_and_is_said():
    result = rc.solve(**SCENE, hardness=5e6)
    assert result.pressure.max() <= result.hardness * (1 + 1e-15) and result.hardness == pytest.approx(5e6, rel=1e-15)
    assert 0.0 < result.plastic_area_fraction < result.area_fraction
    assert result.plastic_area_fraction_error > 0.0
    plastic = result.plastic_gap
    assert plastic.shape == result.gap.shape and plastic.min() >= 0.0 and not plastic.flags.writeable
    assert plastic.mean() == pytest.approx(result.mean_plastic_gap, rel=1e-3)
    assert not plastic[result.pressure < 0.99 * result.hardness].any()
    # Before plastic flow the gap is displacement minus heights, up to a constant.
    copy = pickle.loads(pickle.dumps(result))
    assert copy.plastic_gap.tobytes() == plastic.tobytes() and copy.hardness == result.hardness


def test_without_a_hardness_there_is_nothing_plastic():
    result = rc.solve(**SCENE)
    assert result.hardness is None and result.plastic_area_fraction is None and result.plastic_gap is None
    assert result.plastic_area_fraction_error is None and result.mean_plastic_gap is None


def test_what_it_cannot_bear_is_refused():
    with pytest.raises(ValueError, match="hardness: .* cannot bear"):
        rc.solve(**SCENE, hardness=1e6)


def test_a_sweep_has_it_in_every_row():
    table = rc.sweep(waves=8, grid=64, e_star=1e9, pressures=[1e5, 1e6], hardness=5e6)
    fractions = np.array([row["plastic_area_fraction"] for row in table])
    assert fractions.shape == (2,) and fractions[0] < fractions[1]


@pytest.mark.parametrize("solid", [{"boundary": "free"}, {"layer_thickness": 4e-4, "layer_poisson": 0.3}])
def test_layers_and_patches_have_it(solid):
    elastic = rc.solve(**SCENE, **solid)
    result = rc.solve(**SCENE, **solid, hardness=0.5 * elastic.max_pressure)
    assert 0.0 < result.plastic_area_fraction < result.area_fraction
    assert result.area_fraction > elastic.area_fraction
    assert result.gap.mean() == pytest.approx(result.mean_gap, rel=1e-6)
    assert sum(spot.area_fraction for spot in result.spots) == pytest.approx(result.area_fraction, rel=0.1)


LOADS = {"waves": 8, "grid": 128, "e_star": 1e9, "hardness": 5e6}


@pytest.mark.parametrize("method", ["uniform", "adaptive"])
def test_unloading_leaves_a_surface_that_bears_the_same_load(method):
    first = rc.solve(**LOADS, history=[1e6, "0Pa"], method=method)
    residual = first.residual
    assert residual.shape == first.gap.shape and not residual.flags.writeable and np.isfinite(residual).all()
    assert first.residual_rms_height == pytest.approx(residual.std(), rel=1e-9)
    assert first.control == "pressure" and first.mean_pressure == pytest.approx(1e6, rel=1e-9)
    again = rc.solve(residual, cell=first.sides[0], e_star=1e9, hardness=5e6, pressure=1e6, method=method)
    assert again.area_fraction_cells == pytest.approx(first.area_fraction_cells, rel=7e-3)
    assert again.mean_plastic_gap < 1e-3 * first.mean_plastic_gap
    copy = pickle.loads(pickle.dumps(first))
    assert copy.residual.tobytes() == residual.tobytes()


def test_a_history_is_a_list_an_array_or_text():
    given = [rc.solve(**LOADS, history=loads) for loads in ([5e5, 1e6], np.array([5e5, 1e6]), "0.5MPa,1MPa")]
    assert given[0].summary["residual_rms_height"] == given[1].residual_rms_height == given[2].residual_rms_height
    assert rc.solve(**SCENE, hardness=5e6).residual is None


def test_a_history_without_hardness_or_load_is_refused():
    with pytest.raises(ValueError, match="history: .* give hardness too"):
        rc.solve(waves=8, grid=64, history=[1e5, 0])
    with pytest.raises(ValueError, match="both pressure and history"):
        rc.solve(**LOADS, pressure=1e5, history=[1e5, 0])
    with pytest.raises(ValueError, match="history: one of the loads must be above 0"):
        rc.solve(**LOADS, history=[0, 0])
