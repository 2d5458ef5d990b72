//! Pressures between zero and a hardness.
//!
//! They are compared with elimination, a direct certificate, and known limits.

use std::f64::consts::TAU;

use rc_core::testing::quasi_random;
use rc_core::{DVec2, Field, Grid, HeightField as _, Operator, Silent};
use rc_kernel::Love;
use rc_solver::{
    ContactProblem, Control, DirectSum, Feature, Method, ProblemError, Solution, SolveError, SolveParams,
    solve_dense_with_hardness,
};

use crate::bumps;

fn solve<'a>(
    heights: &'a Field,
    control: Control,
    hardness: f64,
    params: &SolveParams,
) -> Result<Solution<'a>, SolveError> {
    ContactProblem::new(heights, control).with_hardness(hardness).solve(params, &Silent)
}

/// Waves up to `n` per cell with the amplitudes of a self-affine surface.
pub(crate) fn rough(seed: usize, side: usize, n: i32) -> Field {
    let waves: Vec<(f64, f64, f64, f64)> = (-n..=n)
        .flat_map(|ky| (0..=n).map(move |kx| (kx, ky)))
        .filter(|&(kx, ky)| (kx, ky) != (0, 0) && kx * kx + ky * ky <= n * n)
        .enumerate()
        .map(|(i, (kx, ky))| {
            let k = f64::from(kx).hypot(f64::from(ky));
            (1e-3 * k.powf(-1.8), f64::from(kx), f64::from(ky), quasi_random(101 * seed + 37 * i * i))
        })
        .collect();
    let height =
        |at: DVec2| waves.iter().map(|(a, kx, ky, phase)| a * (TAU * (kx * at.x + ky * at.y + phase)).cos()).sum();
    Field::from_fn(Grid::square(side).expect("a grid"), height)
}

/// Violations of the conditions of a hardness, from only the pressure.
///
/// The first is the maximum overlap of elements that could press more. The second is the maximum gap of elements that
/// could press less. Both are relative to the mean gap of elements between the bounds, in units of the height range.
fn violations(heights: &Field, pressure: &Field, hardness: f64) -> [f64; 2] {
    let mut v = vec![0.0; heights.grid().len()];
    DirectSum::new(heights.grid(), &Love).apply(pressure.values(), &mut v, &mut []);
    let gaps: Vec<(f64, f64)> =
        v.iter().zip(heights.values()).zip(pressure.values()).map(|((v, h), p)| (*p, v - h)).collect();
    let between: Vec<f64> = gaps.iter().filter(|(p, _)| *p > 0.0 && *p < hardness).map(|(_, g)| *g).collect();
    let contact = between.iter().sum::<f64>() / between.len().max(1) as f64;
    let range = heights.max() - heights.min();
    let overlap = gaps.iter().filter(|(p, _)| *p < hardness).map(|(_, g)| contact - g).fold(0.0, f64::max);
    let gap = gaps.iter().filter(|(p, _)| *p > 0.0).map(|(_, g)| g - contact).fold(0.0, f64::max);
    [overlap / range, gap / range]
}

#[test]
fn a_hardness_that_nothing_reaches_changes_no_bit() {
    let heights = rough(1, 256, 8);
    for method in [Method::Uniform, Method::Adaptive] {
        let params = SolveParams::default().by(method);
        let depth = solve(&heights, Control::MeanPressure(1e-3), f64::INFINITY, &params).expect("solvable");
        let depth = Control::Penetration(depth.info().penetration);
        for control in [Control::MeanPressure(2e-4), Control::MeanPressure(6e-3), depth] {
            let elastic = solve(&heights, control, f64::INFINITY, &params).expect("solvable");
            let hard = solve(&heights, control, 1e3, &params).expect("solvable");
            let what = format!("{method}, {control:?}");
            assert_eq!(elastic.info(), hard.info(), "{what}");
            assert!(elastic.pressure() == hard.pressure() && elastic.gap() == hard.gap(), "{what}");
            assert_eq!(elastic.stiffness().to_bits(), hard.stiffness().to_bits(), "{what}");
            let (a, b) = (elastic.observables(), hard.observables());
            assert_eq!(
                (a.area, a.rms_pressure_error, a.mean_gap),
                (b.area, b.rms_pressure_error, b.mean_gap),
                "{what}"
            );
            let plastic = b.plastic.expect("a hardness is given");
            assert!(
                plastic.fraction.abs() + plastic.mean_gap.abs() + plastic.cells.abs() < 1e-12,
                "{what}: {plastic:?}"
            );
            assert!(a.plastic.is_none() && hard.plastic_gap().max() <= 0.0, "{what}");
        }
    }
}

