//! Elastic layers and coatings: exact limits, the published kernel, a dense solver, and both methods.

use std::f64::consts::{PI, TAU};

use rc_comm::{Ranks, run_threads};
use rc_core::testing::quasi_random;
use rc_core::{DVec2, Field, Grid, HeightField, Kernel, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{Layer, Love, LoveLayer, Relaxation, Spectral, SpectralLayer, Substrate, Viscoelastic};
use rc_solver::{
    AdaptiveError, ContactProblem, Control, Method, MethodReason, Solution, SolveError, SolveParams, Status, Tolerance,
    solve_dense,
};
use rc_theory::hertz::PeriodicHertz;
use rc_theory::thin_layer::ThinLayer;

use crate::examples::own_kernel::BondedLayer;
use crate::{assert_close, solved};

fn layer(thickness: f64, poisson: f64) -> Layer {
    Layer::on_rigid_base(thickness, poisson)
}

/// Displacement of a layer on a rigid base under a uniform pressure of E*.
fn uniform(layer: Layer) -> f64 {
    layer.uniform_displacement().expect("a rigid base")
}

/// A paraboloid with its apex at the centre of an element.
fn sphere(n: usize, radius: f64) -> Field {
    let grid = Grid::square(n).expect("a grid");
    let centre = grid.centre(n / 2, n / 2);
    Field::from_fn(grid, |at| -(at - centre).length_squared() / (2.0 * radius))
}

fn rough(n: usize, waves: usize) -> Field {
    let surface = Surface::new(&SpectrumParams::paper(waves, 3)).expect("a surface");
    surface.sample_on(Grid::square(n).expect("a grid")).expect("heights")
}

/// The kernel of the example gives the same result as the library's layer.
///
/// The example writes the published formula independently. The two differ by the mean displacement only.
#[test]
fn the_own_kernel_of_the_example_is_this_layer() {
    let heights = rough(128, 8);
    for (thickness, poisson) in [(0.5, 0.3), (0.05, 0.45), (0.02, 0.5)] {
        let own = BondedLayer { thickness, poisson };
        for xi in [1e-3, 0.1, 0.7, 3.0, 40.0] {
            assert_close("factor", layer(thickness, poisson).factor(xi), own.factor(xi), 1e-7);
        }
        let control = Control::MeanPressure(2e-3);
        let [by_own, by_layer] = [&own as &dyn Kernel, &SpectralLayer(layer(thickness, poisson))]
            .map(|kernel| solved(&heights, kernel, control, 1e-10));
        let compressed = uniform(layer(thickness, poisson)) * 2e-3;
        assert_close("max pressure", by_layer.pressure().max(), by_own.pressure().max(), 1e-6);
        let penetration = by_own.info().penetration + compressed;
        assert_close("penetration", by_layer.info().penetration, penetration, 1e-7);
        assert_close("mean gap", by_layer.observables().mean_gap, by_own.observables().mean_gap, 1e-6);
        assert_close("mean gap", by_layer.gap().mean(), by_layer.observables().mean_gap, 1e-6);
        let energy = by_own.info().elastic_energy + 0.5 * compressed * 2e-3;
        assert_close("energy", by_layer.info().elastic_energy, energy, 1e-6);
    }
}

#[test]
fn load_and_penetration_are_two_ways_to_one_contact() {
    let heights = rough(128, 8);
    for (thickness, poisson) in [(2.0, 0.3), (0.1, 0.0), (0.03, 0.45), (0.05, 0.5)] {
        for kernel in [&LoveLayer(layer(thickness, poisson)) as &dyn Kernel, &SpectralLayer(layer(thickness, poisson))]
        {
            for load in [2e-4, 5e-3, 5e-2] {
                let by_load = solved(&heights, kernel, Control::MeanPressure(load), 1e-9);
                let depth = Control::Penetration(by_load.info().penetration);
                let by_depth = solved(&heights, kernel, depth, 1e-9);
                assert_close("load", by_depth.info().mean_pressure, load, 1e-5);
                assert_close("area", by_depth.area().fraction, by_load.area().fraction, 1e-3);
                assert_close("stiffness", by_depth.stiffness(), by_load.stiffness(), 5e-3);
            }
        }
    }
}

/// The displacement is v in gap = v - h + h_max - Δ.
///
/// It includes the compression under the mean pressure.
#[test]
fn displacement_and_gap_belong_together() {
    let heights = rough(64, 6);
    let solution = solved(&heights, &LoveLayer(layer(0.1, 0.2)), Control::MeanPressure(4e-3), 1e-10);
    let offset = heights.max() - solution.info().penetration;
    let fields = solution.displacement().values().iter().zip(heights.values()).zip(solution.gap().values());
    for ((v, h), gap) in fields {
        assert!((v - h + offset - gap).abs() < 1e-12, "{v} - {h} + {offset} for {gap}");
    }
}

#[test]
fn a_dense_solver_finds_the_same_pressure() {
    let heights = rough(24, 4);
    for (thickness, poisson) in [(0.3, 0.3), (0.06, 0.5)] {
        let kernel = LoveLayer(layer(thickness, poisson));
        let range = heights.max() - heights.min();
        for depth in [0.2 * range, 0.3 * range, 0.45 * range] {
            let exact = solve_dense(&heights, &kernel, depth).expect("valid").expect("a contact that settles");
            let found = solved(&heights, &kernel, Control::Penetration(depth), 1e-11);
            let off = found.pressure().values().iter().zip(exact.values()).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-6 * exact.max(), "thickness {thickness}, ν = {poisson}, {depth}");
        }
    }
}

