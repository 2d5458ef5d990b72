//! A problem with its method, ready to be solved.

use std::sync::Arc;

use rc_core::{Field, Observer};
use rc_kernel::PeriodicLove;

use crate::descent::info::{GridSolution, Status};
use crate::grid::solved::{GridSolved, Response};
use crate::levels::adaptive::Unsuitable;
use crate::levels::sliding::solve_sliding;
use crate::levels::tiles::TileLevels;
use crate::levels::uniform::{solve_uniform, solve_uniform_or_gap};
use crate::paper::error::GaussSeidelError;
use crate::paper::half_space::HalfSpace;
use crate::paper::params::GaussSeidelParams;
use crate::paper::solve::solve_gauss_seidel;
use crate::parallel::{self, in_pool};
use crate::problem::contact_problem::ContactProblem;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::problem::summit::Summit;
use crate::problem::tolerance::ErrorBound;
use crate::solution::solved::Solved;
use crate::solution::whole::{HowSolved, Solution};
use crate::solve::error::SolveError;
use crate::solve::features::check_ranks;
use crate::solve::memory::{bytes_per_element, check_uniform};
use crate::solve::params::SolveParams;
use crate::solve::shared::Shared;
use crate::tiles::solution::TileSolution;

/// A checked contact problem with its method. It is not solved yet.
pub struct Plan<'a> {
    pub(crate) problem: ContactProblem<'a>,
    pub(crate) params: SolveParams,
    /// The bound that the certificate must meet.
    pub(crate) bound: ErrorBound,
    pub(crate) chosen: ChosenMethod<'a>,
    pub(crate) reason: MethodReason,
    pub(crate) shared: Arc<Shared<'a>>,
}

/// A method, and its data at the start.
pub(crate) enum ChosenMethod<'a> {
    /// The adaptive method. Heights are evaluated as they are needed.
    Adaptive(Box<TileLevels<'a>>),
    /// The uniform method. All heights will be evaluated.
    Uniform,
    /// The paper's procedure. All heights will be evaluated.
    GaussSeidel,
}

impl<'a> Plan<'a> {
    /// The chosen method.
    ///
    /// If the adaptive method was chosen automatically, the uniform one may replace it. It takes over if the solution
    /// on a coarse grid, the base grid, shows that contact is too scattered or that pressures are too rough for the
    /// tolerance. It also takes over if the solution of the adaptive method is not certified. [`Solution::method`]
    /// returns the method that solved the problem.
    #[must_use]
    pub fn method(&self) -> Method {
        match self.chosen {
            ChosenMethod::Adaptive(_) => Method::Adaptive,
            ChosenMethod::Uniform => Method::Uniform,
            ChosenMethod::GaussSeidel => Method::GaussSeidel,
        }
    }

    /// The reason for the method.
    #[must_use]
    pub fn reason(&self) -> &MethodReason {
        &self.reason
    }

    /// The bound that the certificate must meet.
    #[must_use]
    pub fn bound(&self) -> ErrorBound {
        self.bound
    }

    /// Solves the problem.
    ///
    /// # Errors
    /// [`SolveError::NotConverged`] with the best solution found. [`SolveError::Problem`] for heights that are not
    /// finite. [`SolveError::GaussSeidel`] if the Gauss-Seidel method cannot solve the problem.
    pub fn solve(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        // Ranks wait for each other, which threads of the pool must not.
        if self.problem.is_shared() { self.solve_here(observer) } else { in_pool(|| self.solve_here(observer)) }
    }

    /// Solves the problem in this thread.
    fn solve_here(self, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        let Self { problem, params, bound, chosen, reason, mut shared } = self;
        let name = problem.kernel.get().name();
        let asked = problem.bounds();
        let how = |method, reason| HowSolved { method, reason, bound, kernel: name, asked };
        let (before, chosen, reason) = match chosen {
            ChosenMethod::Adaptive(levels) => {
                let tried = by_adaptive(&problem, &params, (&levels, &reason), observer)?;
                let how = how(Method::Adaptive, reason);
                let summit = levels.data.heights.summit();
                let found = |solution: TileSolution<'a>| Solution::new(how, summit, Box::new(solution));
                match tried {
                    Tried::Solved(solution) => {
                        // An error carries a solution without a borrow, which need not be a copy then.
                        drop((shared, levels));
                        return converged(found(solution));
                    }
                    Tried::Left(reason) => (None, ChosenMethod::Uniform, reason),
                    Tried::NotCertified(solution, reason) => (Some(found(solution)), ChosenMethod::Uniform, reason),
                }
            }
            on_grid => (None, on_grid, reason),
        };
        if let Some(shared) = Arc::get_mut(&mut shared) {
            shared.forget_tiles();
        }
        let (heights, kernel) = (shared.heights(&problem.heights), problem.kernel.get());
        let mut reason = reason;
        let (method, solution) = if matches!(chosen, ChosenMethod::GaussSeidel) {
            let params = (bound, &params.gauss_seidel);
            (Method::GaussSeidel, by_gauss_seidel(&problem, heights, params, observer)?)
        } else {
            let limits = params.iteration(bound);
            let solution = if kernel.sliding_velocity().is_some() {
                solve_sliding(heights, kernel, problem.bounds(), &limits, observer)?
            } else if matches!(reason, MethodReason::AskedFor(_)) {
                solve_uniform(heights, kernel, problem.bounds(), &limits, observer)?
            } else {
                let (solution, is_from_gap) =
                    solve_uniform_or_gap(heights, kernel, problem.bounds(), &limits, observer)?;
                if is_from_gap {
                    reason = MethodReason::HeavyContact;
                }
                solution
            };
            (Method::Uniform, solution)
        };
        let how = how(method, reason);
        let highest = parallel::maximum(heights.values(), f64::NEG_INFINITY);
        let summit = Summit::on_grid(problem.heights.surface(), (heights, highest), problem.boundary());
        let solved = GridSolved::new(solution, heights, Response::Kernel(problem.kernel), problem.hardness);
        let solution = Solution::new(how, summit, Box::new(solved));
        // NaN counts as infinite.
        let error = |solution: &Solution<'_>| solution.certificate().error(bound).min(f64::INFINITY);
        match before {
            // The uniform method did not end either, perhaps because the observer ended it.
            Some(before) if solution.status() == Status::NotConverged && error(&before) < error(&solution) => {
                converged(before)
            }
            _ => converged(solution),
        }
    }
}

