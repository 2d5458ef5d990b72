//! A realised surface: its amplitudes, and its height anywhere.

use std::f64::consts::TAU;

use rayon::prelude::*;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fft::{Complex64, field_of_columns};
use thiserror::Error;

use crate::draws::draw_column;
use crate::moments::SpectralSums;
use crate::waves::{Wave, WaveError, columns_of_waves};
use crate::{Moments, Normalisation, SpectrumError, SpectrumParams};

/// A band-limited surface of zero mean height on the unit cell: one realisation of a [`SpectrumParams`], or a sum of
/// given waves.
///
/// Holds one complex amplitude (16 bytes) for each wave vector of the half plane kx ≥ 0; the others are conjugates.
/// [`HeightField::height`] is the direct sum of Eq. 10 and costs one multiplication per wave; [`HeightField::sample`]
/// is the Fourier synthesis, equal to it at every element centre of any grid up to rounding.
#[derive(Clone, Debug)]
pub struct Surface {
    /// `None` of a surface that was not generated.
    params: Option<SpectrumParams>,
    /// The largest |kx| or |ky| of a wave; N of a generated surface.
    waves: usize,
    /// `columns[kx][reach + ky]`, with the reach of that column.
    columns: Vec<Vec<Complex64>>,
}

/// A grid that cannot carry the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SampleError {
    /// The shortest wave has two elements or less.
    #[error("a grid of {grid} is too coarse for {waves} waves: it needs at least {smallest} elements per side")]
    TooCoarse {
        /// The grid.
        grid: Grid,
        /// N of the surface.
        waves: usize,
        /// The smallest side that would do, 2N + 1.
        smallest: usize,
    },
    /// The surface repeats itself in squares.
    #[error("a surface made of waves needs a square cell")]
    RectangularCell,
}

impl Surface {
    /// The realisation of a spectrum (Eq. 10 to 14). The same parameters give the same surface, bit by bit, for any
    /// number of threads.
    ///
    /// A wave's phase depends on (seed, kx, ky) alone, and its Rayleigh factor too. So surfaces of one seed with
    /// different N, roll-off, truncation or kind of amplitude share the phases of their common waves.
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

    /// The surface that has these waves and no others (Eq. 10), in any order, its amplitudes in λ.
    ///
    /// A wave is given by k, by -k, whose amplitude is the conjugate, or by both if these agree to 1e-6; zeros may be
    /// left out. The mean height, k = 0, is not part of a surface and is dropped.
    ///
    /// # Errors
    /// [`WaveError`] when a wave is given twice, is not the conjugate of its opposite, is too short or not finite, or
    /// when all are zero.
    pub fn from_waves(waves: Vec<Wave>) -> Result<Self, WaveError> {
        let (columns, waves) = columns_of_waves(waves)?;
        Ok(Self { params: None, waves, columns })
    }

    /// The surface with all heights multiplied by `factor`; no longer that of a spectrum.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.columns.par_iter_mut().flatten().for_each(|amplitude| *amplitude = amplitude.scale(factor));
        Self { params: None, ..self }
    }

    /// The spectrum it realises; `None` of a surface of given waves.
    #[must_use]
    pub fn params(&self) -> Option<&SpectrumParams> {
        self.params.as_ref()
    }

    /// N, in waves per cell: the largest wavenumber of a generated surface, the largest component of a wave vector in
    /// one of given waves.
    #[must_use]
    pub fn waves(&self) -> usize {
        self.waves
    }

    /// Moments from exact sums over the waves, without any grid. Test `moments_are_those_of_the_paper` compares them
    /// with independently computed values to ten digits.
    #[must_use]
    pub fn moments(&self) -> Moments {
        self.sums().moments()
    }

    /// Amplitude `a_k` (Eq. 10) in λ; 0 for wave vectors outside the truncation and for k = 0.
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
    /// Equal to [`HeightField::sample`], which takes any grid and would return aliased waves on a coarser one.
    ///
    /// # Errors
    /// [`SampleError::TooCoarse`] when a side has less than 2N + 1 elements; [`SampleError::RectangularCell`].
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

    /// Columns are summed each by one thread and added in their order, so that rounding does not depend on threads.
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
            // Columns kx and -kx are conjugates of each other.
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

/// √⟨|`a_k`|²⟩ in λ where the spectral density is `density` in λ⁴, by Eq. (12) with δ(0) = (λ/2π)².
fn rms_amplitude(density: f64) -> f64 {
    TAU * density.sqrt()
}

/// Amplitudes of the waves with this kx, relative to the plateau: their mean squares are those of Eq. (13).
fn relative_column(params: &SpectrumParams, kx: usize) -> Vec<Complex64> {
    let reach = params.reach(kx);
    let mut column = draw_column(params.seed, kx, reach, params.amplitudes);
    for ky in 0..=reach {
        let size = params.relative_amplitude((kx * kx + ky * ky) as f64);
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

/// Largest ky of a column stored from -reach to reach.
fn reach(column: &[Complex64]) -> usize {
    column.len() / 2
}

/// exp(2πi k x), with the integer part of k x removed before rounding can reach the phase.
fn wave(k: usize, x: f64) -> Complex64 {
    let (k, x) = (k as f64, x - x.round());
    let turns = k * x;
    let lost = k.mul_add(x, -turns);
    Complex64::cis(TAU * (turns - turns.round() + lost))
}
