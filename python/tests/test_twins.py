"""Surfaces from measurements: tables of a spectrum, and twins of maps and profiles."""

from __future__ import annotations

import numpy as np
import pytest

import roughcontact as rc

CELL = 1e-3
CONTACT = {"e_star": 1e9, "pressure": 1e5}


@pytest.fixture
def files(tmp_path, monkeypatch):
    """A table, a skewed map and a profile in the working folder."""
    monkeypatch.chdir(tmp_path)
    q = 2 * np.pi / CELL * np.array([1, 4, 16])
    np.savetxt("psd.csv", np.c_[q, 1e-22 * np.array([1, 1, 1e-2])], delimiter=",", header="q,C")
    rough = rc.surface(waves=8, roll_off=2, grid=48, seed=2, cell=CELL, rms=1e-6)
    np.save("map.npy", 1e-6 * np.exp(rough / 1e-6))
    x = 1e-6 * np.arange(256)
    np.savetxt("profile.txt", np.c_[x, 1e-7 * np.sin(x**2 * 3e9)])
    return tmp_path


def test_a_spectrum_gives_another_surface_for_each_seed_and_that_of_the_command(files, command):
    keys = {"psd": "psd.csv", "cell": CELL, "grid": 64}
    first, second = (rc.surface(**keys, seed=seed) for seed in (1, 2))
    # <h^2> is the integral of C over the wave vectors.
    assert np.std(first) == pytest.approx(np.std(second), rel=1e-9)
    assert not np.allclose(first, second)
    fourier = rc.surface(**keys, psd_convention="fourier")
    assert np.allclose(fourier * 2 * np.pi, first, rtol=1e-9, atol=1e-18)
    done = command("surface", "--psd", "psd.csv", "--cell", CELL, "--grid", 64, "--quiet", "--out", "made.npy")
    assert done.returncode == 0, done.stderr
    assert np.array_equal(np.load("made.npy"), first)


def test_a_twin_has_the_heights_of_the_map_unless_they_are_gaussian(files):
    heights = np.load("map.npy")
    keys = {"like": "map.npy", "cell": CELL}
    twin = rc.surface(**keys, seed=3)
    assert np.array_equal(np.sort(twin, axis=None), np.sort(heights, axis=None))
    assert not np.array_equal(twin, heights)
    gaussian = rc.surface(**keys, seed=3, heights_like="gaussian")
    assert np.std(gaussian) == pytest.approx(np.std(heights), rel=1e-6)
    skewness = [np.mean(((h - h.mean()) / h.std()) ** 3) for h in (heights, twin, gaussian)]
    assert skewness[1] == pytest.approx(skewness[0], rel=1e-9)
    assert abs(skewness[2]) < 0.5 * skewness[0]


def test_twins_are_solved_and_swept(files):
    keys = {"like": "map.npy", "cell": CELL}
    result = rc.solve(**keys, **CONTACT, seed=2)
    assert result.summary["source"]["treatments"] == ["twin, seed 2"]
    table = rc.sweep(**keys, e_star=1e9, pressures=1e5, seeds=[1, 2, 3])
    assert table["area_fraction"][1] == pytest.approx(result.area_fraction, rel=1e-9)
    assert len(set(table["area_fraction"])) == 3


def test_a_profile_gives_a_surface(files):
    result = rc.solve(like="profile.txt", unit="m", grid=64, **CONTACT)
    source = result.summary["source"]
    assert source["file"] == "profile.txt"
    assert "profile" in source["treatments"][0]
    with pytest.raises(ValueError, match="a profile gives a spectrum only"):
        rc.surface(like="profile.txt", unit="m", grid=64, heights_like="map")


def test_what_does_not_fit_is_named(files):
    with pytest.raises(ValueError, match="psd and like both define the surface"):
        rc.surface(psd="psd.csv", like="map.npy", cell=CELL)
    with pytest.raises(ValueError, match="give --like FILE|like"):
        rc.surface(heights_like="gaussian", cell=CELL)
    with pytest.raises(ValueError, match="heights_like"):
        rc.surface(like="map.npy", cell=CELL, heights_like="normal")


def test_inspect_states_the_ends_of_the_power_law():
    heights = rc.surface(waves=64, roll_off=8, hurst=0.7, grid=256, seed=1, cell=CELL, rms=1e-6)
    found = rc.inspect(heights, cell=CELL)
    assert abs(found["hurst"] - 0.7) < 3 * found["hurst_error"]
    assert found["roll_off_wavelength"] == pytest.approx(CELL / 8, rel=0.35)
    assert found["cut_off_wavelength"] == pytest.approx(CELL / 64, rel=0.02)
    assert found["resolution_wavelength"] == pytest.approx(2 * CELL / 256)
    assert found["resolution_reason"] == "spacing of the points"
