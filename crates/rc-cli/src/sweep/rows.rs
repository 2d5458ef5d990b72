//! Solver of the rows of a sweep.
//!
//! A row is solved as `rc solve` solves its scene.

use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rc_core::Silent;
use rc_solver::Plan;
use rc_sweep::memory::Budget;
use rc_sweep::{Cells, Latest, LeakageSummary, RowError, RowSolver, Summary, Sweep, SweepRow, replace_fields};

use super::bar::RowBar;
use super::doubts::Doubts;
use super::surfaces::Surfaces;
use crate::error::CliError;
use crate::run::stop::Stop;
use crate::scene::resolve::ContactSetup;
use crate::scene::surface::LoadedSurface;
use crate::solve::solved::{ProblemSetup, Solved};

/// Solves the rows of a sweep.
pub(super) struct SceneRows<'a> {
    sweep: &'a Sweep,
    surfaces: &'a Surfaces,
    /// The surface that was loaded last. The loads of a surface come one after another.
    loaded: Latest<SurfaceOfLoads>,
    /// Number of all threads of the sweep.
    threads: usize,
    doubts: &'a Doubts,
    limit: Stop,
    bar: RowBar,
}

/// A surface, and the data that its loads share.
struct SurfaceOfLoads {
    surface: LoadedSurface,
    /// The plan of the first load.
    first: Mutex<Option<Plan<'static>>>,
}

impl SurfaceOfLoads {
    /// The plan of `problem`, which must be on this surface.
    fn plan(&self, problem: &ProblemSetup<'_>) -> Result<Plan<'static>, CliError> {
        // Even if a worker panicked, the stored plan is complete or absent.
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        if first.is_none() {
            *first = Some(problem.first_plan()?);
        }
        first.as_ref().map_or_else(|| problem.first_plan(), |first| problem.plan_like(first))
    }
}

impl<'a> SceneRows<'a> {
    /// The rows of `sweep`. Their time limit begins now.
    pub(super) fn new(
        sweep: &'a Sweep,
        surfaces: &'a Surfaces,
        (threads, doubts): (usize, &'a Doubts),
        bar: RowBar,
    ) -> Self {
        let limit = Stop::at(Instant::now(), surfaces.run.time_limit);
        Self { sweep, surfaces, loaded: Latest::default(), threads, doubts, limit, bar }
    }

    /// Solves `contact` on the surface of `row`.
    ///
    /// With fields, the folder of the row is complete when this returns. `wall_seconds` of one row of a surface
    /// includes the time of loading it.
    pub(super) fn solve_contact(&self, row: &SweepRow, contact: &ContactSetup) -> Result<Cells, CliError> {
        let surface = self.surfaces.surface(row);
        let load = || Ok::<_, CliError>(SurfaceOfLoads { surface: surface.load()?, first: Mutex::default() });
        let (loaded, time): (Arc<SurfaceOfLoads>, Duration) = self.loaded.get(row.surface, load)?;
        let started = Instant::now().checked_sub(time).unwrap_or_else(Instant::now);
        let folder = self.sweep.fields_folder(row.index);
        let budget = Budget::new(self.surfaces.run.memory_limit);
        let kernel = contact.kernel()?;
        let problem = ProblemSetup { surface: &loaded.surface, contact, kernel: &*kernel, budget };
        let solved = problem.solve_planned(loaded.plan(&problem)?, started, &Silent)?;
        let summary = solved.summary(self.threads);
        self.doubts.note(row.index, &summary.warnings);
        if let Some(folder) = folder {
            write_fields(&folder, &solved, &summary)?;
        }
        let mut cells = summary.cells();
        if contact.keys.leakage {
            LeakageSummary::complete(&mut cells);
        }
        Ok(cells)
    }
}

fn write_fields(folder: &Path, solved: &Solved<'_>, summary: &Summary) -> Result<(), CliError> {
    replace_fields(folder, || solved.write(folder, summary))
}

impl RowSolver for SceneRows<'_> {
    type Error = CliError;

    fn solve(&self, row: &SweepRow) -> Result<Cells, RowError<CliError>> {
        let cells = self.surfaces.contact(row).and_then(|contact| self.solve_contact(row, &contact));
        cells.map_err(|error| match error {
            CliError::Input(message) => {
                RowError::Refused(CliError::input(format_args!("{}: {message}", self.sweep.plan().describe(row))))
            }
            other => RowError::Failed(other),
        })
    }

    fn row_kept(&self) {
        self.bar.one_more();
    }

    fn should_stop(&self) -> bool {
        self.limit.reason().is_some()
    }
}
