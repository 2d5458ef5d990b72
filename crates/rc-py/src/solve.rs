//! The function `solve`: from keys and heights to a solution.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use rc_cli::error::CliError;
use rc_cli::run::threads;
use rc_cli::scene::fluid::FluidSource;
use rc_cli::scene::keys::{KernelName, RunKeys, Scene};
use rc_cli::scene::loaded::LoadedSurface;
use rc_cli::scene::surface::Source;
use rc_cli::solve::{CheckedScene, SolvedParts};
use rc_cli::warnings::shown::refuse;
use rc_core::{Kernel, Observer};
use rc_heights::HeightMap;
use rc_sweep::memory::Budget;

use crate::arrays::{self, Heights};
use crate::errors::raised;
use crate::kernel::OwnKernel;
use crate::running::{self, Ended, Run, on_threads};
use crate::scene;
use crate::solved::{HeldMap, Parts, Solved, Unfinished};

/// Inputs of a solve that are not keys.
#[derive(FromPyObject)]
pub(crate) struct Given<'py> {
    /// Heights (m), row by row.
    #[pyo3(item)]
    heights: Option<Heights<'py>>,
    /// Sides of the cell of the heights along x and y (m), if they are known.
    #[pyo3(item)]
    sides: Option<[f64; 2]>,
    /// Pressure of a fluid (Pa), row by row.
    #[pyo3(item)]
    fluid: Option<Heights<'py>>,
    /// Path of a scene file.
    #[pyo3(item)]
    scene: Option<PathBuf>,
    /// Function for the symbol of the half-space.
    #[pyo3(item)]
    kernel: Option<Bound<'py, PyAny>>,
    /// Function that sees progress.
    #[pyo3(item)]
    progress: Option<Bound<'py, PyAny>>,
    /// Whether this is a row of a sweep. The memory of the machine then does not decide anything.
    #[pyo3(item)]
    is_row: bool,
    /// Ratio of the load of this row to that under which a solid creeps.
    #[pyo3(item)]
    creep: Option<f64>,
}

/// A problem that is ready to be solved without Python.
struct Prepared {
    scene: CheckedScene,
    kernel: Option<OwnKernel>,
    map: Option<HeightMap>,
    budget: Budget,
    is_strict: bool,
    started: Instant,
}

/// The solution or an unfinished solve, and the exception that ended it early.
type Returned = (Option<Solved>, Option<Unfinished>, Option<Py<PyAny>>);

/// Solves a scene.
///
/// There is no solution if a signal came and the solve has not yet seen that it was told to stop. It then continues on
/// its own.
#[pyfunction]
pub(crate) fn solve(py: Python<'_>, keys: &Bound<'_, PyDict>, given: Given<'_>) -> PyResult<Returned> {
    let scene = scene_of(keys, &given)?;
    let run_keys = scene.run.clone();
    let prepared = Prepared::new(scene, &given)?;
    let held = given.heights.as_ref().map(HeldMap::new).transpose()?;
    let run = Run {
        threads: threads::checked(run_keys.threads).map_err(raised)?.unwrap_or(0),
        end: end(&run_keys, prepared.started),
        progress: given.progress,
        grace: running::GRACE,
    };
    let (ended, threads) = running::run(py, run, move |observer| prepared.solve(observer))?;
    let value = |error: PyErr| error.into_value(py).into_any();
    Ok(match ended {
        Ended::Done { value: Err(_), early: Some(early) } => return Err(early),
        Ended::Done { value: parts, early } => {
            (Some(Solved::new(parts.map_err(raised)?, held, threads)), None, early.map(value))
        }
        Ended::Left { early, rest } => (None, Some(Unfinished::new(rest, held, threads)), Some(value(early))),
    })
}

/// The scene of the keys. A function for a kernel has a name among them.
fn scene_of(keys: &Bound<'_, PyDict>, given: &Given<'_>) -> PyResult<Scene> {
    let mut scene = scene::with_map(keys, given.scene.as_deref(), given.heights.is_some())?;
    if given.kernel.is_some() {
        scene.contact.kernel = Some(KernelName::Own);
    }
    if given.fluid.is_some() {
        scene.contact.fluid_pressure = Some("fluid_pressure.npy".into());
    }
    Ok(scene)
}

fn end(keys: &RunKeys, started: Instant) -> Option<Instant> {
    keys.time_limit.and_then(|limit| started.checked_add(limit.0))
}

