//! What a method found, and how.

use rc_core::{DVec2, Field, Grid};
use rc_kernel::PeriodicLove;
use rc_solver::{
    AdaptiveError, AdaptiveProblem, AdaptiveSolution, ContactArea, GaussSeidelError, GaussSeidelParams, GridSolution,
    IterationError, Observables, SolveInfo, Status, solve_gauss_seidel, solve_uniform,
};

use super::method::Plan;
use super::refusal::{in_si, not_converged};
use crate::error::CliError;
use crate::progress::Progress;
use crate::resolve::ContactProblem;
use crate::scene::Method;
use crate::surface::LoadedSurface;

/// What a method found.
pub(super) struct Found<'a> {
    pub(super) method: Method,
    pub(super) pressure: Pressure<'a>,
    /// The solver's error, when this is only the best pressure it found.
    pub(super) failure: Option<String>,
    /// Greatest height on the finest grid, in λ.
    pub(super) h_max: f64,
}

/// A solution, whole or on the tiles that contact touches.
pub(super) enum Pressure<'a> {
    Whole(Box<GridSolution>),
    Tiles {
        solution: Box<AdaptiveSolution>,
        /// What it solves, heights included.
        problem: Box<AdaptiveProblem<'a>>,
    },
}

impl<'a> Found<'a> {
    /// Carries out `plan`; `side` is λ in m.
    pub(super) fn by(
        plan: Plan<'a>,
        surface: &LoadedSurface,
        contact: &ContactProblem,
        side: f64,
        progress: &Progress,
    ) -> Result<Self, CliError> {
        match plan {
            Plan::Adaptive(problem) => Self::by_adaptive(problem, contact, side, progress),
            Plan::Uniform => {
                let heights = surface.heights()?;
                let result = solve_uniform(&heights, contact.kernel(), contact.control, &contact.params, progress);
                Self::of_whole(Method::Uniform, result, &heights, contact, side)
            }
            Plan::GaussSeidel => {
                let heights = surface.heights()?;
                let result = by_gauss_seidel(&heights, contact, progress)?;
                Self::of_whole(Method::GaussSeidel, result, &heights, contact, side)
            }
        }
    }

    fn by_adaptive(
        problem: Box<AdaptiveProblem<'a>>,
        contact: &ContactProblem,
        side: f64,
        progress: &Progress,
    ) -> Result<Self, CliError> {
        let h_max = problem.h_max();
        let (solution, failure) = match problem.solve(progress) {
            Ok(solution) => (Box::new(solution), None),
            Err(AdaptiveError::NotConverged { grid, iterations, certificate, solution }) => {
                let tolerance = contact.params.tolerance;
                (solution, Some(not_converged(grid, iterations, &certificate, tolerance)))
            }
            Err(AdaptiveError::Solve(error)) => return Err(in_si(&error, side, contact)),
            Err(other) => return Err(CliError::input(other)),
        };
        Ok(Self { method: Method::Adaptive, pressure: Pressure::Tiles { solution, problem }, failure, h_max })
    }

    fn of_whole(
        method: Method,
        result: Result<GridSolution, IterationError>,
        heights: &Field,
        contact: &ContactProblem,
        side: f64,
    ) -> Result<Self, CliError> {
        let (solution, failure) = match result {
            Ok(solution) => (Box::new(solution), None),
            Err(IterationError::NotConverged { grid, iterations, certificate, solution }) => {
                (solution, Some(not_converged(grid, iterations, &certificate, contact.params.tolerance)))
            }
            Err(error) => return Err(in_si(&error, side, contact)),
        };
        Ok(Self { method, pressure: Pressure::Whole(solution), failure, h_max: heights.max() })
    }

    /// `converged`, `full_contact` or `not_converged`.
    pub(super) fn status(&self) -> &'static str {
        match (&self.failure, &self.pressure) {
            (Some(_), _) => "not_converged",
            (None, Pressure::Whole(solution)) if solution.status == Status::FullContact => "full_contact",
            (None, Pressure::Tiles { solution, .. }) if solution.is_full_contact() => "full_contact",
            (None, _) => "converged",
        }
    }

    pub(super) fn info(&self) -> &SolveInfo {
        match &self.pressure {
            Pressure::Whole(solution) => &solution.info,
            Pressure::Tiles { solution, .. } => &solution.info,
        }
    }

    /// The finest grid.
    pub(super) fn grid(&self) -> Grid {
        match &self.pressure {
            Pressure::Whole(solution) => solution.pressure.grid(),
            Pressure::Tiles { solution, .. } => solution.grid(),
        }
    }

    /// Elements that carry unknowns, see [`rc_sweep::Summary::elements`].
    pub(super) fn n_elements(&self) -> usize {
        match &self.pressure {
            Pressure::Whole(solution) => {
                solution.elements.as_ref().map_or(solution.pressure.grid().len(), |elements| elements.mesh.len())
            }
            Pressure::Tiles { solution, .. } => solution.n_elements(),
        }
    }

    /// Elements of the grid whose gap the certificate computed, and those that it proved open instead.
    pub(super) fn evaluated_and_proven(&self) -> (usize, usize) {
        match &self.pressure {
            Pressure::Whole(solution) => (solution.pressure.grid().len(), 0),
            Pressure::Tiles { solution, .. } => (solution.evaluated, solution.proven),
        }
    }

    pub(super) fn contact_area(&self, contact: &ContactProblem) -> ContactArea {
        match &self.pressure {
            Pressure::Whole(solution) => {
                ContactArea::of(&solution.pressure, &solution.gap, contact.kernel().edge_bias())
            }
            Pressure::Tiles { solution, .. } => solution.contact_area(),
        }
    }

    pub(super) fn contact_stiffness(&self, contact: &ContactProblem) -> f64 {
        match &self.pressure {
            Pressure::Whole(solution) => solution.contact_stiffness(contact.kernel()),
            Pressure::Tiles { solution, .. } => solution.contact_stiffness(),
        }
    }

    pub(super) fn observables(&self, contact: &ContactProblem) -> Observables {
        match &self.pressure {
            Pressure::Whole(solution) => Observables::of(solution, contact.kernel()),
            Pressure::Tiles { solution, .. } => solution.observables(),
        }
    }
}

/// The paper's procedure. What only it refuses is bad input; the rest is as for the other methods.
fn by_gauss_seidel(
    heights: &Field,
    contact: &ContactProblem,
    progress: &Progress,
) -> Result<Result<GridSolution, IterationError>, CliError> {
    let periodic = PeriodicLove::new();
    let coefficient = |offset: DVec2, half_side: f64| periodic.coefficient(offset, half_side);
    let params = GaussSeidelParams { tolerance: contact.params.tolerance, ..GaussSeidelParams::paper() };
    match solve_gauss_seidel(heights, contact.kernel(), &coefficient, contact.control, &params, progress) {
        Ok(solution) => Ok(Ok(solution)),
        Err(GaussSeidelError::Solve(error)) => Ok(Err(error)),
        Err(other) => Err(CliError::input(format_args!("method gauss-seidel: {other}"))),
    }
}