/// The first overlap, in λ, is above the hardness in E*. The two units have nothing to do with each other.
#[test]
fn a_hardness_below_the_first_overlap_changes_no_bit() {
    let wave = |at: DVec2| 5e-3 * ((TAU * at.x).cos() + (TAU * at.y).cos());
    let heights = Field::from_fn(Grid::square(64).expect("a grid"), wave);
    for control in [Control::MeanPressure(1e-7), Control::MeanPressure(1e-6)] {
        let solve = |hardness| solve(&heights, control, hardness, &SolveParams::default().by(Method::Uniform));
        let (elastic, hard) = (solve(f64::INFINITY).expect("solvable"), solve(4e-3).expect("solvable"));
        assert!(elastic.pressure().max() < 2e-3, "{:e}", elastic.pressure().max());
        assert_eq!((elastic.info(), elastic.pressure()), (hard.info(), hard.pressure()), "{control:?}");
    }
}

#[test]
fn pressures_are_those_of_elimination() {
    for (nx, ny) in [(16, 16), (12, 20)] {
        let heights = bumps(nx, ny);
        let range = heights.max() - heights.min();
        for depth in [0.2, 0.4, 0.55] {
            let control = Control::Penetration(depth * range);
            let params = SolveParams::to_tolerance(1e-10).by(Method::Uniform);
            let elastic = solve(&heights, control, f64::INFINITY, &params);
            let peak = elastic.map_or(0.05, |solution| solution.pressure().max());
            for part in [0.9, 0.3, 0.02] {
                let (hardness, what) = (part * peak, format!("{nx} x {ny}, depth {depth}, {part} of the peak"));
                let exact = solve_dense_with_hardness(&heights, &Love, depth * range, hardness);
                let exact = exact.expect("in range").expect("an active set");
                let by_load = Control::MeanPressure(exact.mean());
                for control in [control, by_load] {
                    let found = solve(&heights, control, hardness, &params).expect(&what);
                    let differences = found.pressure().values().iter().zip(exact.values()).map(|(a, b)| (a - b).abs());
                    let error = differences.fold(0.0, f64::max) / hardness;
                    assert!(error < 1e-6, "{what}, {control:?}: the pressure is off by {error:e} of the hardness");
                    let penetration = found.info().penetration / (depth * range);
                    // If every element is at a bound, a load has a range of penetrations.
                    let is_unique = exact.values().iter().any(|p| *p > 0.0 && *p < hardness);
                    assert!(
                        !is_unique || (penetration - 1.0).abs() < 1e-7,
                        "{what}, {control:?}: penetration {penetration}"
                    );
                }
            }
        }
    }
}

