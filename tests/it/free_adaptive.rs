//! The adaptive method on patches with free borders.
//!
//! It is compared with the uniform method, direct sums and closed forms.

use std::f64::consts::PI;

use rc_comm::{Ranks, run_threads};
use rc_core::{DVec2, Field, Grid, HeightField as _, HeightSource, Operator as _, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::FreeLove;
use rc_solver::{
    ContactProblem, Control, Method, MethodReason, Solution, SolveParams, Status, Tolerance, UniformOperator,
};
use rc_theory::hertz::Hertz;

use crate::assert_close;

fn solve<'a>(heights: impl Into<HeightSource<'a>>, control: Control, params: &SolveParams) -> Solution<'a> {
    let problem = ContactProblem::new(heights, control).with_kernel(&FreeLove);
    problem.solve(params, &Silent).unwrap_or_else(|error| panic!("{control:?}: {error}"))
}

fn by(method: Method, tolerance: f64) -> SolveParams {
    SolveParams { tolerance: Tolerance::Energy(tolerance), ..SolveParams::default().by(method) }
}

fn surface(waves: usize, seed: u64) -> Surface {
    Surface::new(&SpectrumParams::paper(waves, seed)).expect("a surface")
}

/// A map that does not meet itself across its borders: rounded, tilted and rough.
fn map(waves: usize, [nx, ny]: [usize; 2]) -> Field {
    let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
    let rough = surface(waves, 5);
    Field::from_fn(grid, |at| rough.height(at) + 0.01 * at.x - 0.03 * (at - DVec2::new(0.4, 0.3)).length_squared())
}

/// Asserts that area, loads and lengths are those of the uniform method.
///
/// They may differ by the squares of the energy errors of both iterations.
fn assert_agrees(heights: &Field, found: &Solution<'_>, control: Control) {
    let uniform = solve(heights, control, &by(Method::Uniform, 1e-3));
    assert_eq!((found.method(), uniform.method()), (Method::Adaptive, Method::Uniform));
    let (a, b) = (found.observables(), uniform.observables());
    let allowed = found.info().iteration_error.powi(2) + uniform.info().iteration_error.powi(2) + 1e-9;
    assert!(allowed < 1e-4, "the iterations leave {allowed:e}");
    assert_close("area", a.area.fraction, b.area.fraction, allowed.max(2e-6));
    assert_close("edges", a.area.perimeter, b.area.perimeter, 1e-3);
    assert_close("mean pressure", found.info().mean_pressure, uniform.info().mean_pressure, allowed);
    assert_close("penetration", found.info().penetration, uniform.info().penetration, allowed);
    assert_close("rms pressure", a.rms_pressure, b.rms_pressure, allowed);
    assert_close("mean gap", a.mean_gap, b.mean_gap, allowed);
    if matches!(control, Control::MeanPressure(_)) {
        // Under a given penetration it contains the summit, which is known of the surface and estimated of a map.
        assert_close("error bar of the gap", a.mean_gap_error, b.mean_gap_error, 1e-2);
    }
    assert_eq!(a.rms_pressure_error.is_none(), b.rms_pressure_error.is_none(), "contact reaches a border, or not");
    assert_close("energy", a.elastic_energy, b.elastic_energy, allowed);
    assert_close("stiffness", found.stiffness(), uniform.stiffness(), 3e-3);
    let differences = found.pressure().values().iter().zip(uniform.pressure().values()).map(|(a, b)| (a - b).powi(2));
    let off = (differences.sum::<f64>() / heights.grid().len() as f64).sqrt() / b.rms_pressure;
    // Short waves of the pressure have less energy than long ones.
    assert!(off < 5.0 * allowed.sqrt(), "pressures differ by {off:e} of their rms, for {:e}", allowed.sqrt());
    // Rows of gaps come from the fastest operator.
    let off = (found.gap().mean() - a.mean_gap).abs();
    assert!(off < 2e-6 * found.info().penetration, "mean of the gap: {:e}, {:e}", found.gap().mean(), a.mean_gap);
}

#[test]
fn agrees_with_the_uniform_method_on_generated_surfaces() {
    for (waves, seed, load) in [(32, 11, 1e-5), (24, 3, 8.9e-4), (16, 5, 5e-3)] {
        let surface = surface(waves, seed);
        let grid = Grid::square(512).expect("a grid");
        let heights = surface.sample_on(grid).expect("heights");
        let by_load = solve(surface.on(grid), Control::MeanPressure(load), &by(Method::Adaptive, 1e-3));
        assert_agrees(&heights, &by_load, Control::MeanPressure(load));
        let control = Control::Penetration(by_load.info().penetration);
        let by_depth = solve(surface.on(grid), control, &by(Method::Adaptive, 1e-3));
        assert_close("load", by_depth.info().mean_pressure, load, 1e-5);
        assert_agrees(&heights, &by_depth, control);
    }
}

