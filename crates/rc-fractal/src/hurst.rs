//! The Hurst exponent of a measured spectrum, and the ends of its power law.

use std::f64::consts::TAU;

use crate::bins::{
    BIN_RATIO, FEW_WAVES, FEWEST_BINS, LEAST_RATIO, Limit, Measured, Point, RESOLVED, SELF_AFFINE, bins,
};
use crate::law::{self, Law};
use crate::radial::SpectrumBin;

/// A power law C ∝ q^(-2(1+H)) for a part of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HurstFit {
    /// Hurst exponent H, from 0 to 1.2.
    ///
    /// Above 1 the surface is smoother than a self-affine one, although its spectrum is a power law.
    pub hurst: f64,
    /// Standard error of H.
    pub hurst_error: f64,
    /// ln C of the line at one wave per cell, with C in λ⁴.
    pub ln_c: f64,
    /// First wavenumber of the range, in waves per cell.
    pub from: f64,
    /// Last wavenumber of the range.
    pub to: f64,
    /// Root mean square distance of the bins from the law with its ends, in ln C.
    ///
    /// The weights are those of the fit.
    pub deviation: f64,
    /// Wavenumber below which the spectrum is flat, in waves per cell. `None` where it is not seen.
    pub roll_off: Option<f64>,
    /// Wavenumber of the shortest waves, if the spectrum falls there at once.
    pub cut_off: Option<f64>,
    /// Wavenumber at which the spectrum is twice or half of its law, or ends, and why.
    ///
    /// `None` where only a part of the spectrum is a power law.
    pub resolution: Option<(f64, Limit)>,
}

/// Fits the Hurst exponent H of Eq. (8) to a spectrum, with the ends of its power law.
///
/// H describes the scaling x → t x and h → t^H h.
///
/// The means over bins of a quarter of an octave are compared with power laws that may be flat at long waves (roll-off),
/// and that may end at short waves with a cut-off, with a factor exp(-g k²) (a lens), with a steeper power law (a tip),
/// or with a constant that is added (noise). The law with the least misfit is taken, where each parameter of an end
/// costs twice what the criterion of Bayes says. A law must cover a factor of 4 in wavenumber, with H from 0 to 1.2,
/// and no bin in this range may be further from it than 15 % plus the scatter of a mean over its random waves.
///
/// If there is no such law, the longest part of `spectrum` that is a straight line in logarithms is taken, and nothing
/// is said about its ends. `None` when no such part covers a factor of 4 either. Tests
/// `the_exponent_of_a_generated_surface_and_its_range_are_found` and `roll_off_and_truncation_are_left_out`, and the
/// tests `ends`.
#[must_use]
pub fn fit_hurst(spectrum: &[SpectrumBin], measured: &Measured) -> Option<HurstFit> {
    let points = bins(spectrum, measured);
    match law::best(&points, measured.longest) {
        Some((law, error)) => Some(with_ends(&law, error, &points, spectrum, measured)),
        None => longest_line(&points, measured.longest),
    }
}

/// The fit of a law with its ends.
fn with_ends(law: &Law, hurst_error: f64, points: &[Point], spectrum: &[SpectrumBin], measured: &Measured) -> HurstFit {
    let line = |ln_k: f64| law.ln_c() - 2.0 * (1.0 + law.hurst()) * ln_k;
    // A law that reaches the end of the bins ends with the grid.
    let last = points.last().map_or(0.0, |point| point.ln_k);
    // Waves end at the last ring that is not far below the law, near the bin where the law ends.
    let ring_at = |at: f64| {
        let near = |ring: &&SpectrumBin| (ring.wavenumber.ln() - at).abs() < 2.0 * BIN_RATIO.ln();
        let falls = spectrum.iter().filter(near).find(|ring| ring.psd.ln() < line(ring.wavenumber.ln()) - TAU.ln());
        falls.map_or(at.exp(), |ring| ring.wavenumber - 0.5 * measured.longest)
    };
    let cut_off = law.cut_off().map(ring_at).or_else(|| {
        let end = last.exp() * BIN_RATIO;
        (end < RESOLVED * measured.nyquist).then(|| ring_at(last))
    });
    let (end, limit) = law.end(last);
    let resolution = match limit {
        Limit::Grid => measured.nyquist,
        Limit::Noise | Limit::Blunt => cut_off.map_or(end.exp(), |cut| cut.min(end.exp())),
    };
    let first = points.first().map_or(0.0, |point| point.ln_k);
    let from = law.roll_off().map_or(first, |at| at.max(first));
    let (mut sum, mut weights) = (0.0, 0.0);
    for point in points.iter().filter(|point| (from..=end).contains(&point.ln_k)) {
        let weight = point.tolerance.powi(-2);
        (sum, weights) = (sum + weight * (point.ln_c - law.value(point.ln_k)).powi(2), weights + weight);
    }
    HurstFit {
        hurst: law.hurst(),
        hurst_error,
        ln_c: law.ln_c(),
        from: from.exp(),
        to: cut_off.map_or(end.exp(), |cut| cut.min(end.exp())),
        deviation: (sum / weights).sqrt(),
        roll_off: law.roll_off().map(f64::exp),
        cut_off,
        resolution: Some((resolution, limit)),
    }
}