/// Random scenes: heights, cell, load and hardness.
#[test]
fn bounds_are_kept_exactly_and_the_certificate_is_true() {
    for seed in 0..24 {
        let random = |i: usize| quasi_random(1000 * seed + i);
        let (nx, ny) = (12 + (random(1) * 20.0) as usize, 12 + (random(2) * 20.0) as usize);
        let grid = Grid::new(nx, ny).expect("a grid");
        let smooth = bumps(nx, ny);
        let noise = 10.0_f64.powf(-5.0 + 3.0 * random(3));
        let heights = (0..grid.len()).map(|i| smooth.values()[i] + noise * quasi_random(77 * seed + 3 * i * i + i));
        let heights = Field::new(grid, heights.collect()).expect("a value for each element");
        let hardness = 10.0_f64.powf(-4.0 + 3.0 * random(4));
        let mean = hardness * (0.01 + 0.98 * random(5));
        let what = format!("seed {seed}: {nx} x {ny}, noise {noise:.1e}, hardness {hardness:.2e}, mean {mean:.2e}");
        let params = SolveParams::to_tolerance(1e-8).by(Method::Uniform);
        let by_load = solve(&heights, Control::MeanPressure(mean), hardness, &params).expect(&what);
        let depth = Control::Penetration(by_load.info().penetration);
        let by_depth = solve(&heights, depth, hardness, &params).expect(&what);
        for found in [&by_load, &by_depth] {
            let pressure = found.pressure();
            assert!(pressure.min() >= 0.0 && pressure.max() <= hardness, "{what}: {}", pressure.max() / hardness);
            let [overlap, gap] = violations(&heights, pressure, hardness);
            // The mean gap is not weighted here.
            assert!(overlap < 1e-7 && gap < 1e-6, "{what}: overlap {overlap:e}, gap {gap:e}");
            assert!(found.certificate().meets(found.bound()), "{what}");
            assert!(found.gap().min() > -1e-7 * (heights.max() - heights.min()), "{what}: {}", found.gap().min());
        }
        assert!((by_load.pressure().mean() / mean - 1.0).abs() < 1e-10, "{what}");
        assert!(
            (by_depth.pressure().mean() / mean - 1.0).abs() < 1e-4,
            "{what}: {}",
            by_depth.pressure().mean() / mean
        );
    }
}

#[test]
fn tiles_find_what_the_grid_finds() {
    let heights = rough(2, 512, 16);
    let mean = 5e-4;
    let on_grid = SolveParams::default().by(Method::Uniform);
    let peak =
        solve(&heights, Control::MeanPressure(mean), f64::INFINITY, &on_grid).expect("solvable").pressure().max();
    for part in [0.9, 0.5, 0.15, 0.05] {
        let hardness = part * peak;
        let uniform = solve(&heights, Control::MeanPressure(mean), hardness, &on_grid).expect("solvable");
        let depth = Control::Penetration(uniform.info().penetration);
        for control in [Control::MeanPressure(mean), depth] {
            let what = format!("{part} of the peak, {control:?}");
            let tiles = solve(&heights, control, hardness, &on_grid.by(Method::Adaptive)).expect(&what);
            assert!(tiles.pressure().max() <= hardness, "{what}");
            let (a, b) = (tiles.observables(), uniform.observables());
            let (p, q) = (a.plastic.expect("hard"), b.plastic.expect("hard"));
            let pairs = [
                ("mean pressure", tiles.info().mean_pressure, uniform.info().mean_pressure, 1e-3),
                ("penetration", tiles.info().penetration, uniform.info().penetration, 2e-4),
                ("area", a.area.fraction, b.area.fraction, 2e-3),
                ("area by counting", a.area.cells, b.area.cells, 2e-3),
                ("plastic area", p.fraction, q.fraction, 5e-3),
                ("plastic area by counting", p.cells, q.cells, 5e-3),
                ("plastic flow", p.mean_gap, q.mean_gap, 5e-3),
                ("mean gap", a.mean_gap, b.mean_gap, 2e-3),
                ("stiffness", tiles.stiffness(), uniform.stiffness(), 2e-2),
            ];
            for (name, found, expected, tolerance) in pairs {
                assert!((found / expected - 1.0).abs() < tolerance, "{what}: {name} {found} for {expected}");
            }
            assert!(a.max_pressure <= hardness && p.error > 0.0, "{what}");
            let [flow, gap] = [tiles.plastic_gap(), tiles.gap()];
            assert!(flow.min() >= 0.0 && (flow.mean() / p.mean_gap - 1.0).abs() < 1e-3, "{what}: {}", flow.mean());
            assert!((gap.mean() / a.mean_gap - 1.0).abs() < 1e-3, "{what}: mean gap {}", gap.mean());
        }
    }
}

