"""Heights of every kind, and input that is refused."""

import pathlib

import numpy as np
import pytest

import roughcontact as rc

CONTACT = {"cell": 0.01, "e_star": 1e9, "pressure": 1e6, "method": "uniform"}


def test_an_array_is_read_in_place_and_left_alone(heights):
    from roughcontact._maps import as_heights

    assert as_heights(heights) is heights
    before = heights.copy()
    heights.setflags(write=False)
    try:
        rc.solve(heights, **CONTACT)
    finally:
        heights.setflags(write=True)
    assert np.array_equal(heights, before)


@pytest.mark.parametrize(
    "convert",
    [
        np.ndarray.tolist,
        np.asfortranarray,
        lambda h: np.repeat(h, 2, axis=1)[:, ::2],
        lambda h: h.astype(">f8"),
        lambda h: np.ma.masked_invalid(h),
        lambda h: rc.HeightMap(h),
        lambda h: rc.HeightMap(h, sides=(0.01, 0.01)),
    ],
    ids=["list", "Fortran", "strided", "big endian", "masked", "map", "map with a size"],
)
def test_heights_of_any_kind_have_the_same_digits(convert, heights, result):
    other = rc.solve(convert(heights), **CONTACT)
    assert other.pressure.tobytes() == result.pressure.tobytes()


def test_heights_of_other_types_are_converted(heights):
    single = heights.astype(np.float32)
    assert rc.solve(single, **CONTACT).summary["penetration"] == rc.solve(single.astype(float), **CONTACT).penetration
    levels = np.round(heights / 1e-6).astype(np.int16)
    assert rc.solve(levels, **{**CONTACT, "e_star": 1e9 * 1e-6}).converged


def test_an_array_with_names_is_turned_as_its_names_say(heights, result):
    xarray = pytest.importorskip("xarray")
    for array in (xarray.DataArray(heights, dims=("y", "x")), xarray.DataArray(heights.T, dims=("x", "y"))):
        assert rc.solve(array, **CONTACT).pressure.tobytes() == result.pressure.tobytes()


def test_a_map_brings_its_size_along_and_is_not_contradicted(heights, result):
    sized = rc.HeightMap(heights, sides=(0.01, 0.01))
    keys = {**CONTACT}
    del keys["cell"]
    assert rc.solve(sized, **keys).pressure.tobytes() == result.pressure.tobytes()
    with pytest.raises(ValueError, match="the map is 10 mm wide, cell says 20 mm"):
        rc.solve(sized, **{**CONTACT, "cell": 0.02})


def test_a_surface_is_the_random_surface_of_its_keywords():
    surface = rc.Surface(waves=8, seed=3, grid=64)
    one = rc.solve(surface, pressure=1e5)
    other = rc.solve(waves=8, seed=3, grid=64, pressure=1e5)
    assert one.pressure.tobytes() == other.pressure.tobytes()
    assert rc.solve(surface, grid=32, pressure=1e5).grid == [32, 32]
    assert surface.resolved()["hurst"] == 0.8


def test_a_scene_file_is_solved_and_overridden(heights, result, tmp_path):
    scene = tmp_path / "scene.toml"
    scene.write_text("waves = 8\nseed = 3\ngrid = 64\npressure = 1e5\n")
    assert rc.solve(scene=scene).mean_pressure == pytest.approx(1e5)
    assert rc.solve(scene=scene, pressure=2e5).mean_pressure == pytest.approx(2e5)
    scene.write_text("waves = 8\ncell = 0.01\ne_star = 1e9\npressure = 1e6\nmethod = 'uniform'\n")
    assert rc.solve(heights, scene=scene).pressure.tobytes() == result.pressure.tobytes()


def test_files_of_every_format_are_read(result, tmp_path, heights):
    np.save(tmp_path / "map.npy", heights)
    read = rc.read(tmp_path / "map.npy")
    assert read == rc.HeightMap(heights)
    np.savetxt(tmp_path / "map.csv", heights * 1e6, delimiter=",", fmt="%.17g")
    assert rc.read(tmp_path / "map.csv", unit="um").heights == pytest.approx(heights, rel=1e-14)
    solved = rc.solve(tmp_path / "map.npy", **CONTACT)
    assert solved.pressure.tobytes() == result.pressure.tobytes()


