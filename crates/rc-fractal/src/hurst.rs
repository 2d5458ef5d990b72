//! The Hurst exponent of a measured spectrum, and its range of wavenumbers.

use crate::radial::SpectrumBin;

/// Width of a bin of rings, as a ratio of wavenumbers. Every decade then has the same weight.
const BIN_RATIO: f64 = 1.189_207_115_002_721; // 2^(1/4)

/// Minimum number of bins in a range, and minimum ratio of its wavenumbers.
const FEWEST_BINS: usize = 6;
const LEAST_RATIO: f64 = 4.0;

/// Maximum distance of a bin from the line, in ln C. The scatter of a bin of few waves is added.
const STRAIGHT: f64 = 0.15;

/// Number of standard deviations that count as scatter.
const SCATTER: f64 = 2.5;

/// Exponents of self-affine surfaces, with a small margin.
///
/// A roll-off is straight too, but has H = -1.
const SELF_AFFINE: std::ops::RangeInclusive<f64> = 0.0..=1.2;

/// Minimum C of a ring relative to the maximum C. Smaller values are only rounding.
const ROUNDING: f64 = 1e-20;

/// A power law C ∝ q^(-2(1+H)) for a part of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HurstFit {
    /// Hurst exponent H, from 0 to 1.2.
    ///
    /// Above 1 the surface is smoother than a self-affine one, although its spectrum is a power law.
    pub hurst: f64,
    /// ln C of the line at one wave per cell, with C in λ⁴.
    pub ln_c: f64,
    /// First wavenumber of the range, in waves per cell.
    pub from: f64,
    /// Last wavenumber of the range.
    pub to: f64,
    /// Root mean square distance of the bins from the line, in ln C.
    ///
    /// The weights are those of the fit.
    pub deviation: f64,
}

/// A bin with ln of its wavenumber, ln of its C, and its maximum distance from a line.
#[derive(Clone, Copy)]
struct Point {
    ln_k: f64,
    ln_c: f64,
    tolerance: f64,
}

/// Fits the Hurst exponent H of Eq. (8) to a spectrum.
///
/// H describes the scaling x → t x and h → t^H h.
///
/// The range of the fit is the longest part of `spectrum` that is a straight line in logarithms, with the slope of a
/// self-affine surface. `None` when no such part covers a factor of 4 in wavenumber.
///
/// The line through all bins of a candidate range is fitted by least squares. Bins of many waves have more weight. No
/// bin may be further from the line than 15 % plus the scatter of a mean over its random waves. The straightest of
/// equally long candidates is taken. Tests `the_exponent_of_a_generated_surface_and_its_range_are_found` and
/// `roll_off_and_truncation_are_left_out`.
#[must_use]
pub fn fit_hurst(spectrum: &[SpectrumBin]) -> Option<HurstFit> {
    let points = bins(spectrum);
    let mut best: Option<HurstFit> = None;
    for first in 0..points.len() {
        for last in first + FEWEST_BINS - 1..points.len() {
            let Some(fit) = line(&points[first..=last]) else { continue };
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

fn bins(spectrum: &[SpectrumBin]) -> Vec<Point> {
    let noise = spectrum.iter().fold(0.0_f64, |most, ring| most.max(ring.psd)) * ROUNDING;
    let mut points = Vec::new();
    let mut rings = spectrum.iter().filter(|ring| ring.psd > noise).peekable();
    while let Some(first) = rings.next() {
        let end = first.wavenumber * BIN_RATIO;
        let (mut waves, mut ln_k, mut power) = (0.0, 0.0, 0.0);
        let mut ring = Some(first);
        while let Some(SpectrumBin { wavenumber, psd, n_modes }) = ring.copied() {
            let n = n_modes as f64;
            (waves, ln_k, power) = (waves + n, ln_k + n * wavenumber.ln(), power + n * psd);
            ring = rings.next_if(|next| next.wavenumber < end);
        }
        // k and -k are one wave. The standard deviation of a random wave's power is its mean.
        let tolerance = STRAIGHT + SCATTER / (0.5 * waves).sqrt();
        points.push(Point { ln_k: ln_k / waves, ln_c: (power / waves).ln(), tolerance });
    }
    points
}

/// The power law of Eq. (9) through all points.
///
/// The line is ln C = ln c - 2(1+H) ln k. `None` if a point is too far from it, or if the line is not self-affine.
fn line(points: &[Point]) -> Option<HurstFit> {
    let (first, last) = (points.first()?, points.last()?);
    if last.ln_k - first.ln_k < LEAST_RATIO.ln() {
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
    Some(HurstFit { hurst, ln_c: y - slope * x, from, to, deviation })
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;
    use crate::{Amplitudes, SpectrumParams, Surface, radial_spectrum};

    fn fit(params: &SpectrumParams) -> HurstFit {
        let surface = Surface::new(params).expect("valid parameters");
        let heights = surface.sample_on(Grid::square(512).expect("a grid")).expect("resolved waves");
        fit_hurst(&radial_spectrum(&heights)).expect("a power law")
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
        assert_eq!(fit_hurst(&radial_spectrum(&wave)), None);
    }
}
