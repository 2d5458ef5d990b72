//! Surfaces and height maps without a contact.

use std::path::{Path, PathBuf};

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rc_cli::scene::keys::{Scene, SurfaceKeys};
use rc_cli::scene::loaded::LoadedSurface;
use rc_cli::scene::resolve;
use rc_cli::scene::surface::SurfaceSetup;
use rc_cli::warnings::surface::assumed as assumed_of;
use rc_cli::{inspect, scene::heights, surface as surfaces};
use rc_core::Field;
use rc_heights::{HeightMap, ReadParams};
use rc_sweep::memory::Budget;

use crate::arrays::{self, Heights};
use crate::errors::{bad_input, raised};
use crate::running::on_threads;
use crate::scene::scene_of;

/// An array (m), and the known sides of its rectangle along x and y (m).
type MapParts<'py> = (Bound<'py, PyArray2<f64>>, Option<[f64; 2]>);

/// The parts of a map, and the doubts about it.
type ReadMap<'py> = (Bound<'py, PyArray2<f64>>, Option<[f64; 2]>, Vec<String>);

fn parts(py: Python<'_>, map: HeightMap) -> PyResult<MapParts<'_>> {
    let grid = map.heights.grid();
    Ok((arrays::array_of(py, grid, map.heights.into_values())?, map.sides))
}

/// Names of the channels of a file, each with whether it has heights.
#[pyfunction]
pub(crate) fn channels(py: Python<'_>, path: PathBuf) -> PyResult<Vec<(String, bool)>> {
    let params = ReadParams { max_bytes: rc_sweep::memory::read_limit(None), ..ReadParams::default() };
    let channels =
        on_threads(py, 0, move || rc_heights::channels(&path, &params))?.map_err(|error| raised(error.into()))?;
    Ok(channels.into_iter().map(|channel| (channel.name, channel.is_height)).collect())
}

/// Reads a height map of any format, in metres. Unmeasured points are `NaN`. The last part says what was assumed.
#[pyfunction]
pub(crate) fn read<'py>(py: Python<'py>, path: PathBuf, keys: &Bound<'py, PyDict>) -> PyResult<ReadMap<'py>> {
    let surface = scene_of(keys, None)?.surface;
    let (params, scales) = (surface.read_params(), surface.scales());
    let map = on_threads(py, 0, move || heights::read(&path, &params, scales))?.map_err(raised)?;
    // What the values look like is doubted where the map is used.
    let assumed: Vec<String> = map.notes.iter().filter(|note| note.is_assumption()).map(ToString::to_string).collect();
    let doubts = assumed_of(&assumed).map(|warning| warning.text).into_iter().collect();
    let (heights, sides) = parts(py, map)?;
    Ok((heights, sides, doubts))
}

/// A checked random surface, with its memory limit and number of threads.
fn checked(keys: &Bound<'_, PyDict>) -> PyResult<(SurfaceSetup, Budget, usize)> {
    let Scene { surface, run, .. } = scene_of(keys, None)?;
    resolve::check_size(&surface).map_err(raised)?;
    let setup = resolve::surface(surface).map_err(raised)?;
    let threads = rc_cli::run::threads::checked(run.threads).map_err(raised)?.unwrap_or(0);
    Ok((setup, Budget::new(run.memory_limit), threads))
}

/// Heights (m) of a random surface on its grid, and its cell's sides (m).
#[pyfunction]
pub(crate) fn surface<'py>(py: Python<'py>, keys: &Bound<'py, PyDict>) -> PyResult<MapParts<'py>> {
    let (setup, budget, threads) = checked(keys)?;
    let cell = setup.cell;
    let heights = on_threads(py, threads, move || {
        let surface = setup.load()?;
        budget.check_grid("the surface", surface.grid)?;
        in_metres(&surface, cell.side())
    })?;
    let heights = heights.map_err(raised)?;
    Ok((arrays::array_of(py, heights.grid(), heights.into_values())?, Some(cell.sides())))
}

/// Heights (m) with the same digits as in the files of `rc surface`.
fn in_metres(surface: &LoadedSurface, side: f64) -> Result<Field, rc_cli::error::CliError> {
    let mut heights = surface.heights()?.into_owned();
    match surface.map() {
        Some((_, as_read)) => as_read.restore(0, heights.values_mut()),
        None => heights.values_mut().iter_mut().for_each(|height| *height *= side),
    }
    Ok(heights)
}

/// The resolved keys of a random surface, as JSON.
#[pyfunction]
pub(crate) fn resolved_surface(keys: &Bound<'_, PyDict>) -> PyResult<String> {
    Ok(rc_sweep::to_json(&checked(keys)?.0.keys))
}

/// Statistics of a random surface as JSON.
#[pyfunction]
pub(crate) fn inspect_surface(py: Python<'_>, keys: &Bound<'_, PyDict>) -> PyResult<String> {
    let (setup, budget, threads) = checked(keys)?;
    let record = on_threads(py, threads, move || {
        let surface = setup.load()?;
        budget.check_grid("the surface", surface.grid)?;
        inspect::surface(&surface, setup.cell.side())
    })?;
    record.map_err(raised)
}

/// Statistics of a height map as JSON.
///
/// If the map does not have the size of its cell, it is among the keys.
#[pyfunction]
pub(crate) fn inspect_map(
    py: Python<'_>,
    heights: Heights<'_>,
    sides: Option<[f64; 2]>,
    keys: &Bound<'_, PyDict>,
) -> PyResult<String> {
    let SurfaceKeys { cell, cell_y, .. } = scene_of(keys, None)?.surface;
    if sides.is_none() && cell.is_none() {
        return Err(bad_input("cell: must be given (m), since the map does not know its size"));
    }
    let map = arrays::map_of(&heights, sides)?;
    on_threads(py, 0, move || inspect::height_map(Path::new("heights"), map, [cell, cell_y]))?.map_err(raised)
}

/// Summary and statistics of a result folder as JSON.
#[pyfunction]
pub(crate) fn inspect_result(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    on_threads(py, 0, move || inspect::result(&folder))?.map_err(raised)
}

/// The height map after treatments, which have the names of the flags of `rc surface`, and the doubts about it.
#[pyfunction]
pub(crate) fn treat<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    sides: Option<[f64; 2]>,
    words: Vec<String>,
) -> PyResult<ReadMap<'py>> {
    let treatments = surfaces::treatments(&words).map_err(raised)?;
    let map = arrays::map_of(&heights, sides)?;
    let treated = on_threads(py, 0, move || {
        let grids =
            rc_heights::grids_after(&map, &treatments).map_err(|cause| bad_input(format!("heights: {cause}")))?;
        for (grid, treatment) in grids.into_iter().zip(&treatments) {
            let checked = Budget::new(None).check_grid(&format!("the map after {treatment}"), grid);
            checked.map_err(|error| raised(error.into()))?;
        }
        surfaces::prepared(map, &treatments).map_err(|cause| bad_input(format!("heights: {cause}")))
    })?;
    let (map, doubts) = treated?;
    let (heights, sides) = parts(py, map)?;
    Ok((heights, sides, doubts.into_iter().map(|warning| warning.text).collect()))
}
