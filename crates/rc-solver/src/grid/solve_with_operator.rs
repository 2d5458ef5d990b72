//! The contact problem with any operator.
//!
//! It serves operators that a caller implements.

use rc_core::{Field, Grid, Observer, Operator};

use crate::descent::certificate::Certificate;
use crate::descent::info::{GridSolution, LevelInfo, SolveInfo, Status};
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::{Descent, Start};
use crate::descent::stiffness::stiffness_of;
use crate::grid::any_operator::operators_of;
use crate::problem::checked::Problem;
use crate::problem::contract::check_operator;
use crate::problem::control::Control;
use crate::problem::error::ProblemError;
use crate::problem::params::IterationParams;

/// Maximum fault of an operator, divided by the overlap that a solve aims at.
///
/// The fault is relative to the displacements, and the overlap to U/σ0. The ratio is a tenth, because U/σ0 may be a
/// tenth of the displacements.
const FAULT_PER_AIM: f64 = 0.1;

/// Solves the contact problem on the grid of `heights` (in λ, any mean) with `operator`.
///
/// The operator v = L p must be symmetric, of zero mean, and positive for pressures that are not uniform. Its element i
/// is element i of `heights`.
///
/// Projected conjugate gradients on this grid find the pressure. Nothing is known of the operator that would
/// precondition them or that coarser grids could use. They need several times the iterations of the uniform method,
/// which fits an operator with a [`rc_core::Kernel`] better. The certificate comes from a fresh application of the
/// operator on the returned pressure.
///
/// # Errors
/// [`ProblemError`] for an operator with another number of elements, or one that is not of a half-space. Also for
/// heights that are not finite, and for a control or tolerance out of range.
pub(crate) fn solve_on_grid(
    heights: &Field,
    operator: &dyn Operator,
    control: Control,
    params: &IterationParams,
    observer: &dyn Observer,
) -> Result<GridSolution, ProblemError> {
    let grid = heights.grid();
    if operator.n_elements() != grid.len() {
        return Err(ProblemError::Operator { grid, n_elements: operator.n_elements() });
    }
    let problem = Problem::check(heights, control, params)?;
    if let Control::MeanPressure(mean_pressure) = control
        && problem.h_range == 0.0
    {
        return Ok(flat(grid, mean_pressure));
    }
    check_operator(operator, FAULT_PER_AIM * params.bound.aim())?;
    let mut descent = Descent::new(heights.values(), grid, operators_of(operator), &problem, Start::Nothing);
    let goal =
        Goal { tolerance: params.bound.aim(), max_iterations: params.max_iterations, certify: Some(params.bound) };
    let outcome = descent.run(goal, &DescentObserver { observer, mesh: &grid });
    let level = descent.info();
    let mut solution = descent.into_solution(&outcome, vec![level], None);
    if solution.status == Status::Converged && solution.pressure.min() > 0.0 {
        solution.status = Status::FullContact;
    }
    Ok(solution)
}

/// dσ0/dΔ, in E*/λ, under the contact of `pressure`.
pub(crate) fn stiffness_with_operator(pressure: &Field, operator: &dyn Operator) -> f64 {
    if pressure.values().iter().all(|&p| p > 0.0) {
        return f64::INFINITY;
    }
    let mut operators = operators_of(operator);
    stiffness_of(pressure.values(), pressure.grid().len() as f64, &mut *operators.corrections)
}