/// What the adaptive method did, and why the uniform method takes over.
enum Tried<'a> {
    /// The solution is the result.
    Solved(TileSolution<'a>),
    /// The uniform method is better.
    Left(MethodReason),
    /// The uniform method may certify what this solution does not.
    NotCertified(TileSolution<'a>, MethodReason),
}

/// Solves by the adaptive method, unless the uniform method is better.
///
/// Only a method that an estimate chose is replaced. There are three reasons: contact turns out to be too scattered,
/// the adaptive operator cannot certify the tolerance of such pressures, or it did not. The uniform grid must then fit
/// into memory.
fn by_adaptive<'a>(
    problem: &ContactProblem<'a>,
    params: &SolveParams,
    (levels, reason): (&TileLevels<'a>, &MethodReason),
    observer: &dyn Observer,
) -> Result<Tried<'a>, SolveError> {
    let fits_beside = |bytes: f64| {
        let limit = params.memory_limit.map(|limit| limit.saturating_sub(bytes as u64));
        check_uniform(problem.heights.grid(), bytes_per_element(problem), limit, Method::Uniform)
    };
    let uniform_fits = fits_beside(0.0);
    // If the method may not follow memory, a load is solved in the same way on every machine, or refused.
    let is_only = || params.method_follows_memory && problem.ranks.any(uniform_fits.is_err());
    let may_leave = matches!(reason, MethodReason::SmallContact { .. }) && !is_only();
    let (bound, tolerance) = (levels.params.solve.bound, levels.params.solve.bound.value());
    let reason = match levels.solve(may_leave, observer) {
        Err(Unsuitable::Scattered { tile_fraction }) => {
            MethodReason::ScatteredContact { percent: 100.0 * tile_fraction }
        }
        Err(Unsuitable::Rough) => MethodReason::ToleranceTooSmall { tolerance },
        Ok(solution) => {
            let is_last = !may_leave || problem.is_shared() || uniform_fits.is_err();
            if is_last || solution.status() != Status::NotConverged || observer.should_stop() {
                return Ok(Tried::Solved(solution));
            }
            let error = solution.info.certificate.error(bound);
            let reason = MethodReason::NotCertified { error, tolerance };
            // The solution is kept meanwhile, with its problem, if there is memory for both.
            match fits_beside(levels.estimate().adaptive_bytes) {
                Ok(()) => return Ok(Tried::NotCertified(solution, reason)),
                Err(_) => reason,
            }
        }
    };
    check_ranks(problem, &reason)?;
    uniform_fits?;
    Ok(Tried::Left(reason))
}

/// The solution, or the error that carries it.
fn converged(solution: Solution<'_>) -> Result<Solution<'_>, SolveError> {
    if solution.status() == Status::NotConverged { Err(not_converged(solution)) } else { Ok(solution) }
}

/// The error that carries a solution.
pub(crate) fn not_converged(solution: Solution<'_>) -> SolveError {
    SolveError::NotConverged {
        grid: solution.finest_grid(),
        iterations: solution.info().fine_iterations(),
        certificate: solution.certificate(),
        solution: Box::new(solution.into_owned()),
    }
}

/// The paper's procedure with Love's squares, whose coefficients it needs one by one.
fn by_gauss_seidel(
    problem: &ContactProblem<'_>,
    heights: &Field,
    (bound, params): (ErrorBound, &GaussSeidelParams),
    observer: &dyn Observer,
) -> Result<GridSolution, GaussSeidelError> {
    let periodic = PeriodicLove::new();
    let half_space = HalfSpace {
        kernel: problem.kernel.get(),
        coefficient: &|offset, half_side| periodic.coefficient(offset, half_side),
    };
    solve_gauss_seidel(heights, half_space, problem.control, (bound, params), observer)
}

impl std::fmt::Debug for Plan<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plan").field("problem", &self.problem).field("reason", &self.reason).finish_non_exhaustive()
    }
}
