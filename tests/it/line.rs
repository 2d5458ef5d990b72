//! Line contact: profiles, which are grids of one row, in plane strain.

use std::f64::consts::{PI, TAU};

use rc_core::testing::quasi_random;
use rc_core::{Field, Grid, Kernel};
use rc_kernel::{Love, Spectral};
use rc_solver::{Control, Method, Solution, SolveParams, Status, solve};
use rc_theory::westergaard::Westergaard;

use crate::{assert_close, solved};

const KERNELS: [&dyn Kernel; 2] = [&Love, &Spectral];

fn profile(n: usize, height: impl Fn(f64) -> f64 + Sync) -> Field {
    Field::from_fn(Grid::new(n, 1).expect("a grid"), |at| height(at.x))
}

/// A periodic profile with `waves` waves of random phases, whose amplitudes fall as k^-1.3 (Hurst exponent 0.8).
fn rough(n: usize, waves: usize, seed: usize) -> Field {
    let wave = |k: usize| ((k as f64).powf(-1.3), quasi_random(1000 * seed + k));
    let waves: Vec<(f64, f64)> = (1..=waves).map(wave).collect();
    profile(n, |x| {
        let height =
            |(i, (amplitude, phase)): (usize, &(f64, f64))| amplitude * (TAU * ((i + 1) as f64 * x + phase)).cos();
        1e-3 * waves.iter().enumerate().map(height).sum::<f64>()
    })
}

/// Fails unless pressure and gap are those of a contact, and the certificate holds.
fn assert_is_contact(solution: &Solution<'_>, name: &str) {
    let (pressure, gap) = (solution.pressure().values(), solution.gap().values());
    assert!(pressure.iter().all(|p| *p >= 0.0) && gap.iter().all(|g| *g >= 0.0), "{name}");
    assert!(solution.certificate().meets(solution.bound()), "{name}: {:?}", solution.certificate());
    let (mean, given) = (solution.pressure().mean(), solution.info().mean_pressure);
    assert!((mean / given - 1.0).abs() < 1e-10, "{name}: mean {mean} for {given}");
}

#[test]
fn waves_are_those_of_westergaard_at_every_load() {
    let wave = Westergaard { amplitude: 1e-3 };
    let heights = profile(4096, |x| 1e-3 * (TAU * x).cos());
    for kernel in KERNELS {
        for part in [0.02, 0.1, 0.5, 0.9] {
            let load = part * wave.full_contact_pressure();
            let solution = solved(&heights, kernel, Control::MeanPressure(load), 1e-10);
            assert_is_contact(&solution, kernel.name());
            let (area, exact) = (solution.area(), wave.area_fraction(load));
            assert!((exact - 2.0 / PI * part.sqrt().asin()).abs() < 1e-12);
            assert!((area.fraction - exact).abs() < area.error.min(3e-4), "{}: {area:?} for {exact}", kernel.name());
            assert_close("penetration", solution.info().penetration, wave.penetration(load), 1e-4);
            assert_close("mean gap", solution.observables().mean_gap, wave.mean_gap(load), 1e-4);
            let by_depth = Control::Penetration(solution.info().penetration);
            let again = solved(&heights, kernel, by_depth, 1e-10);
            assert_close("load", again.info().mean_pressure, load, 1e-5);
        }
    }
}

/// The load F per length on a cylinder: a² = 4FR/(π E*), p0 = 2F/(π a). Images at the distance of the cell bend the
/// surface by (π a)²/6 of the curvature.
#[test]
fn a_cylinder_in_a_long_cell_is_that_of_hertz() {
    let (n, radius, force) = (1 << 16, 1.0, 1e-4);
    let heights = profile(n, |x| -(x - 0.5).powi(2) / (2.0 * radius));
    let half_width = (4.0 * force * radius / PI).sqrt();
    for kernel in KERNELS {
        let solution = solved(&heights, kernel, Control::MeanPressure(force), 1e-9);
        assert_is_contact(&solution, kernel.name());
        let images = (PI * half_width).powi(2);
        assert_close("width", solution.area().fraction, 2.0 * half_width, images);
        assert_close("peak", solution.pressure().max(), 2.0 * force / (PI * half_width), images);
    }
}

