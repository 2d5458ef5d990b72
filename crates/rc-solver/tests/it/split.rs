//! Kernels of forks that hand over a split by scale.

use std::f64::consts::{PI, TAU};

use rc_core::{EdgeBias, Event, Field, Grid, Kernel, Observer, Silent, SplitByScale, Symbol};
use rc_kernel::{FreeLove, HalfSpace, Love, Spectral};
use rc_solver::{AdaptiveError, ContactProblem, Control, Feature, Method, MethodReason, ProblemError};
use rc_solver::{Solution, SolveError, SolveParams};

use crate::bumps;

const LOAD: Control = Control::MeanPressure(5e-4);

/// A kernel of a fork: one of rc-kernel, with another factor, split or shift of edges.
struct Fork<'a> {
    own: &'a dyn Kernel,
    factor: f64,
    split: Option<&'a dyn SplitByScale>,
    /// The shift of edges, if it is not that of the original.
    bias: Option<EdgeBias>,
}

impl<'a> Fork<'a> {
    fn of(own: &'a dyn Kernel) -> Self {
        Self { own, factor: 1.0, split: own.split(), bias: None }
    }
}

impl Kernel for Fork<'_> {
    fn name(&self) -> &'static str {
        "fork"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let own = self.own.symbol(grid);
        Box::new(move |kx, ky| self.factor * own(kx, ky))
    }

    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let own = self.own.free_response(grid)?;
        Some(Box::new(move |ix, iy| self.factor * own(ix, iy)))
    }

    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        self.bias.unwrap_or_else(|| self.own.edge_bias(grid))
    }

    fn split(&self) -> Option<&dyn SplitByScale> {
        self.split
    }
}

/// A half-space whose long waves are softer, by a deviation of `size` exp(-(q `length`)²/2), in λ/E*.
#[derive(Clone, Copy)]
struct Soft {
    size: f64,
    length: f64,
    /// Factor of the bound of the curvature.
    bound: f64,
}

const SOFT: Soft = Soft { size: 0.05, length: 0.07, bound: 1.0 };

impl SplitByScale for Soft {
    fn deviation(&self, q: f64) -> f64 {
        self.size * (-0.5 * (q * self.length).powi(2)).exp()
    }

    fn deviates_below(&self, tolerance: f64) -> f64 {
        let first = self.length.recip();
        let all = std::iter::successors(Some(first), |q| Some(1.01 * q));
        all.into_iter().find(|&q| 0.5 * q * self.deviation(q) <= tolerance).expect("the deviation decreases")
    }

    fn curvature(&self) -> f64 {
        // The mean of |x² - 1| over the normal distribution is 4 exp(-1/2)/√(2π).
        self.bound * self.size / self.length.powi(2) * 4.0 * (-0.5_f64).exp() / TAU.sqrt()
    }
}

impl Kernel for Soft {
    fn name(&self) -> &'static str {
        "soft"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let love = Love.symbol(grid);
        let mean =
            |k: usize, n: usize| if k == 0 { 1.0 } else { (PI * k as f64 / n as f64).sin() * n as f64 / k as f64 / PI };
        Box::new(move |kx, ky| match grid.waves(kx, ky) {
            0.0 => 0.0,
            waves => love(kx, ky) + self.deviation(TAU * waves) * mean(kx, grid.nx()) * mean(ky, grid.ny()),
        })
    }

    fn split(&self) -> Option<&dyn SplitByScale> {
        Some(self)
    }
}

fn solve<'a>(heights: &'a Field, kernel: &'a dyn Kernel, method: Option<Method>) -> Result<Solution<'a>, SolveError> {
    let params = SolveParams { method, ..SolveParams::default() };
    ContactProblem::new(heights, LOAD).with_kernel(kernel).solve(&params, &Silent)
}

fn refused(kernel: &dyn Kernel, method: Option<Method>) -> String {
    match solve(&bumps(256, 256), kernel, method) {
        Err(error @ SolveError::Problem(ProblemError::Split { .. })) => error.to_string(),
        other => panic!("{} by {method:?}: {other:?}", kernel.name()),
    }
}

#[test]
fn a_split_of_another_solid_is_refused() {
    let scaled = Fork { factor: 1.3, ..Fork::of(&Love) };
    let free = Fork { factor: 1.3, ..Fork::of(&FreeLove) };
    let spectral = Fork { split: Some(&HalfSpace), ..Fork::of(&Spectral) };
    let other = Soft { size: 1.001 * SOFT.size, ..SOFT };
    let deviating = Fork { split: Some(&other), ..Fork::of(&SOFT) };
    let silent = Fork { split: Some(&HalfSpace), ..Fork::of(&SOFT) };
    for kernel in [&scaled, &free, &spectral, &deviating, &silent] {
        for method in [None, Some(Method::Adaptive)] {
            let text = refused(kernel, method);
            assert!(
                text.contains("the split of the kernel fork gives the ") && text.contains("kernel's own"),
                "{text}"
            );
        }
    }
    refused(&scaled, Some(Method::GaussSeidel));
    let own = Love.symbol(Grid::square(256).expect("grid"))(1, 0);
    let text = refused(&scaled, None);
    let wanted = format!(
        "the split of the kernel fork gives the symbol {own} at (1, 0) of 256 x 256 elements; it must be {}, as the kernel's own",
        1.3 * own
    );
    assert_eq!(text, wanted);
    // The uniform method uses the symbol, and not the split.
    let heights = bumps(256, 256);
    solve(&heights, &scaled, Some(Method::Uniform)).expect("solvable");
}

