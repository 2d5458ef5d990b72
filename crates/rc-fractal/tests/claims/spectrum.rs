//! Amplitudes and phases of single waves.

use std::f64::consts::TAU;

use rc_core::{Grid, HeightField};
use rc_fractal::{Amplitudes, Complex64, Normalisation, SpectrumParams, Surface, Truncation, radial_spectrum};

use crate::{assert_close, surface};

/// Wave vectors of the square of half side N, one of each conjugate pair.
fn half_plane(waves: i64) -> impl Iterator<Item = (i64, i64)> {
    (0..=waves).flat_map(move |kx| (-waves..=waves).map(move |ky| (kx, ky))).filter(|&(kx, ky)| kx > 0 || ky > 0)
}

fn c0(value: f64, base: SpectrumParams) -> Surface {
    surface(SpectrumParams { normalisation: Normalisation::C0(value), ..base })
}

#[test]
fn long_waves_are_shared_between_numbers_of_waves() {
    let (short, long) = (surface(SpectrumParams::paper(64, 5)), surface(SpectrumParams::paper(128, 5)));
    let ratio = short.amplitude(1, 0) / long.amplitude(1, 0);
    assert_close("ratio of |a_10|", ratio.re, 5.001_299_85 / 5.000_043_90, 1e-8);
    let same_c0 = (c0(1.0, SpectrumParams::paper(64, 5)), c0(1.0, SpectrumParams::paper(128, 5)));
    for (kx, ky) in half_plane(64) {
        if kx * kx + ky * ky <= 64 * 64 {
            let (a, b) = (short.amplitude(kx, ky), long.amplitude(kx, ky) * ratio);
            assert!((a - b).norm() <= 1e-15 * b.norm(), "a({kx}, {ky}) = {a}, scaled from N = 128 {b}");
            assert_eq!(same_c0.0.amplitude(kx, ky), same_c0.1.amplitude(kx, ky), "a({kx}, {ky}) with the same C0");
        }
    }
}

#[test]
fn truncations_share_their_waves_and_have_the_right_number_of_them() {
    for (waves, in_disc, in_square) in [(64, 12_852, 16_640), (128, 51_432, 66_048)] {
        let base = SpectrumParams::paper(waves, 1);
        let (disc, square) = (c0(1.0, base), c0(1.0, SpectrumParams { truncation: Truncation::Square, ..base }));
        let count = |surface: &Surface| {
            2 * half_plane(waves as i64 + 1).filter(|&(kx, ky)| surface.amplitude(kx, ky) != Complex64::ZERO).count()
        };
        assert_eq!((count(&disc), count(&square)), (in_disc, in_square));
        for (kx, ky) in half_plane(waves as i64) {
            let inside = kx * kx + ky * ky <= (waves * waves) as i64;
            let expected = if inside { square.amplitude(kx, ky) } else { Complex64::ZERO };
            assert_eq!(disc.amplitude(kx, ky), expected, "a({kx}, {ky})");
        }
    }
}

#[test]
fn amplitudes_are_hermitian_without_mean_and_zero_outside() {
    let surface = surface(SpectrumParams::paper(9, 1));
    for (kx, ky) in half_plane(9) {
        assert_eq!(surface.amplitude(-kx, -ky), surface.amplitude(kx, ky).conj(), "k = ({kx}, {ky})");
    }
    let outside =
        [(0, 0), (9, 1), (10, 0), (0, -10), (i64::MAX, 0), (i64::MIN, i64::MIN), (0, i64::MIN), (1, i64::MAX)];
    for (kx, ky) in outside {
        assert_eq!(surface.amplitude(kx, ky), Complex64::ZERO, "k = ({kx}, {ky})");
    }
}

#[test]
fn the_spectrum_is_flat_up_to_the_roll_off_and_a_power_law_beyond() {
    let (plateau, roll_off, hurst) = (2e-11, 6.5, 0.6);
    let surface = c0(plateau, SpectrumParams { roll_off, hurst, ..SpectrumParams::paper(32, 3) });
    for (kx, ky) in half_plane(22) {
        let k = (kx as f64).hypot(ky as f64);
        let expected = if k <= roll_off { plateau } else { plateau * (k / roll_off).powf(-2.0 * (1.0 + hurst)) };
        let psd = surface.amplitude(kx, ky).norm_sqr() / (TAU * TAU);
        assert_close(&format!("C at ({kx}, {ky})"), psd, expected, 1e-13);
    }
}

/// The |a|² of complex Gaussian numbers are exponentially distributed. So |a|²/⟨|a|²⟩ has mean 1 ± 1 and mean square 2
/// ± √20. Averages over n waves must be within five times these deviations over √n.
#[test]
fn random_amplitudes_are_complex_gaussian_about_the_spectrum() {
    let base = SpectrumParams::paper(128, 2);
    let (fixed, random) = (c0(1.0, base), c0(1.0, SpectrumParams { amplitudes: Amplitudes::Random, ..base }));
    let (mut n, mut mean, mut mean_square, mut direction) = (0.0, 0.0, 0.0, Complex64::ZERO);
    for (kx, ky) in half_plane(90) {
        let (f, r) = (fixed.amplitude(kx, ky), random.amplitude(kx, ky));
        let turned = (r / f).arg().abs();
        assert!(turned < 1e-14, "random amplitudes shift the phase at ({kx}, {ky}) by {turned:e}");
        let power = r.norm_sqr() / f.norm_sqr();
        n += 1.0;
        mean += power;
        mean_square += power * power;
        direction += f / f.norm();
    }
    assert!((mean / n - 1.0).abs() < 5.0 / f64::sqrt(n), "mean |a|² is {} times the spectrum", mean / n);
    let spread = (mean_square / n - 2.0).abs();
    assert!(spread < 5.0 * f64::sqrt(20.0 / n), "mean |a|⁴ is {}, not 2", mean_square / n);
    assert!(direction.norm() < 5.0 * f64::sqrt(n), "phases favour a direction: {} of {n} waves", direction.norm());
}

