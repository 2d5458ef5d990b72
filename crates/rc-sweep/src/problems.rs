//! The interface of the code that knows surfaces and contacts: the problem of each row.

use std::sync::Arc;

use rc_core::{HeightSource, Kernel};
use rc_solver::{ContactProblem, Control, Plan, SolveError, SolveParams};

use crate::plan::SweepRow;
use crate::row::Row;

/// The contact problems of the rows. Workers call it in parallel.
///
/// A surface is made once for all its loads, when the first of them is due.
pub trait RowProblems<R: Row = SweepRow>: Sync {
    /// A surface whose heights can be evaluated.
    type Surface: Send + Sync;
    /// The contact of a row, without its surface.
    type Contact;
    /// Error of a row whose problem cannot be solved.
    type Error: Send;

    /// Makes the surface of `row`.
    ///
    /// # Errors
    /// When it cannot be generated or read.
    fn surface(&self, row: &R) -> Result<Self::Surface, Self::Error>;

    /// The contact of `row`.
    ///
    /// # Errors
    /// When no surface could bear this contact.
    fn contact(&self, row: &R) -> Result<Self::Contact, Self::Error>;

    /// The problem that this contact and this surface make.
    ///
    /// For all loads of a surface, it differs only in [`RowProblem::control`].
    ///
    /// # Errors
    /// When they do not go together.
    fn problem(&self, surface: &Self::Surface, contact: &Self::Contact) -> Result<RowProblem, Self::Error>;

    /// Refuses a plan for other reasons than the solver's. It is called for the first load of a surface.
    ///
    /// # Errors
    /// The reason.
    fn check(
        &self,
        _surface: &Self::Surface,
        _contact: &Self::Contact,
        _plan: &Plan<'static>,
    ) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Expected processor time of the row (s), or `None` if it is not known.
    fn seconds(&self, _surface: &Self::Surface, _contact: &Self::Contact, plan: &Plan<'static>) -> Option<f64> {
        plan.cost().cpu_seconds
    }

    /// The error for a problem that the solver refuses.
    fn refused(&self, surface: &Self::Surface, contact: &Self::Contact, error: SolveError) -> Self::Error;
}

/// The contact problem of a row, in units of λ and E*.
#[derive(Clone)]
pub struct RowProblem {
    /// Heights (λ).
    pub heights: HeightSource<'static>,
    /// Elastic response. `None` is that of [`ContactProblem::new`].
    pub kernel: Option<Arc<dyn Kernel + Send + Sync>>,
    /// The load.
    pub control: Control,
    /// Maximum pressure (E*). It is infinite for an elastic contact.
    pub hardness: f64,
    /// Method, tolerance and limits.
    pub params: SolveParams,
}

impl RowProblem {
    /// Checks the problem and chooses the method.
    pub(crate) fn plan(self) -> Result<Plan<'static>, SolveError> {
        let problem = ContactProblem::new(self.heights, self.control).with_hardness(self.hardness);
        let problem = match self.kernel {
            Some(kernel) => problem.with_shared_kernel(kernel),
            None => problem,
        };
        problem.plan(&self.params)
    }
}

impl std::fmt::Debug for RowProblem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("RowProblem");
        out.field("heights", &self.heights)
            .field("kernel", &self.kernel.as_ref().map(|kernel| kernel.name()))
            .field("control", &self.control)
            .field("hardness", &self.hardness)
            .field("params", &self.params)
            .finish()
    }
}
