//! Statistics of height maps and of pressures, in SI.

use rc_core::Field;
use rc_fractal::{HurstFit, Moments, fit_hurst, radial_spectrum};
use rc_heights::{AreaParameters, BorderStep, Effect};
use serde::Serialize;

/// Bins of a histogram.
const BINS: usize = 40;

/// What a height map is like.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HeightStatistics {
    /// Elements along x and y.
    pub grid: [usize; 2],
    /// Side of the cell along x (m).
    pub cell: f64,
    /// Side of the cell along y (m).
    pub cell_y: f64,
    /// Mean height (m).
    pub mean: f64,
    /// Lowest height (m).
    pub h_min: f64,
    /// Greatest height (m).
    pub h_max: f64,
    /// Rms height about the mean (m).
    pub rms_height: f64,
    /// Rms slope √⟨|∇h|²⟩.
    pub rms_slope: f64,
    /// Rms of the mean curvature ½∇²h (1/m).
    pub rms_curvature: f64,
    /// Nayak's parameter α; 1.5 at least for a Gaussian isotropic surface.
    pub nayak: f64,
    /// Third central moment over the cube of the rms height; 0 for a Gaussian.
    pub skewness: f64,
    /// Fourth central moment over the fourth power of the rms height; 3 for a Gaussian.
    pub kurtosis: f64,
    /// Probability density of heights about the mean (1/m).
    pub distribution: Histogram,
    /// Parameters of ISO 25178-2 (m), from differences of neighbours, without a filter.
    pub parameters: AreaParameters,
    /// Rms step of heights across the border of the cell over that between neighbours inside; about 1 when periodic.
    pub border_step: f64,
    /// Whether the spectrum is that of the heights under Hann's window, because they are not periodic.
    pub windowed: bool,
    /// The power law in the spectrum, if there is one.
    pub hurst_fit: Option<HurstRow>,
    /// Radially averaged power spectral density.
    pub spectrum: Vec<SpectrumRow>,
    /// What was done to a measured map, state by state.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub treatments: Vec<TreatmentRow>,
}

/// Border steps above this ratio make a map one that is not periodic; those of a periodic one are about 1.
const PERIODIC: f64 = 3.0;

/// A power law C = C0 q^(-2(1+H)) through a part of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HurstRow {
    /// Hurst exponent H.
    pub hurst: f64,
    /// C0, for C in m⁴ and q in rad/m.
    pub c0: f64,
    /// First wavenumber of the range, in waves per cell.
    pub from_waves: f64,
    /// Last wavenumber of the range, in waves per cell.
    pub to_waves: f64,
    /// Rms distance of the spectrum from the law, in ln C.
    pub deviation: f64,
}

impl HurstRow {
    fn new(fit: HurstFit, side: f64) -> Self {
        let exponent = 2.0 * (1.0 + fit.hurst);
        let c0 = fit.ln_c.exp() * side.powi(4) * (std::f64::consts::TAU / side).powf(exponent);
        Self { hurst: fit.hurst, c0, from_waves: fit.from, to_waves: fit.to, deviation: fit.deviation }
    }

    /// C (m⁴) on the line at `wavenumber` (rad/m).
    #[must_use]
    pub fn psd(&self, wavenumber: f64) -> f64 {
        self.c0 * wavenumber.powf(-2.0 * (1.0 + self.hurst))
    }
}

/// A measured map after a treatment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TreatmentRow {
    /// The treatment.
    pub treatment: String,
    /// Points along x and y.
    pub grid: [usize; 2],
    /// Points that are missing.
    pub missing: usize,
    /// Rms height about the mean (m).
    pub rms_height: f64,
    /// Rms slope from differences of neighbours.
    pub rms_slope: f64,
    /// As [`HeightStatistics::border_step`]; `None` while points are missing.
    pub border_step: Option<f64>,
}

impl From<&Effect> for TreatmentRow {
    fn from(effect: &Effect) -> Self {
        let Effect { missing, rms_height, rms_slope, border_step, .. } = *effect;
        let grid = [effect.grid.nx(), effect.grid.ny()];
        Self { treatment: effect.treatment.clone(), grid, missing, rms_height, rms_slope, border_step }
    }
}

/// One ring of wave vectors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SpectrumRow {
    /// Waves per cell.
    pub waves: f64,
    /// q = 2π·waves/λ (rad/m).
    pub wavenumber: f64,
    /// C(q) (m⁴).
    pub psd: f64,
    /// Wave vectors in the ring.
    pub modes: usize,
}

/// A probability density in bins of equal width.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Histogram {
    /// Lower end of the first bin.
    pub low: f64,
    /// Upper end of the last bin.
    pub high: f64,
    /// Density in each bin; its integral is 1.
    pub density: Vec<f64>,
}

impl Histogram {
    /// The density of the values in [`low`, `high`]; values outside are passed over. Zero everywhere when there are none.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>, low: f64, high: f64) -> Self {
        let mut counts = [0_u64; BINS];
        let per_width = BINS as f64 / (high - low);
        for value in values.filter(|value| (low..=high).contains(value)) {
            counts[(((value - low) * per_width) as usize).min(BINS - 1)] += 1;
        }
        let total: u64 = counts.iter().sum();
        let scale = if total > 0 { per_width / total as f64 } else { 0.0 };
        Self { low, high, density: counts.iter().map(|count| *count as f64 * scale).collect() }
    }

    /// Middle and density of each bin.
    pub fn bins(&self) -> impl Iterator<Item = (f64, f64)> {
        let width = (self.high - self.low) / self.density.len() as f64;
        self.density.iter().enumerate().map(move |(i, density)| (self.low + (i as f64 + 0.5) * width, *density))
    }
}