/// A penetration beyond the half-space's full contact compresses the layer.
#[test]
fn full_contact_is_exact_at_any_depth() {
    let waves = |at: DVec2| 1e-3 * ((TAU * at.x).cos() + (TAU * (2.0 * at.y - at.x)).cos());
    let heights = Field::from_fn(Grid::square(64).expect("a grid"), waves);
    let solid = layer(0.05, 0.3);
    let kernel = SpectralLayer(solid);
    let depth = heights.max() - heights.mean() + 2e-3;
    let by_depth = solved(&heights, &kernel, Control::Penetration(depth), 1e-10);
    assert_eq!(by_depth.status(), Status::FullContact);
    let expected = 2e-3 / uniform(solid);
    assert_close("load", by_depth.info().mean_pressure, expected, 1e-12);
    assert_close("penetration", by_depth.info().penetration, depth, 1e-12);
    assert_close("stiffness", by_depth.stiffness(), uniform(solid).recip(), 1e-12);
    assert!(by_depth.observables().mean_gap.abs() < 1e-15, "{}", by_depth.observables().mean_gap);
    // A wave q of the heights is the wave of the pressure times 2/q M(q d).
    let stiffness = [TAU, TAU * 5.0_f64.sqrt()].map(|q| 0.5 * q / solid.factor(q * 0.05));
    let wave =
        |at: DVec2| 1e-3 * (stiffness[0] * (TAU * at.x).cos() + stiffness[1] * (TAU * (2.0 * at.y - at.x)).cos());
    let pressure = Field::from_fn(heights.grid(), |at| expected + wave(at));
    let off = pressure.values().iter().zip(by_depth.pressure().values()).map(|(a, b)| (a - b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12 * expected, "the pressure is not that of its waves");
}

#[test]
fn a_sphere_on_a_thick_layer_is_that_of_hertz() {
    let expected = PeriodicHertz { radius: 1.0 }.at_contact_radius(0.1).expect("a small contact");
    let heights = sphere(256, 1.0);
    let thick = layer(3.0, 0.3);
    let solution = solved(&heights, &LoveLayer(thick), Control::MeanPressure(expected.load), 1e-9);
    let compressed = uniform(thick) * expected.load;
    assert_close("peak pressure", solution.pressure().max(), expected.peak_pressure, 2e-3);
    assert_close("penetration", solution.info().penetration, expected.penetration + compressed, 2e-3);
    assert_close("radius", (solution.area().fraction / PI).sqrt(), 0.1, 5e-3);
}

/// A sphere on a thin layer follows Johnson's two limits.
///
/// They are columns that act as springs, and an incompressible layer. Corrections are of first order in the ratio of
/// thickness to contact radius.
#[test]
fn a_sphere_on_a_thin_layer_is_on_springs_or_squeezes_it_out() {
    for (poisson, thickness, allowed) in [(0.3, 0.004, 0.06), (0.0, 0.004, 0.06), (0.5, 0.02, 0.3)] {
        let theory = ThinLayer { radius: 2.0, thickness, poisson };
        let radius = 0.3;
        let errors = [thickness, 0.5 * thickness].map(|thickness| {
            let theory = ThinLayer { thickness, ..theory };
            let load = theory.load(radius);
            let kernel = LoveLayer(layer(thickness, poisson));
            let solution = solved(&sphere(512, 2.0), &kernel, Control::MeanPressure(load), 1e-8);
            assert_close("radius", (solution.area().fraction / PI).sqrt(), radius, 0.5 * allowed);
            assert_close("penetration", solution.info().penetration, theory.penetration(radius), allowed);
            solution.pressure().max() / theory.pressure(0.0, radius) - 1.0
        });
        assert!(errors[0].abs() < allowed && errors[1].abs() < 0.7 * errors[0].abs(), "ν = {poisson}: {errors:?}");
    }
}

#[test]
fn a_layer_that_no_base_grid_resolves_is_solved_on_the_uniform_grid() {
    let heights = rough(128, 8);
    let kernel = LoveLayer(layer(0.05, 0.3));
    let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-4)).with_kernel(&kernel);
    let plan = problem.clone().plan(&SolveParams::default()).expect("a plan");
    let reason = MethodReason::DeviationNotResolved { kernel: "love" };
    assert_eq!((plan.method(), plan.reason()), (Method::Uniform, &reason));
    let error = problem.plan(&SolveParams::default().by(Method::Adaptive)).err();
    assert!(matches!(&error, Some(SolveError::Adaptive(AdaptiveError::Deviation { .. }))), "{error:?}");
    let waves = SpectralLayer(layer(0.5, 0.3));
    let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-4)).with_kernel(&waves);
    let error = problem.plan(&SolveParams::default().by(Method::Adaptive)).err();
    assert!(matches!(&error, Some(SolveError::Unsupported(_))), "{error:?}");
    let stiff = solved(&heights, &kernel, Control::MeanPressure(1e-3), 1e-8);
    let half_space = solved(&heights, &Love, Control::MeanPressure(1e-3), 1e-8);
    assert!(stiff.area().fraction < half_space.area().fraction, "a layer is stiffer than the half-space");
}

