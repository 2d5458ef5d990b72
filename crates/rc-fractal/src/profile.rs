//! Isotropic spectra of surfaces from profiles.

use std::f64::consts::{PI, TAU};

use rc_fft::{Complex64, TransformReal};

/// Rows of the spectrum for each factor of ten in the wavenumber.
const ROWS_PER_DECADE: f64 = 10.0;

/// Points between two rows, and beyond the last, at which the spectrum of the profile is a chord.
const CHORDS: usize = 24;

/// Minimum number of points of a profile.
pub const LEAST_POINTS: usize = 16;

/// The isotropic spectrum C(q) of a surface of which `heights` are a profile with this `spacing`.
///
/// Rows are q (rad per unit of length) and C (fourth power of the unit). C follows from the spectrum C1 of the profile,
/// C1(q) = ∫ C(√(q² + s²)) ds, by Abel's inversion,
///
/// ```text
/// C(q) = -(1/π) ∫_q^∞ C1'(s) ds / √(s² - q²)
/// ```
///
/// C1 is that of the heights minus their line of least squares under Hann's window. It is averaged over intervals of a
/// tenth of a decade, and continued beyond the resolution by the power law of the last intervals. C is 0 where the
/// profile would need a negative one.
///
/// # Panics
/// For fewer than [`LEAST_POINTS`] heights.
#[must_use]
pub fn spectrum_of_profile(heights: &[f64], spacing: f64) -> Vec<[f64; 2]> {
    spectra_of_profile(heights, spacing).iter().map(|row| [row.wavenumber, row.isotropic]).collect()
}

/// A row of the spectra of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileSpectrumRow {
    /// q (rad per unit of length).
    pub wavenumber: f64,
    /// C1(q) of the profile (third power of the unit). ⟨h²⟩ = 2 ∫ C1 dq over q > 0.
    pub along: f64,
    /// C(q) of the isotropic surface (fourth power of the unit), as in [`spectrum_of_profile`].
    pub isotropic: f64,
}

/// The spectrum of a profile, and that of the isotropic surface of [`spectrum_of_profile`], at the same wavenumbers.
///
/// # Panics
/// As [`spectrum_of_profile`].
#[must_use]
pub fn spectra_of_profile(heights: &[f64], spacing: f64) -> Vec<ProfileSpectrumRow> {
    assert!(heights.len() >= LEAST_POINTS, "a profile of {} points", heights.len());
    let rows = averaged(&density_of_profile(heights, spacing));
    let chords = chords_of(&rows);
    let row = |&[wavenumber, along]: &[f64; 2]| {
        let isotropic = inverted(&chords, wavenumber);
        ProfileSpectrumRow { wavenumber, along, isotropic }
    };
    rows.iter().map(row).collect()
}

/// q and C1 of each wave of a profile, without the mean and the limit of resolution. ⟨h²⟩ = 2 ∫ C1 dq over q > 0.
fn density_of_profile(heights: &[f64], spacing: f64) -> Vec<[f64; 2]> {
    let n = heights.len();
    let length = n as f64 * spacing;
    let middle = 0.5 * (n as f64 - 1.0);
    let mean = heights.iter().sum::<f64>() / n as f64;
    let moment: f64 = heights.iter().enumerate().map(|(i, height)| (i as f64 - middle) * height).sum();
    let slope = moment / (n as f64 * ((n * n) as f64 - 1.0) / 12.0);
    // The mean square of the window is 1.
    let scale = (8.0_f64 / 3.0).sqrt() / n as f64;
    let window = |i: usize| scale * (PI * (i as f64 + 0.5) / n as f64).sin().powi(2);
    let flat = |(i, height): (usize, &f64)| (height - mean - slope * (i as f64 - middle)) * window(i);
    let mut waves: Vec<Complex64> = heights.iter().enumerate().map(|at| Complex64::new(flat(at), 0.0)).collect();
    f64::complex_forward(n).process(&mut waves);
    let last = (n - 1) / 2;
    waves[1..=last]
        .iter()
        .zip(1..)
        .map(|(wave, k)| [TAU * f64::from(k) / length, wave.norm_sqr() * length / TAU])
        .collect()
}

