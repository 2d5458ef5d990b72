"""Shear with partial slip."""

import pickle

import numpy as np
import pytest

import roughcontact as rc

SCENE = {"waves": 8, "grid": 64, "young": "3MPa", "poisson": 0.5, "pressure": "20kPa"}


def test_a_shear_has_fields_and_numbers():
    result = rc.solve(**SCENE, friction=0.4, shear_pressure="3kPa", shear_angle=90)
    assert result.shear_y.mean() == pytest.approx(3e3) and result.shear_pressure == pytest.approx(3e3)
    assert result.shear_force == pytest.approx(3e3 * 1e-4) and result.coulomb_friction == 0.4
    traction, limit = np.hypot(result.shear_x, result.shear_y), 0.4 * result.pressure
    assert (traction <= limit * (1 + 1e-9)).all()
    assert traction[result.slip > 0] == pytest.approx(limit[result.slip > 0])
    assert result.stick_area_fraction + result.slip_area_fraction == pytest.approx(result.area_fraction)
    assert 0 < result.shear_error <= 0.01 and result.shear_rounds > 0 and result.slip_work > 0
    assert result.tangential_stiffness == pytest.approx(result.contact_stiffness / 1.5)
    again = rc.solve(**SCENE, friction=0.4, shear_displacement=result.shear_displacement, shear_angle=90)
    assert again.shear_pressure == pytest.approx(3e3, rel=1e-2)
    kept = pickle.loads(pickle.dumps(result))
    assert np.array_equal(kept.slip, result.slip) and kept.shear_displacement == result.shear_displacement


def test_without_friction_there_is_no_shear():
    result = rc.solve(**SCENE)
    assert result.slip is None and result.shear_x is None and result.shear_force is None


def test_a_shear_that_cannot_be_is_refused():
    with pytest.raises(ValueError, match="shear_pressure: 8 kPa slides as a whole"):
        rc.solve(**SCENE, friction=0.4, shear_pressure="8kPa")
    with pytest.raises(ValueError, match="couple pressure and traction"):
        rc.solve(**{**SCENE, "poisson": 0.3}, friction=0.4, shear_pressure="1kPa")
