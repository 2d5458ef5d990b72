//! A realised surface, with its amplitudes and its height at any point.

use std::f64::consts::TAU;

use rayon::prelude::*;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fft::{Complex64, field_of_columns};
use thiserror::Error;

use crate::draws::draw_column;
use crate::moments::SpectralSums;
use crate::table::SpectrumTable;
use crate::waves::{Wave, WaveError, columns_of_waves};
use crate::{Amplitudes, Moments, Normalisation, SpectrumError, SpectrumParams};

/// A band-limited surface of zero mean height on the unit cell.
///
/// It is a realisation of a [`SpectrumParams`], or a sum of given waves. It holds one complex amplitude (16 bytes) for
/// each wave vector of the half plane kx ≥ 0. The other amplitudes are conjugates.
///
/// [`HeightField::height`] is the direct sum of Eq. 10 and costs one multiplication per wave. [`HeightField::sample`]
/// is the Fourier synthesis. It equals the direct sum up to rounding, at every element centre of any grid.
#[derive(Clone, Debug)]
pub struct Surface {
    /// `None` for a surface that was not generated.
    params: Option<SpectrumParams>,
    /// The largest |kx| or |ky| of a wave, which is N for a generated surface.
    waves: usize,
    /// `columns[kx][reach + ky]`, with the reach of this column.
    columns: Vec<Vec<Complex64>>,
}

/// A grid that cannot represent the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The shortest wave has no more than two elements.
    #[error("a grid of {grid} is too coarse for {waves} waves: it needs at least {smallest} elements per side")]
    TooCoarse {
        /// The grid.
        grid: Grid,
        /// N of the surface.
        waves: usize,
        /// The smallest sufficient number of elements per side, 2N + 1.
        smallest: usize,
    },
    /// The cell is not a square, but the surface repeats itself in squares.
    #[error("a surface made of waves needs a square cell")]
    RectangularCell,
}

impl Surface {
    /// The realisation of a spectrum (Eq. 10 to 14).
    ///
    /// The same parameters give bitwise the same surface, for any number of threads.
    ///
    /// The phase and the Rayleigh factor of a wave depend only on (seed, kx, ky). So surfaces with one seed and
    /// different N, roll-off, truncation or kind of amplitude have the same phases of their common waves.
    ///
    /// # Errors
    /// [`SpectrumError`] when a parameter is out of its range.
    pub fn new(params: &SpectrumParams) -> Result<Self, SpectrumError> {
        params.validate()?;
        let columns = (0..=params.waves).into_par_iter().map(|kx| relative_column(params, kx)).collect();
        let mut surface = Self { params: Some(*params), waves: params.waves, columns };
        let factor = match params.normalisation {
            Normalisation::RmsHeight(rms) => rms / surface.sums().height.sqrt(),
            Normalisation::RmsSlope(rms) => rms / surface.sums().slope.sqrt(),
            Normalisation::C0(c0) => rms_amplitude(c0),
        };
        surface.columns.par_iter_mut().flatten().for_each(|amplitude| *amplitude *= factor);
        Ok(surface)
    }

    /// The sum of given waves (Eq. 10), in any order, with amplitudes in λ.
    ///
    /// A wave is given by k, or by -k, whose amplitude is the conjugate. It may be given by both if these agree to
    /// 1e-6. Waves of amplitude zero may be omitted. The mean height, k = 0, is not part of a surface and is dropped.
    ///
    /// # Errors
    /// [`WaveError`] when a wave is given twice, is not the conjugate of its opposite, is too short or not finite. Also
    /// when all waves are zero.
    pub fn from_waves(waves: Vec<Wave>) -> Result<Self, WaveError> {
        let (columns, waves) = columns_of_waves(waves)?;
        Ok(Self { params: None, waves, columns })
    }

    /// A realisation of a tabulated spectrum.
    ///
    /// Phases, and the factors of random amplitudes, are those of [`Surface::new`] with this seed. With fixed amplitudes
    /// |`a_k`|² is (2π)² C(|k|) for every wave.
    #[must_use]
    pub fn from_table(table: &SpectrumTable, amplitudes: Amplitudes, seed: u64) -> Self {
        let column = |kx: usize| {
            let reach = table.reach(kx);
            let size = |k_squared: f64| rms_amplitude(table.density(k_squared.sqrt()));
            scaled_column(kx, draw_column(seed, kx, reach, amplitudes), size)
        };
        let columns = (0..=table.waves()).into_par_iter().map(column).collect();
        Self { params: None, waves: table.waves(), columns }
    }

