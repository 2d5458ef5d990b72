//! Heights of a band-limited surface at the centres of any fine tile.
//!
//! They are interpolated from one grid that resolves the surface.

use rayon::prelude::*;
use rc_core::{DVec2, Field};
use rc_fft::{BLOCK_ROWS, Convolution, SymbolTable};

use crate::tiles::heights::stencil::{MAX_WIDTH, Stencil, Stencils};
use crate::tiles::heights::window::{Derivative, ERRORS, HIGHEST_FREQUENCY, TAPS, transform, window};
use rc_quadtree::TILE;

/// Number of coefficients before the first and after the last of a row.
///
/// Rows before the first and after the last are added too. They are periodic copies, so that a tile need not know where
/// the cell ends.
const HALO_BEFORE: usize = TAPS / 2;
const HALO_AFTER: usize = MAX_WIDTH;

/// Minimum number of elements per side for waves up to the band limit.
///
/// [`Interpolation`] needs four for the shortest wave.
pub(super) fn smallest_side(band_limit: usize) -> usize {
    (band_limit as f64 / HIGHEST_FREQUENCY) as usize
}

/// The stencil of a tile along one direction, and the coefficient that it counts from.
pub(super) type Place<'a> = (&'a Stencil, usize);

/// The coefficients of the interpolating windows, and stencils for finer levels.
///
/// Coefficients are on a grid of `side` × `side` cells. Memory: 8 bytes for each element of the grid.
#[derive(Clone)]
pub(super) struct Interpolation {
    side: usize,
    band_limit: usize,
    /// Mean height, which is not in the coefficients. The error is relative to heights without their mean.
    mean: f64,
    /// rms height about the mean.
    rms: f64,
    /// Coefficients with halo, row-major.
    coefficients: Vec<f64>,
    /// Stencils by level: cells of side 1/side, half of it, …
    levels: Vec<Stencils>,
}

impl Interpolation {
    /// Interpolation of samples with waves up to `band_limit`, on a square grid.
    ///
    /// There are at least [`smallest_side`] samples per side. Levels have side, 2·side, …, 2^(`n_levels` - 1)·side
    /// cells per side.
    pub(super) fn new(samples: Field, band_limit: usize, n_levels: u32) -> Self {
        let (side, mean) = (samples.grid().nx(), samples.mean());
        let squares =
            samples.values().chunks_exact(side).map(|row| row.iter().map(|h| (h - mean).powi(2)).sum::<f64>());
        let rms = squares.sum::<f64>().sqrt() / side as f64;
        let levels = (0..n_levels).map(|level| Stencils::new(level, Derivative::None)).collect();
        let coefficients = coefficients(samples, band_limit);
        Self { side, band_limit, mean, rms, coefficients, levels }
    }

    pub(super) fn side(&self) -> usize {
        self.side
    }

    pub(super) fn band_limit(&self) -> usize {
        self.band_limit
    }

    pub(super) fn mean(&self) -> f64 {
        self.mean
    }

    /// rms height about the mean.
    pub(super) fn rms(&self) -> f64 {
        self.rms
    }

    /// Upper bound of Σ |a_k| over all waves but the mean.
    ///
    /// It bounds the sum of an error per wave. There are less than (2N + 1)² waves, and Σ |a_k|² is the mean square.
    pub(super) fn amplitude(&self) -> f64 {
        (2 * self.band_limit + 1) as f64 * self.rms
    }

    /// Upper bound of the error of the heights of tiles, at any place.
    ///
    /// A wave is wrong by a factor (1 + δx)(1 + δy).
    pub(super) fn error(&self) -> f64 {
        (2.0 + ERRORS[0]) * ERRORS[0] * self.amplitude()
    }

    /// Writes the heights at the centres of tile (`tx`, `ty`).
    ///
    /// The level has 2^`level`·side cells per side.
    pub(super) fn tile(&self, level: usize, tx: usize, ty: usize, out: &mut [f64; TILE * TILE]) {
        let [x, y] = [tx, ty].map(|t| self.levels[level].of_tile(t));
        match x.0.width {
            0..=12 => self.apply::<12>(x, y, out),
            13..=16 => self.apply::<16>(x, y, out),
            _ => self.apply::<MAX_WIDTH>(x, y, out),
        }
    }

