//! Partial slip: two normal contacts, the correction for Poisson's ratio, and the bound on the error.

use std::f64::consts::TAU;

use rc_core::{DVec2, Field, Grid, Kernel, Operator as _, Silent};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Spectral};
use rc_solver::{
    ContactProblem, Control, Method, ShearControl, ShearError, ShearParams, ShearSolution, SolveParams, Tolerance,
    UniformOperator,
};

use crate::bumps;

const LOAD: f64 = 4e-3;
const FRICTION: f64 = 0.3;

/// The contact of these heights, and its shear.
fn sheared(
    (heights, kernel): (&Field, &dyn Kernel),
    params: &ShearParams,
    solve: &SolveParams,
) -> Result<ShearSolution, ShearError> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(LOAD)).with_kernel(kernel);
    let plan = problem.plan(solve).expect("a plan");
    let again = plan.under(Control::MeanPressure(LOAD)).expect("a plan");
    let normal = plan.solve(&Silent).expect("a normal contact");
    again.shear(&normal, params, &Silent)
}

fn to_energy(error: f64) -> SolveParams {
    SolveParams { tolerance: Tolerance::Energy(error), ..SolveParams::default() }
}

/// A shear by this part of the friction, 20° from x.
fn shear(part: f64, poisson: f64) -> ShearParams {
    let direction = DVec2::from_angle(20.0_f64.to_radians());
    ShearParams { direction, poisson, ..ShearParams::new(FRICTION, part * FRICTION * LOAD) }
}