/// The solution on a flat surface.
///
/// The pressure is uniform, and displaces nothing. The operator is not applied.
fn flat(grid: Grid, mean_pressure: f64) -> GridSolution {
    let level = LevelInfo { grid, iterations: 0, operator_applications: 0, preconditioner_applications: 0 };
    let info = SolveInfo {
        certificate: Certificate::EXACT,
        iteration_error: 0.0,
        mean_pressure,
        penetration: 0.0,
        penetration_full_contact: 0.0,
        mean_displacement: 0.0,
        elastic_energy: 0.0,
        levels: vec![level],
        coarser: None,
        friction: None,
    };
    GridSolution {
        pressure: Field::from_fn(grid, |_| mean_pressure),
        gap: Field::zeros(grid),
        status: Status::FullContact,
        elements: None,
        info,
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Silent;
    use rc_kernel::Love;

    use super::*;
    use crate::grid::direct_sum::DirectSum;
    use crate::levels::uniform::solve_uniform;

    /// A half-space that is softer by `factor`.
    struct Softer<'a> {
        operator: &'a dyn Operator,
        factor: f64,
    }

    impl Operator for Softer<'_> {
        fn n_elements(&self) -> usize {
            self.operator.n_elements()
        }

        fn scratch_len(&self) -> usize {
            self.operator.scratch_len()
        }

        fn apply(&self, pressure: &[f64], displacement: &mut [f64], scratch: &mut [f64]) {
            self.operator.apply(pressure, displacement, scratch);
            for v in displacement {
                *v *= self.factor;
            }
        }
    }

    fn heights(nx: usize, ny: usize) -> Field {
        use std::f64::consts::TAU;
        let wave = |x: f64, y: f64| (TAU * (x + 2.0 * y)).cos() + 0.6 * (TAU * (3.0 * x - y) + 1.0).cos();
        Field::from_fn(Grid::new(nx, ny).expect("a grid"), |at| 1e-3 * wave(at.x, at.y))
    }

    fn difference(a: &Field, b: &Field) -> f64 {
        let difference = a.values().iter().zip(b.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        difference / b.max()
    }

    const CONTROLS: [Control; 4] = [
        Control::MeanPressure(3e-4),
        Control::MeanPressure(3e-3),
        Control::Penetration(0.6e-3),
        Control::Penetration(1.2e-3),
    ];

    #[test]
    fn a_direct_sum_gives_what_the_uniform_solver_gives() {
        let params = IterationParams::relative(1e-9);
        for (nx, ny) in [(24, 24), (20, 30)] {
            let heights = heights(nx, ny);
            let operator = DirectSum::new(heights.grid(), &Love);
            for control in CONTROLS {
                let expected = solve_uniform(&heights, &Love, control, &params, &Silent).expect("a solution");
                let found = solve_on_grid(&heights, &operator, control, &params, &Silent).expect("a solution");
                assert!(found.info.certificate.meets(params.bound));
                let error = difference(&found.pressure, &expected.pressure);
                assert!(error < 1e-6, "{nx} x {ny}, {control:?}: the pressure differs by {error:e}");
                let penetration = found.info.penetration / expected.info.penetration - 1.0;
                assert!(penetration.abs() < 1e-7, "{nx} x {ny}, {control:?}: {penetration:e}");
            }
        }
    }

    #[test]
    fn a_stiffer_half_space_needs_a_larger_pressure() {
        let params = IterationParams::relative(1e-9);
        let heights = heights(24, 24);
        let operator = DirectSum::new(heights.grid(), &Love);
        let stiffer = Softer { operator: &operator, factor: 0.5 };
        for control in CONTROLS {
            let soft = match control {
                Control::MeanPressure(mean) => Control::MeanPressure(0.5 * mean),
                Control::Penetration(_) => control,
            };
            let expected = solve_uniform(&heights, &Love, soft, &params, &Silent).expect("a solution");
            let found = solve_on_grid(&heights, &stiffer, control, &params, &Silent).expect("a solution");
            let twice = Field::new(heights.grid(), expected.pressure.values().iter().map(|p| 2.0 * p).collect());
            let error = difference(&found.pressure, &twice.expect("a value for each element"));
            assert!(error < 1e-6, "{control:?}: the pressure differs by {error:e}");
        }
    }

    #[test]
    fn a_flat_surface_has_a_uniform_pressure() {
        let heights = Field::from_fn(Grid::square(8).expect("a grid"), |_| 0.1);
        let operator = DirectSum::new(heights.grid(), &Love);
        let load = Control::MeanPressure(1e-3);
        let solution = solve_on_grid(&heights, &operator, load, &IterationParams::relative(1e-6), &Silent);
        let solution = solution.expect("a solution");
        assert_eq!(solution.status, Status::FullContact);
        assert!(solution.pressure.values().iter().all(|&p| (p - 1e-3).abs() < 1e-15));
    }

    #[test]
    fn an_operator_of_another_size_is_refused() {
        let operator = DirectSum::new(Grid::square(8).expect("a grid"), &Love);
        let heights = heights(8, 9);
        let load = Control::MeanPressure(1e-3);
        let error = solve_on_grid(&heights, &operator, load, &IterationParams::relative(1e-6), &Silent).err();
        assert!(matches!(error, Some(ProblemError::Operator { n_elements: 64, .. })), "{error:?}");
    }
}