impl Prepared {
    fn new(scene: Scene, given: &Given<'_>) -> PyResult<Self> {
        let started = Instant::now();
        let Scene { surface, mut contact, run } = scene;
        if given.creep.is_some() {
            contact = contact.elastic();
        }
        let map = given.heights.as_ref().map(|heights| arrays::map_of(heights, given.sides)).transpose()?;
        let mut scene = match &map {
            Some(map) => {
                let grid = map.heights.grid();
                CheckedScene::of_map(surface, (given.sides, [grid.nx(), grid.ny()]), contact)
            }
            None => CheckedScene::new(surface, contact),
        }
        .map_err(raised)?;
        if let Some(fluid) = &given.fluid {
            scene.contact.fluid = Some(FluidSource::Held(Arc::new(arrays::field_of(fluid)?)));
        }
        scene.contact.params.method_follows_memory &= !given.is_row;
        scene.contact.creep = given.creep;
        let kernel = given.kernel.as_ref().map(|symbol| own_kernel(symbol, &scene, map.as_ref())).transpose()?;
        Ok(Self { scene, kernel, map, budget: Budget::new(run.memory_limit), is_strict: run.strict, started })
    }

    /// Solves on the threads of the caller.
    fn solve(self, observer: &dyn Observer) -> Result<Parts, CliError> {
        let Self { scene, kernel, map, budget, is_strict, started } = self;
        let is_callers = map.is_some() && !scene.surface.is_sum();
        let surface = load(&scene, map)?;
        let own = kernel.as_ref().map(|kernel| kernel as &dyn Kernel);
        let named = if own.is_none() { Some(scene.contact.kernel()?) } else { None };
        let named = named.as_ref().map(|kernel| &**kernel as &dyn Kernel);
        let chosen = own.or(named).expect("a kernel is the caller's or has a name");
        let problem = scene.problem(&surface, chosen, budget);
        if is_strict {
            refuse(&problem.warnings(), true, "; nothing was solved")?;
        }
        let solved = scene.solve(problem, started, observer)?;
        let SolvedParts { solution, failure, residual, path, fluid, flow, shear, warnings, wall } = solved.into_parts();
        let solution = solution.into_owned();
        // The heights of a map that is the caller's are not kept.
        let own_map = if is_callers { None } else { surface.shared_map() };
        let height_and_slope = surface.height_and_slope(scene.contact.boundary);
        let waves = surface.wave_file().cloned();
        let contact = scene.contact;
        let failure = failure.map(|failure| failure.to_string());
        let LoadedSurface { keys: surface, origin, .. } = surface;
        let parts = Parts {
            surface,
            origin,
            waves,
            own_map,
            contact,
            solution,
            failure,
            residual,
            path,
            fluid,
            flow,
            shear,
            warnings,
            all_warnings: Vec::new(),
            wall,
            height_and_slope,
        };
        Ok(parts.with_all_warnings())
    }
}

/// Reads or generates the surface. Heights of the caller are converted into units of the cell.
fn load(scene: &CheckedScene, map: Option<HeightMap>) -> Result<LoadedSurface, CliError> {
    let expected = match &scene.surface.source {
        Source::File { expected, .. } => *expected,
        Source::Random { .. }
        | Source::Waves { .. }
        | Source::Spectrum { .. }
        | Source::Twin { .. }
        | Source::Shape { .. } => None,
    };
    match map {
        Some(map) => scene.surface.of_map(Path::new("heights"), map, expected),
        None => scene.surface.load(),
    }
}

/// The caller's kernel on the grid of the scene.
fn own_kernel(symbol: &Bound<'_, PyAny>, scene: &CheckedScene, map: Option<&HeightMap>) -> PyResult<OwnKernel> {
    let grid = match (&scene.surface.source, map) {
        (
            Source::Random { grid, .. }
            | Source::Waves { grid, .. }
            | Source::Spectrum { grid, .. }
            | Source::Twin { grid, .. }
            | Source::Shape { grid },
            _,
        ) => *grid,
        (_, Some(map)) => map.heights.grid(),
        (Source::File { .. }, None) => {
            let surface = scene.surface.clone();
            on_threads(symbol.py(), 0, move || surface.load())?.map_err(raised)?.grid
        }
    };
    OwnKernel::new(symbol, grid, scene.contact.units)
}