impl HeightStatistics {
    /// Statistics of `heights` (in λ) in a cell of side `side` (m). `moments` are exact ones where they are known, else
    /// [`rc_fractal::moments_of_grid`].
    #[must_use]
    pub fn of(heights: &Field, side: f64, moments: Moments) -> Self {
        let grid = heights.grid();
        // The mean of a random surface is zero up to rounding.
        let mean = Some(heights.mean()).filter(|mean| mean.abs() > 1e-12 * moments.rms_height).unwrap_or(0.0);
        let [second, third, fourth] = central_moments(heights, mean);
        let values = heights.values().iter().map(|height| (height - mean) * side);
        let (low, high) = ((heights.min() - mean) * side, (heights.max() - mean) * side);
        let border_step = BorderStep::of(heights).ratio();
        let windowed = border_step > PERIODIC;
        let rings = if windowed { radial_spectrum(&rc_heights::hann(heights)) } else { radial_spectrum(heights) };
        let hurst_fit = fit_hurst(&rings).map(|fit| HurstRow::new(fit, side));
        let spectrum = rings.into_iter().map(|bin| SpectrumRow {
            waves: bin.wavenumber,
            wavenumber: std::f64::consts::TAU * bin.wavenumber / side,
            psd: bin.psd * side.powi(4),
            modes: bin.n_modes,
        });
        Self {
            grid: [grid.nx(), grid.ny()],
            cell: side,
            cell_y: side * grid.cell_ratio(),
            mean: mean * side,
            h_min: heights.min() * side,
            h_max: heights.max() * side,
            rms_height: moments.rms_height * side,
            rms_slope: moments.rms_slope,
            rms_curvature: moments.rms_curvature / side,
            nayak: moments.nayak,
            skewness: third / second.powf(1.5),
            kurtosis: fourth / (second * second),
            distribution: Histogram::of(values, low, high),
            parameters: AreaParameters::of(heights, [1.0, grid.cell_ratio()]).scaled(side),
            border_step,
            windowed,
            hurst_fit,
            spectrum: spectrum.collect(),
            treatments: Vec::new(),
        }
    }
}

/// ⟨(h - mean)^n⟩ for n = 2, 3, 4, summed row by row.
fn central_moments(heights: &Field, mean: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for iy in 0..heights.grid().ny() {
        let mut row_sums = [0.0; 3];
        for height in heights.row(iy) {
            let d = height - mean;
            row_sums[0] += d * d;
            row_sums[1] += d * d * d;
            row_sums[2] += d * d * d * d;
        }
        for (sum, row_sum) in sums.iter_mut().zip(row_sums) {
            *sum += row_sum;
        }
    }
    sums.map(|sum| sum / heights.values().len() as f64)
}

/// What a pressure field is like.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PressureStatistics {
    /// Elements along x and y of the stored field.
    pub grid: [usize; 2],
    /// Part of the elements with p > 0.
    pub area_fraction_cells: f64,
    /// Mean over the cell (Pa).
    pub mean_pressure: f64,
    /// Root mean square over the cell (Pa).
    pub rms_pressure: f64,
    /// Greatest pressure (Pa).
    pub max_pressure: f64,
    /// Mean over the contact (Pa).
    pub mean_contact_pressure: f64,
    /// Probability density of the pressure in contact (1/Pa).
    pub distribution: Histogram,
}

impl PressureStatistics {
    /// Statistics of `pressure` (Pa).
    #[must_use]
    pub fn of(pressure: &Field) -> Self {
        let grid = pressure.grid();
        let in_contact = pressure.values().iter().copied().filter(|p| *p > 0.0);
        let fraction = in_contact.clone().count() as f64 / grid.len() as f64;
        let (mean, max) = (pressure.mean(), pressure.max());
        Self {
            grid: [grid.nx(), grid.ny()],
            area_fraction_cells: fraction,
            mean_pressure: mean,
            rms_pressure: pressure.rms(),
            max_pressure: max,
            mean_contact_pressure: if fraction > 0.0 { mean / fraction } else { 0.0 },
            distribution: Histogram::of(in_contact, 0.0, max),
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
        let statistics = HeightStatistics::of(&field, side, moments_of_grid(&field));
        let close = |name: &str, value: f64, reference: f64| {
            assert!((value / reference - 1.0).abs() < 1e-9, "{name}: {value}, reference {reference}");
        };
        close("rms height", statistics.rms_height, amplitude * side / 2_f64.sqrt());
        close("rms slope", statistics.rms_slope, TAU * waves * amplitude / 2_f64.sqrt());
        close("kurtosis", statistics.kurtosis, 1.5);
        assert!(statistics.skewness.abs() < 1e-12, "skewness {}", statistics.skewness);
    }

    #[test]
    fn the_integral_of_a_density_is_one() {
        let histogram = Histogram::of((0..1000).map(f64::from), 0.0, 999.0);
        let integral = histogram.density.iter().sum::<f64>() * 999.0 / histogram.density.len() as f64;
        assert!((integral - 1.0).abs() < 1e-12, "integral {integral}");
    }
}
