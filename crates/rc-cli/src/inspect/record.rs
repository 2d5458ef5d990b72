//! Statistics of a height map in SI units, for `rc surface` and `rc inspect`.

use std::borrow::Cow;

use rc_core::{Field, Histogram};
use rc_fractal::{HurstFit, Limit, Measured, Moments, SpectrumBin, fit_hurst, radial_spectrum};
use rc_heights::{AreaParameters, BorderStep, Effect, MapStatistics};
use rc_sweep::{MapOrigin, Warning};
use serde::Serialize;

use super::areal::ArealRow;
use super::mirrored;
use crate::warnings::surface::Shape;

/// Statistics of a height map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct SurfaceRecord {
    /// Elements along x and y.
    pub(crate) grid: [usize; 2],
    /// Number of missing points. The statistics are those of the others.
    pub(crate) missing: usize,
    /// Side of the cell along x (m).
    pub(crate) cell: f64,
    /// Side of the cell along y (m).
    pub(crate) cell_y: f64,
    /// Mean height (m).
    pub(crate) mean: f64,
    /// Minimum height (m).
    pub(crate) h_min: f64,
    /// Maximum height (m).
    pub(crate) h_max: f64,
    /// Rms height about the mean (m).
    pub(crate) rms_height: f64,
    /// Rms slope √⟨|∇h|²⟩; from pairs of measured neighbours if points are missing.
    pub(crate) rms_slope: f64,
    /// Rms of the mean curvature ½∇²h (1/m); `None` if points are missing.
    pub(crate) rms_curvature: Option<f64>,
    /// Nayak's parameter α, which is at least 1.5 for a Gaussian isotropic surface; `None` if points are missing.
    pub(crate) nayak: Option<f64>,
    /// Ratio of the third central moment to the cube of the rms height.
    ///
    /// It is 0 for a Gaussian.
    pub(crate) skewness: f64,
    /// Ratio of the fourth central moment to the fourth power of the rms height.
    ///
    /// It is 3 for a Gaussian.
    pub(crate) kurtosis: f64,
    /// Probability density of heights about the mean (1/m).
    pub(crate) distribution: Histogram,
    /// Parameters of ISO 25178-2 (m), from differences of neighbours, without a filter.
    pub(crate) parameters: AreaParameters,
    /// Parameters of ISO 25178-2 from the material ratio curve and the autocorrelation.
    #[serde(flatten)]
    pub(crate) areal: ArealRow,
    /// Ratio of rms steps of heights: across the cell's border, to between inner neighbours.
    ///
    /// It is about 1 for a periodic map, and `None` if points are missing.
    pub(crate) border_step: Option<f64>,
    /// Whether the spectrum is of the heights under Hann's window, because they are not periodic.
    pub(crate) windowed: bool,
    /// Whether the spectrum is that of the measured part of a mirrored map.
    #[serde(skip)]
    pub(crate) of_part: bool,
    /// Exponent and ends of the power law in the spectrum.
    #[serde(flatten)]
    pub(crate) ends: EndsRow,
    /// The power law in the spectrum, if it has one.
    pub(crate) hurst_fit: Option<HurstRow>,
    /// Radially averaged power spectral density; empty if points are missing, or for one row or column.
    pub(crate) spectrum: Vec<SpectrumRow>,
    /// Measured map before its treatments and after each of them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) treatments: Vec<TreatmentRow>,
    /// Origin of the heights, if they are from a file of a map.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) source: Option<MapOrigin>,
    /// What the reader of the file did, one line each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) notes: Vec<String>,
    /// Doubts about the surface.
    pub(crate) warnings: Vec<Warning>,
    /// Channels of the map's file, if it has several.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) channels: Vec<ChannelRow>,
}

/// A channel of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct ChannelRow {
    /// Name for `--channel`.
    pub(crate) name: String,
    /// Whether its values are lengths.
    pub(crate) is_height: bool,
}

/// A power law C = C0 q^(-2(1+H)) through a part of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct HurstRow {
    /// Hurst exponent H.
    pub(crate) hurst: f64,
    /// C0, for C in m⁴ and q in rad/m.
    pub c0: f64,
    /// First wavenumber of the range, in waves per cell.
    pub(crate) from_waves: f64,
    /// Last wavenumber of the range, in waves per cell.
    pub(crate) to_waves: f64,
    /// Rms distance of the spectrum from the law with its ends, in ln C.
    pub(crate) deviation: f64,
}