#[test]
fn the_softest_surface_is_plastic_wherever_it_touches() {
    let heights = rough(3, 256, 8);
    let params = SolveParams::default();
    for mean in [2e-7, 2e-6] {
        let elastic = solve(&heights, Control::MeanPressure(mean), f64::INFINITY, &params).expect("solvable");
        // A thousandth of the pressures of an elastic contact.
        let hardness = 1e-3 * elastic.pressure().max().max(2e-2);
        let solution = solve(&heights, Control::MeanPressure(mean), hardness, &params).expect("solvable");
        let (area, plastic) = (solution.area(), solution.observables().plastic.expect("hard"));
        let limit = mean / hardness;
        assert!((area.cells / limit - 1.0).abs() < 0.3 && area.cells >= limit, "{} for {limit}", area.cells);
        assert!((area.fraction - limit).abs() < 2.0 * area.error + 0.1 * limit, "{area:?} for {limit}");
        assert!(plastic.fraction <= area.fraction + area.error, "{plastic:?}, {area:?}");
    }
}

#[test]
fn every_load_below_the_hardness_is_borne() {
    let heights = rough(4, 128, 8);
    let params = SolveParams::default().by(Method::Uniform);
    let hardness = 5e-3;
    let mut last = 0.0;
    for part in [0.1, 0.5, 0.9, 0.99, 0.9999] {
        let mean = part * hardness;
        let solution = solve(&heights, Control::MeanPressure(mean), hardness, &params).expect("solvable");
        let (area, plastic) = (solution.area().cells, solution.observables().plastic.expect("hard"));
        assert!(area > last && area >= part, "{part}: area {area} after {last}");
        assert!(plastic.cells <= part, "{part}: {plastic:?}");
        last = area;
        let depth = Control::Penetration(solution.info().penetration);
        let again = solve(&heights, depth, hardness, &params).expect("solvable");
        let found = again.info().mean_pressure;
        assert!((found / mean - 1.0).abs() < 1e-3, "{part}: {found} for {mean}");
    }
}

/// Cells that only fill the tiles of a border level are not elements.
///
/// They bear no pressure, and their area is not counted.
#[test]
fn near_full_contact_with_border_levels_bears_its_load() {
    struct Waves;
    impl rc_core::HeightField for Waves {
        fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
            5e-3 * (TAU * x).cos() + 4e-3 * (TAU * (x + 2.0 * y)).cos() + 6e-4 * (TAU * (5.0 * x - 4.0 * y)).cos()
        }
        fn band_limit(&self) -> Option<usize> {
            Some(7)
        }
    }
    let grid = Grid::square(320).expect("a grid");
    let solve = |control: Control, hardness: f64, params: &SolveParams| {
        ContactProblem::new(Waves.on(grid), control).with_hardness(hardness).solve(params, &Silent)
    };
    let hardness = 2e-2;
    let params = SolveParams { border_level: 2, ..SolveParams::default().by(Method::Adaptive) };
    for part in [0.5, 0.9, 0.99, 0.9999] {
        let mean = part * hardness;
        let on_grid = SolveParams::default().by(Method::Uniform);
        let on_grid = solve(Control::MeanPressure(mean), hardness, &on_grid).expect("solvable");
        let solution = solve(Control::MeanPressure(mean), hardness, &params).expect("solvable");
        let (found, expected) = (solution.observables(), on_grid.observables());
        let (pressure, plastic) = (solution.pressure(), found.plastic.expect("hard"));
        assert!((pressure.mean() / mean - 1.0).abs() < 1e-9, "{part}: mean {}", pressure.mean());
        assert!(pressure.max() <= hardness && pressure.min() >= 0.0, "{part}: up to {}", pressure.max());
        let sides: Vec<f64> = solution.elements().expect("tiles").map(|element| element.side).collect();
        let [least, most] = [sides.iter().copied().fold(1.0, f64::min), sides.iter().copied().fold(0.0, f64::max)];
        assert!(least < 0.3 * grid.spacing().x && most > 1.5 * least, "{part}: sides from {least} to {most}");
        let [area, of_grid] = [found.area.cells, expected.area.cells];
        assert!(area >= part && area <= 1.0 && (area / of_grid - 1.0).abs() < 5e-3, "{part}: {area} for {of_grid}");
        let of_grid = expected.plastic.expect("hard").cells;
        assert!(plastic.cells <= part && (plastic.cells - of_grid).abs() < 1e-2, "{part}: {plastic:?} for {of_grid}");
    }
}

