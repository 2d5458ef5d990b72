//! Contact under a sliding surface on tiles, audited like that of a solid at rest.

use rc_core::DVec2;
use rc_kernel::{Relaxation, Viscoelastic};

use crate::grid::stiffness::contact_stiffness;
use crate::levels::operator_error::tests::*;
use crate::levels::sliding::solve_sliding;
use crate::problem::bounds::Bounds;
use crate::solution::solved::Solved;

/// One relaxation time with a loss tangent of 1.4, and a series over five decades.
fn materials() -> [Relaxation; 2] {
    let many: Vec<[f64; 2]> = (0..10).map(|i| [0.9, 10_f64.powf(f64::from(i) / 2.0 - 4.0)]).collect();
    [Relaxation::single(10.0, 0.1), Relaxation::prony(&many)].map(|material| material.expect("a material"))
}

/// Calls `check` with scenes under sliding surfaces, with their kernels and solutions.
fn for_each_speed(check: impl Fn(&str, &Scene<'_>, (&Viscoelastic<Love>, &Audited))) {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    for (sides, waves, load) in [([256, 256], 8, 0.03), ([512, 512], 16, 0.003), ([256, 128], 8, 0.2)] {
        let grid = Grid::in_cell(sides[0], sides[1], sides[1] as f64 / sides[0] as f64).expect("a grid");
        let map = rough(grid, waves, 0.7, &mut rng);
        for (material, velocity) in materials().iter().flat_map(|m| [0.0, 0.003, 0.03, -0.3, 10.0].map(|v| (m, v))) {
            let kernel = Viscoelastic::new(Love, material, velocity * DVec2::X);
            let base = Some(sides[0] / if sides[0] > 256 { 8 } else { 4 });
            for bound in [ENERGY[0], ENERGY[1], RELATIVE[0]] {
                let control = Control::MeanPressure(1e-3 * load * f64::from(waves));
                let scene = Scene { map: &map, boundary: Boundary::Periodic, base, control, bound };
                let audited = scene.audited_with(&kernel);
                check(&format!("{grid}, velocity {velocity}, {bound}"), &scene, (&kernel, &audited));
            }
        }
    }
}

/// Certificates hold for the operator of the uniform grid, and displacements are within the bound of a solid at rest.
#[test]
fn an_audit_of_sliding_contacts_finds_no_more_than_is_claimed() {
    for_each_speed(|name, scene, (kernel, audited)| {
        let modes = kernel.sliding_modes().expect("a series along x");
        let solid = Solid::from(audited.base).under_sliding(modes.compliance);
        audit_of(solid.clone(), name, scene, audited);
        let control = Control::Penetration(audited.approach(scene.map));
        let scene = Scene { control, ..*scene };
        audit_of(solid, &format!("{name}, its penetration"), &scene, &scene.audited_with(kernel));
    });
}

/// The pressure is that of the uniform grid, as near as both certificates say.
#[test]
fn sliding_contacts_on_tiles_are_those_of_the_uniform_grid() {
    for_each_speed(|name, scene, (kernel, audited)| {
        let limits = IterationParams { bound: scene.bound, max_iterations: 500 };
        let bounds = Bounds::from(scene.control);
        let uniform = solve_sliding(scene.map, kernel, bounds, &limits, &Silent).expect("a problem");
        let difference: Vec<f64> =
            audited.pressure.iter().zip(uniform.pressure.values()).map(|(tiles, grid)| tiles - grid).collect();
        let mut displacement = vec![0.0; difference.len()];
        UniformOperator::new(scene.map.grid(), kernel).apply(&difference, &mut displacement, &mut []);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let energy = 0.5 * product(&audited.pressure, &audited.displacement);
        // The distance of either from the solution is at most √G, and √(G/U) is its energy error.
        let distance = (product(&difference, &displacement) / energy).sqrt();
        let claimed = audited.solved.level.outcome.certificate.energy + uniform.info.certificate.energy;
        assert!(distance < claimed, "{name}: {distance:e}, claimed {claimed:e}");
    });
}

/// Friction and stiffness are those of the uniform grid.
#[test]
fn friction_on_tiles_is_that_of_the_uniform_grid() {
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for (side, waves, load) in [(256, 16, 0.03), (256, 8, 0.03), (512, 8, 0.01)] {
        let map = rough(Grid::square(side).expect("a grid"), waves, 0.7, &mut rng);
        let bound = ErrorBound::Energy(1e-3);
        let control = Control::MeanPressure(1e-3 * load * f64::from(waves));
        for (material, velocity) in materials().iter().flat_map(|m| [0.003, 0.03, -0.3, 10.0].map(|v| (m, v))) {
            let kernel = Viscoelastic::new(Love, material, velocity * DVec2::X);
            let scene = Scene { map: &map, boundary: Boundary::Periodic, base: Some(64), control, bound };
            let solution = scene.levels(&kernel).solve(false, &Silent).expect("no other method may solve it");
            let limits = IterationParams { bound, max_iterations: 500 };
            let uniform = solve_sliding(&map, &kernel, Bounds::from(control), &limits, &Silent).expect("a problem");
            let stiffness = contact_stiffness(&uniform.pressure, f64::INFINITY, &kernel, true);
            let (found, expected) =
                (solution.info.friction.expect("it slides"), uniform.info.friction.expect("it slides"));
            let name = format!("{side}, {waves} waves, velocity {velocity}");
            let coefficient = expected.coefficient;
            let is_near = |found: f64, expected: f64, error: f64| (found - expected).abs() < error * coefficient;
            assert!(is_near(found.coefficient, coefficient, 1e-5), "{name}: {found:?} for {expected:?}");
            assert!(is_near(found.lateral, expected.lateral, 1e-5), "{name}: {found:?} for {expected:?}");
            // Slopes of u are those of the waves of the grid there, and those of the centres of elements here.
            assert!(is_near(found.of_displacement, coefficient, 0.05), "{name}: {found:?}");
            assert!((found.max_loss_tangent - expected.max_loss_tangent).abs() < 1e-12, "{name}: {found:?}");
            // The same slopes over a distance that is a little larger, since it has the error of the operator.
            let ratio =
                found.bound / expected.bound * uniform.info.certificate.energy / solution.info.certificate.energy;
            assert!((ratio - 1.0).abs() < 1e-3, "{name}: {found:?} for {expected:?}");
            assert!((solution.stiffness() / stiffness - 1.0).abs() < 1e-4, "{name}: {stiffness}");
        }
    }
}