#[test]
fn bounds_that_do_not_hold_are_refused() {
    // No pressure between 0 and 1 exceeds half of the integral, since the integral without the magnitude is zero.
    solve(&bumps(256, 256), &Soft { bound: 0.5, ..SOFT }, Some(Method::Adaptive)).expect("solvable");
    let text = refused(&Soft { bound: 0.3, ..SOFT }, None);
    assert!(text.contains("the curvature") && text.ends_with("or more"), "{text}");
    let text = refused(&Soft { bound: f64::NAN, ..SOFT }, Some(Method::Adaptive));
    assert!(text.contains("the curvature NaN"), "{text}");
}

/// The kernel and its split are those of Love under another name, so all digits are the same.
#[test]
fn a_kernel_of_a_fork_has_the_digits_of_its_original() {
    let (heights, adaptive) = (bumps(256, 256), Some(Method::Adaptive));
    for own in [&Love as &dyn Kernel, &FreeLove] {
        let fork = Fork::of(own);
        let (expected, found) = (solve(&heights, own, adaptive), solve(&heights, &fork, adaptive));
        let (expected, found) = (expected.expect("solvable"), found.expect("solvable"));
        assert_eq!((found.method(), found.kernel()), (Method::Adaptive, "fork"));
        assert_eq!((found.info(), found.observables()), (expected.info(), expected.observables()));
        assert_eq!((found.pressure(), found.gap()), (expected.pressure(), expected.gap()));
        assert_eq!(found.stiffness().to_bits(), expected.stiffness().to_bits());
        // The shift of edges is that of the kernel.
        let bias = EdgeBias { per_edge: 0.1, ..own.edge_bias(heights.grid()) };
        let shifted = Fork { bias: Some(bias), ..fork };
        let shifted = solve(&heights, &shifted, adaptive).expect("solvable");
        assert_eq!(shifted.pressure(), expected.pressure());
        assert!(shifted.area().fraction < expected.area().fraction);
    }
}

/// Both methods certify a relative overlap of 1e-8. Pressures then agree to the root of it.
#[test]
fn the_adaptive_method_solves_the_solid_of_the_split() {
    let heights = bumps(256, 256);
    let solve = |kernel: &'static dyn Kernel, method| {
        let params = SolveParams::to_tolerance(1e-8).by(method);
        ContactProblem::new(&heights, LOAD).with_kernel(kernel).solve(&params, &Silent).expect("solvable")
    };
    let (found, uniform) = (solve(&SOFT, Method::Adaptive), solve(&SOFT, Method::Uniform));
    let differs = |a: &Solution<'_>, b: &Solution<'_>| {
        let differences = a.pressure().values().iter().zip(b.pressure().values()).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max) / b.pressure().max()
    };
    let difference = differs(&found, &uniform);
    assert!(difference < 1e-4, "pressures differ by {difference:e} of the maximum");
    let penetrations = [&found, &uniform].map(|solution| solution.info().penetration);
    assert!((penetrations[0] / penetrations[1] - 1.0).abs() < 1e-6, "{penetrations:?}");
    assert!((found.stiffness() / uniform.stiffness() - 1.0).abs() < 5e-3);
    assert!(differs(&found, &solve(&Love, Method::Adaptive)) > 1e-2, "the deviation changes the contact");
}

#[test]
fn a_deviation_that_the_base_grid_does_not_resolve_is_solved_on_the_uniform_grid() {
    let (heights, short) = (bumps(256, 256), Soft { length: 0.02, ..SOFT });
    let solution = solve(&heights, &short, None).expect("solvable");
    assert_eq!(solution.reason(), &MethodReason::DeviationNotResolved { kernel: "soft" });
    let error = solve(&heights, &short, Some(Method::Adaptive)).err();
    // A base grid of 64 elements would be the usual one. The next finer one does not resolve it either.
    let resolved = 0.6 * PI * 128.0;
    assert!(
        matches!(error, Some(SolveError::Adaptive(AdaptiveError::Deviation { kernel: "soft", resolved: found, .. })) if (found / resolved - 1.0).abs() < 1e-9),
        "{error:?}"
    );
    // The paper's procedure has the coefficients of the half-space only.
    let error = solve(&bumps(32, 32), &SOFT, Some(Method::GaussSeidel)).err();
    let refused = matches!(&error, Some(SolveError::Unsupported(refusal)) if refusal.object == Feature::OtherSolid);
    assert!(refused, "{error:?}");
}

/// Ends a solve at once.
struct Stop;

impl Observer for Stop {
    fn notify(&self, _event: &Event) {}

    fn should_stop(&self) -> bool {
        true
    }
}

/// The fork makes no copy of itself, so its results are computed before the borrow ends. Love's copy gives the same.
#[test]
fn a_solution_that_outlives_its_kernel_keeps_its_results() {
    let heights = bumps(64, 64);
    let flat = Field::zeros(Grid::square(16).expect("grid"));
    for (own, heights) in
        [(&Love as &dyn Kernel, &heights), (&FreeLove, &heights), (&Spectral, &heights), (&Love, &flat)]
    {
        let solve = |kernel: &dyn Kernel, observer: &dyn Observer| {
            let params = SolveParams::default().by(Method::Uniform);
            match ContactProblem::new(heights, LOAD).with_kernel(kernel).solve(&params, observer) {
                Ok(solution) => solution.into_owned(),
                Err(SolveError::NotConverged { solution, .. }) => *solution,
                Err(error) => panic!("{error}"),
            }
        };
        for observer in [&Silent as &dyn Observer, &Stop] {
            let (found, expected) = (solve(&Fork::of(own), observer), solve(own, observer));
            assert_eq!(found.displacement(), expected.displacement());
            assert_eq!(found.stiffness().to_bits(), expected.stiffness().to_bits());
            assert_eq!(found.observables(), expected.observables());
        }
    }
}
