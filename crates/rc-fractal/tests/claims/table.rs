//! Surfaces of tabulated spectra.

use std::f64::consts::TAU;

use rc_core::{Grid, HeightField};
use rc_fractal::{Amplitudes, Normalisation, SpectrumParams, SpectrumTable, Surface, radial_spectrum};

use crate::{assert_close, surface};

/// A roll-off at 6 waves, a power law up to 20, then a steeper one up to 30.
fn table() -> SpectrumTable {
    SpectrumTable::new(vec![[2.0, 3e-9], [6.0, 3e-9], [20.0, 4e-11], [30.0, 1e-12]]).expect("a table")
}

#[test]
fn each_wave_has_the_amplitude_of_the_table_and_moments_are_their_sums() {
    let (table, mut sums) = (table(), [0.0; 2]);
    let surface = Surface::from_table(&table, Amplitudes::Fixed, 4);
    assert_eq!((surface.waves(), surface.band_limit()), (30, Some(30)));
    for kx in -31_i64..=31 {
        for ky in -31_i64..=31 {
            let wavenumber = ((kx * kx + ky * ky) as f64).sqrt();
            let power = TAU * TAU * table.density(wavenumber);
            let error = (surface.amplitude(kx, ky).norm_sqr() - power).abs();
            assert!(error <= 1e-12 * power, "|a({kx}, {ky})|² is off by {error:e}");
            sums[0] += power;
            sums[1] += (TAU * wavenumber).powi(2) * power;
        }
    }
    assert_close("rms height", surface.moments().rms_height, sums[0].sqrt(), 1e-12);
    assert_close("rms slope", surface.moments().rms_slope, sums[1].sqrt(), 1e-12);
}

#[test]
fn the_spectrum_of_its_heights_is_the_table_ring_by_ring() {
    let table = table();
    let heights = Surface::from_table(&table, Amplitudes::Fixed, 1).sample(Grid::square(72).expect("a grid"));
    for bin in radial_spectrum(&heights).iter().filter(|bin| bin.wavenumber < 31.0) {
        // A ring has the mean of C over its waves, a few percent off C at the mean |k|. The first and last are half empty.
        let expected = table.density(bin.wavenumber);
        if (2.6..29.0).contains(&bin.wavenumber) {
            assert_close(&format!("C({})", bin.wavenumber), bin.psd, expected, 0.06);
        }
    }
}

#[test]
fn a_tabulated_power_law_is_the_power_law_and_seeds_differ() {
    let c = |k: f64| 3e-9 * k.powf(-3.6);
    let rows = (0..=20).map(|i| 24_f64.powf(f64::from(i) / 20.0)).map(|k| [k, c(k)]).collect();
    let table = SpectrumTable::new(rows).expect("a table");
    let params = SpectrumParams { normalisation: Normalisation::C0(3e-9), ..SpectrumParams::paper(24, 5) };
    for amplitudes in [Amplitudes::Fixed, Amplitudes::Random] {
        let (law, of_table) =
            (surface(SpectrumParams { amplitudes, ..params }), Surface::from_table(&table, amplitudes, 5));
        let other = Surface::from_table(&table, amplitudes, 6);
        for (kx, ky) in [(0, 1), (3, -2), (24, 0), (17, 16), (-5, 20)] {
            let (a, b) = (law.amplitude(kx, ky), of_table.amplitude(kx, ky));
            assert!((a - b).norm() <= 1e-10 * a.norm(), "a({kx}, {ky}) = {b}, not {a}");
            assert!((a - other.amplitude(kx, ky)).norm() > 1e-3 * a.norm(), "({kx}, {ky}) does not depend on the seed");
        }
    }
}
