//! The paper's procedure against the uniform solver, against Hertz, and against its own sums.

use rc_core::{Field, Grid, Operator, Silent};
use rc_kernel::{Love, PeriodicLove};
use rc_solver::{
    Control, GaussSeidelError, GaussSeidelParams, GridSolution, IterationError, IterationParams, Observables,
    UniformOperator, solve_dense, solve_gauss_seidel, solve_uniform,
};

const TAU: f64 = std::f64::consts::TAU;

/// Bumps of different height, no symmetry.
fn bumps(n: usize) -> Field {
    Field::from_fn(Grid::square(n).expect("grid"), |x, y| {
        let wave = |a: f64, kx: f64, ky: f64, phase: f64| a * (TAU * (kx * x + ky * y + phase)).cos();
        wave(5e-3, 1.0, 0.0, 0.1) + wave(4e-3, 1.0, 2.0, 0.37) + wave(2e-3, 3.0, -2.0, 0.8) + wave(1e-3, -2.0, 5.0, 0.5)
    })
}

fn by_the_paper(
    heights: &Field,
    control: Control,
    params: &GaussSeidelParams,
) -> Result<GridSolution, GaussSeidelError> {
    let periodic = PeriodicLove::new();
    solve_gauss_seidel(heights, &Love, &|dx, dy, d| periodic.coefficient(dx, dy, d), control, params, &Silent)
}

fn uniform(heights: &Field, control: Control, tolerance: f64) -> GridSolution {
    let params = IterationParams { tolerance, ..IterationParams::certified() };
    solve_uniform(heights, &Love, control, &params, &Silent).expect("solvable")
}

#[test]
fn gauss_seidel_agrees_with_conjugate_gradients_on_the_same_mesh() {
    let heights = bumps(64);
    let params = GaussSeidelParams { tolerance: 1e-11, uniform_elements: true, ..GaussSeidelParams::paper() };
    for control in [Control::Penetration(4e-3), Control::MeanPressure(2e-3)] {
        let (ours, reference) =
            (by_the_paper(&heights, control, &params).expect("solvable"), uniform(&heights, control, 1e-12));
        let scale = reference.pressure.max();
        let pairs = ours.pressure.values().iter().zip(reference.pressure.values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-8 * scale, "{control:?}: pressures differ by {:e} of the peak", worst / scale);
    }
}

#[test]
fn dense_elimination_gauss_seidel_and_conjugate_gradients_agree() {
    let heights = bumps(32);
    let control = Control::Penetration(6e-3);
    let exact = solve_dense(&heights, &Love, 6e-3).expect("valid").expect("the contact settles");
    let params = GaussSeidelParams { tolerance: 1e-11, uniform_elements: true, ..GaussSeidelParams::paper() };
    let by_sweeps = by_the_paper(&heights, control, &params).expect("solvable");
    let by_gradients = uniform(&heights, control, 1e-12);
    let scale = exact.max();
    assert!(exact.values().iter().filter(|&&p| p > 0.0).count() > 50, "a contact of many elements");
    for (name, solution) in [("Gauss-Seidel", by_sweeps), ("conjugate gradients", by_gradients)] {
        let pairs = solution.pressure.values().iter().zip(exact.values());
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-8 * scale, "{name} differs by {:e} of the peak", worst / scale);
    }
}

#[test]
fn displacement_by_fft_is_the_direct_sum() {
    let heights = bumps(64);
    let solution = by_the_paper(&heights, Control::Penetration(6e-3), &GaussSeidelParams::paper()).expect("solvable");
    let elements = solution.elements.as_ref().expect("a mesh");
    assert!(
        elements.mesh.counts().iter().filter(|&&n| n > 0).count() > 1,
        "several sizes: {:?}",
        elements.mesh.counts()
    );
    let mut by_fft = vec![0.0; 64 * 64];
    UniformOperator::new(heights.grid(), &Love).apply(solution.pressure.values(), &mut by_fft, &mut []);
    let periodic = PeriodicLove::new();
    for i in (0..64 * 64).step_by(131) {
        let (x, y) = heights.grid().centre(i % 64, i / 64);
        let sources = elements.mesh.elements().zip(&elements.pressure);
        let sum: f64 =
            sources.map(|(e, p)| periodic.coefficient(x - e.centre.x, y - e.centre.y, e.half_side()) * p).sum();
        assert!((sum - by_fft[i]).abs() <= 1e-12 * heights.max(), "at {i}: {sum:e} against {:e}", by_fft[i]);
    }
}

