"""Current through contact spots."""

import numpy as np
import pytest

import roughcontact as rc

SCENE = {"waves": 8, "grid": 128, "e_star": 1e9, "pressure": 2e6}


def test_elastic_spots_conduct_as_they_are_stiff():
    result = rc.solve(**SCENE)
    by_stiffness = result.contact_stiffness / 1e9
    assert abs(result.contact_conductance - by_stiffness) <= 2 * result.contact_conductance_error
    assert 0 < result.contact_conductance_error < 0.1 * result.contact_conductance
    assert result.conductance is None


@pytest.mark.parametrize("solid", [{"hardness": 3e7}, {"layer_thickness": 5e-4, "layer_poisson": 0.3}])
def test_conductivities_of_two_bodies_give_their_harmonic_mean(solid):
    by = {given: rc.solve(**SCENE, **solid, conductivity=given) for given in (400.0, (400, 50), "400,50")}
    of_unit = by[400.0].contact_conductance
    assert by[400.0].conductance == pytest.approx(400 * of_unit, rel=1e-14)
    for given in ((400, 50), "400,50"):
        assert by[given].conductance == pytest.approx(2 / (1 / 400 + 1 / 50) * of_unit, rel=1e-14)
        relative = by[given].contact_conductance_error / of_unit
        assert by[given].conductance_error == pytest.approx(relative * by[given].conductance, rel=1e-12)
    table = rc.sweep(waves=8, grid=128, e_star=1e9, pressures=[2e6], **solid, conductivity=400.0)
    assert table[0]["conductance"] == by[400.0].conductance
    assert table[0]["conductance_error"] == by[400.0].conductance_error


def test_the_symbol_of_a_half_space_conducts_as_the_spectral_kernel():
    def half_space(kx, ky):
        return 2 / (1e9 * np.hypot(kx, ky))

    own, named = rc.solve(**SCENE, kernel=half_space), rc.solve(**SCENE, kernel="spectral")
    assert own.contact_conductance == pytest.approx(named.contact_conductance, rel=1e-6)


def test_a_soft_metal_conducts_better():
    found = [rc.solve(**SCENE, **soft).contact_conductance for soft in ({}, {"hardness": 2e7}, {"hardness": 8e6})]
    assert found[0] < found[1] < found[2]


def test_what_is_no_conductivity_is_refused():
    with pytest.raises(ValueError, match="conductivit"):
        rc.solve(**SCENE, conductivity=-1.0)


def test_a_gas_conducts_through_the_gap():
    result = rc.solve(**SCENE, jump_distance="0.1um")
    inverse = 1 / (1e-7 + np.where(result.pressure > 0, 0.0, result.gap))
    assert result.mean_inverse_gap == pytest.approx(inverse.mean(), rel=1e-12)
    assert rc.solve(**SCENE).mean_inverse_gap is None
    table = rc.sweep(waves=8, grid=128, e_star=1e9, pressures=[2e6], jump_distance=1e-7)
    assert table[0]["mean_inverse_gap"] == result.mean_inverse_gap
    with pytest.raises(ValueError, match="jump_distance: must be positive"):
        rc.solve(**SCENE, jump_distance=0.0)
