//! Ends of power laws that are known: roll-off, cut-off, noise, lens, tip.

use std::f64::consts::{PI, TAU};

use rc_core::{Field, Grid};
use rc_fractal::{HurstFit, Limit, Measured, SpectrumParams, fit_hurst, radial_spectrum};

use crate::surface;

/// Points per side of the maps.
const POINTS: usize = 512;
const NYQUIST: f64 = 0.5 * POINTS as f64;
const PERIODIC: Measured = Measured { nyquist: NYQUIST, longest: 1.0, windowed: false };

fn map(hurst: f64, roll_off: f64, waves: usize, seed: u64) -> Field {
    let params = SpectrumParams { hurst, roll_off, ..SpectrumParams::paper(waves, seed) };
    let amplitudes = rc_fractal::Amplitudes::Random;
    surface(SpectrumParams { amplitudes, ..params })
        .sample_on(Grid::square(POINTS).expect("a grid"))
        .expect("resolved waves")
}

fn fit_of(heights: &Field) -> Option<HurstFit> {
    fit_hurst(&radial_spectrum(heights), &PERIODIC)
}

/// The map with Gaussian noise of this standard deviation at each point.
fn noisy(mut map: Field, deviation: f64, seed: u64) -> Field {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    for height in map.values_mut() {
        *height += deviation * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0);
    }
    map
}

