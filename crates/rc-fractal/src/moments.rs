//! Moments of a surface: rms height, slope, curvature, and Nayak's parameter.

use std::f64::consts::TAU;

use rayon::prelude::*;
use rc_core::Field;
use rc_fft::powers_of_lines;

use crate::power::PowerSpectrum;

/// Heights that a thread sums without a division of its work. They take about 10 µs.
const HEIGHTS_OF_TASK: usize = 1 << 13;

/// Statistics of a whole periodic surface.
///
/// They follow from the amplitudes `a_k` with q = 2π|k| (Parseval): ⟨h²⟩ = Σ |a|², ⟨|∇h|²⟩ = Σ q² |a|², ⟨(∇²h)²⟩ = Σ
/// q⁴ |a|².
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Moments {
    /// rms height √⟨h²⟩ about the mean plane, in λ.
    pub rms_height: f64,
    /// rms slope √⟨|∇h|²⟩ of the whole gradient (isotropic), not of one profile.
    pub rms_slope: f64,
    /// rms mean curvature ½ √⟨(∇²h)²⟩, half the Laplacian, in 1/λ.
    pub rms_curvature: f64,
    /// Nayak's bandwidth parameter α = m0 m4 / m2², or `NaN` for a flat surface.
    ///
    /// For an isotropic surface, the moments of profiles are m0 = ⟨h²⟩, m2 = ⟨|∇h|²⟩/2 and m4 = (3/8) ⟨(∇²h)²⟩. So α =
    /// 1.5 ⟨h²⟩ ⟨(∇²h)²⟩ / ⟨|∇h|²⟩². Source: P. R. Nayak, *Random process model of rough surfaces*, J. Lubr. Technol.
    /// 93 (1971) 398-407.
    pub nayak: f64,
}

/// The three sums over waves from which all moments follow.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SpectralSums {
    /// Σ |a|².
    pub(crate) height: f64,
    /// Σ q² |a|².
    pub(crate) slope: f64,
    /// Σ q⁴ |a|².
    pub(crate) laplacian: f64,
}

impl SpectralSums {
    /// Adds waves of squared wavenumber |k|² whose |a|² have the sum `power`.
    pub(crate) fn add(&mut self, k_squared: f64, power: f64) {
        let q_squared = TAU * TAU * k_squared;
        self.height += power;
        self.slope += q_squared * power;
        self.laplacian += q_squared * q_squared * power;
    }

    /// The sums of both, where `other` is multiplied by `weight`.
    pub(crate) fn plus(self, other: Self, weight: f64) -> Self {
        Self {
            height: self.height + weight * other.height,
            slope: self.slope + weight * other.slope,
            laplacian: self.laplacian + weight * other.laplacian,
        }
    }

    pub(crate) fn moments(self) -> Moments {
        Moments {
            rms_height: self.height.sqrt(),
            rms_slope: self.slope.sqrt(),
            rms_curvature: 0.5 * self.laplacian.sqrt(),
            nayak: 1.5 * self.height * self.laplacian / (self.slope * self.slope),
        }
    }
}

/// Moments of a height map, with spectral derivatives through one Fourier transform.
///
/// The mean height is removed first. Moments are exact for a surface whose waves the grid resolves (|kx| < nx/2, |ky| <
/// ny/2), for any sides of the grid and of the cell. Test `moments_of_a_resolved_grid_equal_the_exact_sums` shows
/// 1e-10. A wave of exactly half a side counts with that wavenumber.
#[must_use]
pub fn moments_of_grid(heights: &Field) -> Moments {
    let spectrum = PowerSpectrum::of(heights);
    let mut total = SpectralSums::default();
    for column in spectrum.columns() {
        let mut sums = SpectralSums::default();
        for (ky, power) in column.powers() {
            sums.add(heights.grid().squared_waves(column.kx, ky), power);
        }
        total = total.plus(sums, column.multiplicity as f64);
    }
    total.moments()
}

/// rms height (λ) and rms slope of a height map.
///
/// They equal those of [`moments_of_grid`] up to rounding. The mean square ⟨|∂h/∂x|²⟩ is the mean over rows of Σ
/// q² |a|² with the waves of each row (Parseval along one axis). The mean square ⟨|∂h/∂y|²⟩ follows from columns in the
/// same way. So no second field is needed, unlike for the curvature.
#[must_use]
pub fn height_and_slope_of_grid(heights: &Field) -> [f64; 2] {
    let (grid, n) = (heights.grid(), heights.grid().len() as f64);
    let mean = sum_of_rows(heights, |h| h) / n;
    let squares = sum_of_rows(heights, |h| (h - mean).powi(2));
    let weights = |n: usize, squared_waves: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let multiplicity = |k: usize| if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
        (0..=n / 2).map(|k| multiplicity(k) * TAU * TAU * squared_waves(k) / n as f64).collect()
    };
    let of_rows = weights(grid.nx(), &|kx| grid.squared_waves(kx, 0));
    let of_columns = weights(grid.ny(), &|ky| grid.squared_waves(0, ky));
    let [along_x, along_y] = powers_of_lines(heights, mean, [&of_rows, &of_columns]);
    [squares / n, (along_x + along_y) / n].map(f64::sqrt)
}

/// The sum of `of_height` over all heights. The sum of each row is computed first.
fn sum_of_rows(heights: &Field, of_height: impl Fn(f64) -> f64 + Sync) -> f64 {
    let nx = heights.grid().nx();
    let of_row = |row: &[f64]| row.iter().map(|&h| of_height(h)).sum::<f64>();
    let rows = heights.values().par_chunks(nx).with_min_len(HEIGHTS_OF_TASK.div_ceil(nx)).map(of_row);
    rows.collect::<Vec<f64>>().into_iter().sum()
}

/// rms height (λ) and rms slope of a map whose opposite borders do not match.
///
/// Slopes are differences between neighbours inside the map. They are 5 % too small for a wave of eight elements, and
/// 0.3 % for a wave of 32 elements.
#[must_use]
pub fn height_and_slope_of_patch(heights: &Field) -> [f64; 2] {
    let (grid, spacing) = (heights.grid(), heights.grid().spacing());
    let (nx, ny) = (grid.nx(), grid.ny());
    let mean = heights.mean();
    let sums = |iy: usize| {
        let row = heights.row(iy);
        let squares = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let below = if iy + 1 < ny { squares(row, heights.row(iy + 1)) } else { 0.0 };
        [row.iter().map(|h| (h - mean).powi(2)).sum::<f64>(), squares(&row[..nx - 1], &row[1..]), below]
    };
    let rows: Vec<[f64; 3]> = (0..ny).into_par_iter().map(sums).collect();
    let [height, along_x, along_y] = rows.into_iter().fold([0.0; 3], |a, b| std::array::from_fn(|i| a[i] + b[i]));
    let per = |sum: f64, pairs: usize, side: f64| if pairs > 0 { sum / (pairs as f64 * side * side) } else { 0.0 };
    let slope = per(along_x, (nx - 1) * ny, spacing.x) + per(along_y, nx * (ny - 1), spacing.y);
    [height / grid.len() as f64, slope].map(f64::sqrt)
}
