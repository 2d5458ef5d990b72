//! The way from the problems of rows to the table: sweeps and ensembles whose rows this crate solves.

use std::path::PathBuf;

use crate::contact_rows::{ContactRows, Planner};
use crate::ensemble::{Ensemble, EnsembleMean, Realisation, WantedMean};
use crate::plan::SweepPlan;
use crate::problems::RowProblems;
use crate::results::RowResults;
use crate::row_solver::{RunError, Workers};
use crate::sweep::Sweep;

impl Sweep {
    /// Solves the contact problems of the remaining rows, as [`Sweep::run`] does, and returns the path of the table.
    ///
    /// `results` makes the cells of the rows. If the surfaces share one contact, [`Sweep::solve_surfaces`] is simpler.
    ///
    /// # Errors
    /// Those of [`Sweep::run`].
    pub fn solve<P: RowProblems>(
        &self,
        problems: &P,
        results: &impl RowResults<P>,
        workers: Workers,
    ) -> Result<PathBuf, RunError<P::Error>> {
        self.run(&ContactRows::new(problems, results), workers)
    }
}

impl Ensemble {
    /// Solves the contact problems that the means need, as [`Ensemble::run`] does.
    ///
    /// If the surfaces share one contact, [`Ensemble::solve_surfaces`] is simpler.
    ///
    /// # Errors
    /// Those of [`Ensemble::run`].
    pub fn solve<P: RowProblems<Realisation>>(
        &self,
        wanted: &WantedMean,
        problems: &P,
        results: &impl RowResults<P, Realisation>,
        workers: impl Fn(f64) -> Workers,
    ) -> Result<Option<Vec<EnsembleMean>>, RunError<P::Error>> {
        self.run(wanted, &ContactRows::new(problems, results), workers)
    }
}

impl SweepPlan {
    /// Distributes the rows to shards by the times that the solver expects of `problems`.
    ///
    /// Nothing is solved, but surfaces are made. See [`SweepPlan::dealt_by`].
    #[must_use]
    pub fn dealt_by_estimate(self, problems: &impl RowProblems) -> Self {
        let planner = Planner::new(problems);
        self.dealt_by(|row| planner.seconds(row))
    }
}
