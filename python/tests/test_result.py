"""What a result says and writes."""

import copy
import pickle

import numpy as np
import pytest

import roughcontact as rc


def test_every_key_of_the_summary_is_an_attribute_with_a_type(result):
    # Warnings are a property, since older summaries have none.
    assert set(rc.Result.__annotations__) | {"warnings"} == set(result.summary)
    for key, value in result.summary.items():
        assert getattr(result, key) == value
        assert key in dir(result)
    with pytest.raises(AttributeError, match="no 'area'"):
        result.area  # noqa: B018


def test_fields_agree_with_the_numbers(result):
    assert result.pressure.shape == result.gap.shape == result.contact.shape == (64, 64)
    assert result.pressure.mean() == pytest.approx(result.mean_pressure, rel=1e-12)
    assert result.pressure.max() == result.max_pressure
    assert result.contact.mean() == result.area_fraction_cells
    assert abs(result.gap[result.contact]).max() < 0.05 * result.gap.max()
    assert result.displacement.mean() == pytest.approx(0.0, abs=1e-12 * abs(result.displacement).max())
    # The gap is displacement minus heights, up to a constant.
    assert result.e_star == 1e9 and result.sides == (0.01, 0.01)


def test_the_gap_closes_the_contact(result, heights):
    rest = result.gap - (result.displacement - heights)
    is_open = result.gap > 0
    level = rest[is_open].mean()
    assert np.ptp(rest[is_open]) < 1e-9 * np.ptp(heights)
    # The gap is zero where the tolerance of the solve leaves an overlap.
    overlap = rest[~is_open] - level
    assert -1e-9 * np.ptp(heights) < overlap.min() and overlap.max() < 1.01 * result.penetration_error * np.ptp(heights)


def test_spots_and_distribution_add_up_to_the_contact(result):
    spots = result.spots
    assert sum(spot.mean_pressure for spot in spots) == pytest.approx(result.mean_pressure, rel=1e-12)
    assert sum(spot.area_fraction for spot in spots) == pytest.approx(result.area_fraction, rel=1e-9)
    assert [spot.area_fraction for spot in spots] == sorted((s.area_fraction for s in spots), reverse=True)
    stress = result.stress_distribution(40)
    assert stress.edges.shape == (41,) and stress.density.shape == (40,)
    assert (stress.density * np.diff(stress.edges)).sum() == pytest.approx(stress.area_fraction, rel=0.01)
    middle = 0.5 * (stress.edges[1:] + stress.edges[:-1])
    assert (middle * stress.density * np.diff(stress.edges)).sum() == pytest.approx(result.mean_pressure, rel=0.05)
    assert np.array_equal(result.stress_distribution(stress.edges).density, stress.density)
    for bins in (0, [1.0], [2.0, 1.0], [-1.0, 1.0]):
        with pytest.raises(ValueError, match="^bins: "):
            result.stress_distribution(bins)


def test_the_certificate_is_that_of_the_summary(result):
    certificate = result.certificate
    assert certificate.energy_error == result.energy_error <= certificate.energy_tolerance == 0.01
    assert certificate.load_error <= 1e-10


def test_the_mesh_of_the_adaptive_method_carries_the_load():
    result = rc.solve(waves=8, grid=128, pressure=1e5, method="adaptive")
    mesh = result.mesh
    assert len(mesh.x) == result.elements
    assert (mesh.pressure * mesh.size**2).sum() == pytest.approx(1e5 * 0.01**2, rel=1e-9)


@pytest.mark.parametrize("method", ["uniform", "adaptive"])
def test_a_pickled_result_is_the_result(method, heights, tmp_path):
    result = rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6, method=method)
    copy = pickle.loads(pickle.dumps(result))
    assert copy.summary == result.summary and repr(copy) == repr(result) and copy.converged
    assert copy.pressure.tobytes() == result.pressure.tobytes()
    assert copy.gap.tobytes() == result.gap.tobytes()
    assert copy.spots == result.spots
    assert (copy.mesh is None) == (result.mesh is None)
    assert method == "uniform" or np.array_equal(copy.mesh.pressure, result.mesh.pressure)
    again = pickle.loads(pickle.dumps(copy))
    again.save(tmp_path / "copy")
    result.save(tmp_path / "result")
    for path in (tmp_path / "result").iterdir():
        assert (tmp_path / "copy" / path.name).read_bytes() == path.read_bytes(), path.name
    with pytest.raises(ValueError, match="^displacement: "):
        copy.displacement  # noqa: B018