/// The map under a lens: a Gaussian mean with this standard deviation, in points.
fn blurred(map: &Field, sigma: f64) -> Field {
    let reach = (5.0 * sigma).ceil() as isize;
    let weights: Vec<f64> = (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let n = POINTS as isize;
    let along = |values: &[f64], x: isize, y: isize| {
        let at = |i: isize, j: isize| values[(j.rem_euclid(n) * n + i.rem_euclid(n)) as usize];
        (-reach..=reach).zip(&weights).map(|(d, w)| w * at(x + d, y)).sum::<f64>() / total
    };
    let mut values = map.values().to_vec();
    for _ in 0..2 {
        // Along x, and with the axes exchanged.
        values = (0..n * n).map(|i| along(&values, i / n, i % n)).collect();
    }
    Field::new(map.grid(), values).expect("a field")
}

/// The map as a paraboloid of this radius (λ) feels it.
fn dilated(map: &Field, radius: f64) -> Field {
    let range = map.max() - map.min();
    let n = POINTS as isize;
    let reach = ((2.0 * radius * range).sqrt() * POINTS as f64).ceil() as isize;
    let values = map.values();
    let at = |x: isize, y: isize| values[(y.rem_euclid(n) * n + x.rem_euclid(n)) as usize];
    let drop = |d: isize| (d as f64 / POINTS as f64).powi(2) / (2.0 * radius);
    // The paraboloid is a sum of two parabolas, so that each axis is dilated in turn.
    let once = |at: &dyn Fn(isize, isize) -> f64| -> Vec<f64> {
        let felt = |x, y| (-reach..=reach).map(|d| at(x + d, y) - drop(d)).fold(f64::NEG_INFINITY, f64::max);
        (0..n * n).map(|i| felt(i % n, i / n)).collect()
    };
    let along_x = once(&at);
    let exchanged = once(&|y, x| along_x[(y.rem_euclid(n) * n + x.rem_euclid(n)) as usize]);
    let back = (0..n * n).map(|i| exchanged[((i % n) * n + i / n) as usize]).collect();
    Field::new(map.grid(), back).expect("a field")
}

/// The middle quarter of a map of twice the side, under Hann's window, with a `tilt` (λ) over its side.
fn windowed(big: &Field, tilt: f64) -> Field {
    let n = POINTS;
    let at = |i: usize| ((i % n) as f64 + 0.5) / n as f64;
    let part = |i: usize| big.values()[(i / n + n / 2) * 2 * n + i % n + n / 2] + tilt * at(i);
    let mean = (0..n * n).map(part).sum::<f64>() / (n * n) as f64;
    let hann = |at: f64| (8.0_f64 / 3.0).sqrt() * (PI * at).sin().powi(2);
    let value = |i: usize| (part(i) - mean) * hann(at(i)) * hann(at(i / n));
    Field::new(Grid::square(n).expect("a grid"), (0..n * n).map(value).collect()).expect("a field")
}

fn assert_hurst(fit: &HurstFit, hurst: f64, within: f64, what: &str) {
    assert!((fit.hurst - hurst).abs() < within, "{what}: H = {hurst}, {fit:?}");
    assert!((fit.hurst - hurst).abs() < 3.0 * fit.hurst_error, "{what}: H = {hurst}, {fit:?}");
}

/// `None` for a roll-off at the longest wave, else within a factor of 1.35.
fn assert_roll_off(fit: &HurstFit, roll_off: f64, what: &str) {
    match fit.roll_off {
        Some(found) => assert!(roll_off > 1.0 && (found / roll_off).ln().abs() < 1.35_f64.ln(), "{what}: {fit:?}"),
        None => assert!(roll_off <= 1.0, "{what}: {fit:?}"),
    }
}

fn assert_resolution(fit: &HurstFit, wavenumber: f64, limit: Limit, within: f64, what: &str) {
    let Some((found, why)) = fit.resolution else { panic!("{what}: {fit:?}") };
    assert!(why == limit && (found / wavenumber - 1.0).abs() < within, "{what}: {wavenumber}, {fit:?}");
}

/// Exponents, roll-offs and seeds.
fn cases() -> impl Iterator<Item = (f64, f64, u64)> {
    [0.3, 0.5, 0.8].into_iter().flat_map(|hurst| [(hurst, 1.0, 1), (hurst, 4.0, 2), (hurst, 8.0, 3)])
}

#[test]
fn roll_off_and_cut_off_are_found_and_not_invented() {
    for (hurst, roll_off, seed) in cases() {
        for waves in [64, 128] {
            let what = format!("N = {waves}, roll-off {roll_off}");
            let fit = fit_of(&map(hurst, roll_off, waves, seed)).expect("a law");
            assert_hurst(&fit, hurst, 0.06, &what);
            assert_roll_off(&fit, roll_off, &what);
            let cut_off = fit.cut_off.expect("a cut-off");
            assert!((cut_off / waves as f64 - 1.0).abs() < 0.02, "{what}: {fit:?}");
            assert_resolution(&fit, NYQUIST, Limit::Grid, 1e-12, &what);
        }
        let fit = fit_of(&map(hurst, roll_off, 250, seed)).expect("a law");
        assert_hurst(&fit, hurst, 0.04, "all waves");
        assert_eq!(fit.cut_off, None, "the grid resolves no cut-off at N = 250");
        assert_resolution(&fit, NYQUIST, Limit::Grid, 1e-12, "all waves");
    }
}

#[test]
fn noise_and_a_lens_limit_the_resolution() {
    for (hurst, roll_off, seed) in cases() {
        let map = map(hurst, roll_off, 250, seed);
        // The noise is as strong as the law at 60 waves.
        let psd = radial_spectrum(&map)[59].psd;
        let deviation = (psd * TAU * TAU).sqrt() * POINTS as f64;
        let fit = fit_of(&noisy(map.clone(), deviation, seed)).expect("a law");
        assert_hurst(&fit, hurst, 0.06, "noise");
        assert_roll_off(&fit, roll_off, "noise");
        assert_resolution(&fit, 60.0, Limit::Noise, 0.1, "noise");
        assert_eq!(fit.cut_off, None, "noise hides a cut-off");
        // exp(-q²σ²) = ½.
        let sigma = 2.0;
        let half = POINTS as f64 * 2.0_f64.ln().sqrt() / (TAU * sigma);
        let lens = blurred(&map, sigma);
        for (heights, what) in [(lens.clone(), "lens"), (noisy(lens, 0.3 * deviation, seed), "lens and noise")] {
            let fit = fit_of(&heights).expect("a law");
            assert_hurst(&fit, hurst, 0.1, what);
            assert_roll_off(&fit, roll_off, what);
            assert_resolution(&fit, half, Limit::Blunt, 0.1, what);
            assert_eq!(fit.cut_off, None, "{what}");
        }
    }
}

#[test]
fn a_tip_limits_the_resolution() {
    for (roll_off, seed) in [(1.0, 1), (4.0, 2), (8.0, 3)] {
        let map = map(0.3, roll_off, 250, seed);
        let [sharp, blunt] = [0.01, 0.05].map(|radius| fit_of(&dilated(&map, radius)).expect("a law"));
        for fit in [&sharp, &blunt] {
            assert_hurst(fit, 0.3, 0.28, "tip");
            assert_roll_off(fit, roll_off, "tip");
        }
        let (Some((of_sharp, Limit::Blunt)), Some((of_blunt, Limit::Blunt))) = (sharp.resolution, blunt.resolution)
        else {
            panic!("{sharp:?}, {blunt:?}")
        };
        assert!(of_blunt < 0.7 * of_sharp, "{of_sharp}, {of_blunt}");
    }
}

#[test]
fn a_part_of_a_surface_has_the_ends_of_the_whole_whatever_its_tilt() {
    for (hurst, roll_off, seed) in cases() {
        let params = SpectrumParams { hurst, roll_off: 2.0 * roll_off, ..SpectrumParams::paper(200, seed) };
        let grid = Grid::square(2 * POINTS).expect("a grid");
        let big = surface(params).sample_on(grid).expect("resolved waves");
        for tilt in [0.0, 3.0 * big.rms()] {
            let part = windowed(&big, tilt);
            let measured = Measured { windowed: true, ..PERIODIC };
            let fit = fit_hurst(&radial_spectrum(&part), &measured).expect("a law");
            assert_hurst(&fit, hurst, 0.08, "part");
            // Few waves of a part are longer than its quarter, so that roll-off may not be seen.
            if !(3.0..5.0).contains(&roll_off) || fit.roll_off.is_some() {
                assert_roll_off(&fit, roll_off, "part");
            }
            let cut_off = fit.cut_off.expect("a cut-off");
            assert!((cut_off / 100.0 - 1.0).abs() < 0.02, "{fit:?}");
        }
    }
}

#[test]
fn noise_alone_and_smooth_hills_have_no_law() {
    let flat = Field::zeros(Grid::square(POINTS).expect("a grid"));
    for seed in 1..6 {
        assert_eq!(fit_of(&noisy(flat.clone(), 1e-6, seed)), None);
        assert_eq!(fit_of(&blurred(&noisy(flat.clone(), 1e-6, seed), 6.0)), None);
    }
}
