"""A half-space whose symbol is a function."""

import warnings

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
    # 33 by 25 waves without the zero wave, in rad/m, then images of some.
    own = 33 * 25 - 1
    assert kx.shape == ky.shape and kx.min() < 0 and ky.min() < 0
    assert kx[:own].min() == ky[:own].min() == 0 and np.unique(np.stack([kx, ky])[:, :own], axis=1).shape == (2, own)
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
        (lambda kx, ky: -half_space(kx, ky), r"^kernel: the function returned -.* m at kx = .*, ky = .* rad/m; it must be positive and finite$"),
        (lambda kx, ky: np.full(kx.shape, np.nan), "kernel"),
        (lambda kx, ky: half_space(kx, 2 * ky), "kernel"),
    ]:
        with pytest.raises(ValueError, match=sentence):
            rc.solve(heights, **CONTACT, kernel=symbol)

    def fails(kx, ky):
        raise ZeroDivisionError("inside")

    with pytest.raises(ZeroDivisionError, match="inside"):
        rc.solve(heights, **CONTACT, kernel=fails)
    with pytest.raises(ValueError, match="^method: the method adaptive cannot be combined with a function as kernel"):
        rc.solve(heights, **CONTACT, kernel=half_space, method="adaptive")
    with pytest.raises(ValueError, match="^area_error: .* the function is evaluated on one grid only"):
        rc.solve(waves=8, pressure=1e5, area_error=0.01, kernel=half_space)


def test_its_result_is_saved_and_said_to_be_its_own(heights, command, tmp_path):
    result = rc.solve(heights, **CONTACT, kernel=half_space)
    result.save(tmp_path / "result")
    assert rc.load(tmp_path / "result").kernel == "own"
    result.report(tmp_path / "page.html")
    done = command("solve", tmp_path / "result" / "scene.toml")
    assert done.returncode == 2 and "function of a Python program" in done.stderr


@pytest.mark.parametrize(
    ("factor", "sentence"),
    [
        (lambda kx, ky: 1.0 + 0.1 * (kx < 0), "differ; they must be even in kx and in ky"),
        (lambda kx, ky: 1.0 + 0.1 * (kx * ky < 0), "differ; they must be even in kx and in ky"),
        (lambda kx, ky: 1.0 + 0.1 * (abs(kx) > 2 * abs(ky)), "on a square grid they must be the same with kx and ky exchanged"),
        # At one wave of a thousand.
        (lambda kx, ky: 1.0 + 0.1 * ((kx > 6280) & (kx < 6290) & (ky == 0)), "exchanged"),
    ],
)
def test_symmetry_is_checked_where_it_is_needed(heights, factor, sentence):
    with pytest.raises(ValueError, match=f"^kernel: the values for .* rad/m {sentence}" if sentence[0] == "d" else sentence):
        rc.solve(heights, **CONTACT, kernel=lambda kx, ky: factor(kx, ky) * half_space(kx, ky))


def test_axes_may_differ_where_the_grid_does(heights):
    stiffer = lambda kx, ky: half_space(kx, 1.2 * ky)  # noqa: E731
    part = np.ascontiguousarray(heights[:48])
    with pytest.warns(UserWarning, match="short waves"):
        assert rc.solve(part, **{**CONTACT, "e_star": 2e9}, cell_y=0.0075, kernel=stiffer).converged


def test_another_material_than_that_of_short_waves_is_named(heights):
    message = r"^kernel: at short waves, the function is nearest to a half-space with E\* ="
    for factor, named in ((2.0, "5.0000e8 Pa, but e_star, which locates contact edges, is 1.0000e9 Pa"), (1 / 0.91, "9.1000e8 Pa")):
        with pytest.warns(UserWarning, match=f"{message} {named}"):
            rc.solve(heights, **CONTACT, kernel=lambda kx, ky: factor * half_space(kx, ky))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rc.solve(heights, **CONTACT, kernel=half_space)
        # A layer on a stiffer base, which short waves do not see; and rounding.
        rc.solve(heights, **CONTACT, kernel=lambda kx, ky: half_space(kx, ky) * np.tanh(np.hypot(kx, ky) * 5e-4) * (1 + 1e-12))


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
    with pytest.raises(ValueError, match="layer_thickness: an elastic layer cannot be combined with a function as kernel"):
        rc.solve(heights, **CONTACT, kernel=layer, **keywords)


def test_a_patch_does_not_meet_itself(heights):
    patch = rc.solve(heights, **CONTACT, boundary="free")
    assert patch.mean_gap == pytest.approx(patch.gap.mean(), rel=1e-9)
    assert patch.penetration > rc.solve(heights, **CONTACT).penetration
    # Contact at both ends of a row is one spot in a cell, and two on a patch.
    trough = np.tile((np.arange(64) - 31.5) ** 2 * 1e-8, (64, 1))
    in_cell, alone = (rc.solve(trough, **CONTACT, boundary=boundary) for boundary in ("periodic", "free"))
    assert len(in_cell.spots) == 1 and len(alone.spots) == 2
    with pytest.raises(ValueError, match="^boundary: .* the function describes a periodic cell"):
        rc.solve(heights, **CONTACT, kernel=half_space, boundary="free")
    film = rc.solve(heights, **CONTACT, boundary="free", viscosity="1mPas", pressure_drop="1bar").leakage
    assert film.flow == pytest.approx([k * 1e5 / 12e-3 for k in film.permeance])
