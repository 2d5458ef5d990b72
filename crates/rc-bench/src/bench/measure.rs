//! One solve with its time, memory and results.

use std::time::Instant;

use anyhow::{Context, Result};
use rc_core::{Grid, HeightSource, Silent};
use rc_figures::memory;
use rc_solver::{AdaptiveParams, AdaptiveProblem, IterationParams, Observables, SolveInfo, solve_uniform};
use serde::{Deserialize, Serialize};

use super::scenes::Scene;
use super::setting::{Method, Setting};

/// A solved scene, in units of λ and E*.
pub(super) struct Solved {
    pub(super) info: SolveInfo,
    pub(super) observables: Observables,
    /// Elements in contact.
    pub(super) n_elements: usize,
    /// Of the solve alone; the adaptive method's heights are part of it, a uniform grid's are given.
    seconds: f64,
    /// Of the evaluation of all observables.
    observables_seconds: f64,
}

/// What is reported of one solve, ours or a peer's: pressures in E*, lengths in λ, areas relative to the cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Outcome {
    pub(super) status: String,
    /// On the finest level.
    pub(super) iterations: Option<u64>,
    /// Of the operator, on the finest level.
    pub(super) applications: Option<u64>,
    /// Elements in contact.
    pub(super) elements: Option<u64>,
    /// Of the solve alone.
    pub(super) seconds: f64,
    /// Of the evaluation of the observables.
    pub(super) observables_seconds: f64,
    /// Peak memory of the process less that before its first solve.
    pub(super) memory_mb: Option<f64>,
    /// By counting elements.
    pub(super) area_counted: f64,
    /// Best estimate; a peer has none.
    pub(super) area: Option<f64>,
    /// Its error as stated by the program.
    pub(super) area_bar: Option<f64>,
    /// Edges between elements in and out of contact.
    pub(super) edges: u64,
    pub(super) rms_pressure: f64,
    pub(super) mean_gap: f64,
}

/// Solves `scene` once.
///
/// # Errors
/// When a solve fails.
pub(super) fn solve(scene: &Scene, setting: &Setting) -> Result<Solved> {
    let params = IterationParams { tolerance: setting.relative_tolerance(), ..IterationParams::certified() };
    let solved = match setting.method {
        Method::Uniform => uniform(scene, setting, &params),
        Method::Adaptive => adaptive(scene, setting, params),
    };
    solved.with_context(|| format!("scene {}, {setting}", scene.name))
}

fn uniform(scene: &Scene, setting: &Setting, params: &IterationParams) -> Result<Solved> {
    let heights = scene.surface()?.sample_on(Grid::square(scene.side(setting.elements_per_wave))?)?;
    let kernel = setting.kernel.kernel();
    let start = Instant::now();
    let solution = solve_uniform(&heights, kernel, scene.control(), params, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let observables = Observables::of(&solution, kernel);
    Ok(Solved {
        observables,
        n_elements: solution.pressure.values().iter().filter(|&&p| p > 0.0).count(),
        info: solution.info,
        seconds,
        observables_seconds: start.elapsed().as_secs_f64(),
    })
}

fn adaptive(scene: &Scene, setting: &Setting, solve: IterationParams) -> Result<Solved> {
    let surface = scene.surface()?;
    let params = AdaptiveParams { solve, border_level: setting.border_level, ..AdaptiveParams::certified() };
    let start = Instant::now();
    let source =
        HeightSource::Surface { surface: &surface, grid: Grid::square(scene.side(setting.elements_per_wave))? };
    let solution = AdaptiveProblem::new(source, scene.control(), &params)?.solve(&Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let observables = solution.observables();
    Ok(Solved {
        observables,
        n_elements: solution.n_elements(),
        info: solution.info,
        seconds,
        observables_seconds: start.elapsed().as_secs_f64(),
    })
}

/// Solves `scene` once in this process, which has done nothing else, and reports.
///
/// # Errors
/// Those of [`solve`].
pub(super) fn measure(scene: &Scene, setting: &Setting) -> Result<Outcome> {
    let before = memory::peak();
    let solved = solve(scene, setting)?;
    let memory = memory::peak().zip(before).map(|(after, before)| 1e-6 * after.saturating_sub(before) as f64);
    let Solved { info, observables, n_elements, seconds, observables_seconds } = solved;
    Ok(Outcome {
        status: "converged".to_owned(),
        iterations: Some(info.fine_iterations() as u64),
        applications: Some(info.fine_operator_applications() as u64),
        elements: Some(n_elements as u64),
        seconds,
        observables_seconds,
        memory_mb: memory,
        area_counted: observables.area.cells,
        area: Some(observables.area.fraction),
        area_bar: Some(observables.area.error),
        edges: observables.area.perimeter_edges as u64,
        rms_pressure: observables.rms_pressure_corrected,
        mean_gap: observables.mean_gap,
    })
}
