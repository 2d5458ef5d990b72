//! Values on a grid.

use glam::DVec2;
use thiserror::Error;

use crate::Grid;

/// Values at the element centres of a [`Grid`], row-major.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    grid: Grid,
    values: Vec<f64>,
}

/// The number of values does not match the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a field on {grid} elements needs {expected} values, not {actual}", expected = grid.len())]
pub struct ShapeError {
    /// The grid.
    pub grid: Grid,
    /// Number of values given.
    pub actual: usize,
}

impl Field {
    /// A field from its values, `values[iy * nx + ix]`.
    ///
    /// # Errors
    /// [`ShapeError`] when `values.len() != grid.len()`.
    pub fn new(grid: Grid, values: Vec<f64>) -> Result<Self, ShapeError> {
        if values.len() == grid.len() {
            Ok(Self { grid, values })
        } else {
            Err(ShapeError { grid, actual: values.len() })
        }
    }

    /// A field of zeros.
    #[must_use]
    pub fn zeros(grid: Grid) -> Self {
        Self { grid, values: vec![0.0; grid.len()] }
    }

    /// A field that holds the value of a function at each element centre. The function takes the centre in λ.
    #[must_use]
    pub fn from_fn(grid: Grid, mut value: impl FnMut(DVec2) -> f64) -> Self {
        let mut values = Vec::with_capacity(grid.len());
        for iy in 0..grid.ny() {
            for ix in 0..grid.nx() {
                values.push(value(grid.centre(ix, iy)));
            }
        }
        Self { grid, values }
    }

    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        self.grid
    }

    /// The values, row-major.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values, mutable.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The values, without the grid.
    #[must_use]
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }

    /// Value at element (`ix`, `iy`).
    ///
    /// # Panics
    /// When the element is outside the grid.
    #[must_use]
    pub fn at(&self, ix: usize, iy: usize) -> f64 {
        self.values[self.grid.index(ix, iy)]
    }

    /// Row `iy`.
    ///
    /// # Panics
    /// When `iy` is outside the grid.
    #[must_use]
    pub fn row(&self, iy: usize) -> &[f64] {
        let nx = self.grid.nx();
        &self.values[iy * nx..(iy + 1) * nx]
    }

    /// Mean over the cell.
    ///
    /// Each row is summed first. Rounding errors therefore grow with the side of the grid, not with its number of
    /// elements.
    #[must_use]
    pub fn mean(&self) -> f64 {
        let rows = self.values.chunks_exact(self.grid.nx());
        rows.map(|row| row.iter().sum::<f64>()).sum::<f64>() / self.values.len() as f64
    }

    /// Root mean square over the cell. The mean is not subtracted.
    #[must_use]
    pub fn rms(&self) -> f64 {
        let rows = self.values.chunks_exact(self.grid.nx());
        (rows.map(|row| row.iter().map(|v| v * v).sum::<f64>()).sum::<f64>() / self.values.len() as f64).sqrt()
    }

    /// Smallest value. NaN values are ignored.
    #[must_use]
    pub fn min(&self) -> f64 {
        extreme(&self.values, f64::INFINITY, |value, least| value < least)
    }

    /// Largest value. NaN values are ignored.
    #[must_use]
    pub fn max(&self) -> f64 {
        extreme(&self.values, f64::NEG_INFINITY, |value, greatest| value > greatest)
    }
}

/// The extreme of all values and `start`, where `is_beyond` compares two values.
///
/// Sixteen lanes are compared independently, so the compiler can use vector instructions.
fn extreme(values: &[f64], start: f64, is_beyond: impl Fn(f64, f64) -> bool) -> f64 {
    let farther = |value: f64, so_far: f64| if is_beyond(value, so_far) { value } else { so_far };
    let (chunks, rest) = values.as_chunks::<16>();
    let mut lanes = [start; 16];
    for chunk in chunks {
        for (lane, &value) in lanes.iter_mut().zip(chunk) {
            *lane = farther(value, *lane);
        }
    }
    lanes.iter().chain(rest).fold(start, |so_far, &value| farther(value, so_far))
}