/// The longest straight part of the spectrum.
///
/// The line through all bins of a candidate range is fitted by least squares. Bins of many waves have more weight. The
/// straightest of equally long candidates is taken.
fn longest_line(points: &[Point], longest: f64) -> Option<HurstFit> {
    let mut best: Option<HurstFit> = None;
    for first in 0..points.len() {
        for last in first + FEWEST_BINS - 1..points.len() {
            let Some(fit) = line(&points[first..=last], longest) else { continue };
            let length = |fit: &HurstFit| fit.to / fit.from;
            let better = best.as_ref().is_none_or(|best| {
                let ratio = length(&fit) / length(best);
                ratio > 1.0 + 1e-9 || (ratio > 1.0 - 1e-9 && fit.deviation < best.deviation)
            });
            if better {
                best = Some(fit);
            }
        }
    }
    best
}

/// The power law of Eq. (9) through all points.
///
/// The line is ln C = ln c - 2(1+H) ln k. `None` if a point is too far from it, or if the line is not self-affine.
fn line(points: &[Point], longest: f64) -> Option<HurstFit> {
    let (first, last) = (points.first()?, points.last()?);
    if last.ln_k - first.ln_k.max((FEW_WAVES * longest).ln()) < LEAST_RATIO.ln() {
        return None;
    }
    // The weight follows from the tolerance, so that the scatter of a few long waves does not tilt the line.
    let weight = |point: &Point| point.tolerance.powi(-2);
    let total: f64 = points.iter().map(weight).sum();
    let mean =
        |value: &dyn Fn(&Point) -> f64| points.iter().map(|point| weight(point) * value(point)).sum::<f64>() / total;
    let (x, y) = (mean(&|point| point.ln_k), mean(&|point| point.ln_c));
    let slope = mean(&|point| (point.ln_k - x) * (point.ln_c - y)) / mean(&|point| (point.ln_k - x).powi(2));
    let off = |point: &Point| point.ln_c - y - slope * (point.ln_k - x);
    let hurst = -0.5 * slope - 1.0;
    if !SELF_AFFINE.contains(&hurst) || points.iter().any(|point| off(point).abs() > point.tolerance) {
        return None;
    }
    let deviation = mean(&|point| off(point).powi(2)).sqrt();
    let (from, to) = (first.ln_k.exp(), last.ln_k.exp());
    let spread = mean(&|point| (point.ln_k - x).powi(2)).sqrt();
    let hurst_error = 0.5 * deviation / (spread * (points.len() as f64 - 2.0).sqrt());
    let (roll_off, cut_off, resolution) = (None, None, None);
    Some(HurstFit { hurst, hurst_error, ln_c: y - slope * x, from, to, deviation, roll_off, cut_off, resolution })
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;
    use crate::{Amplitudes, SpectrumParams, Surface, radial_spectrum};

    const PERIODIC: Measured = Measured { nyquist: 256.0, longest: 1.0, windowed: false };

    fn fit(params: &SpectrumParams) -> HurstFit {
        let surface = Surface::new(params).expect("valid parameters");
        let heights = surface.sample_on(Grid::square(512).expect("a grid")).expect("resolved waves");
        fit_hurst(&radial_spectrum(&heights), &PERIODIC).expect("a power law")
    }

    #[test]
    fn the_exponent_of_a_generated_surface_and_its_range_are_found() {
        for amplitudes in [Amplitudes::Fixed, Amplitudes::Random] {
            for hurst in [0.3, 0.8] {
                let params = SpectrumParams { hurst, amplitudes, ..SpectrumParams::paper(128, 5) };
                let fit = fit(&params);
                // Bins of hundreds of waves, over a factor of 60 in wavenumber, scatter by a few percent in C.
                assert!((fit.hurst - hurst).abs() < 0.03, "H = {hurst}, {amplitudes:?}: {fit:?}");
                assert!(fit.from < 4.0 && (90.0..140.0).contains(&fit.to), "{fit:?}");
            }
        }
    }

    #[test]
    fn roll_off_and_truncation_are_left_out() {
        let fit = fit(&SpectrumParams { roll_off: 16.0, ..SpectrumParams::paper(128, 5) });
        assert!((fit.hurst - 0.8).abs() < 0.03 && (12.0..22.0).contains(&fit.from), "{fit:?}");
    }

    #[test]
    fn a_roll_off_near_the_longest_waves_does_not_tilt_the_line() {
        // The few long waves of a roll-off may scatter by as much as its distance from the line.
        let fit = fit(&SpectrumParams { roll_off: 4.0, ..SpectrumParams::paper(128, 5) });
        assert!((fit.hurst - 0.8).abs() < 0.03, "{fit:?}");
    }

    #[test]
    fn a_single_wave_has_no_exponent() {
        let grid = Grid::square(64).expect("a grid");
        let wave = rc_core::Field::from_fn(grid, |at| (std::f64::consts::TAU * 5.0 * at.x).cos());
        assert_eq!(fit_hurst(&radial_spectrum(&wave), &Measured { nyquist: 32.0, ..PERIODIC }), None);
    }
}