@pytest.mark.parametrize(
    ("heights", "sentence"),
    [
        ([1.0, 2.0], "must be a 2-D array, shape"),
        (np.zeros((2, 2, 2)), "must be a 2-D array, shape"),
        ([[1.0, 2.0], [3.0]], "must be a 2-D array of numbers"),
        ([["a", "b"], ["c", "d"]], "must be a 2-D array of numbers"),
        (np.ones((2, 2), complex), "must be a 2-D array of numbers"),
        (np.zeros((0, 4)), "heights: "),
        ([[1.0, np.nan], [0.0, 2.0]], r"row 0, column 1 \(from 0\) is NaN"),
        ([[1.0, np.inf], [0.0, 2.0]], r"row 0, column 1 \(from 0\) is inf"),
        (np.ones((4, 4)), "a flat surface has no contact problem"),
    ],
)
def test_heights_that_cannot_be_solved_are_refused(heights, sentence):
    with pytest.raises(ValueError, match=f"^heights: .*{sentence}" if "heights: " not in sentence else sentence):
        rc.solve(heights, cell=1.0, e_star=1.0, pressure=1e-3)


def test_values_of_a_wrong_kind_are_refused():
    with pytest.raises(TypeError, match="pressure: must be a number or text, not dict"):
        rc.solve(pressure={})
    with pytest.raises(TypeError, match="unexpected keyword argument 'presure'"):
        rc.solve(presure=1.0)
    with pytest.raises(ValueError, match="^method: unknown variant"):
        rc.solve(pressure=1.0, method="fft")
    with pytest.raises(ValueError, match="^hurst: must be above 0"):
        rc.Surface(hurst=2.0)
    with pytest.raises(ValueError, match="no-such-file"):
        rc.read("no-such-file.npy")


def test_a_topography_brings_its_size_and_unit_along(heights):
    topographies = pytest.importorskip("SurfaceTopography")
    part = heights[:48]
    # Its arrays have x first.
    topography = topographies.Topography(1e6 * part.T, (10e3, 7.5e3), unit="µm", periodic=True)
    one = rc.solve(topography, e_star=1e9, pressure=1e6)
    other = rc.solve(part, cell=0.01, cell_y=0.0075, e_star=1e9, pressure=1e6)
    assert one.sides == pytest.approx((0.01, 0.0075), rel=1e-12)
    assert one.pressure == pytest.approx(other.pressure, abs=1e-6 * other.max_pressure)


def test_channels_of_a_file_are_listed_and_picked():
    file = pathlib.Path(__file__).parents[2] / "data/formats/h5py-chunked.h5"
    names = rc.channels(file)
    assert set(names.values()) == {True, False}, names
    first = next(name for name, is_height in names.items() if is_height)
    assert np.array_equal(rc.read(file, channel=first).heights, rc.read(file).heights, equal_nan=True)
    with pytest.raises(ValueError, match="channel"):
        rc.read(file, channel="not there")


def test_a_file_of_waves_is_a_surface(tmp_path):
    file = tmp_path / "waves.txt"
    file.write_text("# one wave\n2 0 5e-7 0\n")
    surface = rc.Surface(spectrum=file, cell=1e-3, grid=64)
    x = (np.arange(64) + 0.5) / 64
    assert np.allclose(surface.heights(), 1e-6 * np.cos(4 * np.pi * x), atol=1e-18)
    solved = [rc.solve(h, pressure=1e5, e_star=1e9, grid=64, **k) for h, k in ((surface, {}), (None, {"spectrum": file, "cell": 1e-3}))]
    assert np.array_equal(solved[0].pressure, solved[1].pressure)
    solved[0].save(tmp_path / "out")
    again = rc.solve(scene=tmp_path / "out/scene.toml")
    assert np.array_equal(again.pressure, solved[0].pressure)
