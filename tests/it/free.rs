//! Patches with free borders.
//!
//! They are compared with closed forms of the infinite half-space, with direct sums, and with periodic cells of
//! increasing size.

use std::f64::consts::PI;

use rc_core::{Boundary, DVec2, Field, Grid, Kernel as _, Operator as _, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{FreeLove, Love};
use rc_solver::{
    ContactProblem, ContactSpot, Control, DirectSum, Feature, Method, SolveError, SolveParams, Status, UniformOperator,
    solve_dense,
};
use rc_theory::cone::Cone;
use rc_theory::hertz::Hertz;

use crate::{assert_close, solved};

/// Heights of a body of revolution with its apex at `place`.
fn body(n: usize, place: DVec2, height: impl Fn(f64) -> f64 + Sync) -> Field {
    Field::from_fn(Grid::square(n).expect("a grid"), |at| height((at - place).length()))
}

fn rough(n: usize, waves: usize) -> Field {
    let surface = Surface::new(&SpectrumParams::paper(waves, 3)).expect("a surface");
    let waves = surface.sample_on(Grid::square(n).expect("a grid")).expect("heights");
    // The surface is rounded and tilted, so that opposite borders do not fit together.
    let grid = waves.grid();
    let bent = |at: DVec2| 0.01 * at.x - 0.1 * (at - 0.5).length_squared();
    let bent = Field::from_fn(grid, bent);
    let values = waves.values().iter().zip(bent.values()).map(|(a, b)| a + b).collect();
    Field::new(grid, values).expect("a field")
}

/// Load, radius and peak pressure of a sphere are exact to 0.1 % at any place.
#[test]
fn a_sphere_is_that_of_hertz() {
    let sphere = Hertz { radius: 1.0 };
    for (place, radius) in [([0.5, 0.5], 0.2), ([0.3, 0.62], 0.2), ([0.21, 0.79], 0.15)] {
        let heights = body(512, DVec2::from(place), |r| -0.5 * r * r);
        let depth = sphere.penetration(radius);
        // The highest point of the grid may be below the apex by up to (h/2)².
        let below = -heights.max();
        let by_depth = solved(&heights, &FreeLove, Control::Penetration(depth - below), 1e-8);
        assert_close("load", by_depth.info().mean_pressure, sphere.load(radius), 1e-3);
        assert_close("radius", (by_depth.area().fraction / PI).sqrt(), radius, 1e-3);
        assert_close("peak pressure", by_depth.pressure().max(), sphere.peak_pressure(radius), 1e-3);
        let by_load = solved(&heights, &FreeLove, Control::MeanPressure(sphere.load(radius)), 1e-8);
        assert_close("penetration", by_load.info().penetration + below, depth, 1e-3);
        assert_close("stiffness", by_load.stiffness(), 2.0 * radius, 3e-3);
        assert_close("energy", by_load.info().elastic_energy, sphere.energy(radius), 2e-3);
        let gap = by_load.observables().mean_gap;
        assert_close("mean gap", gap, by_load.gap().mean(), 1e-9);
    }
}

#[test]
fn a_cone_is_that_of_sneddon() {
    let cone = Cone { slope: 0.1 };
    let heights = body(512, DVec2::splat(0.5), |r| -0.1 * r);
    let radius = 0.3;
    let below = -heights.max();
    let solution = solved(&heights, &FreeLove, Control::Penetration(cone.penetration(radius) - below), 1e-8);
    assert_close("load", solution.info().mean_pressure, cone.load(radius), 3e-3);
    assert_close("radius", (solution.area().fraction / PI).sqrt(), radius, 3e-3);
}

/// A round punch follows Boussinesq: F = 2aδ and p = δ/(π √(a² - r²)).
///
/// The stiffness of a square punch is 1.1 to 1.2 times its side.
#[test]
fn flat_punches_are_those_of_boussinesq() {
    let radius = 0.4;
    let mut errors = Vec::new();
    for n in [128, 256] {
        let heights = body(n, DVec2::splat(0.5), |r| if r < radius { 0.0 } else { -1.0 });
        let solution = solved(&heights, &FreeLove, Control::Penetration(1e-3), 1e-9);
        errors.push((solution.info().mean_pressure / (2.0 * radius * 1e-3) - 1.0).abs());
        let grid = heights.grid();
        let at = grid.centre(n / 2 + n / 8, n / 2);
        let expected = 1e-3 / (PI * (radius * radius - (at - 0.5).length_squared()).sqrt());
        assert_close("pressure inside", solution.pressure().at(n / 2 + n / 8, n / 2), expected, 5e-3);
    }
    assert!(errors[1] < 5e-3, "{errors:?}");
    // On a flat patch every element carries pressure. Unlike a periodic cell, a patch then has no state of full
    // contact.
    let flat = Field::zeros(Grid::square(256).expect("a grid"));
    let params = SolveParams::default();
    for control in [Control::Penetration(1e-3), Control::MeanPressure(1.15e-3)] {
        let problem = ContactProblem::new(&flat, control).with_kernel(&FreeLove);
        let solution = problem.solve(&params, &Silent).expect("a solution");
        assert_eq!((solution.status(), solution.method()), (Status::Converged, Method::Uniform));
        let info = solution.info();
        // The stiffness is F = 1.1523 E* δ side: π times the capacity of a square, which is 0.3667875 side.
        assert_close("stiffness of a square", info.mean_pressure / info.penetration, 0.366_787_5 * PI, 3e-3);
        assert_close("incremental stiffness", solution.stiffness(), 0.366_787_5 * PI, 5e-3);
        assert_close("area", solution.area().fraction, 1.0, 1e-12);
        assert!(solution.certificate().energy <= 1e-2, "{}", solution.certificate());
    }
}

#[test]
fn the_operator_is_the_direct_sum() {
    for (nx, ny, ratio) in [(12, 12, 1.0), (9, 20, 20.0 / 9.0), (16, 10, 1.0), (1, 7, 1.0), (31, 2, 0.3)] {
        let grid = Grid::in_cell(nx, ny, ratio).expect("a grid");
        let pressure: Vec<f64> = (0..grid.len()).map(rc_core::testing::quasi_random).collect();
        let (mut fast, mut slow) = (vec![0.0; grid.len()], vec![0.0; grid.len()]);
        UniformOperator::new(grid, &FreeLove).apply(&pressure, &mut fast, &mut []);
        DirectSum::new(grid, &FreeLove).apply(&pressure, &mut slow, &mut []);
        for (fast, slow) in fast.iter().zip(&slow) {
            assert!((fast - slow).abs() < 1e-13 * slow.abs(), "{grid}: {fast} for {slow}");
        }
    }
}

#[test]
fn a_dense_solver_finds_the_same_pressure() {
    for (nx, ny) in [(24, 24), (20, 28)] {
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        let heights = Field::from_fn(grid, |at| {
            1e-2 * ((7.0 * at.x).sin() * (9.0 * at.y).cos() + 0.3 * at.x - (at.y - 0.4).powi(2))
        });
        let range = heights.max() - heights.min();
        for depth in [0.2 * range, 0.7 * range, 3.0 * range] {
            let exact = solve_dense(&heights, &FreeLove, depth).expect("valid").expect("a contact that settles");
            let found = solved(&heights, &FreeLove, Control::Penetration(depth), 1e-11);
            let off = found.pressure().values().iter().zip(exact.values()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-6 * exact.max(), "{grid} at {depth}");
            let by_load = solved(&heights, &FreeLove, Control::MeanPressure(found.info().mean_pressure), 1e-11);
            assert_close("penetration", by_load.info().penetration, depth, 1e-7);
        }
    }
}

/// A contact in periodic cells of 2, 4 and 8 patches per side approaches the half-space.
///
/// The effect of the images and of the missing mean falls with the third power.
#[test]
fn a_growing_cell_becomes_the_half_space() {
    let patch = rough(64, 6);
    let load = 2e-3;
    let free = solved(&patch, &FreeLove, Control::MeanPressure(load), 1e-9);
    let mut errors = Vec::new();
    for copies in [2_usize, 4, 8] {
        let n = 64 * copies;
        let grid = Grid::square(n).expect("a grid");
        let low = patch.min() - 1.0;
        let scale = 1.0 / copies as f64;
        let values = (0..grid.len()).map(|i| {
            let (ix, iy) = (i % n, i / n);
            scale * if ix < 64 && iy < 64 { patch.at(ix, iy) } else { low }
        });
        let heights = Field::new(grid, values.collect()).expect("a field");
        let control = Control::MeanPressure(load / (copies * copies) as f64);
        let params = SolveParams::default().by(Method::Uniform);
        let params = SolveParams { tolerance: rc_solver::Tolerance::Energy(1e-4), ..params };
        let solution = ContactProblem::new(&heights, control).with_kernel(&Love).solve(&params, &Silent);
        let solution = solution.expect("a solution");
        let off = (0..64 * 64).map(|i| {
            let (ix, iy) = (i % 64, i / 64);
            (solution.pressure().at(ix, iy) - free.pressure().at(ix, iy)).powi(2)
        });
        let size: f64 = free.pressure().values().iter().map(|p| p * p).sum();
        errors.push((off.sum::<f64>() / size).sqrt());
    }
    assert!(errors[1] < 0.25 * errors[0] && errors[2] < 0.25 * errors[1] && errors[2] < 2e-3, "{errors:?}");
}

/// √(G/U) is an upper bound of the distance to the solution in the energy norm.
#[test]
fn the_certificate_bounds_the_error_on_a_patch() {
    let heights = rough(96, 8);
    let range = heights.max() - heights.min();
    for control in [Control::MeanPressure(2e-3), Control::Penetration(0.5 * range), Control::Penetration(2.0 * range)] {
        let exact = solved(&heights, &FreeLove, control, 1e-12);
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let loose = solved(&heights, &FreeLove, control, tolerance);
            let difference: Vec<f64> =
                loose.pressure().values().iter().zip(exact.pressure().values()).map(|(a, b)| a - b).collect();
            let mut displaced = vec![0.0; difference.len()];
            UniformOperator::new(heights.grid(), &FreeLove).apply(&difference, &mut displaced, &mut []);
            let work: f64 = difference.iter().zip(&displaced).map(|(a, b)| a * b).sum();
            let error = (work / difference.len() as f64 / exact.info().elastic_energy).sqrt();
            let bound = loose.certificate().energy;
            assert!(error <= bound * (1.0 + 1e-6), "{control:?}, {tolerance:e}: {error:e}, bound {bound:e}");
        }
    }
}

