//! Contact under a sliding surface on tiles, audited like that of a solid at rest.

use rc_core::DVec2;
use rc_kernel::{Relaxation, Viscoelastic};

use crate::levels::operator_error::tests::*;
use crate::problem::bounds::Bounds;
use crate::sliding::levels::solve_sliding;

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
