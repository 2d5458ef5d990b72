"""Arrays of other packages are read like files of them, and what is no map is named as what it is."""

import warnings

import numpy as np
import pytest

import roughcontact as rc

CONTACT = {"e_star": 1e9, "pressure": 1e6, "method": "uniform"}


@pytest.fixture
def rough():
    """Heights of 20 x 30 points, in some unit."""
    return np.random.default_rng(5).normal(size=(20, 30))


# xarray


def named(values, x, y, unit="um", units=("um", "um"), dims=("y", "x")):
    xarray = pytest.importorskip("xarray")
    attributes = [{} if unit is None else {"units": unit} for unit in units]
    coordinates = {dims[1]: (dims[1], x, attributes[0]), dims[0]: (dims[0], y, attributes[1])}
    attrs = {} if unit is None else {"units": unit}
    return xarray.DataArray(values, dims=dims, coords=coordinates, attrs=attrs, name="height")


@pytest.mark.parametrize(("unit", "metres"), [("um", 1e-6), ("micrometer", 1e-6), ("mm", 1e-3), ("nm", 1e-9), ("m", 1.0)])
def test_units_and_coordinates_give_metres_and_sides(rough, unit, metres):
    array = named(rough, 0.5 * np.arange(30.0), 0.25 * np.arange(20.0), unit, ("mm", "mm"))
    read = rc.HeightMap(array)
    assert np.array_equal(read.heights, rough * metres)
    assert read.sides == pytest.approx((15e-3, 5e-3), rel=1e-12)
    assert rc.HeightMap(array.transpose("x", "y")) == read


@pytest.mark.parametrize("flip", ["x", "y", "xy"])
def test_decreasing_coordinates_reverse_the_array(rough, flip):
    x, y, turned = np.arange(30.0), np.arange(20.0), rough
    if "x" in flip:
        x, turned = x[::-1], turned[:, ::-1]
    if "y" in flip:
        y, turned = y[::-1], turned[::-1]
    read = rc.HeightMap(named(turned, x, y))
    assert np.array_equal(read.heights, rough * 1e-6) and read.sides == pytest.approx((30e-6, 20e-6))


def test_an_array_and_its_file_agree(rough, tmp_path):
    pytest.importorskip("netCDF4")
    holes = rough.copy()
    holes[3, 4] = -9999.0
    for values, attributes, keys in [
        (rough, {"units": "um"}, {}),
        (rough, {"unit": "nm"}, {}),
        (rough.astype("f4"), {"units": "mm"}, {}),
        (holes, {"units": "um", "missing_value": -9999.0}, {}),
        (np.round(1000 * rough).astype("i4"), {"units": "m", "scale_factor": 1e-9, "add_offset": 2e-9}, {}),
        (rough, {"units": "um"}, {"x": np.arange(30.0)[::-1]}),
    ]:
        array = named(values, keys.get("x", 0.1 * np.arange(30.0)), 0.1 * np.arange(20.0), None, ("um", None))
        array.attrs.update(attributes)
        path = tmp_path / f"{len(list(tmp_path.iterdir()))}.nc"
        array.to_netcdf(path)
        file, memory = rc.read(path), rc.HeightMap(array)
        assert memory.sides == pytest.approx(file.sides, rel=1e-12), attributes
        assert memory.missing == file.missing
        assert np.allclose(memory.heights, file.heights, rtol=1e-12, atol=0.0, equal_nan=True), attributes


def test_coordinates_that_are_no_lengths_or_not_even_are_named(rough):
    x, y = np.arange(30.0), np.arange(20.0)
    with pytest.raises(ValueError, match="^unit of x: 'degrees_east' is not a unit of length"):
        rc.HeightMap(named(rough, x, y, units=("degrees_east", "um")))
    with pytest.raises(ValueError, match="^heights: 'K' is not a unit of length"):
        rc.HeightMap(named(rough, x, y, unit="K"))
    with pytest.raises(ValueError, match="^y: is not evenly spaced: value 7 "):
        rc.HeightMap(named(rough, x, np.where(y == 7, 7.2, y)))
    assert rc.HeightMap(named(rough, x, np.where(y == 7, 7.05, y))).sides == pytest.approx((30e-6, 20e-6))
    # Angles are no coordinates of a map.
    assert rc.HeightMap(named(rough, x, y, units=(None, None), dims=("lat", "lon"))).sides is None
    assert rc.HeightMap(rc.HeightMap(rough, (1.0, 2.0))).sides == (1.0, 2.0)