/// The error bar of the area covers the change of the area with the grid.
///
/// The patch has many contacts.
#[test]
fn the_error_bar_of_the_area_holds_the_limit_of_fine_grids() {
    let surface = Surface::new(&SpectrumParams::paper(8, 5)).expect("a surface");
    let area = |n: usize| {
        let heights = surface.sample_on(Grid::square(n).expect("a grid")).expect("heights");
        let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-3)).with_kernel(&FreeLove);
        problem.solve(&SolveParams::default(), &Silent).expect("a solution").area()
    };
    let [coarse, middle, fine] = [64, 128, 512].map(area);
    for found in [coarse, middle] {
        let off = (found.fraction - fine.fraction).abs();
        assert!(off <= found.error.hypot(fine.error), "{} ± {} for {}", found.fraction, found.error, fine.fraction);
    }
}

/// The limit is extrapolated: errors at borders fall with the side of elements.
#[test]
fn the_error_bar_of_the_penetration_holds_where_contact_reaches_a_border() {
    let beside = |n: usize| body(n, DVec2::new(0.1, 0.2), |r| -0.5 * r * r);
    let inside = |n: usize| body(n, DVec2::splat(0.5), |r| -0.5 * r * r);
    let bodies: [&dyn Fn(usize) -> Field; 3] = [&beside, &inside, &|n| rough(n, 4)];
    for (heights, load) in bodies.into_iter().zip([0.1, 0.5, 0.03]) {
        let [coarse, fine, finest] =
            [128, 256, 512].map(|n| solved(&heights(n), &FreeLove, Control::MeanPressure(load), 1e-8));
        let limit = 2.0 * finest.info().penetration - fine.info().penetration;
        for solution in [coarse, fine] {
            let (error, bar) = (solution.info().penetration - limit, solution.penetration_error());
            assert!(error.abs() <= bar && bar <= 6.0 * error.abs(), "{load}: {error:e}, bar {bar:e}");
            assert_eq!(solution.observables().rms_pressure_error, None, "the rms pressure has no limit");
        }
    }
    let apart = solved(&inside(128), &FreeLove, Control::MeanPressure(1e-3), 1e-8);
    assert!(apart.observables().rms_pressure_error.is_some_and(|bar| bar < 1e-2));
}

#[test]
fn spots_are_not_joined_across_borders() {
    let grid = Grid::square(32).expect("a grid");
    let at_corners = |at: DVec2| if at.x.min(1.0 - at.x) < 0.1 && at.y.min(1.0 - at.y) < 0.1 { 1.0 } else { 0.0 };
    let (pressure, gap) = (Field::from_fn(grid, at_corners), Field::zeros(grid));
    assert_eq!(ContactSpot::all(&pressure, &gap, Love.edge_bias(grid)).len(), 1);
    assert_eq!(ContactSpot::with_boundary(&pressure, &gap, Love.edge_bias(grid), Boundary::Free).len(), 4);
}

#[test]
fn the_procedure_of_the_paper_is_refused_on_a_patch() {
    let heights = rough(128, 8);
    let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-4)).with_kernel(&FreeLove);
    let error = problem.plan(&SolveParams::default().by(Method::GaussSeidel)).err();
    assert!(
        matches!(&error, Some(SolveError::Unsupported(refusal)) if refusal.object == Feature::FreeBorders),
        "{error:?}"
    );
}
