"""Heights of every kind, and input that is refused."""

import pathlib
import warnings

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
    with pytest.raises(ValueError, match="the map is 10 mm wide, but cell says 20 mm"):
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
        (np.ones((4, 4)), "a flat surface in a periodic cell has no contact problem"),
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
    with pytest.raises(ValueError, match="^method: must be 'adaptive' or 'uniform' or 'gauss-seidel', not 'fft'$"):
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


def test_a_file_of_waves_is_found_from_everywhere(tmp_path, monkeypatch):
    (tmp_path / "waves.txt").write_text("2 0 5e-7 0\n")
    monkeypatch.chdir(tmp_path)
    surface = rc.Surface(spectrum="waves.txt", cell=1e-3, grid=64)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert surface.heights().shape == (64, 64)
    assert rc.solve(surface, pressure=1e5, e_star=1e9).converged


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"cell": (1.0, 2.0)}, "^cell: must be a number or text, not tuple; the other side is cell_y$"),
        ({"pressure": [1e5, 2e5]}, "^pressure: must be a number or text, not list; roughcontact.sweep solves for several$"),
        ({"seed": range(3)}, "^seed: must be a number or text, not range; roughcontact.sweep solves for several$"),
        ({"seed": -1}, "^seed: must be a whole number of at least 0, not -1$"),
        ({"seed": 2**64}, "^seed: 18446744073709551616 is too large$"),
        ({"threads": -1}, "^threads: must be a whole number of at least 0, not -1$"),
        ({"threads": True}, "^threads: must be a whole number of at least 0, not True$"),
        ({"waves": 8.5}, "^waves: must be a whole number of at least 0, not 8.5$"),
        ({"pressure": "much"}, "^pressure: must be "),
        ({"kernel": "foo"}, "^kernel: must be 'love' or 'spectral', not 'foo'$"),
        ({"progress": 3}, "^progress: must be True, False or a function, not 3$"),
        ({"unit": "um"}, "^unit and height_scale apply to surfaces from files; give heights or spectrum, or omit them$"),
    ],
)
def test_values_are_refused_in_the_words_of_python(keys, sentence):
    with pytest.raises((TypeError, ValueError), match=sentence):
        rc.solve(**{"waves": 8, "grid": 64, "pressure": 1e5, **keys})


def test_missing_points_are_filled_by_what_the_message_names(heights):
    holes = heights.copy()
    holes[3, 4] = np.nan
    with pytest.raises(ValueError, match=r'roughcontact.prepare\(heights, fill="laplace"\) fills the missing points \(1 of 4096\)$'):
        rc.solve(holes, **CONTACT)
    assert rc.solve(rc.prepare(holes, fill="laplace"), **CONTACT).converged


def test_no_size_is_invented(heights):
    with pytest.raises(ValueError, match="^cell: must be given"):
        rc.inspect(heights)
    assert rc.inspect(rc.HeightMap(heights, (0.02, 0.02)))["rms_slope"] == pytest.approx(
        0.5 * rc.inspect(heights, cell=0.01)["rms_slope"]
    )
    for what in (rc.Surface(waves=8, grid=64), rc.solve(heights, **CONTACT)):
        with pytest.raises(ValueError, match="^cell: a surface and a result have their own"):
            rc.inspect(what, cell=0.02)


def test_sides_of_a_map_are_two_lengths_and_not_contradicted(heights):
    for sides in ((0.0, 1.0), (1.0, -1.0), (np.nan, 1.0), (1.0, np.inf), (1.0,), 1.0, ("a", 1.0)):
        with pytest.raises(ValueError, match="^sides: must be"):
            rc.HeightMap(heights, sides)
    part = heights[:48]
    for keys, sentence in [
        ({"cell": -1.0}, "^cell: must be positive"),
        ({"cell": 1.0, "cell_y": 0.0}, "^cell_y: must be positive"),
        ({"cell_y": 1.0}, r"^cell: must be given \(m\) beside cell_y"),
    ]:
        with pytest.raises(ValueError, match=sentence):
            rc.prepare(part, level="plane", **keys)
    assert rc.prepare(part, cell=0.01, cell_y=0.0075).sides == (0.01, 0.0075)
    sized = rc.HeightMap(part, (0.01, 0.0075))
    with pytest.raises(ValueError, match="^heights: the map is 0.0075 m high, but cell_y says 0.01 m; omit cell_y"):
        rc.prepare(sized, cell=0.01, cell_y=0.01)
    assert rc.prepare(sized, cell=0.01).sides == sized.sides


def test_axes_are_flipped_one_or_several(heights):
    both = rc.prepare(heights, flip=("x", "y")).heights
    assert np.array_equal(both, heights[::-1, ::-1]) and np.array_equal(rc.prepare(heights, flip="x,y").heights, both)
    assert np.array_equal(rc.prepare(heights, crop=(32, 16)).heights, rc.prepare(heights, crop="32x16").heights)
    with pytest.raises(ValueError, match="flip"):
        rc.prepare(heights, flip=("x", "w"))


def test_spikes_go_and_other_points_stay(heights):
    spiky = heights.copy()
    spiky[20, 33] += 1e-3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        despiked = rc.prepare(spiky, cell=0.01, despike=True).heights
    assert [tuple(at) for at in np.argwhere(despiked != spiky)] == [(20, 33)]
    assert abs(despiked[20, 33] - heights[20, 33]) < 0.5 * np.std(heights)
    assert np.array_equal(rc.prepare(spiky, cell=0.01, despike=8.0).heights, despiked)
    with pytest.warns(rc.InputWarning, match="far from all neighbours"):
        assert np.array_equal(rc.prepare(spiky, cell=0.01, despike=False).heights, spiky)
    with pytest.raises(ValueError, match="despike: must be 3 or more"):
        rc.prepare(heights, cell=0.01, despike=1)


def test_high_pass_is_what_low_pass_leaves(heights):
    short, long = (rc.prepare(heights, cell=0.01, **{name: 2e-3}).heights for name in ("high_pass", "low_pass"))
    assert abs(short + long - heights).max() < 1e-12 * np.std(heights)


def test_arrays_with_names_and_units_of_other_packages_are_heights(heights, result):
    xarray = pytest.importorskip("xarray")
    named = xarray.DataArray(heights, dims=("y", "x"), name="height")
    assert rc.solve(named, **CONTACT).pressure.tobytes() == result.pressure.tobytes()
    assert np.array_equal(rc.prepare(named.transpose("x", "y"), level="mean").heights, rc.prepare(heights, level="mean").heights)
    assert rc.inspect(named, cell=0.01) == rc.inspect(heights, cell=0.01)