def test_files_in_single_precision_and_a_mesh_that_no_file_holds(tmp_path):
    result = rc.solve(waves=8, grid=128, pressure=1e5, precision="single", method="adaptive")
    result.save(tmp_path / "saved")
    loaded, copied = rc.load(tmp_path / "saved"), pickle.loads(pickle.dumps(result))
    assert loaded.pressure.dtype == np.float64 and np.array_equal(loaded.pressure, result.pressure.astype(np.float32))
    assert np.array_equal(loaded.contact, result.contact)
    assert np.array_equal(copied.pressure, result.pressure) and np.array_equal(copied.mesh.x, result.mesh.x)
    with pytest.raises(ValueError, match="^mesh: the folder has no elements.csv"):
        loaded.mesh  # noqa: B018


def assert_same_fields(one, other):
    for name in ("pressure", "gap", "contact"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes(), name
    assert one.spots == other.spots
    assert np.array_equal(one.stress_distribution().density, other.stress_distribution().density)


def test_a_pickle_has_the_fields_and_not_their_means_over_blocks(heights, tmp_path):
    result = rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6, output_grid=16)
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(result))))
    assert again.pressure.shape == (64, 64)
    assert_same_fields(again, result)
    # Files are those of the command line all the same.
    again.save(tmp_path / "saved")
    assert np.load(tmp_path / "saved/pressure.npy").shape == (16, 16)
    means = rc.load(tmp_path / "saved")
    assert means.pressure.mean() == pytest.approx(1e6)
    for name in ("contact", "spots"):
        with pytest.raises(ValueError, match=rf"^{name}: needs the elements, .*16 x 16 means over blocks \(output_grid\) instead of 64 x 64"):
            getattr(means, name)
    with pytest.raises(ValueError, match="^stress_distribution: needs the elements"):
        means.stress_distribution()
    assert "table" in means._repr_html_() and means.plot() is not None


@pytest.mark.parametrize("output_grid", [None, 32])
def test_with_border_levels_contact_spots_and_stress_are_those_of_the_smallest_elements(output_grid, tmp_path):
    keys = {"waves": 8, "seed": 3, "pressure": 3e5, "method": "adaptive"}
    result = rc.solve(**keys, grid=128, border_level=2, output_grid=output_grid, elements=True)
    assert result.pressure.shape == (128, 128) and result.contact.shape == (512, 512)
    # As the summary counts them, in the area of elements and between their centres.
    assert result.contact.mean() == pytest.approx(result.area_fraction_cells, rel=1e-12)
    assert sum(spot.area_fraction for spot in result.spots) == pytest.approx(result.area_fraction, rel=1e-9)
    assert sum(spot.mean_pressure for spot in result.spots) == pytest.approx(result.mean_pressure, rel=1e-9)
    stress = result.stress_distribution(20)
    assert stress.area_fraction == pytest.approx(result.area_fraction, rel=1e-12)
    # A grid of such elements everywhere, in the same contact; means on the coarse grid have a tenth more of it.
    fine = rc.solve(**keys, grid=512)
    assert (result.contact == fine.contact).mean() > 0.998
    assert np.abs(stress.density - fine.stress_distribution(stress.edges).density).max() < 0.1 * stress.density.max()
    assert abs(len(result.spots) - len(fine.spots)) <= 0.05 * len(fine.spots)
    for again in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result)):
        assert_same_fields(again, result)
    result.save(tmp_path / "saved")
    loaded = rc.load(tmp_path / "saved")
    assert loaded.contact.tobytes() == result.contact.tobytes()
    with pytest.raises(ValueError, match="^spots: a result folder has no gap on the smallest elements"):
        loaded.spots  # noqa: B018


def test_a_copy_is_the_result_with_everything(result):
    for other in (copy.copy(result), copy.deepcopy(result)):
        assert_same_fields(other, result)
        assert other.displacement.tobytes() == result.displacement.tobytes()


def test_surfaces_and_maps_are_pickled(heights):
    surface = rc.Surface(waves=8, seed=3)
    assert pickle.loads(pickle.dumps(surface)) == surface
    sized = rc.HeightMap(heights, (1.0, 1.0))
    assert pickle.loads(pickle.dumps(sized)) == sized