#[test]
fn what_a_hardness_cannot_bear_is_refused() {
    let heights = bumps(16, 16);
    let params = SolveParams::default();
    let error = |control, hardness, params: &SolveParams| match solve(&heights, control, hardness, params) {
        Err(SolveError::Problem(error)) => error,
        other => panic!("{other:?}"),
    };
    for mean in [1e-3, 2e-3] {
        let found = error(Control::MeanPressure(mean), 1e-3, &params);
        assert_eq!(found, ProblemError::TooSoft { value: mean, hardness: 1e-3 });
    }
    for hardness in [0.0, -1.0, f64::NAN] {
        let found = error(Control::MeanPressure(1e-3), hardness, &params);
        assert!(matches!(found, ProblemError::Hardness { .. }), "{found:?}");
    }
    let found = error(Control::Penetration(1.0), 1e-3, &params);
    assert!(matches!(found, ProblemError::FullyPlastic { .. }), "{found:?}");
    let procedure = solve(&heights, Control::MeanPressure(1e-4), 1e-3, &params.by(Method::GaussSeidel));
    assert!(
        matches!(&procedure, Err(SolveError::Unsupported(refusal)) if refusal.object == Feature::Hardness),
        "{procedure:?}"
    );
}

#[test]
fn a_flat_surface_bears_what_is_below_its_hardness() {
    let heights = Field::from_fn(Grid::square(32).expect("a grid"), |_| 0.3);
    let solution = solve(&heights, Control::MeanPressure(1e-3), 1.1e-3, &SolveParams::default()).expect("solvable");
    assert!(solution.pressure().values().iter().all(|p| (p - 1e-3).abs() < 1e-15));
    assert!(solution.observables().plastic.expect("hard").fraction <= 0.0);
}

/// A contact is the same problem when heights, load and hardness change by one factor.
///
/// Another program does not converge from a load of 0.07 E* on.
#[test]
fn pressures_of_the_order_of_e_star_take_no_more_iterations() {
    let gentle = rough(5, 128, 8);
    let params = SolveParams::default().by(Method::Uniform);
    for (mean, hardness) in [(2e-3, 4e-3), (4e-3, 8e-3), (8e-3, 1.6e-2)] {
        let small = solve(&gentle, Control::MeanPressure(mean), hardness, &params).expect("solvable");
        for factor in [35.0, 350.0] {
            let steep = gentle.values().iter().map(|h| factor * h).collect();
            let steep = Field::new(gentle.grid(), steep).expect("a value for each element");
            let control = Control::MeanPressure(factor * mean);
            let large = solve(&steep, control, factor * hardness, &params).expect("solvable");
            let [a, b] = [&small, &large].map(|solution| solution.info().fine_iterations());
            assert!(b <= a + 2 && b <= 20, "{b} iterations at a load of {} E*, {a} at {mean} E*", factor * mean);
            let [a, b] = [&small, &large].map(|solution| solution.observables().plastic.expect("hard").cells);
            assert!((a - b).abs() < 1e-3 * a, "{b} for {a}");
        }
    }
}

/// In long cells a small change of the load of one place displaces everything, and steps may be far too long.
#[test]
fn long_cells_with_a_hardness_converge() {
    let ratio = 64;
    let grid = Grid::in_cell(32, 32 * ratio, ratio as f64).expect("a grid");
    for seed in 0..3 {
        let height =
            |(at, i): (f64, usize)| 0.035 * quasi_random(i * i * 101 + seed * i) + 0.02 * (3.0 * TAU * at).sin();
        let along = |i: usize| (i / grid.nx()) as f64 / grid.ny() as f64;
        let heights = Field::new(grid, (0..grid.len()).map(|i| height((along(i), i))).collect()).expect("a field");
        let range = heights.max() - heights.min();
        for control in [Control::MeanPressure(0.09), Control::MeanPressure(0.03), Control::Penetration(0.5 * range)] {
            let solution = solve(&heights, control, 0.1, &SolveParams::default()).expect("it converges");
            assert!(solution.observables().plastic.expect("hard").fraction > 0.0, "{control:?}, {seed}");
        }
    }
}
