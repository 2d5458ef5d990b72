//! Partial slip against closed forms: Mindlin's sphere, and Westergaard's wave superposed.

use std::f64::consts::{PI, TAU};

use rc_core::{DVec2, Field, Grid, Kernel, Silent};
use rc_kernel::{FreeLove, Spectral};
use rc_solver::{ContactProblem, Control, ShearInfo, ShearParams, SolveParams, Tolerance};
use rc_theory::westergaard::Westergaard;

use crate::assert_close;

const FRICTION: f64 = 0.3;

/// The contact under `load`, sheared by each part of its friction.
fn sheared(heights: &Field, kernel: &dyn Kernel, load: f64, (parts, poisson): (&[f64], f64)) -> Vec<(ShearInfo, f64)> {
    let params = SolveParams { tolerance: Tolerance::Energy(1e-3), ..SolveParams::default() };
    let problem = ContactProblem::new(heights, Control::MeanPressure(load)).with_kernel(kernel);
    let plan = problem.plan(&params).expect("a plan");
    let again = plan.under(Control::MeanPressure(load)).expect("a plan");
    let normal = plan.solve(&Silent).expect("a normal contact");
    let shear = |part: &f64| {
        let params = ShearParams { poisson, ..ShearParams::new(FRICTION, part * FRICTION * load) };
        let found = again.shear(&normal, &params, &Silent).expect("a sheared contact");
        (found.info, normal.area().fraction)
    };
    parts.iter().map(shear).collect()
}

/// A paraboloid of radius 1 at the centre of a patch of side 0.25.
fn sphere(n: usize) -> Field {
    Field::from_fn(Grid::square(n).expect("a grid"), |at| -2.0 * (at - DVec2::splat(0.5)).length_squared())
}

/// Cattaneo 1938, Mindlin 1949: stick radius (1 - τ/μσ0)^(1/3), displacement μ a²/R (1 - (1 - τ/μσ0)^(2/3)).
#[test]
fn mindlins_sphere() {
    // The sphere of radius 2 cells with a = 0.363424 cells is that of radius 1 with a = 0.090856 in a cell of 1/4.
    let a = 0.363_424;
    let radius = 0.25;
    let load = 4.0 * f64::powi(a, 3) / (3.0 * radius);
    let parts = [0.25, 0.5, 0.75, 0.9];
    let found = sheared(&sphere(256), &FreeLove, load, (&parts, 0.0));
    for ((info, area), part) in found.into_iter().zip(parts) {
        let left: f64 = 1.0 - part;
        assert_close("contact radius", (area / PI).sqrt(), a, 2e-3);
        // Edges are located to 3 % of an element, of which the smallest stick radius has 43.
        assert_close("stick radius", (info.stick_area / area).sqrt(), left.cbrt(), 3e-3);
        assert_close("slip area", info.slip_area / area, 1.0 - left.powf(2.0 / 3.0), 1e-2);
        let displacement = FRICTION * a * a / radius * (1.0 - left.powf(2.0 / 3.0));
        assert_close("displacement", info.displacement, displacement, 2e-3);
        // d = ∫ dτ/K_t, so that K_t is 2a per nominal area at the start.
        assert_close("stiffness", info.stiffness, 2.0 * a, 5e-3);
        // The work of the force minus the energy that a full unloading gives back, Johnson's Eq. 7.36 without its sum.
        let loss = slip_work_of_sphere(part) * FRICTION * load * FRICTION * a * a / radius;
        assert_close("slip work", info.slip_work, loss, 2e-2);
    }
}

/// ⟨μp s⟩ over μσ0 · μa²/R, from the tractions of both loads: τ d - ½⟨t·v⟩ - ∫ d dτ' by quadrature.
fn slip_work_of_sphere(part: f64) -> f64 {
    // Energy of t = μ(p(a) - p(c)): with P ∝ a³ and Δ ∝ a², U = ∫ τ dd at fixed stick, ½⟨t v⟩ by reciprocity:
    // ⟨p_i v_j⟩ of Hertz pressures of radii c ≤ a is P_c (Δ_a - 1/5 Δ_c).
    let c = (1.0 - part).cbrt();
    let product = |c: f64, a: f64| c.powi(3) * (a * a - c * c / 5.0);
    let stored = 0.5 * (product(1.0, 1.0) - 2.0 * product(c, 1.0) + product(c, c));
    let n = 20_000;
    let step = part / f64::from(n);
    let displacement = |part: f64| 1.0 - (1.0 - part).powf(2.0 / 3.0);
    let work_of_force =
        part * displacement(part) - (0..n).map(|i| step * displacement((f64::from(i) + 0.5) * step)).sum::<f64>();
    work_of_force - stored
}