def test_a_saved_result_is_loaded_and_solved_again(result, command, tmp_path):
    result.save(tmp_path / "result")
    loaded = rc.load(tmp_path / "result")
    assert loaded.pressure.tobytes() == result.pressure.tobytes()
    done = command("solve", tmp_path / "result" / "scene.toml", "--out", tmp_path / "again", "--quiet")
    assert done.returncode == 0, done.stderr
    assert np.load(tmp_path / "again" / "pressure.npy").tobytes() == result.pressure.tobytes()
    with pytest.raises(ValueError, match="no such folder"):
        rc.load(tmp_path / "nothing")


def test_heights_that_were_changed_since_are_not_written(heights, tmp_path):
    own = heights.copy()
    result = rc.solve(own, cell=0.01, e_star=1e9, pressure=1e6)
    own[0, 0] += 1e-9
    with pytest.raises(ValueError, match="^heights: the array was changed"):
        result.save(tmp_path / "result")
    assert not (tmp_path / "result").exists() or not any((tmp_path / "result").iterdir())


def test_a_report_is_one_page(result, tmp_path):
    result.report(tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    assert page.startswith("<!") and "Contact under 1 MPa" in page
    with pytest.raises(ValueError, match="is a folder"):
        result.report(tmp_path)


def test_a_result_shows_itself(result):
    assert "Result(converged, 64 x 64, uniform" in repr(result)
    html = result._repr_html_()
    assert html.count("data:image/png;base64,") == 2 and "contact area" in html
    figure = pytest.importorskip("matplotlib.figure")
    assert isinstance(result.plot(), figure.Figure)


def test_a_table_has_columns_and_means():
    table = rc.sweep(waves=8, grid=64, pressures=[1e5, 2e5], seeds=range(1, 4), keep_results=True)
    assert len(table) == len(table.results) == 6 and table[0]["seed"] == 1
    loads, area, error = table.mean("area_fraction")
    assert loads.tolist() == [1e5, 2e5] and (np.diff(area) > 0).all() and (error > 0).all()
    assert area[0] == pytest.approx(np.mean([row["area_fraction"] for row in table if row["control_value"] == 1e5]))
    assert "<td>" in table._repr_html_()
    with pytest.raises(KeyError, match="no column 'area'"):
        table["area"]
    with pytest.raises(ValueError, match="exactly one of pressures"):
        rc.sweep(waves=8)
    with pytest.raises(ValueError, match="must all rise or all fall"):
        rc.sweep(waves=8, pressures=[1.0, 3.0, 2.0])
    with pytest.raises(ValueError, match="seeds: the height map has none"):
        rc.sweep(np.eye(4), cell=1.0, e_star=1.0, pressures=[1.0], seeds=[1])


def test_fields_are_not_changed_by_accident(heights):
    result = rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6)
    for field in (result.pressure, result.gap):
        with pytest.raises(ValueError, match="read-only"):
            field *= 2
    for bins in (0, -3, True, [0, 1e6, np.inf], [1, 0]):
        with pytest.raises(ValueError, match="bins"):
            result.stress_distribution(bins)
    assert result.stress_distribution(np.int64(4)).density.shape == (4,)


@pytest.mark.parametrize("name, value", [("unit", "um"), ("height_scale", 1e-6), ("channel", "x"), ("layout", "xyz"), ("spectrum", "w.txt")])
def test_what_is_said_of_files_is_refused_with_arrays(heights, name, value):
    with pytest.raises(ValueError, match=name):
        rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6, **{name: value})


def test_a_flow_is_conserved_and_comes_back_from_its_files(heights, tmp_path):
    result = rc.solve(heights, cell=0.01, e_star=1e9, pressure=1e6, leakage=True)
    leakage = result.leakage
    assert leakage.percolates == [True, True] and max(leakage.relative_error) <= 1e-9
    assert max(leakage.conservation_error) <= 1e-10
    axis = ["x", "y"].index(leakage.flow_direction)
    assert leakage.permeance[axis] == max(leakage.permeance)
    flux = result.flux[axis]
    # The flow through every section across the axis, for a fall of the pressure by 1: flux times width of elements.
    sections = flux.sum(axis=1 if axis == 1 else 0) * result.sides[1 - axis] / flux.shape[1 - axis]
    assert np.allclose(sections, leakage.permeance[axis], rtol=1e-8)
    assert not flux[result.contact].any()
    result.save(tmp_path / "flow")
    stored = rc.load(tmp_path / "flow")
    assert stored.leakage == leakage and np.array_equal(stored.flux, result.flux)
    assert np.array_equal(pickle.loads(pickle.dumps(result)).flux, result.flux)


def test_without_the_option_there_is_no_flow(result):
    assert result.leakage is None and result.flux is None