#[test]
fn without_poissons_ratio_two_normal_contacts_are_the_answer() {
    let (square, oblong) = (bumps(64, 64), bumps(48, 36));
    let accurate = SolveParams::to_tolerance(1e-12);
    for (heights, kernel, solve) in [
        (&square, &Love as &dyn Kernel, accurate.by(Method::Uniform)),
        (&square, &Spectral, accurate),
        (&oblong, &FreeLove, accurate.by(Method::Uniform)),
    ] {
        for part in [0.1, 0.5, 0.95] {
            let found = sheared((heights, kernel), &shear(part, 0.0), &solve).expect("a sheared contact");
            assert_eq!(found.info.rounds, 0);
            // √(G/U) is about the root of the relative overlap that the normal contacts leave.
            assert!(found.info.error < 1e-4, "{} at {part}: {:e}", kernel.name(), found.info.error);
            let mean = found.info.mean_shear / (part * FRICTION * LOAD);
            assert!((mean - 1.0).abs() < 1e-10, "{mean}");
            // The tractions are along the direction of shear.
            for (x, y) in found.traction[0].values().iter().zip(found.traction[1].values()) {
                assert!(DVec2::new(*x, *y).perp_dot(found.direction).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn the_adaptive_mesh_has_the_same_shear_as_the_grid() {
    let heights = bumps(128, 128);
    let of = |method| {
        sheared((&heights, &Love), &shear(0.5, 0.0), &to_energy(1e-3).by(method)).expect("a sheared contact").info
    };
    let (adaptive, uniform) = (of(Method::Adaptive), of(Method::Uniform));
    for (a, u) in [
        (adaptive.displacement, uniform.displacement),
        (adaptive.stick_area, uniform.stick_area),
        (adaptive.slip_work, uniform.slip_work),
    ] {
        assert!((a / u - 1.0).abs() < 2e-3, "{a} and {u}");
    }
}

/// ⟨a·`L_T` b⟩ for the kernel spectral, from direct sums over waves.
fn product(grid: Grid, poisson: f64, a: &[Field; 2], b: &[Field; 2]) -> f64 {
    let n = grid.nx();
    let half = (n / 2) as i64;
    let transform = |field: &Field, k: [i64; 2]| {
        let mut sums = [0.0; 2];
        for (i, value) in field.values().iter().enumerate() {
            let phase = TAU * (k[0] * (i % n) as i64 + k[1] * (i / n) as i64) as f64 / n as f64;
            sums[0] += value * phase.cos();
            sums[1] += value * phase.sin();
        }
        sums.map(|sum| sum / grid.len() as f64)
    };
    let mut sum = 0.0;
    for kx in -half..half {
        for ky in -half..half {
            if [kx, ky] == [0, 0] {
                continue;
            }
            let q = TAU * DVec2::new(kx as f64, ky as f64);
            let [of_a, of_b] = [a, b].map(|fields| fields.each_ref().map(|field| transform(field, [kx, ky])));
            for part in 0..2 {
                let vector = |of: [[f64; 2]; 2]| DVec2::new(of[0][part], of[1][part]);
                let (a, b) = (vector(of_a), vector(of_b));
                // A wave of half the elements has no sign of its direction, and no product of x and y.
                let is_half = kx == -half || ky == -half;
                let unit = q.normalize();
                let along = if is_half { (unit * unit).dot(a * b) } else { unit.dot(a) * unit.dot(b) };
                sum += 2.0 / q.length() * (along + (a.dot(b) - along) / (1.0 - poisson));
            }
        }
    }
    sum
}

#[test]
fn the_bound_contains_the_error_of_a_correction() {
    let (heights, poisson) = (bumps(32, 32), 0.4);
    let of = |tolerance| sheared((&heights, &Spectral), &shear(0.6, poisson), &to_energy(tolerance)).expect("sheared");
    let (rough, fine) = (of(0.1), of(1e-4));
    assert!(fine.info.rounds > rough.info.rounds && fine.info.error <= 1e-4, "{:?}", fine.info);
    let difference = [0, 1].map(|i| {
        let values = rough.traction[i].values().iter().zip(fine.traction[i].values()).map(|(a, b)| a - b);
        Field::new(heights.grid(), values.collect()).expect("a field")
    });
    let grid = heights.grid();
    let error = product(grid, poisson, &difference, &difference).sqrt();
    let energy = 0.5 * product(grid, poisson, &rough.traction, &rough.traction);
    // The pressures of both differ by the error of the normal contact, which is below a tenth of the bound.
    let bound = rough.info.error * energy.sqrt();
    assert!(error <= 1.1 * bound && error > 1e-3 * bound, "{error:e} for the bound {bound:e}");
}

#[test]
fn a_correction_for_poissons_ratio_keeps_force_and_friction() {
    let heights = bumps(64, 64);
    for kernel in [&Love as &dyn Kernel, &FreeLove] {
        let solve = to_energy(1e-3).by(Method::Uniform);
        let found = sheared((&heights, kernel), &shear(0.7, 0.5), &solve).expect("a sheared contact");
        let start = sheared((&heights, kernel), &shear(0.7, 0.0), &solve).expect("a sheared contact");
        assert!(found.info.rounds > 0 && found.info.error <= 1e-3, "{:?}", found.info);
        assert!((found.info.mean_shear / (0.7 * FRICTION * LOAD) - 1.0).abs() < 1e-10);
        // Rubber is softer across the waves than along them, by at most 1/(1 - ν).
        let ratio = found.info.displacement / start.info.displacement;
        assert!(ratio > 1.1 && ratio < 2.0, "{ratio}");
        let slip = found.slip.values().iter().zip(found.traction[0].values()).zip(found.traction[1].values());
        let slips = slip.filter(|((slip, _), _)| **slip > 0.0).count();
        assert!(slips > 50, "{slips}");
    }
}

#[test]
fn a_displacement_gives_the_force_that_gives_it() {
    let heights = bumps(64, 64);
    for (poisson, tolerance, bar) in [(0.0, 1e-4, 1e-6), (0.4, 3e-4, 1e-3)] {
        let by_force = sheared((&heights, &Love), &shear(0.5, poisson), &to_energy(tolerance)).expect("by force").info;
        let control = ShearControl::Displacement(by_force.displacement);
        let params = ShearParams { control, ..shear(0.5, poisson) };
        let by_depth = sheared((&heights, &Love), &params, &to_energy(tolerance)).expect("by displacement").info;
        let ratio = by_depth.mean_shear / by_force.mean_shear;
        assert!((ratio - 1.0).abs() < bar, "ν = {poisson}: {ratio}");
    }
}

#[test]
fn what_slides_or_cannot_be_sheared_is_refused() {
    let heights = bumps(32, 32);
    let of = |params: &ShearParams| sheared((&heights, &Love), params, &SolveParams::default());
    let sliding = of(&shear(1.0, 0.0)).expect_err("the friction of the whole contact");
    assert!(matches!(sliding, ShearError::Sliding { .. }), "{sliding}");
    let far = ShearParams { control: ShearControl::Displacement(1.0), ..shear(0.5, 0.0) };
    assert!(matches!(of(&far).expect_err("far"), ShearError::SlipsAll { .. }));
    for tiny in [shear(1e-10, 0.0), ShearParams { control: ShearControl::Displacement(1e-30), ..shear(0.5, 0.5) }] {
        assert!(matches!(of(&tiny).expect_err("tiny"), ShearError::TooSmall { .. }));
    }
    for wrong in [
        ShearParams { friction: 0.0, ..shear(0.5, 0.0) },
        ShearParams { poisson: 0.6, ..shear(0.5, 0.0) },
        ShearParams { direction: DVec2::splat(1.0), ..shear(0.5, 0.0) },
        ShearParams { control: ShearControl::MeanShear(f64::NAN), ..shear(0.5, 0.0) },
    ] {
        let error = of(&wrong).expect_err("a parameter out of range");
        assert!(matches!(error, ShearError::Parameter { .. }), "{error}");
    }
    let layer = LoveLayer(Layer::on_rigid_base(0.3, 0.3));
    let refused = sheared((&heights, &layer), &shear(0.5, 0.0), &SolveParams::default()).expect_err("a layer");
    assert!(matches!(refused, ShearError::Unsupported(_)), "{refused}");
    let few = SolveParams { memory_limit: Some(100_000), ..SolveParams::default() };
    let memory = sheared((&heights, &Love), &shear(0.5, 0.0), &few).expect_err("little memory");
    assert!(matches!(memory, ShearError::Memory { .. }), "{memory}");
}

#[test]
fn full_contact_sticks_everywhere() {
    let heights = Field::from_fn(Grid::square(32).expect("a grid"), |at| 1e-4 * (TAU * at.x).cos());
    let found = sheared((&heights, &Spectral), &shear(0.5, 0.3), &SolveParams::default()).expect("a sheared contact");
    assert_eq!((found.info.slip_area, found.info.stick_area, found.info.error), (0.0, 1.0, 0.0));
    assert!(found.info.stiffness.is_infinite() && found.info.displacement.abs() < 1e-15);
    assert!((found.traction[0].min() / found.traction[0].max() - 1.0).abs() < 1e-9);
}

#[test]
fn the_digits_do_not_depend_on_the_number_of_threads() {
    let heights = bumps(64, 64);
    let of = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| sheared((&heights, &Love), &shear(0.6, 0.3), &to_energy(3e-3)).expect("sheared"))
    };
    let (one, three) = (of(1), of(3));
    assert!(one.info.rounds > 0);
    assert_eq!(one, three);
}

/// The displacement of the whole contact is that of the body far away, minus what the tractions displace.
#[test]
fn elements_that_stick_move_together() {
    let heights = bumps(64, 64);
    let solve = SolveParams::to_tolerance(1e-12).by(Method::Uniform);
    let found = sheared((&heights, &Love), &shear(0.4, 0.0), &solve).expect("a sheared contact");
    let operator = UniformOperator::new(heights.grid(), &Love);
    let mut displaced = Field::zeros(heights.grid());
    operator.apply(found.traction[0].values(), displaced.values_mut(), &mut []);
    let scale = found.info.displacement * found.direction.x;
    let (mut sticking, mut slipping) = (0, 0);
    for ((v, slip), t) in displaced.values().iter().zip(found.slip.values()).zip(found.traction[0].values()) {
        let left = (scale - v) / scale;
        if *slip > 0.0 {
            slipping += 1;
            assert!(left > -1e-6, "slip against the shear: {left}");
        } else if *t > 0.0 {
            sticking += 1;
            assert!(left.abs() < 1e-5, "{left} where it sticks");
        }
    }
    assert!(sticking > 100 && slipping > 100, "{sticking} stick, {slipping} slip");
}
