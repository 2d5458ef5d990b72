//! The front door: a contact problem, its solution, and nothing in between that a caller has to choose.

mod area_error;
mod choice;
mod cost;
mod error;
mod kernel_of_grid;
mod params;
mod plan;
mod solution;

use rc_core::{HeightSource, Kernel, Observer, Silent};
use rc_kernel::Love;

pub use self::cost::Cost;
pub use self::error::SolveError;
pub use self::params::SolveParams;
pub use self::plan::Plan;
pub use self::solution::Solution;
use crate::Control;

/// A contact problem: heights, half-space and load.
///
/// ```
/// use rc_core::{Field, Grid};
/// use rc_kernel::Spectral;
/// use rc_solver::{ContactProblem, Control, Method, SolveParams};
///
/// // Westergaard's wave at a quarter of the load of full contact, with another kernel than the default.
/// let wave = Field::from_fn(Grid::square(64)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
/// let load = Control::MeanPressure(0.25 * std::f64::consts::PI * 1e-3);
/// let plan = ContactProblem::new(&wave, load).with_kernel(&Spectral).plan(&SolveParams::default())?;
/// assert_eq!(plan.method(), Method::Uniform);
/// let solution = plan.solve(&rc_core::Silent)?;
/// assert!((solution.area().fraction - 1.0 / 3.0).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy)]
pub struct ContactProblem<'a> {
    heights: HeightSource<'a>,
    kernel: &'a dyn Kernel,
    control: Control,
}

impl<'a> ContactProblem<'a> {
    /// The contact of `heights` (in λ) with the elastic half-space under a load. The kernel is [`Love`].
    #[must_use]
    pub fn new(heights: impl Into<HeightSource<'a>>, control: Control) -> Self {
        Self { heights: heights.into(), kernel: &Love, control }
    }

    /// The same problem with another half-space, or another discretisation of it.
    #[must_use]
    pub fn with_kernel(self, kernel: &'a dyn Kernel) -> Self {
        Self { kernel, ..self }
    }

    /// Checks the problem and chooses the method. Nothing is solved.
    ///
    /// # Errors
    /// [`SolveError`], but not [`SolveError::NotConverged`].
    pub fn plan(self, params: &SolveParams) -> Result<Plan<'a>, SolveError> {
        choice::plan(self, params)
    }

    /// Solves the problem: [`ContactProblem::plan`] and [`Plan::solve`].
    ///
    /// # Errors
    /// [`SolveError`].
    pub fn solve(self, params: &SolveParams, observer: &dyn Observer) -> Result<Solution<'a>, SolveError> {
        self.plan(params)?.solve(observer)
    }

    /// Solves the problem on the coarsest grid whose error bar of the contact area is at most `wanted` of the area. The heights must be
    /// a band-limited surface; the grid they are wanted on is not used.
    ///
    /// The bar on a first grid, with four elements for the shortest wave, says where to go next. Mostly two problems are solved, of which
    /// the last takes longer than all others.
    ///
    /// # Errors
    /// [`SolveError`]; [`SolveError::NoWaves`] for heights that no other grid can have, and [`SolveError::AreaError`] when 256 elements
    /// for the shortest wave are not enough.
    pub fn solve_to_area_error(
        self,
        wanted: f64,
        params: &SolveParams,
        observer: &dyn Observer,
    ) -> Result<Solution<'a>, SolveError> {
        area_error::solve(self, wanted, params, observer)
    }
}

impl std::fmt::Debug for ContactProblem<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut out = f.debug_struct("ContactProblem");
        out.field("heights", &self.heights)
            .field("kernel", &self.kernel.name())
            .field("control", &self.control)
            .finish()
    }
}

/// Solves the contact of `heights` (in λ) with the elastic half-space under a load.
///
/// The method is chosen by the estimated contact area unless `params` name one. The certificate comes from a fresh application of L on the
/// returned pressure. The result is bitwise the same for any number of threads.
///
/// ```
/// use rc_core::{Field, Grid};
/// use rc_solver::{Control, SolveParams, solve};
///
/// // Westergaard's wave at half the load of full contact, π E* a/λ: half of it touches.
/// let wave = Field::from_fn(Grid::square(128)?, |at| 1e-3 * (std::f64::consts::TAU * at.x).cos());
/// let solution = solve(&wave, Control::MeanPressure(0.5e-3 * std::f64::consts::PI), &SolveParams::default())?;
/// let area = solution.area();
/// assert!((area.fraction - 0.5).abs() < 5e-3, "A/A0 = {:.4} ± {:.4}", area.fraction, area.error);
/// assert!(solution.pressure().max() > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`SolveError`]. Non-convergence is one, and carries the best solution found.
pub fn solve<'a>(
    heights: impl Into<HeightSource<'a>>,
    control: Control,
    params: &SolveParams,
) -> Result<Solution<'a>, SolveError> {
    ContactProblem::new(heights, control).solve(params, &Silent)
}
