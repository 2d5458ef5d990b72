//! Solver of the realisations of an ensemble.
//!
//! A realisation is solved as `rc solve` does with its seed and grid.

use std::time::Instant;

use rc_core::Silent;
use rc_sweep::memory::Budget;
use rc_sweep::{Cells, ControlKind, Realisation, RowError, RowSolver};

use super::bar::RowBar;
use super::doubts::Doubts;
use super::surfaces::SweptSurface;
use crate::error::CliError;
use crate::run::stop::Stop;
use crate::scene::keys::{RunKeys, SurfaceKeys};
use crate::scene::resolve;
use crate::scene::values::GridSpec;
use crate::solve::solved::ProblemSetup;

/// Solves the realisations of a surface.
pub(super) struct Realisations<'a> {
    surface: &'a SweptSurface,
    control: ControlKind,
    /// Number of all threads.
    threads: usize,
    run: &'a RunKeys,
    doubts: &'a Doubts,
    limit: Stop,
    bar: RowBar,
}

impl<'a> Realisations<'a> {
    /// The realisations of `surface`. Their time limit begins now.
    pub(super) fn new(
        surface: &'a SweptSurface,
        (control, threads): (ControlKind, usize),
        (run, doubts): (&'a RunKeys, &'a Doubts),
        bar: RowBar,
    ) -> Self {
        Self { surface, control, threads, run, doubts, limit: Stop::at(Instant::now(), run.time_limit), bar }
    }

    fn solve_one(&self, row: &Realisation) -> Result<Cells, CliError> {
        let started = Instant::now();
        let grid = Some(GridSpec::square(row.side));
        let keys = SurfaceKeys { seed: Some(row.seed), grid, ..self.surface.setup.keys.clone() };
        let surface = resolve::surface(keys)?.load()?;
        let contact = self.surface.contact(self.control, row.load)?;
        let kernel = contact.kernel()?;
        let problem = ProblemSetup {
            surface: &surface,
            contact: &contact,
            kernel: &*kernel,
            budget: Budget::new(self.run.memory_limit),
        };
        let summary = problem.solve(started, &Silent)?.summary(self.threads);
        // Realisations have no order.
        self.doubts.note(0, &summary.warnings);
        Ok(summary.cells())
    }
}

impl RowSolver<Realisation> for Realisations<'_> {
    type Error = CliError;

    fn solve(&self, row: &Realisation) -> Result<Cells, RowError<CliError>> {
        self.solve_one(row).map_err(|error| match error {
            CliError::Input(message) => {
                let (seed, side, load) = (row.seed, row.side, row.load);
                let place = format_args!("seed {seed} on grid {side} ({} {load:e}): {message}", self.control.key());
                RowError::Refused(CliError::input(place))
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
