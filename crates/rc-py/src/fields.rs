//! Results that are computed from the fields of a live or stored result.

use numpy::PyArray1;
use pyo3::prelude::*;
use rc_cli::scene::resolve;
use rc_cli::sweep::crept;
use rc_core::{EdgeBias, Field, Grid, PeriodicCell};
use rc_solver::{ContactSpot, StressDistribution};
use rc_sweep::{LeakageSummary, Summary, to_json};

use crate::arrays::{self, Heights};
use crate::errors::{bad_input, raised};
use crate::running::on_threads;

/// A contact spot as a tuple.
///
/// Elements, fraction of the cell, perimeter (m), Euler number, and contribution to the mean pressure (Pa).
type Spot = (usize, f64, f64, f64, f64);

/// The field of an array, with each value divided by `unit`.
///
/// Its cell has the sides `sides`.
fn field_of(array: &Heights<'_>, sides: [f64; 2], unit: f64) -> PyResult<Field> {
    let grid = arrays::grid_of(array)?;
    let grid = Grid::in_cell(grid.nx(), grid.ny(), sides[1] / sides[0]).map_err(bad_input)?;
    Field::new(grid, arrays::divided(array, unit)?).map_err(bad_input)
}

/// Numbers in the text of `scene.toml`.
///
/// They are the sides of the cell along x and y (m), E* (Pa), and the seed of a random surface.
#[pyfunction]
pub(crate) fn scene_numbers(scene: &str) -> PyResult<([f64; 2], f64, Option<u64>)> {
    let scene = rc_cli::scene::file::parse(scene).map_err(|cause| bad_input(format!("scene.toml: {cause}")))?;
    let side = scene.surface.cell.ok_or_else(|| bad_input("scene.toml: cell: must be given"))?;
    let cell = PeriodicCell::rectangle(side, scene.surface.cell_y.unwrap_or(side)).map_err(bad_input)?;
    let contact = resolve::contact(scene.contact, cell).map_err(raised)?;
    Ok((cell.sides(), contact.units.elasticity().e_star(), scene.surface.seed))
}

/// Density (1/Pa) of a pressure (Pa) over the nominal area, and the contact area.
///
/// `edges` are the ends of the bins (Pa). The contact area is `area`, if it is known.
#[pyfunction]
#[pyo3(signature = (pressure, e_star, edges, area=None))]
pub(crate) fn stress_distribution<'py>(
    py: Python<'py>,
    pressure: Heights<'py>,
    e_star: f64,
    edges: Vec<f64>,
    area: Option<f64>,
) -> PyResult<(Bound<'py, PyArray1<f64>>, f64)> {
    let pressure = field_of(&pressure, [1.0, 1.0], e_star)?;
    let edges: Vec<f64> = edges.into_iter().map(|edge| edge / e_star).collect();
    let found = on_threads(py, 0, move || match area {
        Some(area) => StressDistribution::with_area(&pressure, &edges, area),
        None => StressDistribution::of(&pressure, &edges),
    })?;
    let density = found.density.into_iter().map(|density| density / e_star).collect();
    Ok((PyArray1::from_vec(py, density), found.area_fraction))
}

/// Relative error of a hardness that was a number of Pa.
const ROUNDING: f64 = 1e-12;

/// Contact spots of a pressure (Pa) and a gap (m), largest first.
///
/// `fields` are these two. `units` are the sides of the cell (m) and E* (Pa). `scene` is the text of their
/// `scene.toml`. The areas add up to `area_fraction`. With a hardness, the overlap that plastic flow has removed is
/// subtracted from the gap.
#[pyfunction]
pub(crate) fn spots(
    py: Python<'_>,
    fields: (Heights<'_>, Heights<'_>),
    units: ([f64; 2], f64),
    scene: &str,
    area_fraction: f64,
) -> PyResult<Vec<Spot>> {
    let ((pressure, gap), (sides, e_star)) = (fields, units);
    let keys = rc_cli::scene::file::parse(scene).map_err(bad_input)?.contact;
    let (pressure, gap) = (field_of(&pressure, sides, e_star)?, field_of(&gap, sides, sides[0])?);
    if pressure.grid() != gap.grid() {
        return Err(bad_input(format_args!("gap: {} elements, but the pressure has {}", gap.grid(), pressure.grid())));
    }
    let kernel = keys.kernel.and_then(resolve::kernel);
    let bias = kernel.map_or_else(EdgeBias::default, |kernel| kernel.edge_bias(pressure.grid()));
    let boundary = keys.boundary.unwrap_or_default();
    let hardness = keys.hardness.map_or(f64::INFINITY, |hardness| (1.0 - ROUNDING) * hardness / e_star);
    let spots =
        on_threads(py, 0, move || ContactSpot::with_area([&pressure, &gap], hardness, bias, boundary, area_fraction))?;
    let in_si = |spot: ContactSpot| {
        let ContactSpot { elements, area_fraction, perimeter, euler_number, mean_pressure } = spot;
        (elements, area_fraction, perimeter * sides[0], euler_number, mean_pressure * e_star)
    };
    Ok(spots.into_iter().map(in_si).collect())
}

/// Runs a command of `rc` that writes files. An error becomes an exception.
#[pyfunction]
pub(crate) fn run(py: Python<'_>, words: Vec<String>) -> PyResult<()> {
    py.detach(|| rc_cli::run_words(words.into_iter().map(Into::into))).map_err(raised)
}

/// The cells of a row of a sweep from a summary, both as JSON.
///
/// The columns are those that the scene asks for. With `creep`, the ratio of its load to that under which a solid creeps, they
/// are those of this solid.
#[pyfunction]
#[pyo3(signature = (summary, scene, creep=None))]
pub(crate) fn cells(summary: &str, scene: &str, creep: Option<f64>) -> PyResult<String> {
    let scene = rc_cli::scene::file::parse(scene).map_err(|cause| bad_input(format!("scene.toml: {cause}")))?;
    let summary: Summary =
        serde_json::from_str(summary).map_err(|cause| bad_input(format!("summary.json: {cause}")))?;
    let mut cells = summary.cells();
    if let Some(creep) = creep {
        crept(&mut cells, creep);
    }
    if scene.contact.leakage {
        LeakageSummary::complete(&mut cells, scene.contact.viscosity.is_some());
    }
    Ok(to_json(&cells))
}
