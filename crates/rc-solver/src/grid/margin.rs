//! The approximate inverse of L for heights with free borders.
//!
//! It is the inverse of a periodic cell with a margin around the heights. Outside of the heights the surface is as free
//! as between contacts, and a residual is extended smoothly over it ([`super::extension`]). A margin is enough, because
//! the surface farther away matters only to long waves, of which there are few. `docs/constants.md` has the
//! iterations with and without it.

use rc_core::{Grid, Kernel};
use rc_fft::{Convolution, SymbolTable};

use crate::grid::inverse::Inverse;
use crate::parallel;
use rc_fft::has_small_factors;

/// Width of the margin, relative to a side of the heights.
const MARGIN: f64 = 0.25;

/// Maximum prime factor of the sides with their margins.
///
/// Fourier transforms of such lengths are fast.
const GREATEST_FACTOR: usize = 5;

/// Heights in the corner of a periodic cell that is larger by a margin.
pub(super) struct Margin {
    inner: Grid,
    convolution: Convolution<f32>,
    active: Vec<bool>,
    values: Vec<f32>,
}

impl Margin {
    /// A margin around heights on `inner`.
    pub(super) fn around(inner: Grid) -> Self {
        let [nx, ny] = [inner.nx(), inner.ny()].map(with_margin);
        let ratio = inner.cell_ratio() * (ny as f64 / inner.ny() as f64) / (nx as f64 / inner.nx() as f64);
        let grid = Grid::in_cell(nx, ny, ratio).expect("a padded grid is larger, and was checked");
        Self {
            inner,
            convolution: Convolution::new(grid),
            active: vec![false; grid.len()],
            values: vec![0.0; grid.len()],
        }
    }

    /// The grid with the margin. Its side is its own unit of length.
    pub(super) fn grid(&self) -> Grid {
        self.convolution.grid()
    }

    /// The inverse symbol of `kernel`, in units of the heights' cell.
    pub(super) fn inverse(&self, kernel: &dyn Kernel) -> SymbolTable<f32> {
        let (grid, scale) = (self.grid(), self.inner.nx() as f64 / self.grid().nx() as f64);
        let inverse = SymbolTable::<f64>::new(grid, kernel.symbol(grid)).inverse::<f64>(grid);
        inverse.map(|value| (scale * value) as f32)
    }

    /// Sets the active elements, and returns them with those of the margin.
    pub(super) fn set_active(&mut self, active: &[bool]) -> &[bool] {
        let [from, to] = [self.inner.nx(), self.grid().nx()];
        parallel::for_each(self.active.chunks_mut(to).zip(active.chunks(from)), |(row, active)| {
            row[..from].copy_from_slice(active);
        });
        &self.active
    }

    /// Applies the inverse to values that are zero where elements are not active.
    pub(super) fn apply(&mut self, inverse: &mut Inverse, values: &mut [f32]) {
        let [from, to] = [self.inner.nx(), self.grid().nx()];
        // The inverse leaves zeros in the margin.
        parallel::for_each(self.values.chunks_mut(to).zip(values.chunks(from)), |(row, values)| {
            row[..from].copy_from_slice(values);
        });
        inverse.apply(&mut self.convolution, &self.active, &mut self.values);
        parallel::for_each(self.values.chunks(to).zip(values.chunks_mut(from)), |(row, values)| {
            values.copy_from_slice(&row[..from]);
        });
    }
}

/// Length of a side of `n` elements with its margin.
fn with_margin(n: usize) -> usize {
    let least = ((1.0 + MARGIN) * n as f64).ceil() as usize;
    // One of these sides is a power of two.
    (least..=2 * least)
        .find(|&side| side.is_multiple_of(2) && has_small_factors(side, GREATEST_FACTOR))
        .unwrap_or(2 * n)
}