def test_heights_without_a_unit_beside_coordinates_with_one_are_doubted(rough):
    array = named(rough, np.arange(30.0), np.arange(20.0), unit=None)
    with pytest.warns(rc.InputWarning, match="^assumed: the heights have no attribute units"):
        assert np.array_equal(rc.HeightMap(array).heights, rough)
    with pytest.raises(ValueError, match="assumed: the heights"):
        rc.solve(array, **CONTACT, strict=True)


def test_a_dataset_and_a_band_are_maps(rough):
    xarray = pytest.importorskip("xarray")
    array = named(rough, np.arange(30.0), np.arange(20.0))
    assert rc.HeightMap(array.expand_dims("band")) == rc.HeightMap(array)
    assert rc.HeightMap(array.to_dataset()) == rc.HeightMap(array)
    with pytest.raises(ValueError, match="this one has 2"):
        rc.HeightMap(xarray.Dataset({"a": array, "b": array}))


def test_quantities_are_converted(rough):
    pint = pytest.importorskip("pint")
    units = pint.UnitRegistry()
    assert rc.HeightMap(rough * units.um).heights == pytest.approx(rough * 1e-6, rel=1e-12)
    with pytest.raises(ValueError, match="^heights: 'kelvin' is not a unit of length"):
        rc.HeightMap(rough * units.kelvin)


# Tables and points


def points_of(rough, order="xyz"):
    ny, nx = rough.shape
    x, y = np.meshgrid(0.5e-6 * np.arange(nx), 0.25e-6 * np.arange(ny))
    columns = {"x": x.ravel(), "y": y.ravel(), "z": rough.ravel()}
    return np.column_stack([columns[name] for name in order])


def test_points_on_a_grid_are_a_map_in_any_order(rough):
    points = points_of(rough)
    np.random.default_rng(1).shuffle(points)
    read = rc.HeightMap(points)
    assert np.array_equal(read.heights, rough) and read.sides == pytest.approx((15e-6, 5e-6), rel=1e-9)
    assert rc.inspect(points)["rms_height"] == pytest.approx(rough.std())


def test_scattered_points_are_named_as_points():
    points = np.random.default_rng(1).random((600, 3))
    for call in (lambda: rc.solve(points, cell=1.0, **CONTACT), lambda: rc.HeightMap(points), lambda: rc.prepare(points)):
        with pytest.raises(ValueError, match=r"^heights: the 600 x 3 array is a list of points x, y, z, not a map") as error:
            call()
        assert "layout" not in str(error.value) and "\n" not in str(error.value)
    assert rc.HeightMap(points, (1.0, 1.0)).shape == (600, 3), "the caller says that it is a map"


def test_profiles_are_named_as_profiles(rough):
    for profile in (rough[0], np.column_stack([np.arange(30.0), rough[0]])):
        for call in (lambda p: rc.solve(p, cell=1.0, **CONTACT), rc.HeightMap, rc.inspect):
            with pytest.raises(ValueError, match="^heights: .* profile"):
                call(profile)


def test_a_line_scan_is_named_as_one():
    class UniformLineScan:
        """As that of SurfaceTopography."""

        dim, physical_sizes, unit = 1, (1.0,), "nm"

        def heights(self):
            return np.zeros(8)

    with pytest.raises(ValueError, match=r"^heights: the topography \(UniformLineScan\) is a line scan, a profile"):
        rc.solve(UniformLineScan(), **CONTACT)


def test_line_scans_of_surface_topography_are_named():
    topographies = pytest.importorskip("SurfaceTopography")
    x = np.arange(16.0)
    for scan in (topographies.UniformLineScan(x % 3, 16.0, unit="nm"), topographies.NonuniformLineScan(x, x % 3, unit="nm")):
        with pytest.raises(ValueError, match="is a line scan, a profile"):
            rc.solve(scan, **CONTACT)


def test_tables_are_maps_or_points_without_their_counters(rough, tmp_path):
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame(rough)
    assert np.array_equal(rc.HeightMap(table).heights, rough)
    table.to_csv(tmp_path / "map.csv")
    again = pandas.read_csv(tmp_path / "map.csv")
    assert rc.HeightMap(again).heights == pytest.approx(rough)
    for order in ("xyz", "zyx", "yzx"):
        points = pandas.DataFrame(points_of(rough, order), columns=[f"{name.upper()} (m)" for name in order])
        read = rc.HeightMap(points)
        assert np.array_equal(read.heights, rough) and read.sides == pytest.approx((15e-6, 5e-6), rel=1e-9)
    with pytest.raises(ValueError, match="columns x, y and z"):
        rc.HeightMap(pandas.DataFrame(np.ones((20, 4)), columns=["x", "y", "a", "b"]))