#[test]
fn agrees_with_the_uniform_method_on_maps_of_any_size() {
    for sides in [[256, 256], [512, 256], [250, 250], [301, 207]] {
        let heights = map(12, sides);
        for load in [2e-4, 4e-3] {
            let control = Control::MeanPressure(load);
            let found = solve(&heights, control, &by(Method::Adaptive, 1e-3));
            assert_agrees(&heights, &found, control);
            let control = Control::Penetration(found.info().penetration);
            assert_agrees(&heights, &solve(&heights, control, &by(Method::Adaptive, 1e-3)), control);
        }
    }
}

/// Spheres at corners and at a border, and a cylinder along a border.
#[test]
fn contact_that_touches_the_border_agrees() {
    let grid = Grid::square(256).expect("a grid");
    let bodies: [fn(DVec2) -> f64; 4] = [
        |at| -0.5 * at.length_squared(),
        // At opposite corners, which filters would join around a period that is too short.
        |at| (-0.5 * at.length_squared()).max(-0.5 * (at - 1.0).length_squared()),
        |at| -0.5 * (at - DVec2::new(1.0, 0.4)).length_squared(),
        |at| -0.5 * (at.y - 0.02).powi(2),
    ];
    for body in bodies {
        let heights = Field::from_fn(grid, body);
        for control in [Control::MeanPressure(1e-3), Control::Penetration(5e-3)] {
            let found = solve(&heights, control, &by(Method::Adaptive, 1e-3));
            assert_agrees(&heights, &found, control);
        }
    }
}

/// Load, radius and peak pressure to 0.1 %.
#[test]
fn a_sphere_is_that_of_hertz() {
    let sphere = Hertz { radius: 1.0 };
    for (place, radius) in [([0.5, 0.5], 0.1), ([0.13, 0.87], 0.12)] {
        let place = DVec2::from(place);
        let heights = Field::from_fn(Grid::square(1024).expect("a grid"), |at| -0.5 * (at - place).length_squared());
        let below = -heights.max();
        let params = SolveParams::to_tolerance(1e-8).by(Method::Adaptive);
        let depth = sphere.penetration(radius);
        let by_depth = solve(&heights, Control::Penetration(depth - below), &params);
        assert_close("load", by_depth.info().mean_pressure, sphere.load(radius), 1e-3);
        assert_close("radius", (by_depth.area().fraction / PI).sqrt(), radius, 1e-3);
        assert_close("peak pressure", by_depth.pressure().max(), sphere.peak_pressure(radius), 1e-3);
        let by_load = solve(&heights, Control::MeanPressure(sphere.load(radius)), &params);
        assert_close("penetration", by_load.info().penetration + below, depth, 1e-3);
        assert_close("stiffness", by_load.stiffness(), 2.0 * radius, 3e-3);
        assert_close("energy", by_load.info().elastic_energy, sphere.energy(radius), 2e-3);
        assert_close("mean gap", by_load.observables().mean_gap, by_load.gap().mean(), 1e-6);
    }
}

/// A sum without images on every element finds the certificate and no other contact.
#[test]
fn nothing_penetrates_where_nothing_was_evaluated() {
    let grid = Grid::square(512).expect("a grid");
    for (seed, load) in [(1, 1e-5), (2, 1e-3)] {
        let surface = surface(32, seed);
        let heights = surface.sample_on(grid).expect("heights");
        let found = solve(surface.on(grid), Control::MeanPressure(load), &by(Method::Adaptive, 1e-2));
        assert_eq!(found.n_evaluated() + found.n_proven(), grid.len());
        assert!(2 * found.n_proven() > grid.len(), "{load:e}: {} are proven", found.n_proven());
        let mut displaced = vec![0.0; grid.len()];
        UniformOperator::new(grid, &FreeLove).apply(found.pressure().values(), &mut displaced, &mut []);
        let offset = heights.max() - found.info().penetration;
        let gaps = displaced.iter().zip(heights.values()).map(|(v, h)| v - h + offset);
        let range = heights.max() - heights.min();
        let deepest = -gaps.fold(f64::INFINITY, f64::min) / range;
        assert!(deepest <= found.certificate().penetration, "{deepest:e}, {}", found.certificate());
        assert_eq!(found.status(), Status::Converged);
    }
}

#[test]
fn digits_do_not_depend_on_the_number_of_threads() {
    let heights = map(16, [256, 256]);
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let found = solve(&heights, Control::MeanPressure(1e-3), &by(Method::Adaptive, 1e-2));
            (found.pressure().values().to_vec(), found.gap().values().to_vec(), found.stiffness().to_bits())
        })
    });
    assert!(one == two);
}