/// Mindlin's ratio (2 - ν)/(2 (1 - ν)) of displacements is an approximation where the contact slips.
#[test]
fn poissons_ratio_softens_a_sphere_as_mindlin_says() {
    let (a, radius) = (0.363_424, 0.25);
    let load = 4.0 * f64::powi(a, 3) / (3.0 * radius);
    for (info, _) in sheared(&sphere(128), &FreeLove, load, (&[0.25, 0.75], 0.3)) {
        let left: f64 = 1.0 - info.mean_shear / (FRICTION * load);
        let displacement = FRICTION * a * a / radius * (1.0 - left.powf(2.0 / 3.0)) * 1.7 / 1.4;
        assert!(info.rounds > 0, "{info:?}");
        assert_close("displacement", info.displacement, displacement, 1e-2);
    }
}

/// Shear of a wave leaves the contact area, the displacement and the pressure of a smaller load out of its own.
#[test]
fn westergaards_wave_superposed() {
    let wave = Westergaard { amplitude: 1e-3 };
    let load = 0.5 * wave.full_contact_pressure();
    let (profile, surface) = (Grid::in_cell(1024, 1, 1.0 / 1024.0), Grid::in_cell(256, 64, 0.25));
    for grid in [profile, surface] {
        let heights = Field::from_fn(grid.expect("a grid"), |at| wave.amplitude * (TAU * at.x).cos());
        // Shear along the wave is in plane strain, and as stiff as pressure for any Poisson's ratio.
        for poisson in [0.0, 0.3] {
            let parts = [0.3, 0.8];
            for ((info, _), part) in sheared(&heights, &Spectral, load, (&parts, poisson)).into_iter().zip(parts) {
                let left = (1.0 - part) * load;
                // Both edges are located to half an element. Where Poisson's ratio counts, elements are counted.
                let expected = wave.area_fraction(left);
                let is_profile = heights.grid().ny() == 1;
                let elements = if poisson > 0.0 && !is_profile { 2.0 } else { 1.0 };
                let bar = elements / (heights.grid().nx() as f64 * expected);
                assert_close("stick area", info.stick_area, expected, bar);
                let depth = wave.penetration(load) - wave.penetration(left);
                assert_close("displacement", info.displacement, FRICTION * depth, 3e-3);
                assert!(!is_profile || info.rounds == 0, "{info:?}");
            }
        }
    }
}

/// Across a profile, all waves are softer by 1/(1 - ν): the area stays, and the displacement grows.
#[test]
fn a_profile_is_softer_across_than_along() {
    let wave = Westergaard { amplitude: 1e-3 };
    let (load, poisson) = (0.5 * wave.full_contact_pressure(), 0.5);
    let grid = Grid::in_cell(1024, 1, 1.0 / 1024.0).expect("a grid");
    let heights = Field::from_fn(grid, |at| wave.amplitude * (TAU * at.x).cos());
    let plan = ContactProblem::new(&heights, Control::MeanPressure(load)).with_kernel(&Spectral);
    let plan = plan.plan(&SolveParams::default()).expect("a plan");
    let again = plan.under(Control::MeanPressure(load)).expect("a plan");
    let normal = plan.solve(&Silent).expect("a normal contact");
    let shear = |direction| {
        let params = ShearParams { poisson, direction, ..ShearParams::new(FRICTION, 0.4 * FRICTION * load) };
        again.shear(&normal, &params, &Silent).expect("a sheared contact").info
    };
    let (along, across) = (shear(DVec2::X), shear(DVec2::Y));
    assert_close("displacement", across.displacement, 2.0 * along.displacement, 1e-12);
    assert_close("stiffness", across.stiffness, 0.5 * along.stiffness, 1e-12);
    assert!(across.stick_area.to_bits() == along.stick_area.to_bits() && across.rounds == 0, "{across:?}");
    assert!(across.error <= 0.01 && along.error <= 0.01, "{across:?}");
}
