//! The functions that solve a contact problem.

use std::sync::Arc;

use rc_core::{Boundary, Grid, HeightSource, Observer, Operator, Silent};

use crate::descent::info::Status;
use crate::grid::solve_with_operator::solve_on_grid;
use crate::grid::solved::{GridSolved, Response};
use crate::problem::bounds::Bounds;
use crate::problem::capabilities::{Feature, refusal};
use crate::problem::checked::check_tolerance;
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::problem::summit::Summit;
use crate::solution::whole::HowSolved;
use crate::solution::whole::Solution;
use crate::solve::area_error;
use crate::solve::choice;
use crate::solve::error::SolveError;
use crate::solve::params::SolveParams;
use crate::solve::plan;
use crate::solve::plan::Plan;

impl<'a> ContactProblem<'a> {
    /// Checks the problem and chooses its method, without solving.
    ///
    /// Load, tolerance, grid, kernel and estimated memory are checked.
    ///
    /// # Errors
    /// [`SolveError`], but not [`SolveError::NotConverged`].
    pub fn plan(self, params: &SolveParams) -> Result<Plan<'a>, SolveError> {
        choice::plan(self, params, Arc::default())
    }

    /// Solves the problem: [`ContactProblem::plan`] and [`Plan::solve`].
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn solve(self, params: &SolveParams, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        self.plan(params)?.solve(observer)
    }

    /// The first grid of [`ContactProblem::solve_to_area_error`].
    ///
    /// All later grids are finer. Their numbers of elements per side are multiples of the number on this one.
    ///
    /// # Errors
    /// [`SolveError::Unsupported`], and [`SolveError::Grid`] for a surface with too many waves.
    pub fn coarsest_grid(&self) -> Result<Grid, SolveError> {
        area_error::coarsest_grid(self)
    }

    /// Solves the problem on finer grids until the contact area is accurate enough.
    ///
    /// The relative error bar of the contact area is then at most `wanted`. The heights must be a band-limited surface
    /// in a square cell. The grid of the given [`HeightSource`] only says that the cell is a square. Its numbers of
    /// elements are not used.
    ///
    /// The first grid has at least four elements for the shortest wave. The error bar on a grid determines the next
    /// grid, which has 2, 4, 8, ... times the elements per side. In most cases two problems are solved. The last takes
    /// longer than all others.
    ///
    /// # Errors
    /// [`SolveError`]. [`SolveError::Unsupported`] for heights that cannot be sampled on another grid.
    /// [`SolveError::AreaError`] when 256 elements for the shortest wave are not enough.
    pub fn solve_to_area_error(
        self,
        wanted: f64,
        params: &SolveParams,
        observer: &dyn Observer,
    ) -> Result<Solution<'a>, SolveError> {
        area_error::solve(&self, wanted, params, observer)
    }
}

impl Plan<'_> {
    /// The plan of another load on the same surface, with the same parameters.
    ///
    /// The plans share heights, bounds of the heights and tables of the operator. These are kept as long as one of the
    /// plans lives. Results are bitwise those of a separate plan: a solve does not start from the pressure of another
    /// load.
    ///
    /// ```
    /// use rc_core::{Field, Grid, Silent};
    /// use rc_solver::{ContactProblem, Control, SolveParams};
    ///
    /// let wave = Field::from_fn(Grid::square(128)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
    /// let plan = ContactProblem::new(&wave, Control::MeanPressure(1e-4)).plan(&SolveParams::default())?;
    /// for load in [2e-4, 4e-4, 8e-4] {
    ///     let solution = plan.under(Control::MeanPressure(load))?.solve(&Silent)?;
    ///     println!("{load:e}: {:.3}", solution.area().fraction);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`ContactProblem::plan`].
    pub fn under(&self, control: Control) -> Result<Self, SolveError> {
        let problem = ContactProblem { control, ..self.problem.clone() };
        choice::plan(problem, &self.params, Arc::clone(&self.shared))
    }
}

