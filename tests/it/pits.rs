//! Pits, offsets and light loads, which must not loosen a tolerance.

use rc_core::{Field, Grid, HeightField, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams, Tolerance, solve};

/// Side of the maps.
const SIDE: usize = 256;

fn rough(seed: u64) -> Field {
    let surface = Surface::new(&SpectrumParams::paper(16, seed)).expect("a valid spectrum");
    surface.sample(Grid::square(SIDE).expect("a grid"))
}

/// The heights with the deepest element lowered by `depth` rms heights.
fn with_pit(heights: &Field, depth: f64) -> Field {
    let mut heights = heights.clone();
    let (rms, least) = (heights.rms(), heights.min());
    let deepest = heights.values().iter().position(|&h| h <= least).expect("a least height");
    heights.values_mut()[deepest] -= depth * rms;
    heights
}

/// A paraboloid, and Hertz's load for a contact radius in elements.
///
/// The apex is beside the middle of an element.
fn sphere(elements: f64) -> (Field, Control) {
    let (n, radius) = (64.0, 50.0);
    let heights = Field::from_fn(Grid::square(64).expect("a grid"), |at| {
        -((at.x - 0.5 - 0.3 / n).powi(2) + (at.y - 0.5 + 0.2 / n).powi(2)) / (2.0 * radius)
    });
    (heights, Control::MeanPressure(4.0 / 3.0 * (elements / n).powi(3) / radius))
}

fn solved(heights: &Field, control: Control, method: Method, tolerance: Tolerance) -> Solution<'_> {
    let params = SolveParams { tolerance, ..SolveParams::default().by(method) };
    ContactProblem::new(heights, control).solve(&params, &Silent).expect("a solvable scene")
}

/// Fails unless area and rms pressure are within a tenth of their error bars.
///
/// The reference solution is converged a thousand times better.
fn assert_converged(name: &str, heights: &Field, control: Control, method: Method) {
    for tolerance in [Tolerance::DEFAULT, Tolerance::Auto] {
        let solution = solved(heights, control, method, tolerance);
        let exact = solved(heights, control, method, Tolerance::Energy(3e-4));
        let (found, limit) = (solution.observables(), exact.observables());
        let difference = (found.area.fraction - limit.area.fraction).abs();
        let bar = found.area.error;
        assert!(difference < 0.1 * bar, "{name}, {method}, {tolerance:?}: area off by {difference:e}, bar {bar:e}");
        let difference = (found.rms_pressure - limit.rms_pressure).abs();
        let bar = found.rms_pressure_error.expect("a bar");
        assert!(
            difference < 0.1 * bar,
            "{name}, {method}, {tolerance:?}: rms pressure off by {difference:e}, bar {bar:e}"
        );
        let penetration = (solution.info().penetration / exact.info().penetration - 1.0).abs();
        assert!(penetration < 1e-4, "{name}, {method}, {tolerance:?}: penetration off by {penetration:e}");
    }
}

#[test]
fn pits_loosen_no_tolerance() {
    let heights = rough(21);
    let load = Control::MeanPressure(8.9e-4);
    for depth in [0.0, 10.0, 1e3, 1e6] {
        let map = with_pit(&heights, depth);
        let depth_of_load = solve(&map, load, &SolveParams::default()).expect("solvable").info().penetration;
        for method in [Method::Uniform, Method::Adaptive] {
            for control in [load, Control::Penetration(depth_of_load)] {
                assert_converged(&format!("a pit of {depth} rms, {control:?}"), &map, control, method);
            }
        }
    }
}

#[test]
fn pits_cost_no_iterations() {
    let heights = rough(22);
    let iterations = |depth: f64, method: Method| {
        let map = with_pit(&heights, depth);
        let solution = solved(&map, Control::MeanPressure(8.9e-4), method, Tolerance::DEFAULT);
        solution.info().levels.iter().map(|level| level.iterations).sum::<usize>()
    };
    for method in [Method::Uniform, Method::Adaptive] {
        let without = iterations(0.0, method);
        for depth in [1e2, 1e4, 1e6] {
            let with = iterations(depth, method);
            assert!(
                5 * with <= 6 * without,
                "{method}: {with} iterations with a pit of {depth} rms, {without} without"
            );
        }
    }
}

#[test]
fn an_offset_changes_nothing() {
    let heights = rough(23);
    let mut raised = heights.clone();
    let offset = 1e4 * heights.rms();
    for h in raised.values_mut() {
        *h += offset;
    }
    for method in [Method::Uniform, Method::Adaptive] {
        let area = |map: &Field| solved(map, Control::MeanPressure(8.9e-4), method, Tolerance::DEFAULT).area().fraction;
        let change = (area(&raised) / area(&heights) - 1.0).abs();
        assert!(change < 1e-7, "{method}: {change:e}");
    }
}

#[test]
fn contacts_of_three_elements_are_converged() {
    for elements in [3.0, 6.0, 10.0] {
        let (heights, load) = sphere(elements);
        assert_converged(&format!("a contact of {elements} elements"), &heights, load, Method::Uniform);
    }
    for pressure in [1e-7, 1e-6, 1e-5] {
        let heights = rough(24);
        for method in [Method::Uniform, Method::Adaptive] {
            assert_converged(&format!("σ0/E* = {pressure:e}"), &heights, Control::MeanPressure(pressure), method);
        }
    }
}