/// Exponent and ends of the power law in the spectrum; `None` where it is not seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub(crate) struct EndsRow {
    /// Hurst exponent H.
    pub(crate) hurst: Option<f64>,
    /// Standard error of H.
    pub(crate) hurst_error: Option<f64>,
    /// Wavelength (m) above which the spectrum is flat.
    pub(crate) roll_off_wavelength: Option<f64>,
    /// Wavelength (m) of the shortest waves.
    pub(crate) cut_off_wavelength: Option<f64>,
    /// Wavelength (m) at which the spectrum is twice or half of the law, or which the points limit.
    pub(crate) resolution_wavelength: Option<f64>,
    /// What limits the resolution.
    pub(crate) resolution_reason: Option<&'static str>,
}

impl EndsRow {
    fn new(fit: &HurstFit, side: f64) -> Self {
        let reason = |limit| match limit {
            Limit::Noise => "noise",
            Limit::Blunt => "tip or lens",
            Limit::Grid => "spacing of the points",
        };
        Self {
            hurst: Some(fit.hurst),
            hurst_error: Some(fit.hurst_error),
            roll_off_wavelength: fit.roll_off.map(|waves| side / waves),
            cut_off_wavelength: fit.cut_off.map(|waves| side / waves),
            resolution_wavelength: fit.resolution.map(|(waves, _)| side / waves),
            resolution_reason: fit.resolution.map(|(_, limit)| reason(limit)),
        }
    }
}

impl HurstRow {
    /// The law of the spectrum of a part with side `side` (m), of which a side of the cell has `n_parts`.
    fn new(fit: HurstFit, (side, n_parts): (f64, f64)) -> Self {
        let exponent = 2.0 * (1.0 + fit.hurst);
        let c0 = fit.ln_c.exp() * side.powi(4) * (std::f64::consts::TAU / side).powf(exponent);
        let [from_waves, to_waves] = [fit.from, fit.to].map(|waves| n_parts * waves);
        Self { hurst: fit.hurst, c0, from_waves, to_waves, deviation: fit.deviation }
    }

    /// C (m⁴) on the line at `wavenumber` (rad/m).
    #[must_use]
    pub(crate) fn psd(&self, wavenumber: f64) -> f64 {
        self.c0 * wavenumber.powf(-2.0 * (1.0 + self.hurst))
    }
}

/// Statistics of a measured map after a treatment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct TreatmentRow {
    /// Name of the treatment.
    pub(crate) treatment: String,
    /// Number of points that were cut, replaced, filled or moved.
    pub(crate) changed: usize,
    /// Points along x and y.
    pub(crate) grid: [usize; 2],
    /// Number of missing points.
    pub(crate) missing: usize,
    /// Rms height about the mean (m).
    pub(crate) rms_height: f64,
    /// Rms slope from differences of neighbours.
    pub(crate) rms_slope: f64,
    /// Border step as in [`SurfaceRecord::border_step`]; `None` while points are missing.
    pub(crate) border_step: Option<f64>,
}

impl From<&Effect> for TreatmentRow {
    fn from(effect: &Effect) -> Self {
        let Effect { changed, missing, rms_height, rms_slope, border_step, .. } = *effect;
        let grid = [effect.grid.nx(), effect.grid.ny()];
        Self { treatment: effect.treatment.clone(), changed, grid, missing, rms_height, rms_slope, border_step }
    }
}

/// One ring of wave vectors in the spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct SpectrumRow {
    /// Waves per cell.
    pub(crate) waves: f64,
    /// q = 2π·waves/λ (rad/m).
    pub(crate) wavenumber: f64,
    /// C(q) (m⁴).
    pub(crate) psd: f64,
    /// Number of wave vectors in the ring.
    pub(crate) modes: usize,
}

impl SpectrumRow {
    /// The ring in the spectrum of a part with side `side` (m), of which a side of the cell has `n_parts`.
    fn new(ring: &SpectrumBin, (side, n_parts): (f64, f64)) -> Self {
        Self {
            waves: n_parts * ring.wavenumber,
            wavenumber: std::f64::consts::TAU * ring.wavenumber / side,
            psd: ring.psd * side.powi(4),
            modes: ring.n_modes,
        }
    }
}

impl SurfaceRecord {
    /// The record of `heights` (in λ) in a cell of side `side` (m).
    ///
    /// `moments` are exact ones if they are known, else [`rc_fractal::moments_of_grid`]. A map of one row or column has no
    /// texture and no spectrum of an area.
    #[must_use]
    pub(crate) fn of(heights: &Field, side: f64, moments: Moments) -> Self {
        Self::of_source(heights, side, moments, None)
    }

