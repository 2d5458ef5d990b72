//! What a research fork does: its own half-space and its own surface, through the traits alone.

use std::f64::consts::TAU;

use rc_core::testing::{check_height_field, check_kernel};
use rc_core::{EdgeBias, Grid, HeightField, Kernel, Silent, Symbol};
use rc_kernel::Love;
use rc_solver::{Control, SolveError, SolveParams, Status, solve_uniform};

/// An elastic layer of thickness `depth` bonded to a rigid base, incompressible limit left aside: the half-space response
/// times a factor that tends to 1 for short waves and to 0 for waves longer than the layer is thick.
struct Layer {
    depth: f64,
}

impl Kernel for Layer {
    fn name(&self) -> &'static str {
        "layer"
    }

    fn symbol(&self, _grid: Grid) -> Symbol<'_> {
        Box::new(|kx, ky| {
            let q = TAU * f64::hypot(kx as f64, ky as f64);
            if q == 0.0 { 0.0 } else { 2.0 / q * (q * self.depth).tanh() }
        })
    }

    fn edge_bias(&self) -> EdgeBias {
        EdgeBias { per_edge: 0.03, per_contact: 0.0, per_bend: 0.0 }
    }
}

/// A Weierstrass-like profile along x.
struct Weierstrass;

impl HeightField for Weierstrass {
    fn height(&self, x: f64, _y: f64) -> f64 {
        (0..5).map(|octave| 1e-3 * 0.4_f64.powi(octave) * (TAU * f64::from(1 << octave) * x).cos()).sum()
    }

    fn band_limit(&self) -> Option<usize> {
        Some(16)
    }
}

#[test]
fn own_surface_and_own_half_space_drive_the_solver() {
    let layer = Layer { depth: 0.05 };
    check_kernel(&layer);
    check_height_field(&Weierstrass);
    let heights = Weierstrass.sample(Grid::square(128).expect("grid"));
    let solve = |kernel: &dyn Kernel| {
        let params = SolveParams::certified();
        solve_uniform(&heights, kernel, Control::MeanPressure(5e-4), &params, &Silent).expect("solvable")
    };
    let (thin, thick) = (solve(&layer), solve(&rc_kernel::Spectral));
    assert_eq!((thin.status, thick.status), (Status::Converged, Status::Converged));
    // A thin layer on a rigid base yields less than a half-space, so the same load penetrates less.
    let (a, b) = (thin.info.penetration, thick.info.penetration);
    assert!(a < 0.9 * b, "layer {a:e}, half-space {b:e}");
    // The profile does not vary along y, so neither does the pressure.
    for iy in 1..128 {
        let worst = (0..128).map(|ix| (thin.pressure.at(ix, iy) - thin.pressure.at(ix, 0)).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-3 * thin.pressure.max(), "row {iy} differs by {worst:e}");
    }
}

/// Love's squares, but for one wave.
struct Broken {
    eigenvalue: f64,
}

impl Kernel for Broken {
    fn name(&self) -> &'static str {
        "broken"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let love = Love.symbol(grid);
        Box::new(move |kx, ky| if (kx, ky) == (1, 2) { self.eigenvalue } else { love(kx, ky) })
    }

    fn edge_bias(&self) -> EdgeBias {
        Love.edge_bias()
    }
}

#[test]
fn a_half_space_that_answers_nan_is_an_error_and_no_contact() {
    let heights = Weierstrass.sample(Grid::square(32).expect("grid"));
    let depth = heights.max() - heights.mean();
    for eigenvalue in [f64::NAN, f64::INFINITY] {
        let kernel = Broken { eigenvalue };
        for control in [Control::MeanPressure(1e-4), Control::MeanPressure(10.0), Control::Penetration(0.3 * depth)] {
            let solved = solve_uniform(&heights, &kernel, control, &SolveParams::certified(), &Silent);
            let error = solved.err().map(|error| matches!(error, SolveError::NotConverged { .. }));
            assert_eq!(error, Some(true), "{eigenvalue}, {control:?}");
        }
    }
}