fn by(method: Method, problem: &ContactProblem<'_>, tolerance: f64) -> Solution<'static> {
    let params = SolveParams { tolerance: Tolerance::Energy(tolerance), ..SolveParams::default().by(method) };
    let solution = problem.clone().solve(&params, &Silent);
    solution.unwrap_or_else(|error| panic!("{method}: {error}")).into_owned()
}

/// Fails unless the methods agree on `problem`.
///
/// Energies, and what follows from them, have errors of the square of the energy error, times a factor of order 10.
/// Stiffnesses are computed to 1e-3.
#[track_caller]
fn assert_agreement(problem: &ContactProblem<'_>, tolerance: f64) {
    let [found, expected] = [Method::Adaptive, Method::Uniform].map(|method| by(method, problem, tolerance));
    let square = 10.0 * tolerance * tolerance;
    assert_eq!((found.method(), found.status()), (Method::Adaptive, expected.status()));
    for solution in [&found, &expected] {
        assert!(solution.certificate().meets(solution.bound()), "{}", solution.certificate());
    }
    let [a, b] = [&found, &expected].map(rc_solver::Solution::info);
    assert_close("load", a.mean_pressure, b.mean_pressure, square);
    assert_close("penetration", a.penetration, b.penetration, square);
    assert_close("energy", a.elastic_energy, b.elastic_energy, square);
    // Full contact on an elastic substrate is infinitely stiff.
    let (stiffness, wanted) = (found.stiffness(), expected.stiffness());
    assert!(
        (stiffness.is_infinite() && wanted.is_infinite()) || (stiffness / wanted - 1.0).abs() < 3e-3,
        "stiffness {stiffness}, not {wanted}"
    );
    let [a, b] = [&found, &expected].map(Solution::observables);
    assert_close("rms pressure", a.rms_pressure, b.rms_pressure, square);
    // The gap of heavy contact is a small difference.
    let off = (a.mean_gap - b.mean_gap).abs();
    assert!(off < square * expected.info().penetration_full_contact, "{} and {}", a.mean_gap, b.mean_gap);
    let [a, b] = [&found, &expected].map(Solution::area);
    assert!((a.fraction - b.fraction).abs() <= (3e-4 * b.fraction).min(b.error), "{a:?} and {b:?}");
    if found.status() != Status::FullContact {
        assert_close("conductance", found.conductance(), expected.conductance(), 3e-3);
    }
}

/// Random layers and coatings, from the thinnest that the usual base grid takes to a thickness of the cell.
#[test]
fn both_methods_agree_on_layers() {
    for scene in 0..12 {
        let random = |i: usize| quasi_random(101 * scene + i);
        let waves = [4, 8, 16][scene % 3];
        let heights = rough(256, waves);
        let thickness = match scene {
            0 | 4 => 1.0,
            1 | 5 => 1.3 / waves.max(16) as f64,
            _ => (1.0 / waves.max(16) as f64).powf(random(0)),
        };
        let poisson = [0.0, 0.5, 0.3, 0.45, 0.49][scene % 5];
        let modulus = 10.0_f64.powf(3.0 * random(2) - 1.5);
        let substrate = (scene % 4 == 3).then_some(Substrate { modulus, poisson: 0.5 * random(3) });
        let kernel = LoveLayer(Layer { thickness, poisson, substrate });
        let load = Control::MeanPressure(1e-4 * 100.0_f64.powf(random(1)));
        assert_agreement(&ContactProblem::new(&heights, load).with_kernel(&kernel), 1e-3);
    }
}

/// Depths go from the first touch to full contact, with and without a hardness, on grids that are not squares too.
#[test]
fn both_methods_agree_with_what_layers_are_combined_with() {
    let oblong = {
        let grid = Grid::in_cell(256, 192, 0.75).expect("a grid");
        let square = rough(256, 8);
        Field::from_fn(grid, |at| square.at((at.x * 256.0) as usize % 256, (at.y / 0.75 * 256.0) as usize % 256))
    };
    let [square, uneven] = [rough(256, 8), rough(250, 8)];
    let substrate = Some(Substrate { modulus: 0.2, poisson: 0.4 });
    let solids = [layer(0.2, 0.3), layer(0.15, 0.5), Layer { substrate, ..layer(0.2, 0.45) }];
    for (heights, solid) in [&square, &uneven, &oblong].into_iter().zip(solids) {
        let kernel = LoveLayer(solid);
        let problem = |control| ContactProblem::new(heights, control).with_kernel(&kernel);
        let full = heights.max() - heights.mean();
        assert_agreement(&problem(Control::Penetration(0.4 * full)), 2e-3);
        assert_agreement(&problem(Control::MeanPressure(2e-3)).with_hardness(0.02), 2e-3);
        assert_agreement(&problem(Control::MeanPressure(1.0)), 2e-3);
        // Beyond full contact of the half-space, a base is pressed too.
        if solid.uniform_displacement().is_some_and(|displacement| displacement > 0.0) {
            assert_agreement(&problem(Control::Penetration(2.0 * full)), 2e-3);
        }
    }
}

/// The unresolved part of a deviation counts as an error, or the base grid is finer.
#[test]
fn the_certificate_of_a_thin_layer_meets_the_tolerance() {
    let heights = rough(256, 16);
    for (thickness, tolerance) in [(0.083, 1e-2), (0.083, 1e-3), (0.045, 1e-2), (0.06, 2e-4)] {
        let kernel = LoveLayer(layer(thickness, 0.5));
        let problem = ContactProblem::new(&heights, Control::MeanPressure(1e-3)).with_kernel(&kernel);
        assert_agreement(&problem, tolerance);
    }
}

#[test]
fn ranks_and_border_levels_go_with_layers() {
    let surface = Surface::new(&SpectrumParams::paper(8, 3)).expect("a surface");
    let kernel = LoveLayer(layer(0.2, 0.4));
    let (load, adaptive) = (Control::MeanPressure(5e-4), SolveParams::default().by(Method::Adaptive));
    let solve = |n: usize, ranks: Ranks, border_level: usize| {
        let problem = ContactProblem::new(surface.on(Grid::square(n).expect("a grid")), load).with_kernel(&kernel);
        let solution = problem.over(ranks).solve(&SolveParams { border_level, ..adaptive }, &Silent).expect("solvable");
        (solution.info().clone(), solution.area(), solution.stiffness().to_bits())
    };
    let alone = solve(512, Ranks::alone(), 0);
    for found in run_threads(3, |ranks| solve(512, ranks, 0)).expect("all ranks end") {
        assert_eq!(found, alone);
    }
    let divided = solve(256, Ranks::alone(), 1);
    assert_close("area", divided.1.fraction, alone.1.fraction, 5e-3);
    assert_close("penetration", divided.0.penetration, alone.0.penetration, 2e-3);
}

#[test]
fn a_layer_slides_on_the_adaptive_mesh() {
    let heights = rough(256, 8);
    let rubber = Relaxation::single(10.0, 0.05).expect("a material");
    let kernel = Viscoelastic::new(LoveLayer(layer(0.2, 0.48)), &rubber, DVec2::X);
    let problem = ContactProblem::new(&heights, Control::MeanPressure(2e-3)).with_kernel(&kernel);
    let [found, expected] = [Method::Adaptive, Method::Uniform].map(|method| by(method, &problem, 1e-3));
    assert_close("penetration", found.info().penetration, expected.info().penetration, 1e-5);
    assert_close("rms pressure", found.observables().rms_pressure, expected.observables().rms_pressure, 1e-4);
    let [found, expected] = [found, expected].map(|solution| solution.info().friction.expect("friction").coefficient);
    assert_close("friction", found, expected, 1e-3);
}

/// A coating of the material of its substrate is the half-space, and on a stiff one the layer.
#[test]
fn a_coating_lies_between_a_layer_and_the_half_space() {
    let (heights, load) = (rough(128, 8), Control::MeanPressure(2e-3));
    let on = |modulus: f64| Layer { substrate: Some(Substrate { modulus, poisson: 0.45 }), ..layer(0.1, 0.45) };
    let area = |kernel: &dyn Kernel| solved(&heights, kernel, load, 1e-9).area().fraction;
    for kernels in [
        [&Love as &dyn Kernel, &LoveLayer(on(1.0)), &LoveLayer(on(1e6)), &LoveLayer(layer(0.1, 0.45))],
        [&Spectral, &SpectralLayer(on(1.0)), &SpectralLayer(on(1e6)), &SpectralLayer(layer(0.1, 0.45))],
    ] {
        let [half_space, same, stiff, rigid] = kernels.map(area);
        assert_close("one material", same, half_space, 1e-9);
        assert_close("a stiff substrate", stiff, rigid, 1e-4);
        assert!(rigid < half_space, "{rigid} and {half_space}");
    }
    let areas = [1e3, 3.0, 1.0, 0.3, 0.01].map(|modulus| area(&LoveLayer(on(modulus))));
    assert!(areas.is_sorted_by(|a, b| a < b), "softer substrates: {areas:?}");
}

/// √(G/U) bounds the distance to the solution in the energy norm, also at loose tolerances.
///
/// U does not include the uniform compression.
#[test]
fn the_certificate_bounds_the_error_on_a_layer() {
    let heights = rough(96, 6);
    let kernel = LoveLayer(layer(0.2, 0.3));
    for control in [Control::MeanPressure(3e-3), Control::Penetration(0.7 * (heights.max() - heights.mean()))] {
        let exact = solved(&heights, &kernel, control, 1e-12);
        for tolerance in [1e-2, 1e-3, 1e-4] {
            let params = SolveParams::to_tolerance(tolerance).by(Method::Uniform);
            let problem = ContactProblem::new(&heights, control).with_kernel(&kernel);
            let loose = problem.solve(&params, &Silent).expect("a solution");
            let difference: Vec<f64> =
                loose.pressure().values().iter().zip(exact.pressure().values()).map(|(a, b)| a - b).collect();
            let difference = Field::new(heights.grid(), difference).expect("a field");
            let work = |a: &Field, b: &Field| {
                a.values().iter().zip(b.values()).map(|(a, b)| a * b).sum::<f64>() / heights.grid().len() as f64
            };
            let operator = rc_solver::UniformOperator::new(heights.grid(), &kernel);
            let mut displaced = Field::zeros(heights.grid());
            rc_core::Operator::apply(&operator, difference.values(), displaced.values_mut(), &mut []);
            let uniform = uniform(layer(0.2, 0.3)) * exact.info().mean_pressure.powi(2);
            let energy = exact.info().elastic_energy - 0.5 * uniform;
            let error = (work(&difference, &displaced) / energy).sqrt();
            let bound = loose.certificate().energy;
            assert!(error <= bound * (1.0 + 1e-6), "{control:?}, {tolerance:e}: {error:e}, bound {bound:e}");
        }
    }
}