    /// The record of heights from `source`. The spectrum of a mirrored map is that of its measured part.
    pub(crate) fn of_source(heights: &Field, side: f64, moments: Moments, source: Option<MapOrigin>) -> Self {
        let with_moments = Self {
            rms_height: moments.rms_height * side,
            rms_slope: moments.rms_slope,
            rms_curvature: Some(moments.rms_curvature / side),
            nayak: Some(moments.nayak),
            border_step: Some(BorderStep::of(heights).ratio()),
            ..Self::of_measured(heights, side)
        };
        if heights.grid().nx().min(heights.grid().ny()) == 1 {
            return Self { source, ..with_moments };
        }
        let part = source.as_ref().and_then(|origin| mirrored::measured_part(heights, origin));
        let n_parts = if part.is_some() { 2.0 } else { 1.0 };
        let (seen, of_part) = (part.as_ref().unwrap_or(heights), (side / n_parts, n_parts));
        let windowed = !BorderStep::of(seen).is_periodic();
        let under_window = if windowed { Cow::Owned(rc_heights::hann(seen)) } else { Cow::Borrowed(seen) };
        let rings = radial_spectrum(&under_window);
        let fit = fit_hurst(&rings, &Measured::on(seen.grid(), windowed));
        Self {
            windowed,
            of_part: part.is_some(),
            ends: fit.map_or_else(EndsRow::default, |fit| EndsRow::new(&fit, of_part.0)),
            hurst_fit: fit.map(|fit| HurstRow::new(fit, of_part)),
            spectrum: rings.iter().map(|ring| SpectrumRow::new(ring, of_part)).collect(),
            areal: with_moments.areal.clone().with_texture(seen, &under_window, of_part.0),
            notes: part.iter().map(|_| mirrored::NOTE.to_owned()).collect(),
            source,
            ..with_moments
        }
    }

    /// Slope and range of the surface, for warnings.
    pub(crate) fn shape(&self) -> Shape {
        // The border of a map that is not periodic is no slope of the surface.
        let jumps = self.windowed && !self.of_part;
        let rms_slope = if jumps { self.parameters.sdq } else { self.rms_slope };
        Shape { rms_slope, range: self.h_max - self.h_min, sides: [self.cell, self.cell_y] }
    }

    /// The record of the measured points of `heights` (in λ, `NaN` where missing) in a cell of side `side` (m).
    ///
    /// What needs all points is absent.
    #[must_use]
    pub(crate) fn of_measured(heights: &Field, side: f64) -> Self {
        let (grid, statistics) = (heights.grid(), MapStatistics::of(heights, side));
        Self {
            grid: [grid.nx(), grid.ny()],
            missing: heights.values().iter().filter(|height| height.is_nan()).count(),
            cell: side,
            cell_y: side * grid.cell_ratio(),
            mean: statistics.mean,
            h_min: statistics.min,
            h_max: statistics.max,
            rms_height: statistics.parameters.sq,
            rms_slope: statistics.parameters.sdq,
            rms_curvature: None,
            nayak: None,
            skewness: statistics.parameters.ssk,
            kurtosis: statistics.parameters.sku,
            distribution: statistics.distribution,
            parameters: statistics.parameters,
            areal: ArealRow::of(heights, side, statistics.mean),
            border_step: None,
            windowed: false,
            of_part: false,
            ends: EndsRow::default(),
            hurst_fit: None,
            spectrum: Vec::new(),
            treatments: Vec::new(),
            source: None,
            notes: Vec::new(),
            warnings: Vec::new(),
            channels: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_core::Grid;
    use rc_fractal::moments_of_grid;
    use std::f64::consts::TAU;

    #[test]
    fn a_wave_has_the_statistics_of_a_wave() {
        let (amplitude, waves, side) = (1e-3, 4.0, 2.0);
        let field = Field::from_fn(Grid::square(64).expect("a grid"), |at| amplitude * (TAU * waves * at.x).cos());
        let statistics = SurfaceRecord::of(&field, side, moments_of_grid(&field));
        let close = |name: &str, value: f64, reference: f64| {
            assert!((value / reference - 1.0).abs() < 1e-9, "{name}: {value}, reference {reference}");
        };
        close("rms height", statistics.rms_height, amplitude * side / 2_f64.sqrt());
        close("rms slope", statistics.rms_slope, TAU * waves * amplitude / 2_f64.sqrt());
        close("kurtosis", statistics.kurtosis, 1.5);
        assert!(statistics.skewness.abs() < 1e-12, "skewness {}", statistics.skewness);
    }
}