#[test]
fn digits_do_not_depend_on_the_number_of_ranks() {
    let heights = map(16, [256, 128]);
    let told = |ranks: Ranks| {
        let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-3)).with_kernel(&FreeLove).over(ranks);
        let found = problem.solve(&by(Method::Adaptive, 1e-2), &Silent).expect("a solution");
        let numbers =
            [found.area().fraction, found.observables().mean_gap, found.info().penetration, found.stiffness()];
        (numbers.map(f64::to_bits), found.pressure().values().to_vec(), found.gap().values().to_vec())
    };
    let alone = told(Ranks::alone());
    for size in [2, 3] {
        for of_rank in run_threads(size, told).expect("all ranks end") {
            assert!(of_rank == alone, "{size} ranks");
        }
    }
}

/// A hardness limits the pressure of a patch on both meshes alike, under both controls.
#[test]
fn a_hardness_gives_the_pressure_of_the_uniform_method() {
    let heights = map(12, [256, 256]);
    let elastic = solve(&heights, Control::MeanPressure(2e-3), &by(Method::Adaptive, 1e-2));
    let hardness = 0.3 * elastic.observables().max_pressure;
    for control in [Control::MeanPressure(2e-3), Control::Penetration(elastic.info().penetration)] {
        let [adaptive, uniform] = [Method::Adaptive, Method::Uniform].map(|method| {
            let problem = ContactProblem::new(&heights, control).with_kernel(&FreeLove).with_hardness(hardness);
            problem.solve(&by(method, 1e-3), &Silent).expect("a solution")
        });
        let (a, b) = (adaptive.observables(), uniform.observables());
        let plastic = [a, b].map(|found| found.plastic.expect("a plastic part").fraction);
        assert!(plastic[0] > 0.1 * a.area.fraction, "{plastic:?}");
        assert_close("plastic area", plastic[0], plastic[1], 1e-4);
        assert_close("area", a.area.fraction, b.area.fraction, 1e-5);
        assert_close("mean pressure", adaptive.info().mean_pressure, uniform.info().mean_pressure, 1e-5);
        assert_close("penetration", adaptive.info().penetration, uniform.info().penetration, 1e-5);
        assert_close("mean gap", a.mean_gap, b.mean_gap, 1e-5);
    }
}

/// Border levels divide elements at edges of contacts, also along free borders.
///
/// Load and gap stay the same.
#[test]
fn border_levels_refine_edges_on_a_patch() {
    let surface = surface(12, 3);
    let grid = Grid::square(256).expect("a grid");
    let control = Control::MeanPressure(1e-3);
    let params = SolveParams { border_level: 1, ..by(Method::Adaptive, 1e-2) };
    let found = solve(surface.on(grid), control, &params);
    let fine = solve(surface.on(Grid::square(512).expect("a grid")), control, &by(Method::Adaptive, 1e-2));
    assert_close("area", found.area().fraction, fine.area().fraction, 5e-3);
    assert_close("penetration", found.info().penetration, fine.info().penetration, 1e-3);
    assert_close("mean gap", found.observables().mean_gap, fine.observables().mean_gap, 1e-3);
}

#[test]
fn a_small_contact_on_a_patch_is_solved_adaptively_and_a_large_one_is_not() {
    let surface = surface(16, 3);
    let plan = |load: f64| {
        let on = surface.on(Grid::square(512).expect("a grid"));
        let plan = ContactProblem::new(on, Control::MeanPressure(load)).with_kernel(&FreeLove);
        let plan = plan.plan(&SolveParams::default()).expect("a plan");
        (plan.method(), plan.reason().clone())
    };
    assert!(matches!(plan(1e-5), (Method::Adaptive, MethodReason::SmallContact { .. })));
    assert!(matches!(plan(1.0), (Method::Uniform, MethodReason::LargeContact { .. })));
}

/// Displacements are then many times the height range. Values without an element must not touch.
#[test]
fn heavy_loads_with_border_levels_and_uneven_grids_converge() {
    let surface = surface(16, 1);
    for (side, border_level) in [(128, 1), (128, 2), (250, 0)] {
        for load in [1e-2, 0.1, 1.0] {
            let params = SolveParams { border_level, ..SolveParams::default().by(Method::Adaptive) };
            let source = surface.on(Grid::square(side).expect("a grid"));
            let found = solve(source, Control::MeanPressure(load), &params);
            assert_eq!(found.status(), Status::Converged, "{side}, {border_level}, {load}: {}", found.certificate());
        }
    }
}