# Sizes


def test_spacings_are_equal_without_a_size_for_y_and_this_is_said(heights):
    part = heights[:48]
    for call in (
        lambda **keys: rc.solve(part, **CONTACT, **keys).sides,
        lambda **keys: rc.prepare(part, level="mean", **keys).sides,
        lambda **keys: rc.inspect(part, **keys)["rms_slope"],
        lambda **keys: rc.sweep(part, pressures=[1e6], e_star=1e9, method="uniform", **keys)["area_fraction"].tolist(),
    ):
        with pytest.warns(rc.InputWarning, match="^assumed: equal spacings .*cell_y says otherwise") as told:
            assumed = call(cell=0.01)
        # That the part does not repeat itself is another doubt.
        told = [warning for warning in told if str(warning.message).startswith("assumed")]
        assert len(told) == 1 and told[0].filename == __file__, [str(warning.message) for warning in told]
        with warnings.catch_warnings():
            warnings.filterwarnings("error", "assumed", rc.InputWarning)
            assert call(cell=0.01, cell_y=0.0075) == assumed
    for call in (rc.solve, rc.sweep):
        load = {"pressure": 1e6} if call is rc.solve else {"pressures": [1e6]}
        with pytest.raises(ValueError, match="assumed: equal spacings"):
            call(part, cell=0.01, e_star=1e9, strict=True, **load)
    with pytest.raises(ValueError, match="assumed: equal spacings"):
        rc.prepare(part, cell=0.01, strict=True)
    with warnings.catch_warnings():
        warnings.simplefilter("error", rc.InputWarning)
        assert rc.solve(heights, cell=0.01, **CONTACT).warnings == []


def test_prepare_warns_of_what_it_treats(heights):
    spiky = heights.copy()
    spiky[5, 7] += 30 * heights.std()
    with pytest.warns(rc.InputWarning, match="stands far from all neighbours"):
        rc.prepare(spiky, cell=0.01, level="mean")
    holes = heights.copy()
    holes[10:30, 10:30] = np.nan
    with pytest.warns(rc.InputWarning, match="were missing and filled"):
        rc.prepare(holes, cell=0.01, fill="laplace")
    with pytest.raises(ValueError, match="were missing and filled.*strict"):
        rc.prepare(holes, cell=0.01, fill="laplace", strict=True)


def test_keywords_for_files_do_not_apply_to_arrays(heights):
    for keys in ({"missing": -9999.0}, {"mask": "ignore"}):
        name = next(iter(keys))
        for call in (lambda k: rc.solve(heights, cell=0.01, **CONTACT, **k), lambda k: rc.prepare(heights, **k)):
            with pytest.raises(ValueError, match=f"^{name}: is for files"):
                call(keys)


def test_what_a_solve_tells_is_warned_of_once_and_an_error_with_strict(heights, monkeypatch):
    from roughcontact import _solve

    monkeypatch.setattr(_solve, "told", lambda result: ["slope: 0.4 is above 0.3"])
    with pytest.warns(rc.InputWarning, match="^slope") as told:
        rc.solve(heights, cell=0.01, **CONTACT)
    assert len(told) == 1 and told[0].filename == __file__
    with pytest.raises(ValueError, match="slope") as error:
        rc.solve(heights, cell=0.01, **CONTACT, strict=True)
    assert error.value.result.converged


# What the displacement is


@pytest.mark.parametrize(
    ("keys", "mean_is_zero"),
    [({}, True), ({"method": "adaptive"}, True), ({"boundary": "free"}, False), ({"layer_thickness": 1e-3, "layer_poisson": 0.3}, False)],
)
def test_the_displacement_follows_the_heights_in_contact(heights, keys, mean_is_zero):
    result = rc.solve(heights, cell=0.01, **{**CONTACT, **keys}, energy_tolerance=1e-3)
    displacement = result.displacement
    assert displacement.shape == heights.shape
    rest = displacement - heights - result.gap
    # The same constant everywhere: the gap is v - h plus a constant, and grows away from contact.
    assert np.ptp(rest) < 1e-4 * np.ptp(heights)
    in_contact = result.pressure > 0
    assert (displacement - heights)[~in_contact].min() > (displacement - heights)[in_contact].mean() - 1e-3 * np.ptp(heights)
    assert (abs(displacement.mean()) < 1e-9 * np.ptp(heights)) == mean_is_zero
    assert mean_is_zero or displacement.mean() > 0