/// Means of q and C1 over intervals of q with equal ratios of their ends.
fn averaged(waves: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let interval = |q: f64| ((q / waves[0][0]).log10() * ROWS_PER_DECADE).round();
    let same = |a: &[f64; 2], b: &[f64; 2]| interval(a[0]).total_cmp(&interval(b[0])).is_eq();
    let mean = |group: &[[f64; 2]]| [0, 1].map(|i| group.iter().map(|wave| wave[i]).sum::<f64>() / group.len() as f64);
    waves.chunk_by(same).map(mean).collect()
}

/// Points of C1, so close that chords between them follow the power laws between `rows`, and beyond.
fn chords_of(rows: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let exponent = |a: [f64; 2], b: [f64; 2]| (b[1] / a[1]).ln() / (b[0] / a[0]).ln();
    let mut points = Vec::new();
    for pair in rows.windows(2) {
        let ratio = pair[1][0] / pair[0][0];
        let power = if pair[0][1] > 0.0 && pair[1][1] > 0.0 { exponent(pair[0], pair[1]) } else { 0.0 };
        let between = |i: usize| ratio.powf(i as f64 / CHORDS as f64);
        points.extend((0..CHORDS).map(|i| [pair[0][0] * between(i), pair[0][1] * between(i).powf(power)]));
    }
    let (Some(&last), Some(&before)) = (rows.last(), rows.get(rows.len().saturating_sub(4))) else { return points };
    points.push(last);
    let power = if last[1] > 0.0 && before[1] > 0.0 && last[0] > before[0] { exponent(before, last) } else { 0.0 };
    if power < 0.0 {
        let beyond = |i: usize| 10_f64.powf(i as f64 / (ROWS_PER_DECADE * CHORDS as f64) * 4.0);
        points.extend((1..=2 * CHORDS * 10).map(|i| [last[0] * beyond(i), last[1] * beyond(i).powf(power)]));
    }
    points
}

/// Abel's inversion of the chords between `points` at q, at least 0.
fn inverted(points: &[[f64; 2]], q: f64) -> f64 {
    let of_chord = |pair: &[[f64; 2]]| {
        let ([from, c_from], [to, c_to]) = (pair[0], pair[1]);
        if to <= q {
            return 0.0;
        }
        let slope = (c_to - c_from) / (to - from);
        slope * ((to / q).acosh() - (from / q).max(1.0).acosh())
    };
    (-points.windows(2).map(of_chord).sum::<f64>() / PI).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// C = q^-(2+2H) has C1 = √π Γ(H + ½)/Γ(1 + H) q^-(1+2H).
    #[test]
    fn a_power_law_is_inverted_exactly() {
        // H = ½: √π Γ(1)/Γ(3/2) = 2.
        let rows: Vec<[f64; 2]> =
            (0..=30).map(|i| 10_f64.powf(f64::from(i) / 10.0)).map(|q| [q, 2.0 * q.powi(-2)]).collect();
        let chords = chords_of(&rows);
        for &[q, _] in &rows {
            let error = inverted(&chords, q) * q.powi(3) - 1.0;
            assert!(error.abs() < 0.02, "C({q}) is off by {error}");
        }
    }

    #[test]
    fn a_wave_has_its_mean_square() {
        let heights: Vec<f64> =
            (0..500).map(|i| 3.0 + 0.01 * f64::from(i) + (TAU * f64::from(i) / 10.0).sin()).collect();
        let waves = density_of_profile(&heights, 0.5);
        let square: f64 = 2.0 * waves.iter().map(|wave| wave[1]).sum::<f64>() * TAU / 250.0;
        assert!((square / 0.5 - 1.0).abs() < 0.01, "mean square {square}");
        let highest = waves.iter().max_by(|a, b| a[1].total_cmp(&b[1])).expect("waves");
        assert!((highest[0] - TAU / 5.0).abs() < 1e-9, "q = {}", highest[0]);
    }
}