    /// Height at any place of the periodic cell of side 1.
    pub(super) fn height(&self, at: DVec2) -> f64 {
        let taps = |along: f64| {
            let place = along.rem_euclid(1.0) * self.side as f64 - 0.5;
            let left = place.floor();
            let weight = |tap| window(place - left + (TAPS / 2 - 1) as f64 - tap as f64, Derivative::None);
            // The halo before the first coefficient is half of the taps.
            ((left + 1.0) as usize, std::array::from_fn::<f64, TAPS, _>(weight))
        };
        let ((column, along_x), (row, along_y)) = (taps(at.x), taps(at.y));
        let rows = self.coefficients[row * stride(self.side)..].chunks(stride(self.side));
        let of_row = |row: &[f64]| row[column..].iter().zip(along_x).map(|(c, weight)| c * weight).sum::<f64>();
        self.mean + rows.zip(along_y).map(|(row, weight)| weight * of_row(row)).sum::<f64>()
    }

    fn apply<const WIDTH: usize>(&self, x: Place<'_>, y: Place<'_>, out: &mut [f64; TILE * TILE]) {
        for (row, out) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
            *out = across(&self.blend::<WIDTH>(x, y, row), x.0);
            for height in out {
                *height += self.mean;
            }
        }
    }

    /// Weighted sums of the coefficients along y, for one row of centres of a tile.
    ///
    /// There is one sum for each coefficient column that the tile uses. WIDTH is at least the width of the stencil
    /// along x, and at most [`MAX_WIDTH`].
    #[inline]
    pub(super) fn blend<const WIDTH: usize>(&self, x: Place<'_>, y: Place<'_>, row: usize) -> [f64; WIDTH] {
        let ((along_x, origin_x), (along_y, origin_y)) = (x, y);
        let stride = stride(self.side);
        let first_column = origin_x + along_x.starts[0];
        let rows = self.coefficients[(origin_y + along_y.starts[row]) * stride..].chunks_exact(stride);
        // The fixed width keeps the sums in registers.
        let mut blended = [0.0; WIDTH];
        for (row, weight) in rows.zip(&along_y.weights[row]) {
            for (sum, coefficient) in blended.iter_mut().zip(&row[first_column..first_column + WIDTH]) {
                *sum += weight * coefficient;
            }
        }
        blended
    }
}

/// Weighted sums along x of the sums of [`Interpolation::blend`]: values at one row of centres.
#[inline]
pub(super) fn across<const WIDTH: usize>(blended: &[f64; WIDTH], along_x: &Stencil) -> [f64; TILE] {
    let mut sums = [0.0; TILE];
    for (blended, weights) in blended.iter().zip(&along_x.by_coefficient) {
        for (sum, weight) in sums.iter_mut().zip(weights) {
            *sum += blended * weight;
        }
    }
    sums
}

/// Length of a row of coefficients with its halo.
fn stride(side: usize) -> usize {
    HALO_BEFORE + side + HALO_AFTER
}

/// Divides the waves of the samples by the transform of the window.
///
/// Drops everything that is not a wave of the surface: its mean, and rounding beyond the band limit.
fn coefficients(samples: Field, band_limit: usize) -> Vec<f64> {
    let grid = samples.grid();
    let (side, stride) = (grid.nx(), stride(grid.nx()));
    let factors: Vec<f64> = (0..=band_limit).map(|k| 1.0 / transform(k as f64 / side as f64)).collect();
    let symbol = SymbolTable::<f64>::new(grid, |kx, ky| match (factors.get(kx), factors.get(ky)) {
        (Some(x), Some(y)) if kx + ky > 0 => x * y,
        _ => 0.0,
    });
    let mut convolution = Convolution::<f64>::new(grid);
    convolution
        .transform_rows(samples.values().par_chunks(BLOCK_ROWS * side), |source, rows| rows.copy_from_slice(source));
    // Memory then holds two grids at a time, not three.
    drop(samples);
    convolution.apply_symbol(&symbol);
    let mut padded = vec![0.0; stride * stride];
    let interior = &mut padded[HALO_BEFORE * stride..][..side * stride];
    convolution.read_rows(interior.par_chunks_mut(BLOCK_ROWS * stride), |target, rows| {
        for (target, row) in target.chunks_exact_mut(stride).zip(rows.chunks_exact(side)) {
            target[HALO_BEFORE..HALO_BEFORE + side].copy_from_slice(row);
            for column in halo(side) {
                target[column] = row[inside(column, side)];
            }
        }
    });
    for row in halo(side) {
        let source = (HALO_BEFORE + inside(row, side)) * stride;
        padded.copy_within(source..source + stride, row * stride);
    }
    padded
}

/// Places of the halo in a padded line.
fn halo(side: usize) -> impl Iterator<Item = usize> {
    (0..HALO_BEFORE).chain(HALO_BEFORE + side..stride(side))
}

/// The cell whose copy is at a place in a padded line.
fn inside(padded: usize, side: usize) -> usize {
    (padded + side * HALO_BEFORE - HALO_BEFORE) % side
}