/// Solves the contact of `heights` (in λ) with the elastic half-space under a load.
///
/// The estimated contact area determines the method, unless `params` specifies one. The certificate comes from a fresh
/// application of L on the returned pressure. The result is bitwise the same for any number of threads.
///
/// ```
/// use rc_core::{Field, Grid};
/// use rc_solver::{Control, SolveParams, solve};
///
/// // The load of full contact of Westergaard's wave is π E* a/λ. At half this load, half of the wave touches.
/// let wave = Field::from_fn(Grid::square(128)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
/// let solution = solve(&wave, Control::MeanPressure(0.5e-3 * std::f64::consts::PI), &SolveParams::default())?;
/// let area = solution.area();
/// assert!((area.fraction - 0.5).abs() < 5e-3, "A/A0 = {:.4} ± {:.4}", area.fraction, area.error);
/// assert!(solution.pressure().max() > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SolveError`]. Non-convergence is an error too, and contains the best solution found.
pub fn solve<'a>(
    heights: impl Into<HeightSource<'a>>,
    control: Control,
    params: &SolveParams,
) -> Result<Solution<'a>, SolveError> {
    ContactProblem::new(heights, control).solve(params, &Silent)
}

/// Solves the contact of `heights` (in λ) with the half-space of the caller's operator.
///
/// The operator v = L p must be symmetric, and positive for pressures that are not uniform. The displacement must have
/// zero mean. Element i of the operator is element i of the heights.
///
/// Projected conjugate gradients on the grid of the heights find the pressure. No preconditioner is known for a general
/// operator, so they need several times the iterations of the uniform method. For a half-space with a
/// [`rc_core::Kernel`], [`ContactProblem::with_kernel`] is faster. Of `params`, only the tolerance and the number of
/// iterations count. A border level, or a method other than [`Method::Uniform`], is an error. The certificate comes
/// from a fresh application of the operator. [`Solution::stiffness`] is then less accurate, because its iteration is
/// not preconditioned either. It is a lower bound, usually less than a percent too small.
///
/// # Errors
/// [`SolveError`]. [`crate::ProblemError::Operator`] for an operator with another number of elements.
/// [`crate::ProblemError::NotElastic`] if the check at the start shows that the operator is not one of a half-space
/// (see [`Operator`]).
pub fn solve_with_operator<'a>(
    heights: impl Into<HeightSource<'a>>,
    operator: &'a dyn Operator,
    control: Control,
    params: &SolveParams,
    observer: &dyn Observer,
) -> Result<Solution<'a>, SolveError> {
    let border = (params.border_level > 0).then_some(Feature::BorderLevel);
    let features: Vec<_> = std::iter::once(Feature::OwnOperator).chain(border).collect();
    if let Some(refused) = refusal(&features, params.method) {
        return Err(refused.into());
    }
    let source = heights.into();
    let bound = params.tolerance.bound(source.elements_per_wave());
    check_tolerance(bound)?;
    let heights = source.heights();
    let reason = match refusal(&features, Some(Method::Adaptive)) {
        Some(refusal) => MethodReason::Only { method: Method::Uniform, refusal },
        None => MethodReason::AskedFor(Method::Uniform),
    };
    let limits = params.iteration(bound);
    let solution = solve_on_grid(&heights, operator, control, &limits, observer)?;
    let asked = Bounds::from(control);
    let how = HowSolved { method: Method::Uniform, reason, bound, kernel: "operator", asked };
    let summit = Summit::on_grid(source.surface(), (&heights, heights.max()), Boundary::Periodic);
    let solved = GridSolved::new(solution, &heights, Response::Operator(operator), f64::INFINITY);
    let solution = Solution::new(how, summit, Box::new(solved));
    if solution.status() == Status::NotConverged { Err(plan::not_converged(solution)) } else { Ok(solution) }
}
