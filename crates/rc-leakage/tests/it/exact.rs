//! Flows with closed forms.

use std::f64::consts::TAU;

use rc_core::{Field, Grid};
use rc_leakage::{Axis, LeakageParams, leakage};

fn permeances(gap: &Field) -> [f64; 2] {
    leakage(gap, &LeakageParams::default()).expect("a flow").flows.map(|flow| flow.permeance)
}

/// Fails unless `value` is `exact` within rounding and the error of a solve to 1e-10.
fn check(value: f64, exact: f64, what: &str) {
    assert!((value / exact - 1.0).abs() < 1e-9, "{what}: {value} for {exact}");
}

#[test]
fn between_parallel_plates_the_permeance_is_g_cubed_times_width_over_length() {
    for (nx, ny, ratio) in [(8, 8, 1.0), (48, 20, 0.5), (1, 1, 3.0), (1, 700, 1.0), (33, 7, 100.0)] {
        let gap = Field::from_fn(Grid::in_cell(nx, ny, ratio).expect("a grid"), |_| 0.02);
        let [x, y] = permeances(&gap);
        check(x, 8e-6 * ratio, &format!("along x, {nx} x {ny}"));
        check(y, 8e-6 / ratio, &format!("along y, {nx} x {ny}"));
    }
}

#[test]
fn a_channel_with_a_step_adds_resistances_and_channels_side_by_side_add_conductances() {
    let grid = Grid::in_cell(64, 32, 2.0).expect("a grid");
    let step = Field::from_fn(grid, |at| if at.x < 0.25 { 0.01 } else { 0.03 });
    let [along, across] = permeances(&step);
    check(along, 2.0 / (0.25 / 0.01_f64.powi(3) + 0.75 / 0.03_f64.powi(3)), "in series");
    check(across, 0.125 * 0.01_f64.powi(3) + 0.375 * 0.03_f64.powi(3), "side by side");
    // A step inside a channel between walls.
    let channel = Field::from_fn(grid, |at| match (at.y < 0.5, at.x < 0.5) {
        (true, true) => 0.01,
        (true, false) => 0.02,
        (false, _) => 0.0,
    });
    check(permeances(&channel)[0], 0.5 / (0.5 / 1e-6 + 0.5 / 8e-6), "a step between walls");
}

/// A gap that is its own dual has the permeance K = 1.
///
/// By Keller's theorem (J. Math. Phys. 5, 1964) K_x of g³ times K_y of 1/g³ is 1. A shift of this gap by half a cell
/// along both axes turns g³ into 1/g³, and exchanging x and y does not change it. So K = 1, as in effective medium
/// theory. The network has the same symmetry.
#[test]
fn a_medium_that_is_its_own_dual_has_the_geometric_mean() {
    for n in [32, 64, 128] {
        let gap = Field::from_fn(Grid::square(n).expect("a grid"), |at| {
            (0.7 * ((TAU * at.x).cos() + (TAU * at.y).cos())).exp()
        });
        let [x, y] = permeances(&gap);
        check(x, 1.0, "along x");
        check(y, 1.0, "along y");
    }
}

#[test]
fn the_error_bar_holds_the_error_of_the_grid_and_halves_at_least_with_the_element() {
    let solved = |n: usize| {
        // The contact is round islands, which are not along the lines of any grid.
        let gap = Field::from_fn(Grid::square(n).expect("a grid"), |at| {
            let island = |x: f64, y: f64, r: f64| ((at.x - x).hypot(at.y - y) - r).max(0.0);
            island(0.31, 0.47, 0.173).min(island(0.74, 0.22, 0.131)).powf(1.5)
        });
        leakage(&gap, &LeakageParams::default()).expect("a flow").flows[0]
    };
    let exact = solved(1024).permeance;
    let mut bar_before = f64::INFINITY;
    for n in [64, 128, 256] {
        let flow = solved(n);
        let (error, bar) = ((flow.permeance - exact).abs(), flow.permeance_error.expect("even sides"));
        assert!(error <= bar && bar <= 0.5 * bar_before, "{n}: {error:e} with a bar of {bar:e} after {bar_before:e}");
        bar_before = bar;
    }
    assert!(bar_before < 0.02 * exact, "{bar_before:e} of {exact:e}");
}

#[test]
fn the_critical_constriction_is_the_saddle_of_the_gap() {
    // Walls have two openings, at x = 0.5 and x = 0.75. The narrowest place of the wider one decides.
    let gap = Field::from_fn(Grid::square(64).expect("a grid"), |at| {
        let opening = |centre: f64, gap: f64| if (at.x - centre).abs() < 0.05 { gap + at.y } else { 0.0 };
        if at.y > 0.4 && at.y < 0.6 { opening(0.5, 0.1).max(opening(0.75, 0.2)) } else { 10.0 }
    });
    let leakage = leakage(&gap, &LeakageParams::default()).expect("a flow");
    let along_y = leakage.flows[Axis::Y.index()].constriction.expect("it percolates");
    assert!((along_y.gap - 0.2 - along_y.at.y).abs() < 1e-12 && (along_y.at.y - 0.4).abs() < 1.0 / 64.0, "{along_y:?}");
    assert!((along_y.at.x - 0.75).abs() < 0.05, "{along_y:?}");
    let along_x = leakage.flows[Axis::X.index()].constriction.expect("it percolates");
    assert!((along_x.gap - 10.0).abs() < 1e-12, "{along_x:?}");
}
