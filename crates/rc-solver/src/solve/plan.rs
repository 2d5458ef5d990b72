//! A problem with its method, ready to be solved.

use rc_core::Observer;
use rc_kernel::PeriodicLove;

use super::solution::HowSolved;
use super::{ContactProblem, Cost, Solution, SolveError, SolveParams};
use crate::adaptive::AdaptiveProblem;
use crate::solution::Status;
use crate::{
    AdaptiveError, GaussSeidelError, GaussSeidelParams, GridSolution, IterationError, Method, MethodReason,
    solve_gauss_seidel, solve_uniform,
};

/// A contact problem that has been checked and has its method. Nothing is solved yet.
pub struct Plan<'a> {
    pub(super) problem: ContactProblem<'a>,
    pub(super) params: SolveParams,
    /// The tolerance as a number.
    pub(super) tolerance: f64,
    pub(super) prepared: Prepared<'a>,
    pub(super) reason: MethodReason,
}

/// A method with what it needs to start.
pub(super) enum Prepared<'a> {
    /// Heights are evaluated as they are needed.
    Adaptive(Box<AdaptiveProblem<'a>>),
    /// All heights will be evaluated.
    Uniform,
    /// All heights will be evaluated.
    GaussSeidel,
}

impl<'a> Plan<'a> {
    /// The method.
    #[must_use]
    pub fn method(&self) -> Method {
        match self.prepared {
            Prepared::Adaptive(_) => Method::Adaptive,
            Prepared::Uniform => Method::Uniform,
            Prepared::GaussSeidel => Method::GaussSeidel,
        }
    }

    /// Why it is this one.
    #[must_use]
    pub fn reason(&self) -> &MethodReason {
        &self.reason
    }

    /// The tolerance as a number, relative to the peak-to-valley height.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// What the solve is expected to take.
    #[must_use]
    pub fn cost(&self) -> Cost {
        Cost::of(self)
    }

    /// Solves the problem.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`] with the best solution found; [`SolveError::Problem`] for heights that are not finite, and
    /// [`SolveError::GaussSeidel`] for what the paper's procedure refuses.
    pub fn solve(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        let solution = match self.prepared {
            Prepared::Adaptive(_) => self.solve_adaptive(observer),
            Prepared::Uniform => self.solve_uniform(observer),
            Prepared::GaussSeidel => self.solve_gauss_seidel(observer),
        }?;
        if solution.status() == Status::NotConverged { Err(solution.into_error()) } else { Ok(solution) }
    }

    fn solve_adaptive(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        let Prepared::Adaptive(problem) = self.prepared else { unreachable!("called for the adaptive method only") };
        let solution = match problem.solve(observer) {
            Ok(solution) => solution,
            Err(AdaptiveError::NotConverged { solution, .. }) => *solution,
            Err(error) => return Err(error.into()),
        };
        let how = HowSolved::new(Method::Adaptive, self.reason, self.tolerance, self.problem.kernel);
        Ok(Solution::on_tiles(how, solution, problem))
    }

    fn solve_uniform(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        let ContactProblem { heights, kernel, control } = self.problem;
        let heights = heights.heights();
        let params = self.params.iteration(self.tolerance);
        let solution = even_if_not_converged(solve_uniform(&heights, kernel, control, &params, observer))?;
        let how = HowSolved::new(Method::Uniform, self.reason, self.tolerance, kernel);
        Ok(Solution::on_grid(how, kernel, solution, heights.max()))
    }

    fn solve_gauss_seidel(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        let ContactProblem { heights, kernel, control } = self.problem;
        let heights = heights.heights();
        let periodic = PeriodicLove::new();
        let coefficient = |offset, half_side| periodic.coefficient(offset, half_side);
        let params = GaussSeidelParams { tolerance: self.tolerance, ..self.params.gauss_seidel };
        let result = match solve_gauss_seidel(&heights, kernel, &coefficient, control, &params, observer) {
            Err(GaussSeidelError::Solve(error)) => Err(error),
            Err(error) => return Err(error.into()),
            Ok(solution) => Ok(solution),
        };
        let solution = even_if_not_converged(result)?;
        let how = HowSolved::new(Method::GaussSeidel, self.reason, self.tolerance, kernel);
        Ok(Solution::on_grid(how, kernel, solution, heights.max()))
    }
}

/// The solution, converged or not.
fn even_if_not_converged(result: Result<GridSolution, IterationError>) -> Result<GridSolution, SolveError> {
    match result {
        Ok(solution) => Ok(solution),
        Err(IterationError::NotConverged { solution, .. }) => Ok(*solution),
        Err(error) => Err(error.into()),
    }
}

impl std::fmt::Debug for Plan<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plan").field("problem", &self.problem).field("reason", &self.reason).finish_non_exhaustive()
    }
}