#[test]
fn adaptive_mesh_matches_the_uniform_solution_with_the_same_smallest_element() {
    let heights = bumps(128);
    for control in [Control::Penetration(7e-3), Control::MeanPressure(1.5e-2)] {
        let (ours, reference) = (
            by_the_paper(&heights, control, &GaussSeidelParams::paper()).expect("solvable"),
            uniform(&heights, control, 1e-8),
        );
        let (a, b) = (Observables::of(&ours, &Love), Observables::of(&reference, &Love));
        let elements = ours.elements.as_ref().expect("a mesh").mesh.len() as f64;
        assert!(elements < 0.8 * a.area.cells * 128.0 * 128.0, "{elements} elements save something");
        for (what, value, wanted) in [
            ("area", a.area.cells, b.area.cells),
            ("load", ours.info.mean_pressure, reference.info.mean_pressure),
            ("penetration", ours.info.penetration, reference.info.penetration),
        ] {
            assert!((value / wanted - 1.0).abs() <= 0.01, "{control:?}: {what} {value:e}, uniform {wanted:e}");
        }
    }
}

#[test]
fn tables_and_fresh_coefficients_give_the_same_result_and_so_does_any_number_of_threads() {
    let heights = bumps(32);
    let run = |memory_budget: usize, threads: usize| {
        let params = GaussSeidelParams { memory_budget, ..GaussSeidelParams::paper() };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("thread pool");
        pool.install(|| by_the_paper(&heights, Control::Penetration(5e-3), &params).expect("solvable"))
    };
    let reference = run(1 << 30, 1);
    for (budget, threads) in [(1 << 30, 2), (1 << 30, 3), (0, 2), (10_000, 2)] {
        assert!(run(budget, threads) == reference, "budget {budget}, {threads} threads differ");
    }
}

#[test]
fn what_cannot_be_done_is_refused_before_any_work() {
    let heights = bumps(64);
    let refuse = |params: GaussSeidelParams, control| by_the_paper(&heights, control, &params).expect_err("refused");
    let paper = GaussSeidelParams::paper();
    let small = refuse(GaussSeidelParams { sweep_budget: 1000, ..paper }, Control::Penetration(4e-3));
    assert!(matches!(small, GaussSeidelError::Budget { elements, .. } if elements > 30), "{small}");
    for relaxation in [0.0, 2.0, f64::NAN] {
        let error = refuse(GaussSeidelParams { relaxation, ..paper }, Control::Penetration(4e-3));
        assert!(matches!(error, GaussSeidelError::Parameter { .. }), "{error}");
    }
    let deep = refuse(paper, Control::Penetration(1.0));
    assert!(matches!(deep, GaussSeidelError::Solve(IterationError::Penetration { .. })), "{deep}");
    let rectangles = Field::zeros(Grid::new(8, 16).expect("grid"));
    let error = by_the_paper(&rectangles, Control::MeanPressure(1.0), &paper).expect_err("rectangles");
    assert!(matches!(error, GaussSeidelError::NotSquare { .. }), "{error}");
}

#[test]
fn too_few_sweeps_are_an_error_that_carries_the_residuals() {
    let heights = bumps(64);
    let params = GaussSeidelParams { max_sweeps: 1, max_checks: 1, ..GaussSeidelParams::paper() };
    let error = by_the_paper(&heights, Control::Penetration(4e-3), &params).expect_err("not converged");
    let GaussSeidelError::Solve(IterationError::NotConverged { certificate, .. }) = error else { panic!("{error}") };
    assert!(certificate.penetration > 1e-6, "{certificate}");
}
