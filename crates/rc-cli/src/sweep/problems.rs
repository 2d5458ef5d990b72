//! The contact problems of the rows of a sweep or a mean.
//!
//! A row is the problem that `rc solve` solves for its scene.

use std::sync::Arc;

use rc_core::Kernel;
use rc_solver::{Plan, Solution, SolveError};
use rc_sweep::memory::Budget;
use rc_sweep::{Row, RowProblem, RowProblems, SolvedRow};

use crate::error::CliError;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::ContactSetup;
use crate::solve::solved::{ProblemSetup, Solved};

/// Scenes with the surface and the contact of each row.
pub(crate) trait RowScenes<R>: Sync {
    /// Reads or generates the surface of `row`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    fn load(&self, row: &R) -> Result<LoadedSurface, CliError>;

    /// The contact of `row`.
    ///
    /// # Errors
    /// [`CliError::Input`] for keys of the contact.
    fn contact(&self, row: &R) -> Result<ContactSetup, CliError>;

    /// Sees the solution of `row` before the row is kept.
    ///
    /// # Errors
    /// [`CliError::Write`].
    fn see(&self, _row: &R, _solution: &Solution<'_>) -> Result<(), CliError> {
        Ok(())
    }
}

/// The problems of the rows of `scenes`.
pub(super) struct SceneProblems<'a, S> {
    scenes: &'a S,
    budget: Budget,
}

/// The contact of a row, with its kernel and the memory of its solve.
pub(super) struct SceneContact {
    pub(super) setup: ContactSetup,
    kernel: Arc<dyn Kernel + Send + Sync>,
    budget: Budget,
}

impl<'a, S> SceneProblems<'a, S> {
    pub(super) fn new(scenes: &'a S, budget: Budget) -> Self {
        Self { scenes, budget }
    }
}

impl SceneContact {
    fn on<'a>(&'a self, surface: &'a LoadedSurface) -> ProblemSetup<'a> {
        ProblemSetup { surface, contact: &self.setup, kernel: &*self.kernel, budget: self.budget }
    }

    /// The solved problem on `surface`.
    pub(super) fn solved<'a>(&'a self, surface: &'a LoadedSurface, solved: SolvedRow) -> Solved<'a> {
        self.on(surface).solved_row(solved)
    }
}

impl<R: Row, S: RowScenes<R>> RowProblems<R> for SceneProblems<'_, S> {
    type Surface = LoadedSurface;
    type Contact = SceneContact;
    type Error = CliError;

    fn surface(&self, row: &R) -> Result<LoadedSurface, CliError> {
        self.scenes.load(row)
    }

    fn contact(&self, row: &R) -> Result<SceneContact, CliError> {
        let setup = self.scenes.contact(row)?;
        Ok(SceneContact { kernel: setup.kernel()?, setup, budget: self.budget })
    }

    fn problem(&self, surface: &LoadedSurface, contact: &SceneContact) -> Result<RowProblem, CliError> {
        contact.on(surface).of_row(Arc::clone(&contact.kernel))
    }

    fn check(&self, surface: &LoadedSurface, contact: &SceneContact, plan: &Plan<'static>) -> Result<(), CliError> {
        contact.on(surface).check_flow(plan)
    }

    fn seconds(&self, surface: &LoadedSurface, contact: &SceneContact, plan: &Plan<'static>) -> Option<f64> {
        contact.on(surface).cost(plan).cpu_seconds
    }

    fn refused(&self, surface: &LoadedSurface, contact: &SceneContact, error: SolveError) -> CliError {
        contact.on(surface).refuse(&error)
    }
}
