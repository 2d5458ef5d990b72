//! One solve with its time, memory and results.

use std::time::Instant;

use anyhow::{Context, Result};
use rc_core::{Grid, HeightField as _, HeightSource, Silent};
use rc_solver::{ContactProblem, Method, Observables, SolveInfo, SolveParams, Tolerance};
use rc_sweep::memory;
use serde::{Deserialize, Serialize};

use super::scenes::Scene;
use super::setting::{KernelName, MESHES, Setting};

/// A solved scene, in units of λ and E*.
pub(super) struct Solved {
    pub(super) info: SolveInfo,
    pub(super) observables: Observables,
    /// Elements in contact.
    pub(super) n_in_contact: usize,
    /// Fraction of the cells whose gap was computed.
    cells_evaluated: f64,
    /// Seconds of the solve alone. They include the heights of the adaptive method, but not the heights of a uniform
    /// grid, which are given.
    seconds: f64,
    /// Seconds of the evaluation of all observables.
    observables_seconds: f64,
}

/// Reported results of one solve, ours or a peer's.
///
/// Pressures are in E*, lengths in λ, areas relative to the cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Outcome {
    pub(super) status: String,
    /// Iterations on the finest level.
    pub(super) iterations: Option<u64>,
    /// Applications of the operator on the finest level.
    pub(super) applications: Option<u64>,
    /// Elements in contact.
    pub(super) elements: Option<u64>,
    /// Seconds of the solve alone.
    pub(super) seconds: f64,
    /// Seconds of the evaluation of the observables.
    pub(super) observables_seconds: f64,
    /// Peak memory of the process, minus its peak memory before its first solve.
    pub(super) memory_mb: Option<f64>,
    /// Area by counting elements.
    pub(super) area_counted: f64,
    /// Best estimate of the area, which a peer does not have.
    pub(super) area: Option<f64>,
    /// Error of `area` as the program states it. The other fields `…_bar` are alike.
    pub(super) area_bar: Option<f64>,
    /// Number of edges between elements in and out of contact.
    pub(super) edges: u64,
    pub(super) rms_pressure: f64,
    pub(super) rms_pressure_bar: Option<f64>,
    pub(super) mean_gap: f64,
    pub(super) mean_gap_bar: Option<f64>,
    /// Fraction of the cells of the finest grid whose gap was computed. The others are proven to be free.
    pub(super) cells_evaluated: Option<f64>,
}

/// Solves `scene` once.
///
/// # Errors
/// When a solve fails.
pub(super) fn solve(scene: &Scene, setting: &Setting) -> Result<Solved> {
    try_solve(scene, setting).with_context(|| format!("scene {}, {setting}", scene.name))
}

fn try_solve(scene: &Scene, setting: &Setting) -> Result<Solved> {
    let (surface, grid) = (scene.surface()?, Grid::square(scene.side(setting.elements_per_wave))?);
    // A uniform grid gets its heights ready-made. The adaptive method makes its heights within the solve.
    let map = (setting.method() == Method::Uniform).then(|| surface.sample_on(grid)).transpose()?;
    let heights = map.as_ref().map_or_else(|| surface.on(grid), HeightSource::from);
    let problem = ContactProblem::new(heights, scene.control()).with_kernel(setting.kernel.kernel());
    let params = SolveParams {
        border_level: setting.border_level,
        tolerance: setting.tolerance,
        ..SolveParams::default().by(setting.method())
    };
    let start = Instant::now();
    let solution = problem.solve(&params, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let observables = *solution.observables();
    Ok(Solved {
        observables,
        n_in_contact: solution.n_in_contact(),
        cells_evaluated: solution.n_evaluated() as f64 / (solution.n_evaluated() + solution.n_proven()) as f64,
        info: solution.info().clone(),
        seconds,
        observables_seconds: start.elapsed().as_secs_f64(),
    })
}

/// Solves `scene` once in this process, which has done nothing else, and measures it.
///
/// The processes of peers stay from solve to solve. Ours first solves the coarsest mesh, so that threads and code are
/// there too.
///
/// # Errors
/// Those of [`solve`].
pub(super) fn measure(scene: &Scene, setting: &Setting) -> Result<Outcome> {
    let before = memory::peak();
    solve(scene, &Setting::uniform(KernelName::Spectral, MESHES[0], Tolerance::Auto))?;
    let solved = solve(scene, setting)?;
    let memory = memory::peak().zip(before).map(|(after, before)| 1e-6 * after.saturating_sub(before) as f64);
    let Solved { info, observables, n_in_contact, cells_evaluated, seconds, observables_seconds, .. } = solved;
    Ok(Outcome {
        status: "converged".to_owned(),
        iterations: Some(info.fine_iterations() as u64),
        applications: Some(info.fine_operator_applications() as u64),
        elements: Some(n_in_contact as u64),
        seconds,
        observables_seconds,
        memory_mb: memory,
        area_counted: observables.area.cells,
        area: Some(observables.area.fraction),
        area_bar: Some(observables.area.error),
        edges: observables.area.perimeter_edges as u64,
        rms_pressure: observables.rms_pressure_corrected,
        rms_pressure_bar: observables.rms_pressure_error,
        mean_gap: observables.mean_gap,
        mean_gap_bar: Some(observables.mean_gap_error),
        cells_evaluated: Some(cells_evaluated),
    })
}
