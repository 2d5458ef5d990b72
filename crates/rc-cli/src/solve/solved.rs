//! A solved scene with what its files and its summary need.

use std::path::Path;
use std::time::{Duration, Instant};

use rc_core::Observer;
use rc_solver::{ContactProblem, Plan, Solution, SolveError, SolveParams};
use rc_sweep::memory::Budget;
use rc_sweep::{SolveContext, Summary};

use super::{messages, result_files};
use crate::error::CliError;
use crate::files::coarsen::check_factor;
use crate::scene::resolve::ContactSetup;
use crate::scene::surface::LoadedSurface;
use crate::scene::values::Fraction;

/// What is solved: a surface, a contact, and the memory that there is.
#[derive(Clone, Copy)]
pub(crate) struct ProblemSetup<'a> {
    pub(crate) surface: &'a LoadedSurface,
    pub(crate) contact: &'a ContactSetup,
    pub(crate) budget: Budget,
}

/// A solved problem.
pub(crate) struct Solved<'a> {
    problem: ProblemSetup<'a>,
    solution: Solution<'static>,
    /// What is said of a solution that did not reach the tolerance.
    failure: Option<String>,
    wall: Duration,
}

impl<'a> ProblemSetup<'a> {
    /// Checks the problem and chooses the method.
    ///
    /// # Errors
    /// [`CliError::Input`] when the scene, the method asked for, or the memory there is do not allow it.
    pub(crate) fn plan(&self) -> Result<Plan<'static>, CliError> {
        if let Some(spec) = self.contact.keys.output_grid {
            check_factor(self.surface.grid, spec)?;
        }
        self.contact_problem().plan(&self.params()).map_err(|error| self.refuse(&error))
    }

    /// The same with what `other`, a plan on the same surface with the same parameters, has prepared.
    ///
    /// # Errors
    /// As of [`ProblemSetup::plan`].
    pub(crate) fn plan_like(&self, other: &Plan<'static>) -> Result<Plan<'static>, CliError> {
        other.under(self.contact.control).map_err(|error| self.refuse(&error))
    }

    /// Solves; `started` is the moment from which `wall_seconds` counts. Nothing is written.
    ///
    /// # Errors
    /// [`CliError::Input`]; a solution that did not converge is not an error, see [`Solved::failure`].
    pub(crate) fn solve(self, started: Instant, observer: &dyn Observer) -> Result<Solved<'a>, CliError> {
        self.solve_planned(self.plan()?, started, observer)
    }

    /// The same by a plan of this problem.
    ///
    /// # Errors
    /// As of [`ProblemSetup::solve`].
    pub(crate) fn solve_planned(
        self,
        plan: Plan<'static>,
        started: Instant,
        observer: &dyn Observer,
    ) -> Result<Solved<'a>, CliError> {
        self.solved(plan.solve(observer), started)
    }

    /// The same on the coarsest grid that gives the contact area with a relative error of at most `wanted`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn solve_to_area_error(
        self,
        Fraction(wanted): Fraction,
        started: Instant,
        observer: &dyn Observer,
    ) -> Result<Solved<'a>, CliError> {
        let problem = self.contact_problem();
        if let Some(spec) = self.contact.keys.output_grid {
            // All grids are multiples of the first.
            check_factor(problem.coarsest_grid().map_err(|error| self.refuse(&error))?, spec)?;
        }
        let result = problem.solve_to_area_error(wanted, &self.params(), observer);
        self.solved(result, started)
    }

    fn contact_problem(&self) -> ContactProblem<'static> {
        ContactProblem::new(self.surface.source(), self.contact.control).with_kernel(self.contact.kernel())
    }

    fn params(&self) -> SolveParams {
        SolveParams { memory_limit: self.budget.available(), ..self.contact.params }
    }

    fn solved(self, result: Result<Solution<'static>, SolveError>, started: Instant) -> Result<Solved<'a>, CliError> {
        let (solution, failure) = match result {
            Ok(solution) => (solution, None),
            Err(SolveError::NotConverged { grid, iterations, certificate, solution }) => {
                let failure = messages::not_converged(grid, iterations, &certificate, solution.bound());
                (*solution, Some(failure))
            }
            Err(error) => return Err(self.refuse(&error)),
        };
        Ok(Solved { problem: self, solution, failure, wall: started.elapsed() })
    }

    fn refuse(&self, error: &SolveError) -> CliError {
        messages::in_si(error, self.surface, self.contact, self.budget)
    }
}

impl Solved<'_> {
    /// What is to be said of a solution that did not reach the tolerance.
    pub(crate) fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// The summary in SI; `threads` is what it says of them.
    pub(crate) fn summary(&self, threads: usize) -> Summary {
        let ProblemSetup { surface, contact, .. } = self.problem;
        // Not before: the time to the certified solution does not include what the solution does not need.
        let [rms_height, rms_slope] = surface.height_and_slope();
        let context = SolveContext {
            control: contact.control.into(),
            border_level: contact.params.border_level,
            rms_height,
            rms_slope,
            wall: self.wall,
            threads,
        };
        Summary::of(&self.solution, contact.units, &context)
    }

    /// Writes the result folder.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(crate) fn write(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        let ProblemSetup { surface, contact, .. } = self.problem;
        Ok(result_files::write(folder, surface, contact, &self.solution, summary)?)
    }
}
