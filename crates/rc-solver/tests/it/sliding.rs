//! Contact under a sliding surface by the adaptive method, against the uniform one.

use rc_core::{DVec2, Field, Silent};
use rc_kernel::{Love, Relaxation, Viscoelastic};
use rc_solver::{ContactProblem, Control, Friction, Method, Solution, SolveParams};

use crate::bumps;

const SIDE: usize = 256;

fn rubber() -> Relaxation {
    Relaxation::prony(&[[4.0, 0.02], [5.0, 0.5]]).expect("a material")
}

fn solve(heights: &Field, velocity: f64, hardness: f64, method: Option<Method>) -> Solution<'static> {
    let kernel = Viscoelastic::new(Love, &rubber(), velocity * DVec2::X);
    let params = SolveParams { method, ..SolveParams::to_tolerance(1e-8) };
    let problem = ContactProblem::new(heights, Control::MeanPressure(2e-3)).with_kernel(&kernel);
    problem.with_hardness(hardness).solve(&params, &Silent).expect("a solution").into_owned()
}

fn friction(solution: &Solution<'_>) -> Friction {
    solution.info().friction.expect("it slides")
}

#[test]
fn the_adaptive_method_agrees_with_the_uniform_one() {
    let heights = bumps(SIDE, SIDE);
    for (velocity, hardness) in [(0.1, f64::INFINITY), (-3.0, f64::INFINITY), (0.1, 0.03)] {
        let tiles = solve(&heights, velocity, hardness, Some(Method::Adaptive));
        let grid = solve(&heights, velocity, hardness, Some(Method::Uniform));
        assert_eq!((tiles.method(), grid.method()), (Method::Adaptive, Method::Uniform));
        let (found, expected) = (friction(&tiles), friction(&grid));
        let near = |found: f64, expected: f64, error: f64| (found - expected).abs() < error * expected.abs();
        assert!(near(found.coefficient, expected.coefficient, 1e-5), "{velocity}: {found:?} for {expected:?}");
        assert!(found.coefficient > 0.0 && near(found.of_displacement, found.coefficient, 0.02), "{found:?}");
        let [penetration, others] = [&tiles, &grid].map(|solution| solution.info().penetration);
        assert!(near(penetration, others, 1e-4), "{velocity}: {penetration} for {others}");
        let [rms, other] = [&tiles, &grid].map(|solution| solution.pressure().rms());
        assert!(near(rms, other, 1e-4), "{velocity}: {rms} for {other}");
        if hardness.is_infinite() {
            assert!(near(tiles.stiffness(), grid.stiffness(), 2e-3));
        }
        // The gap of the whole cell is computed when it is asked for.
        let difference = tiles.gap().values().iter().zip(grid.gap().values()).map(|(a, b)| (a - b).abs());
        assert!(difference.fold(0.0, f64::max) < 1e-3 * (heights.max() - heights.min()));
    }
}

#[test]
fn sliding_the_other_way_over_the_mirrored_surface_is_the_same() {
    let heights = bumps(SIDE, SIDE);
    let mirrored = heights.values().chunks(SIDE).flat_map(|row| row.iter().rev().copied()).collect();
    let mirrored = Field::new(heights.grid(), mirrored).expect("a value for each element");
    let [one, other] = [(&heights, 0.1), (&mirrored, -0.1)]
        .map(|(heights, velocity)| friction(&solve(heights, velocity, f64::INFINITY, Some(Method::Adaptive))));
    assert!((one.coefficient / other.coefficient - 1.0).abs() < 1e-6, "{one:?}, {other:?}");
    assert!((one.lateral + other.lateral).abs() < 1e-6 * one.coefficient, "{one:?}, {other:?}");
}

#[test]
fn digits_do_not_depend_on_the_number_of_threads() {
    let heights = bumps(SIDE, SIDE);
    let with_threads = |n: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
        let solution = pool.install(|| solve(&heights, 0.1, f64::INFINITY, Some(Method::Adaptive)));
        (friction(&solution), solution.pressure().values().to_vec())
    };
    let (one, two) = (with_threads(1), with_threads(3));
    assert!(one == two, "{:?}, {:?}", one.0, two.0);
}

/// A solid that creeps has an increment of the elastic pressure for each time, which must not be negative.
#[test]
fn the_pressure_of_a_growing_contact_rises_everywhere_by_at_least_the_load() {
    let heights = bumps(SIDE, SIDE);
    let solve = |load: f64, method: Method| {
        let params = SolveParams { method: Some(method), ..SolveParams::to_tolerance(1e-8) };
        let problem = ContactProblem::new(&heights, Control::MeanPressure(load));
        problem.solve(&params, &Silent).expect("a solution").into_owned()
    };
    for (load, method) in [(1e-3, Method::Uniform), (1e-3, Method::Adaptive), (8e-3, Method::Uniform)] {
        // A small step hardly changes the contact, so its increment is that of the fixed contact.
        let [before, after] = [load, 1.001 * load].map(|load| solve(load, method));
        let pairs = before.pressure().values().iter().zip(after.pressure().values());
        let rises = pairs.filter(|(before, _)| **before > 0.0).map(|(before, after)| (after - before) / (1e-3 * load));
        let (found, expected) = (before.least_pressure_rise().expect("a kernel"), rises.fold(f64::INFINITY, f64::min));
        assert!(found >= 1.0, "{found}");
        assert!((found / expected - 1.0).abs() < 0.02, "{load} {method:?}: {found} for {expected}");
    }
    let full = solve(1.0, Method::Uniform);
    assert_eq!(full.least_pressure_rise(), Some(1.0));
}
