"""A half-space whose symbol is a function."""

import numpy as np
import pytest

import roughcontact as rc

CONTACT = {"cell": 0.01, "e_star": 1e9, "pressure": 1e6}


def half_space(kx, ky):
    """The symbol 2/(E* |k|) (m/Pa)."""
    return 2.0 / (1e9 * np.hypot(kx, ky))


def test_the_half_space_as_a_function_is_the_kernel_spectral(heights):
    own = rc.solve(heights, **CONTACT, kernel=half_space, tolerance=1e-9)
    named = rc.solve(heights, **CONTACT, kernel="spectral", tolerance=1e-9)
    assert own.kernel == "own"
    assert np.abs(own.pressure - named.pressure).max() < 1e-6 * named.max_pressure
    assert own.contact_stiffness == pytest.approx(named.contact_stiffness, rel=1e-3)


def test_the_function_sees_wavenumbers_once(heights):
    calls = []

    def symbol(kx, ky):
        calls.append((kx.copy(), ky.copy()))
        return half_space(kx, ky)

    rc.solve(np.ascontiguousarray(heights[:48]), **CONTACT, cell_y=0.0075, kernel=symbol)
    ((kx, ky),) = calls
    # 33 by 25 waves without the zero wave, in rad/m.
    assert kx.shape == ky.shape == (33 * 25 - 1,)
    assert kx.max() == pytest.approx(2 * np.pi * 32 / 0.01) and ky.max() == pytest.approx(2 * np.pi * 24 / 0.0075)


def test_a_stiffer_solid_has_less_contact(heights):
    # A layer that is stiffer for waves longer than its thickness.
    thin = rc.solve(heights, **CONTACT, kernel=lambda kx, ky: half_space(kx, ky) * np.tanh(np.hypot(kx, ky) * 5e-4))
    thick = rc.solve(heights, **CONTACT, kernel=half_space)
    assert thin.area_fraction < thick.area_fraction


def test_a_function_that_is_not_a_solid_is_refused(heights):
    for symbol, sentence in [
        (lambda kx, ky: 1.0, "one number for each wave"),
        (lambda kx, ky: half_space(kx, ky)[:-1], "one number for each wave"),
        (lambda kx, ky: -half_space(kx, ky), "kernel"),
        (lambda kx, ky: np.full(kx.shape, np.nan), "kernel"),
        (lambda kx, ky: half_space(kx, 2 * ky), "kernel"),
    ]:
        with pytest.raises(ValueError, match=sentence):
            rc.solve(heights, **CONTACT, kernel=symbol)

    def fails(kx, ky):
        raise ZeroDivisionError("inside")

    with pytest.raises(ZeroDivisionError, match="inside"):
        rc.solve(heights, **CONTACT, kernel=fails)
    with pytest.raises(ValueError, match="so kernel must be love"):
        rc.solve(heights, **CONTACT, kernel=half_space, method="adaptive")
    with pytest.raises(ValueError, match="area_error: a function for a kernel"):
        rc.solve(waves=8, pressure=1e5, area_error=0.01, kernel=half_space)


def test_its_result_is_saved_and_said_to_be_its_own(heights, command, tmp_path):
    result = rc.solve(heights, **CONTACT, kernel=half_space)
    result.save(tmp_path / "result")
    assert rc.load(tmp_path / "result").kernel == "own"
    result.report(tmp_path / "page.html")
    done = command("solve", tmp_path / "result" / "scene.toml")
    assert done.returncode == 2 and "function of a Python program" in done.stderr


def test_the_layer_as_a_function_is_the_layer_by_its_keywords(heights):
    poisson, thickness = 0.3, 4e-4

    def layer(kx, ky):
        k = np.hypot(kx, ky)
        x, kappa = np.minimum(2 * k * thickness, 300), 3 - 4 * poisson
        factor = (kappa * np.sinh(x) - x) / (kappa * np.cosh(x) + (1 + kappa**2) / 2 + x**2 / 2)
        return 2 * factor / (1e9 * k)

    own = rc.solve(heights, **CONTACT, kernel=layer, tolerance=1e-9)
    keywords = {"layer_thickness": thickness, "layer_poisson": poisson}
    named = rc.solve(heights, **CONTACT, kernel="spectral", tolerance=1e-9, **keywords)
    assert np.abs(own.pressure - named.pressure).max() < 1e-6 * named.max_pressure
    compressed = 1e6 * thickness * (1 - 2 * poisson) / (1e9 * (1 - poisson) ** 2)
    assert named.penetration == pytest.approx(own.penetration + compressed, rel=1e-9)
    assert named.mean_gap == pytest.approx(own.mean_gap, rel=1e-6)
    # Two springs in series.
    soft = 1 / (1 / own.contact_stiffness + compressed / 1e6)
    assert named.contact_stiffness == pytest.approx(soft, rel=3e-3)
    with pytest.raises(ValueError, match="layer_thickness: a function"):
        rc.solve(heights, **CONTACT, kernel=layer, **keywords)


def test_a_patch_does_not_meet_itself(heights):
    patch = rc.solve(heights, **CONTACT, boundary="free")
    assert patch.mean_gap == pytest.approx(patch.gap.mean(), rel=1e-9)
    assert patch.penetration > rc.solve(heights, **CONTACT).penetration
    # Contact at both ends of a row is one spot in a cell, and two on a patch.
    trough = np.tile((np.arange(64) - 31.5) ** 2 * 1e-8, (64, 1))
    in_cell, alone = (rc.solve(trough, **CONTACT, boundary=boundary) for boundary in ("periodic", "free"))
    assert len(in_cell.spots) == 1 and len(alone.spots) == 2
    with pytest.raises(ValueError, match="boundary: a function"):
        rc.solve(heights, **CONTACT, kernel=half_space, boundary="free")
