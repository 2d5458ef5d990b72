//! A half-space and a surface of a fork, which use only the traits.

use std::sync::atomic::{AtomicUsize, Ordering};

use rc_core::testing::{ChangedOperator, check_height_field, check_kernel};
use rc_core::{Field, Grid, HeightField, Kernel, Silent, Symbol};
use rc_kernel::Love;
use rc_solver::{
    ContactProblem, Control, Method, OperatorFault, ProblemError, SolveError, SolveParams, Status, UniformOperator,
    solve, solve_with_operator,
};

use crate::examples::own_kernel::BondedLayer;
use crate::examples::own_surface::Weierstrass;

/// Heights of a surface that is not in the libraries.
fn heights(side: usize) -> Field {
    Weierstrass::default().sample(Grid::square(side).expect("grid"))
}

#[test]
fn own_surface_and_own_half_space_drive_the_solver() {
    let layer = BondedLayer { thickness: 0.05, poisson: 0.3 };
    check_kernel(&layer);
    check_height_field(&Weierstrass::default());
    let heights = heights(128);
    let problem = ContactProblem::new(&heights, Control::MeanPressure(5e-4));
    let solve =
        |problem: ContactProblem<'_>| problem.solve(&SolveParams::default(), &Silent).expect("solvable").into_owned();
    let (thin, thick) = (solve(problem.clone().with_kernel(&layer)), solve(problem.with_kernel(&rc_kernel::Spectral)));
    assert_eq!((thin.status(), thick.status()), (Status::Converged, Status::Converged));
    let reason = "uniform: a kernel without a split by scale has no adaptive form (bonded-layer)";
    assert_eq!(thin.reason().to_string(), reason);
    // A thin layer on a rigid base is stiffer than a half-space, so the same load penetrates less.
    let (a, b) = (thin.info().penetration, thick.info().penetration);
    assert!(a < 0.9 * b, "layer {a:e}, half-space {b:e}");
}

/// Love's squares with a wrong value at one wave, after `sound` calls.
struct Broken {
    eigenvalue: f64,
    sound: usize,
    asked: AtomicUsize,
}

impl Broken {
    fn new(eigenvalue: f64, sound: usize) -> Self {
        Self { eigenvalue, sound, asked: AtomicUsize::new(0) }
    }
}

impl Kernel for Broken {
    fn name(&self) -> &'static str {
        "broken"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let is_broken = self.asked.fetch_add(1, Ordering::Relaxed) >= self.sound;
        let love = Love.symbol(grid);
        Box::new(move |kx, ky| if is_broken && (kx, ky) == (1, 2) { self.eigenvalue } else { love(kx, ky) })
    }
}

/// The error of a solve with this kernel.
fn error_with(kernel: &Broken, control: Control) -> Option<SolveError> {
    let heights = heights(32);
    ContactProblem::new(&heights, control).with_kernel(kernel).solve(&SolveParams::default(), &Silent).err()
}

#[test]
fn a_faulty_half_space_is_refused_before_the_solve() {
    for eigenvalue in [f64::NAN, f64::INFINITY, 0.0, -0.1, 0.1] {
        let error = error_with(&Broken::new(eigenvalue, 0), Control::MeanPressure(1e-4));
        let is_named = matches!(&error, Some(SolveError::Problem(ProblemError::Symbol { kernel: "broken", .. })));
        assert!(is_named, "{eigenvalue}: {error:?}");
    }
    let error = error_with(&Broken::new(0.1, 1), Control::MeanPressure(1e-4)).expect("not the same when asked again");
    let text = "the symbol of the kernel broken at the wave (1, 2) of 32 x 32 elements is 0.1; it must be the same each time it is evaluated";
    assert_eq!(error.to_string(), text);
}

#[test]
fn a_half_space_that_answers_nan_later_is_an_error_and_no_contact() {
    let heights = heights(32);
    let depth = heights.max() - heights.mean();
    for eigenvalue in [f64::NAN, f64::INFINITY] {
        for control in [Control::MeanPressure(1e-4), Control::MeanPressure(10.0), Control::Penetration(0.3 * depth)] {
            // The check at the start asks for the symbol twice.
            let error = error_with(&Broken::new(eigenvalue, 2), control);
            assert!(matches!(error, Some(SolveError::NotConverged { .. })), "{eigenvalue}, {control:?}: {error:?}");
        }
    }
}

/// Multiplies all values by `factor`.
fn scale(values: &mut [f64], factor: f64) {
    for value in values {
        *value *= factor;
    }
}

/// Half the load on twice the compliance gives the same contact.
///
/// The problem is linear in the compliance.
#[test]
fn an_own_operator_drives_the_solver() {
    let heights = heights(64);
    // This half-space is twice as compliant.
    let soft = ChangedOperator(UniformOperator::new(heights.grid(), &Love), |v: &mut [f64]| scale(v, 2.0));
    rc_core::testing::check_operator(&soft);
    let params = SolveParams::to_tolerance(1e-8);
    let own = solve_with_operator(&heights, &soft, Control::MeanPressure(5e-4), &params, &Silent).expect("solvable");
    let hard = solve(&heights, Control::MeanPressure(1e-3), &params.by(Method::Uniform)).expect("solvable");
    assert_eq!(own.status(), Status::Converged);
    assert_eq!(own.reason().to_string(), "uniform: the operator is the caller's");
    let range = heights.max() - heights.min();
    assert!((own.info().penetration - hard.info().penetration).abs() < 1e-7 * range);
    let worst = own.pressure().values().iter().zip(hard.pressure().values()).map(|(a, b)| (2.0 * a - b).abs());
    assert!(worst.fold(0.0, f64::max) < 1e-4 * hard.pressure().max());
    assert!((2.0 * own.stiffness() / hard.stiffness() - 1.0).abs() < 5e-3);
    let (v, owned) = (own.displacement().clone(), own.into_owned());
    assert_eq!(owned.displacement(), &v, "an owned solution keeps its displacement");
    let small = Field::zeros(Grid::square(8).expect("grid"));
    let refused = solve_with_operator(&small, &soft, Control::MeanPressure(1e-3), &params, &Silent);
    assert!(matches!(refused, Err(SolveError::Problem(ProblemError::Operator { .. }))));
}

#[test]
fn an_operator_of_no_half_space_is_refused_before_the_solve() {
    let heights = heights(64);
    let refused = |part: f64| {
        // The elements of the first half have larger displacements.
        let lopsided = |v: &mut [f64]| {
            let (half, n) = (v.len() / 2, v.len() as f64);
            scale(&mut v[..half], 1.0 + part);
            let mean = v.iter().sum::<f64>() / n;
            for value in v {
                *value -= mean;
            }
        };
        let operator = ChangedOperator(UniformOperator::new(heights.grid(), &Love), lopsided);
        let load = Control::MeanPressure(1e-3);
        solve_with_operator(&heights, &operator, load, &SolveParams::default(), &Silent).err()
    };
    for part in [1e-3, 0.1, 10.0] {
        let fault = refused(part);
        let is_named =
            matches!(&fault, Some(SolveError::Problem(ProblemError::NotElastic(OperatorFault::Symmetry { .. }))));
        assert!(is_named, "{part}: {fault:?}");
    }
    assert!(refused(1e-9).is_none(), "far below the tolerance");
}
