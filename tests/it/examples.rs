//! The examples run, and their results are right.

use std::f64::consts::TAU;

use rc_core::testing::{check_height_field, check_kernel};
use rc_core::{Field, Grid, HeightField as _, Kernel as _};
use rc_solver::Control;

use crate::{assert_close, solved};

#[path = "../examples/generate_and_solve.rs"]
mod generate_and_solve;
#[path = "../examples/height_map.rs"]
mod height_map;
#[path = "../examples/load_curve.rs"]
mod load_curve;
#[path = "../examples/own_kernel.rs"]
pub(crate) mod own_kernel;
#[path = "../examples/own_surface.rs"]
pub(crate) mod own_surface;

#[test]
fn every_example_runs() {
    let examples = [generate_and_solve::main, height_map::main, load_curve::main, own_kernel::main, own_surface::main];
    for example in examples {
        example().expect("an example ends well");
    }
}

/// With half the waves, the area is larger than the paper's A/A0 = 0.0673 for N = 64.
///
/// Fewer waves have smaller slopes.
#[test]
fn the_first_example_solves_a_surface_like_the_papers() {
    let solution = generate_and_solve::solve().expect("solvable");
    let area = solution.observables().area;
    assert!((0.07..0.09).contains(&area.fraction), "A/A0 = {}", area.fraction);
    assert!(solution.info().certificate.energy <= 1e-2 && solution.info().certificate.load <= 1e-10);
}

/// The map in pascals gives the same numbers as in units of E*.
///
/// p = 1e6 Pa at E* = 1e9 Pa is σ0/E* = 1e-3.
#[test]
fn the_height_map_carries_its_load() {
    let solution = height_map::solve().expect("solvable");
    assert_close("mean pressure", solution.info().mean_pressure, 1e-3, 1e-10);
    assert_eq!(solution.grid(), Grid::square(512).expect("a grid"), "mirrored once");
}

/// κ is about 2 at low loads and falls towards full contact.
///
/// Theories give 1.6 (Persson) and 2.5 (Bush).
#[test]
fn the_load_curve_is_nearly_straight_at_low_loads_and_rises() {
    let (points, slope) = load_curve::curve().expect("solvable");
    assert!(points.windows(2).all(|pair| (0..3).all(|i| pair[0][i] < pair[1][i])), "{points:?}");
    // The area of contacts of a few elements is uncertain, so the first two loads are left out.
    let kappa: Vec<f64> = points[2..].iter().map(|[load, area, _]| area * slope / load).collect();
    assert!(kappa.iter().all(|kappa| (1.0..3.0).contains(kappa)), "{kappa:?}");
}

#[test]
fn the_bonded_layer_is_a_half_space_for_short_waves_and_springs_for_long_ones() {
    let poisson: f64 = 0.3;
    let layer = own_kernel::BondedLayer { thickness: 0.1, poisson };
    check_kernel(&layer);
    assert_close("M at ξ = 20", layer.factor(20.0), 1.0, 1e-12);
    assert_close("M far beyond overflow", layer.factor(1e4), 1.0, 1e-15);
    // The compliance of a confined column is d (1+ν)(1-2ν) / (E (1-ν)). With E* = 1, 1/E is 1/(1-ν²).
    let thin = own_kernel::BondedLayer { thickness: 1e-4, poisson };
    let young = 1.0 - poisson * poisson;
    let spring = thin.thickness * (1.0 + poisson) * (1.0 - 2.0 * poisson) / (young * (1.0 - poisson));
    let symbol = thin.symbol(Grid::square(16).expect("a grid"));
    assert_close("long waves", symbol(1, 0), spring, 1e-5);
    // The layer is incompressible: M vanishes faster, as 2ξ³/3·…, but stays positive.
    let rubber = own_kernel::BondedLayer { thickness: 0.01, poisson: 0.5 };
    check_kernel(&rubber);
}

/// On springs the pressure is the overlap divided by the compliance.
///
/// A wave that is in contact everywhere keeps its shape.
#[test]
fn a_wave_on_a_thin_layer_is_pressed_as_on_springs() {
    let thin = own_kernel::BondedLayer { thickness: 1e-3, poisson: 0.3 };
    let grid = Grid::square(64).expect("a grid");
    let amplitude = 1e-4;
    let heights = Field::from_fn(grid, |at| amplitude * (TAU * at.x).cos());
    let compliance = thin.symbol(grid)(1, 0);
    let control = Control::MeanPressure(2.0 * amplitude / compliance);
    let solution = solved(&heights, &thin, control, 1e-6);
    let swing = solution.pressure().max() - solution.pressure().mean();
    let highest = (TAU * 0.5 / 64.0).cos();
    assert_close("swing of the pressure", swing, amplitude * highest / compliance, 1e-9);
}

#[test]
fn the_own_surface_is_solved() {
    check_height_field(&own_surface::Weierstrass::default());
    let solution = own_surface::solve().expect("solvable");
    assert_close("mean pressure", solution.info().mean_pressure, 1e-3, 1e-10);
    let heights = own_surface::Weierstrass::default().sample(solution.grid());
    let full = heights.max() - heights.mean();
    assert_close("penetration of full contact", solution.info().penetration_full_contact, full, 1e-12);
}