#[test]
fn full_contact_has_the_pressures_of_all_waves() {
    let heights = rough(1000, 16, 1);
    let load = 1.0;
    let solution = solve(&heights, Control::MeanPressure(load), &SolveParams::default().by(Method::Uniform));
    let solution = solution.expect("solvable");
    assert_eq!(solution.status(), Status::FullContact);
    assert!((solution.area().fraction - 1.0).abs() < 1e-12);
    // Each wave has the pressure amplitude q h/2, and its root mean square is that over √2.
    let square: f64 = (1..=16).map(|k| 0.5 * (0.5 * TAU * f64::from(k) * 1e-3 * f64::from(k).powf(-1.3)).powi(2)).sum();
    let exact = square.mul_add(1.0, load * load).sqrt();
    assert_close("rms pressure", solution.observables().rms_pressure_corrected, exact, 1e-6);
}

#[test]
fn profiles_of_any_number_of_points_are_solved() {
    for n in [1, 2, 3, 17, 97, 100, 1001, 4099] {
        let heights = rough(n, 5, 2);
        for kernel in KERNELS {
            let solution = solved(&heights, kernel, Control::MeanPressure(3e-4), 1e-6);
            assert_is_contact(&solution, &format!("{} on {n}", kernel.name()));
        }
    }
}

#[test]
fn a_million_points_are_solved_and_do_not_depend_on_threads() {
    let n = 1 << 20;
    // Waves on all scales down to 32 elements, each twice as high per octave as a profile of the Hurst exponent 1 has.
    let octaves: Vec<(f64, f64, f64)> =
        (0..16).map(|i| (f64::from(1 << i), 2_f64.powi(-i).powf(0.8), quasi_random(i as usize))).collect();
    let heights = profile(n, |x| {
        1e-3 * octaves.iter().map(|(k, amplitude, phase)| amplitude * (TAU * (k * x + phase)).cos()).sum::<f64>()
    });
    let params = SolveParams::default();
    let solve_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| solve(&heights, Control::MeanPressure(5e-4), &params).expect("solvable").into_owned())
    };
    let (one, two) = (solve_on(1), solve_on(2));
    assert_is_contact(&one, "2^20");
    assert_eq!(one.pressure(), two.pressure());
}

/// Area, rms pressure and mean gap, each with its bar.
fn bars(solution: &Solution<'_>) -> [(f64, f64); 3] {
    let found = solution.observables();
    [
        (found.area.fraction, found.area.error),
        (found.rms_pressure_corrected, found.rms_pressure_error.expect("a bar")),
        (found.mean_gap, found.mean_gap_error),
    ]
}

/// Each bar holds the change to a grid 32 times as fine in 95 % of the profiles, and bars are not idle.
#[test]
fn error_bars_hold_the_change_to_a_fine_grid() {
    const WAVES: usize = 48;
    for kernel in KERNELS {
        let (mut misses, mut squares, mut all) = ([0; 3], [0.0; 3], 0);
        for elements in [4, 8, 16] {
            for (seed, load) in (0..12).flat_map(|seed| [1e-4, 5e-4, 2e-3].map(|load| (seed, load))) {
                let at = |n: usize| solved(&rough(n, WAVES, seed), kernel, Control::MeanPressure(load), 1e-8);
                let (coarse, fine) = (at(WAVES * elements), at(WAVES * elements * 32));
                for (i, (found, exact)) in bars(&coarse).into_iter().zip(bars(&fine)).enumerate() {
                    let change = (found.0 - exact.0).abs();
                    misses[i] += usize::from(change > found.1);
                    squares[i] += (change / found.1).powi(2);
                }
                all += 1;
            }
        }
        let sizes = squares.map(|sum: f64| (sum / all as f64).sqrt());
        let told = format!("{}: {misses:?} of {all} missed, rms of change/bar {sizes:.3?}", kernel.name());
        assert!(misses.iter().all(|missed| 20 * missed <= all), "{told}");
        assert!(sizes.iter().all(|size| *size > 0.1), "{told}");
    }
}
