//! The paper's procedure against the uniform solver, against Hertz, and against its own sums.

use rc_core::{Field, Grid, Operator};
use rc_kernel::{Love, PeriodicLove};
use rc_solver::{
    ContactElement, Control, Feature, GaussSeidelError, GaussSeidelParams, Method, ProblemError, Solution, SolveError,
    SolveParams, UniformOperator, solve, solve_dense,
};

use crate::bumps;

/// The paper's procedure with these parameters, to `tolerance`.
fn by_the_paper(
    heights: &Field,
    control: Control,
    tolerance: f64,
    gauss_seidel: GaussSeidelParams,
) -> Result<Solution<'_>, SolveError> {
    solve(
        heights,
        control,
        &SolveParams { gauss_seidel, ..SolveParams::to_tolerance(tolerance).by(Method::GaussSeidel) },
    )
}

fn uniform(heights: &Field, control: Control, tolerance: f64) -> Solution<'_> {
    solve(heights, control, &SolveParams::to_tolerance(tolerance).by(Method::Uniform)).expect("solvable")
}

#[test]
fn gauss_seidel_agrees_with_conjugate_gradients_on_the_same_mesh() {
    let heights = bumps(64, 64);
    let params = GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() };
    for control in [Control::Penetration(4e-3), Control::MeanPressure(2e-3)] {
        let (ours, reference) =
            (by_the_paper(&heights, control, 1e-11, params).expect("solvable"), uniform(&heights, control, 1e-12));
        let scale = reference.pressure().max();
        let pairs = ours.pressure().values().iter().zip(reference.pressure().values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-8 * scale, "{control:?}: pressures differ by {:e} of the peak", worst / scale);
    }
}

#[test]
fn dense_elimination_gauss_seidel_and_conjugate_gradients_agree() {
    let heights = bumps(32, 32);
    let control = Control::Penetration(6e-3);
    let exact = solve_dense(&heights, &Love, 6e-3).expect("valid").expect("the contact settles");
    let params = GaussSeidelParams { uniform_elements: true, ..GaussSeidelParams::paper() };
    let by_sweeps = by_the_paper(&heights, control, 1e-11, params).expect("solvable");
    let by_gradients = uniform(&heights, control, 1e-12);
    let scale = exact.max();
    assert!(exact.values().iter().filter(|&&p| p > 0.0).count() > 50, "a contact of many elements");
    for (name, solution) in [("Gauss-Seidel", by_sweeps), ("conjugate gradients", by_gradients)] {
        let pairs = solution.pressure().values().iter().zip(exact.values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-8 * scale, "{name} differs by {:e} of the peak", worst / scale);
    }
}

#[test]
fn displacement_by_fft_is_the_direct_sum() {
    let heights = bumps(64, 64);
    let solution =
        by_the_paper(&heights, Control::Penetration(6e-3), 1e-6, GaussSeidelParams::paper()).expect("solvable");
    let elements: Vec<ContactElement> = solution.elements().expect("a mesh").collect();
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for element in &elements {
        (least, most) = (least.min(element.side), most.max(element.side));
    }
    assert!(least < most, "several sizes: {least} to {most}");
    let mut by_fft = vec![0.0; 64 * 64];
    UniformOperator::new(heights.grid(), &Love).apply(solution.pressure().values(), &mut by_fft, &mut []);
    let periodic = PeriodicLove::new();
    for i in (0..64 * 64).step_by(131) {
        let at = heights.grid().centre(i % 64, i / 64);
        let influence = |e: &ContactElement| periodic.coefficient(at - e.centre, 0.5 * e.side) * e.pressure;
        let sum: f64 = elements.iter().map(influence).sum();
        assert!((sum - by_fft[i]).abs() <= 1e-12 * heights.max(), "at {i}: {sum:e} against {:e}", by_fft[i]);
    }
}

#[test]
fn adaptive_mesh_matches_the_uniform_solution_with_the_same_smallest_element() {
    let heights = bumps(128, 128);
    for control in [Control::Penetration(7e-3), Control::MeanPressure(1.5e-2)] {
        let (ours, reference) = (
            by_the_paper(&heights, control, 1e-6, GaussSeidelParams::paper()).expect("solvable"),
            uniform(&heights, control, 1e-8),
        );
        let (a, b) = (ours.observables(), reference.observables());
        let elements = ours.n_elements() as f64;
        assert!(elements < 0.8 * a.area.cells * 128.0 * 128.0, "{elements} elements save something");
        for (what, value, wanted) in [
            ("area", a.area.cells, b.area.cells),
            ("load", ours.info().mean_pressure, reference.info().mean_pressure),
            ("penetration", ours.info().penetration, reference.info().penetration),
        ] {
            assert!((value / wanted - 1.0).abs() <= 0.01, "{control:?}: {what} {value:e}, uniform {wanted:e}");
        }
    }
}

#[test]
fn tables_and_fresh_coefficients_give_the_same_result_and_so_does_any_number_of_threads() {
    let heights = bumps(32, 32);
    let run = |memory_budget: usize, threads: usize| {
        let params = GaussSeidelParams { memory_budget, ..GaussSeidelParams::paper() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("thread pool");
        pool.install(|| {
            let solution = by_the_paper(&heights, Control::Penetration(5e-3), 1e-6, params).expect("solvable");
            (solution.pressure().clone(), solution.gap().clone(), solution.info().clone())
        })
    };
    let reference = run(1 << 30, 1);
    for (budget, threads) in [(1 << 30, 2), (1 << 30, 3), (0, 2), (10_000, 2)] {
        assert!(run(budget, threads) == reference, "budget {budget}, {threads} threads differ");
    }
}

#[test]
fn what_cannot_be_done_is_refused_before_any_work() {
    let heights = bumps(64, 64);
    let refuse = |params, control| by_the_paper(&heights, control, 1e-6, params).expect_err("refused");
    let paper = GaussSeidelParams::paper();
    let small = refuse(GaussSeidelParams { sweep_budget: 1000, ..paper }, Control::Penetration(4e-3));
    assert!(
        matches!(small, SolveError::GaussSeidel(GaussSeidelError::Budget { elements, .. }) if elements > 30),
        "{small}"
    );
    for relaxation in [0.0, 2.0, f64::NAN] {
        let error = refuse(GaussSeidelParams { relaxation, ..paper }, Control::Penetration(4e-3));
        assert!(matches!(error, SolveError::GaussSeidel(GaussSeidelError::Parameter { .. })), "{error}");
    }
    let deep = refuse(paper, Control::Penetration(1.0));
    assert!(matches!(deep, SolveError::Problem(ProblemError::Penetration { .. })), "{deep}");
    let rectangles = Field::zeros(Grid::new(8, 16).expect("grid"));
    let error = by_the_paper(&rectangles, Control::MeanPressure(1.0), 1e-6, paper).expect_err("rectangles");
    assert!(matches!(&error, SolveError::Unsupported(refusal) if refusal.object == Feature::OblongGrid), "{error}");
}

#[test]
fn too_few_sweeps_are_an_error_that_carries_the_residuals() {
    let heights = bumps(64, 64);
    let params = GaussSeidelParams { max_sweeps: 1, max_checks: 1, ..GaussSeidelParams::paper() };
    let error = by_the_paper(&heights, Control::Penetration(4e-3), 1e-6, params).expect_err("not converged");
    let SolveError::NotConverged { certificate, .. } = error else { panic!("{error}") };
    assert!(certificate.penetration > 1e-6, "{certificate}");
}
