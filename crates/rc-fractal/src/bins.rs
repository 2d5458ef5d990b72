//! Means over bins of a measured spectrum.

use rc_core::Grid;

use crate::radial::SpectrumBin;

/// Width of a bin of rings, as a ratio of wavenumbers. Every decade then has the same weight.
pub(crate) const BIN_RATIO: f64 = 1.189_207_115_002_721; // 2^(1/4)

/// Minimum number of bins in a range, and minimum ratio of its wavenumbers.
pub(crate) const FEWEST_BINS: usize = 6;
pub(crate) const LEAST_RATIO: f64 = 4.0;

/// Wavenumber below which there are few waves, in waves per longer side. Longer waves do not make a law longer.
pub(crate) const FEW_WAVES: f64 = 3.0;

/// Maximum distance of a bin from the line, in ln C. The scatter of a bin of few waves is added.
const STRAIGHT: f64 = 0.15;

/// Number of standard deviations that count as scatter.
const SCATTER: f64 = 2.5;

/// Standard deviation of a bin of many waves from a law that is true.
const UNEVEN: f64 = 0.07;

/// Exponents of self-affine surfaces, with a small margin.
///
/// A roll-off is straight too, but has H = -1.
pub(crate) const SELF_AFFINE: std::ops::RangeInclusive<f64> = 0.0..=1.2;

/// Minimum C of a ring relative to the maximum C. Smaller values are only rounding.
const ROUNDING: f64 = 1e-20;

/// Part of the limit of resolution of the grid up to which a spectrum is used. Beyond it, C has waves that the grid
/// does not resolve.
pub(crate) const RESOLVED: f64 = 0.8;

/// First wavenumber of a spectrum under a window, in waves per longer side.
///
/// Longer waves contain what the window makes of form and tilt.
const FIRST_UNDER_WINDOW: f64 = 1.5;

/// Waves under Hann's window that scatter as one.
const WAVES_UNDER_WINDOW: f64 = 2.25;

/// How a spectrum was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Largest |k| that the grid resolves in all directions (Nyquist), in waves per λ.
    pub nyquist: f64,
    /// Waves per λ of a wave as long as the longer side.
    pub longest: f64,
    /// Whether the heights are under Hann's window.
    pub windowed: bool,
}

impl Measured {
    /// The spectrum of heights on `grid`.
    #[must_use]
    pub fn on(grid: Grid, windowed: bool) -> Self {
        let ratio = grid.cell_ratio();
        let nyquist = (0.5 * grid.nx() as f64).min(0.5 * grid.ny() as f64 / ratio);
        Self { nyquist, longest: 1.0 / ratio.max(1.0), windowed }
    }
}

/// What ends the power law of a measured spectrum at short waves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum Limit {
    /// The spectrum becomes flat.
    Noise,
    /// The spectrum falls faster than the law, as under a blunt tip or a lens.
    Blunt,
    /// The spacing of the points.
    Grid,
}

/// A bin with ln of its wavenumber, ln of its C, and its maximum distance from a line.
#[derive(Clone, Copy)]
pub(crate) struct Point {
    pub(crate) ln_k: f64,
    pub(crate) ln_c: f64,
    pub(crate) tolerance: f64,
    /// Variance of `ln_c`.
    pub(crate) variance: f64,
}

/// Means over bins of rings.
pub(crate) fn bins(spectrum: &[SpectrumBin], measured: &Measured) -> Vec<Point> {
    let noise = spectrum.iter().fold(0.0_f64, |most, ring| most.max(ring.psd)) * ROUNDING;
    let first = if measured.windowed { FIRST_UNDER_WINDOW * measured.longest } else { 0.0 };
    let range = first..=RESOLVED * measured.nyquist;
    let alike = if measured.windowed { WAVES_UNDER_WINDOW } else { 1.0 };
    let mut points = Vec::new();
    let is_used = |ring: &&SpectrumBin| ring.psd > noise && range.contains(&ring.wavenumber);
    let mut rings = spectrum.iter().filter(is_used).peekable();
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
        let scatter = (2.0 * alike / waves).sqrt();
        points.push(Point {
            ln_k: ln_k / waves,
            ln_c: (power / waves).ln(),
            tolerance: STRAIGHT + SCATTER * scatter,
            variance: scatter * scatter + UNEVEN * UNEVEN,
        });
    }
    points
}
