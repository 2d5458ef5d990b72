//! Spectra of surfaces from profiles.

use std::f64::consts::TAU;

use rc_core::{DVec2, HeightField};
use rc_fractal::{Amplitudes, Normalisation, SpectrumParams, Surface, spectrum_of_profile};

use crate::{assert_close, surface};

/// Profiles of a surface give its spectrum, within the scatter of a few waves.
#[test]
fn the_mean_over_profiles_gives_the_spectrum_of_the_surface() {
    let c0 = 1e-8;
    let mut mean: Vec<[f64; 2]> = Vec::new();
    let (n, count) = (512, 40);
    for seed in 0..count {
        let normalisation = Normalisation::C0(c0);
        let amplitudes = Amplitudes::Random;
        let surface: Surface =
            surface(SpectrumParams { normalisation, amplitudes, roll_off: 6.0, ..SpectrumParams::paper(80, seed) });
        let profile: Vec<f64> = (0..n).map(|i| surface.height(DVec2::new(f64::from(i) / f64::from(n), 0.3))).collect();
        let rows = spectrum_of_profile(&profile, 1.0 / f64::from(n));
        if mean.is_empty() {
            mean = vec![[0.0; 2]; rows.len()];
        }
        for (mean, row) in mean.iter_mut().zip(rows) {
            *mean = [row[0], mean[1] + row[1] / f64::from(u32::try_from(count).expect("few"))];
        }
    }
    // In units of λ and waves: C(k) = C0 (k/6)^-3.6, q = 2πk.
    let inside: Vec<_> = mean.iter().filter(|row| (10.0..40.0).contains(&(row[0] / TAU))).collect();
    assert!(inside.len() >= 5, "{mean:?}");
    let logs = inside.iter().map(|row| (row[1] / (c0 * (row[0] / TAU / 6.0).powf(-3.6))).ln()).sum::<f64>();
    assert_close("mean ratio to C", (logs / inside.len() as f64).exp(), 1.0, 0.25);
}