    /// The surface with all heights multiplied by `factor`. It has no [`Surface::params`].
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.columns.par_iter_mut().flatten().for_each(|amplitude| *amplitude = amplitude.scale(factor));
        Self { params: None, ..self }
    }

    /// The spectrum of the surface, or `None` for a surface of given waves.
    #[must_use]
    pub fn params(&self) -> Option<&SpectrumParams> {
        self.params.as_ref()
    }

    /// N, in waves per cell.
    ///
    /// For a generated surface this is the largest wavenumber. For given waves it is the largest component of a wave
    /// vector.
    #[must_use]
    pub fn waves(&self) -> usize {
        self.waves
    }

    /// Moments from exact sums over the waves, without a grid.
    ///
    /// Test `moments_are_those_of_the_paper` compares them with independently computed values to ten digits.
    #[must_use]
    pub fn moments(&self) -> Moments {
        self.sums().moments()
    }

    /// Amplitude `a_k` (Eq. 10) in λ. It is 0 for wave vectors outside the truncation and for k = 0.
    #[must_use]
    pub fn amplitude(&self, kx: i64, ky: i64) -> Complex64 {
        let stored = |kx: i64, ky: i64| {
            let column = self.columns.get(usize::try_from(kx).ok()?)?;
            let index = ky.checked_add(reach(column) as i64)?;
            column.get(usize::try_from(index).ok()?).copied()
        };
        let amplitude =
            if kx < 0 { stored(kx.saturating_neg(), ky.saturating_neg()).map(|a| a.conj()) } else { stored(kx, ky) };
        amplitude.unwrap_or(Complex64::ZERO)
    }

    /// Heights at the element centres of a grid that resolves every wave.
    ///
    /// They equal [`HeightField::sample`], which takes any grid and returns aliased waves on a coarser grid.
    ///
    /// # Errors
    /// - [`SampleError::TooCoarse`] when a side has fewer than 2N + 1 elements.
    /// - [`SampleError::RectangularCell`] when the cell is not a square.
    pub fn sample_on(&self, grid: Grid) -> Result<Field, SampleError> {
        let waves = self.waves();
        if !grid.has_square_cell() {
            return Err(SampleError::RectangularCell);
        }
        if grid.resolved_wavenumber() < waves {
            return Err(SampleError::TooCoarse { grid, waves, smallest: 2 * waves + 1 });
        }
        Ok(self.sample(grid))
    }

    /// Sums over all waves.
    ///
    /// Each column is summed by one thread. Columns are added in their order, so that rounding does not depend on the
    /// number of threads.
    fn sums(&self) -> SpectralSums {
        let of_columns: Vec<SpectralSums> = self.columns.par_iter().enumerate().map(column_sums).collect();
        let mut columns = of_columns.into_iter();
        let axis = columns.next().unwrap_or_default();
        columns.fold(axis, |total, column| total.plus(column, 2.0))
    }
}

impl HeightField for Surface {
    /// The direct sum over waves, Eq. (10).
    fn height(&self, at: DVec2) -> f64 {
        let along_y: Vec<Complex64> = (0..=self.waves()).map(|ky| wave(ky, at.y)).collect();
        let mut height = 0.0;
        for (kx, column) in self.columns.iter().enumerate() {
            let reach = reach(column);
            let mut sum = column[reach];
            for ky in 1..=reach {
                sum += column[reach + ky] * along_y[ky] + column[reach - ky] * along_y[ky].conj();
            }
            // Columns kx and -kx are conjugates.
            let multiplicity = if kx == 0 { 1.0 } else { 2.0 };
            height += multiplicity * (sum * wave(kx, at.x)).re;
        }
        height
    }

    fn band_limit(&self) -> Option<usize> {
        Some(self.waves())
    }

    fn sample(&self, grid: Grid) -> Field {
        if grid.has_square_cell() {
            field_of_columns(&self.columns, grid)
        } else {
            Field::from_fn(grid, |at| self.height(at))
        }
    }
}

/// rms amplitude √⟨|`a_k`|²⟩ in λ for a spectral density in λ⁴, by Eq. (12) with δ(0) = (λ/2π)².
fn rms_amplitude(density: f64) -> f64 {
    TAU * density.sqrt()
}

/// Amplitudes of the waves with this kx, relative to the plateau.
///
/// Their mean squares follow Eq. (13).
fn relative_column(params: &SpectrumParams, kx: usize) -> Vec<Complex64> {
    let column = draw_column(params.seed, kx, params.reach(kx), params.amplitudes);
    scaled_column(kx, column, |k_squared| params.relative_amplitude(k_squared))
}

/// The column of kx with the amplitude of each wave multiplied by `size` of its |k|².
fn scaled_column(kx: usize, mut column: Vec<Complex64>, size: impl Fn(f64) -> f64) -> Vec<Complex64> {
    let reach = reach(&column);
    for ky in 0..=reach {
        let size = size((kx * kx + ky * ky) as f64);
        column[reach + ky] *= size;
        if ky > 0 {
            column[reach - ky] *= size;
        }
    }
    column
}

fn column_sums((kx, column): (usize, &Vec<Complex64>)) -> SpectralSums {
    let reach = reach(column);
    let mut sums = SpectralSums::default();
    for (index, amplitude) in column.iter().enumerate() {
        let ky = index.abs_diff(reach);
        sums.add((kx * kx + ky * ky) as f64, amplitude.norm_sqr());
    }
    sums
}

/// Largest ky of a column that holds -reach to reach.
fn reach(column: &[Complex64]) -> usize {
    column.len() / 2
}

/// exp(2πi k x). The integer part of x is removed before its rounding reaches the phase.
fn wave(k: usize, x: f64) -> Complex64 {
    let (k, x) = (k as f64, x - x.round());
    let turns = k * x;
    let lost = k.mul_add(x, -turns);
    Complex64::cis(TAU * (turns - turns.round() + lost))
}
