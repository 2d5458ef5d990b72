//! The Hurst exponent of a measured spectrum, and the range over which it is one.

use crate::radial::SpectrumBin;

/// Rings are put together into bins that are this much wider than the ones before, so that every decade counts alike.
const BIN_RATIO: f64 = 1.189_207_115_002_721; // 2^(1/4)

/// Minimum number of bins in a range, and minimum ratio of the last to the first.
const FEWEST_BINS: usize = 6;
const LEAST_RATIO: f64 = 4.0;

/// Maximum distance of a bin from the line, in ln C, besides the scatter of a bin of few waves.
const STRAIGHT: f64 = 0.15;

/// Deviations of that many standard deviations are scatter.
const SCATTER: f64 = 2.5;

/// Exponents that make a range: those of self-affine surfaces, and a little more. A roll-off is straight too, with
/// H = -1.
const SELF_AFFINE: std::ops::RangeInclusive<f64> = 0.0..=1.2;

/// Part of the maximum C below which there is only rounding.
const ROUNDING: f64 = 1e-20;

/// A power law C ∝ q^(-2(1+H)) through a part of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct HurstFit {
    /// Hurst exponent H, from 0 to 1.2. Above 1 the surface is smoother than a self-affine one, though its spectrum is
    /// a power law.
    pub hurst: f64,
    /// ln C at one wave per cell on the line, C in λ⁴.
    pub ln_c: f64,
    /// First wavenumber of the range, in waves per cell.
    pub from: f64,
    /// Last wavenumber of the range.
    pub to: f64,
    /// Root mean square distance from the line, in ln C, of bins weighted as in the fit.
    pub deviation: f64,
}

/// A bin: ln of the wavenumber, ln of C, and what C may scatter.
#[derive(Clone, Copy)]
struct Point {
    ln_k: f64,
    ln_c: f64,
    tolerance: f64,
}

/// H of Eq. (8), x → t x and h → t^H h, from the longest part of `spectrum` that is straight in logarithms, within the
/// scatter of its rings, and as steep as that of a self-affine surface; `None` when less than a factor 4 in wavenumber
/// is.
///
/// A line through all bins of a candidate by least squares, bins of many waves with more weight; no bin further from it
/// than 15 % and the scatter of a mean over so many random waves. Of equally long candidates the straighter one. Tests
/// `the_exponent_of_a_generated_surface_and_its_range_are_found` and `roll_off_and_truncation_are_left_out`.
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
        // k and -k are one wave; powers of random waves scatter by their mean.
        let tolerance = STRAIGHT + SCATTER / (0.5 * waves).sqrt();
        points.push(Point { ln_k: ln_k / waves, ln_c: (power / waves).ln(), tolerance });
    }
    points
}

/// The power law of Eq. (9) through all points, ln C = ln c - 2(1+H) ln k, if they are on one.
fn line(points: &[Point]) -> Option<HurstFit> {
    let (first, last) = (points.first()?, points.last()?);
    if last.ln_k - first.ln_k < LEAST_RATIO.ln() {
        return None;
    }
    // A bin counts by what it may be off, so that the scatter of a few long waves does not tilt the line.
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
                // Bins of hundreds of waves over a factor 60 in wavenumber: a few percent of ln C each.
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
        // Its few long waves may scatter as much as the roll-off is off the line.
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