#[test]
fn different_seeds_are_different_surfaces() {
    let phases = |seed| {
        let surface = surface(SpectrumParams::paper(40, seed));
        half_plane(28).map(|(kx, ky)| surface.amplitude(kx, ky)).map(|a| a / a.norm()).collect::<Vec<_>>()
    };
    let first = phases(0);
    let n = first.len() as f64;
    for seed in [1, 2, 1 << 32, u64::MAX] {
        let overlap: Complex64 = first.iter().zip(phases(seed)).map(|(a, b)| a * b.conj()).sum();
        assert!(overlap.norm() < 5.0 * n.sqrt(), "seed {seed} overlaps with seed 0 by {} of {n}", overlap.norm());
    }
}

/// The draws are part of the format. A seed means the same surface on every machine and in every later version.
///
/// The values come from an independent implementation of the description in `draws.rs`, including `ChaCha8`.
#[test]
fn a_seed_names_the_same_surface_for_ever() {
    let surface = surface(SpectrumParams { amplitudes: Amplitudes::Random, ..SpectrumParams::paper(4, 42) });
    let expected = [
        (-6.349_559_303_591_684e-5, 2.783_190_383_795_659e-4),
        (6.706_742_265_490_019e-5, 4.646_621_089_287_167e-4),
        (-4.361_529_666_782_378e-4, -1.512_063_276_788_288e-4),
        (4.343_156_330_089_987e-5, 5.334_025_719_401_627e-5),
    ];
    for ((kx, ky), (re, im)) in [(0, 1), (1, 0), (1, -1), (3, 2)].into_iter().zip(expected) {
        let a = surface.amplitude(kx, ky);
        let error = (a - Complex64::new(re, im)).norm() / a.norm();
        assert!(error < 1e-14, "a({kx}, {ky}) = {:e} {:+e}i, was {re:e} {im:+e}i", a.re, a.im);
    }
}

#[test]
fn rings_add_up_to_the_mean_square_height() {
    let surface = surface(SpectrumParams::paper(30, 6));
    for (nx, ny) in [(64, 64), (61, 90), (100, 75)] {
        let grid = Grid::new(nx, ny).expect("small");
        let rings = radial_spectrum(&surface.sample(grid));
        let sum: f64 = rings.iter().map(|ring| TAU * TAU * ring.psd * ring.n_modes as f64).sum();
        assert_close(&format!("Σ (2π)² C on {grid}"), sum, 1.3e-3 * 1.3e-3, 1e-12);
        assert_eq!(rings.iter().map(|ring| ring.n_modes).sum::<usize>(), grid.len() - 1);
        assert!(rings.is_sorted_by(|a, b| a.wavenumber < b.wavenumber));
    }
}

/// Averaging k^-3.6 over |k| ± ½ raises it by about 3.6·4.6/24 k^-2. Lattice points are also uneven in a ring. Both
/// together are 1 % beyond k = 10.
#[test]
fn unit_rings_follow_the_power_law() {
    let surface = c0(1.0, SpectrumParams::paper(64, 6));
    let rings = radial_spectrum(&surface.sample(Grid::square(160).expect("small")));
    for ring in rings.iter().filter(|ring| (10.0..63.0).contains(&ring.wavenumber)) {
        assert_close(&format!("C({})", ring.wavenumber), ring.psd, ring.wavenumber.powf(-3.6), 0.01);
    }
}

#[test]
fn a_flat_map_has_an_empty_spectrum() {
    let rings = radial_spectrum(&rc_core::Field::from_fn(Grid::new(5, 8).expect("small"), |_| 3.0));
    assert!(rings.iter().all(|ring| ring.psd == 0.0), "{rings:?}");
    assert!(radial_spectrum(&rc_core::Field::zeros(Grid::square(1).expect("small"))).is_empty());
}

#[test]
fn the_low_cut_takes_long_waves_away_and_leaves_the_others() {
    let base = SpectrumParams { roll_off: 7.0, ..SpectrumParams::paper(20, 3) };
    for amplitudes in [Amplitudes::Fixed, Amplitudes::Random] {
        let base = SpectrumParams { amplitudes, ..base };
        let (all, cut) = (c0(1e-9, base), c0(1e-9, SpectrumParams { low_cut: 5.0, ..base }));
        let (mut height, mut slope) = (0.0, 0.0);
        for (kx, ky) in half_plane(20) {
            let k_squared = (kx * kx + ky * ky) as f64;
            // (3, 4) and (5, 0) are not below 5.
            let expected = if k_squared < 25.0 { Complex64::ZERO } else { all.amplitude(kx, ky) };
            assert_eq!(cut.amplitude(kx, ky), expected, "a({kx}, {ky}), {amplitudes:?}");
            height += 2.0 * expected.norm_sqr();
            slope += 2.0 * TAU * TAU * k_squared * expected.norm_sqr();
        }
        assert!(cut.amplitude(3, 4) != Complex64::ZERO && cut.amplitude(4, 2) == Complex64::ZERO);
        assert_close("rms height", cut.moments().rms_height, height.sqrt(), 1e-13);
        assert_close("rms slope", cut.moments().rms_slope, slope.sqrt(), 1e-13);
    }
    let sized = surface(SpectrumParams { low_cut: 5.0, ..base });
    assert_close("rms height as asked for", sized.moments().rms_height, 1.3e-3, 1e-13);
}
