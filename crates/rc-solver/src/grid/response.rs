//! L on a grid as a convolution.

use rayon::prelude::*;
use rc_core::{Boundary, Field, Grid, Kernel};
use rc_fft::{Convolution, SymbolTable, TransformReal, half_plane_values};

use rc_fft::has_small_factors;

use crate::grid::factors::Factors;

/// Maximum prime factor of the periods of padded grids.
///
/// Fourier transforms of such lengths are fast.
const GREATEST_FACTOR: usize = 5;

/// L on a grid, as the symbol of a kernel.
///
/// The symbol is on the grid or on a larger one.
#[derive(Clone)]
pub(crate) struct GridResponse {
    grid: Grid,
    /// Number of elements of the transforms along both axes.
    period: [usize; 2],
    /// Factor of each wave of the period.
    pub(crate) factors: Factors<f64>,
    pub(crate) boundary: Boundary,
}

impl GridResponse {
    /// The response of `kernel` on `grid`.
    pub(crate) fn of(grid: Grid, kernel: &dyn Kernel) -> Self {
        if let Some(response) = kernel.free_response(grid) {
            let period = [grid.nx(), grid.ny()].map(padded_side);
            let table = table_of_response(padded_grid(grid, period), [grid.nx(), grid.ny()], &response);
            return Self { grid, period, factors: Factors::AtRest(table), boundary: Boundary::Free };
        }
        let mut factors = Factors::of(kernel, grid);
        if let Some(displacement) = kernel.uniform_displacement() {
            factors.set_mean(displacement / grid.len() as f64);
        }
        Self { grid, period: [grid.nx(), grid.ny()], factors, boundary: Boundary::Periodic }
    }

    /// The response of the elastic solid with the storage modulus of each wave.
    pub(crate) fn storage(self) -> Self {
        Self { factors: self.factors.storage(), ..self }
    }

    /// A convolution between the grid and the waves of the table.
    pub(crate) fn convolution<T: TransformReal>(&self) -> Convolution<T> {
        Convolution::padded(self.grid, self.period)
    }
}

/// Number of elements of a padded side of `n` elements.
///
/// No element acts on another around the border. The side has at most 1.25 times the elements that are needed.
pub(crate) fn padded_side(n: usize) -> usize {
    let is_fast = |side: &usize| side.is_multiple_of(2) && has_small_factors(*side, GREATEST_FACTOR);
    // One of these sides is a power of two.
    (2 * n - 1..=4 * n).find(is_fast).unwrap_or(4 * n)
}

/// The elements of a period around those of `grid`.
fn padded_grid(grid: Grid, [px, py]: [usize; 2]) -> Grid {
    let ratio = grid.cell_ratio() * (py as f64 / grid.ny() as f64) / (px as f64 / grid.nx() as f64);
    Grid::in_cell(px, py, ratio).expect("a grid whose double can be counted was checked")
}

/// The transform of the response to one element, on a period of elements `around` it.
///
/// The response is even along both axes. It is zero from `nx` and `ny` elements on.
pub(crate) fn table_of_response<T: TransformReal>(
    around: Grid,
    [nx, ny]: [usize; 2],
    response: &(dyn Fn(usize, usize) -> f64 + Sync),
) -> SymbolTable<T> {
    let (px, py) = (around.nx(), around.ny());
    let columns = nx.max(1);
    let mut quadrant = vec![0.0; nx * ny];
    quadrant.par_chunks_mut(columns).enumerate().for_each(|(iy, row)| {
        for (ix, value) in row.iter_mut().enumerate() {
            *value = response(ix, iy);
        }
    });
    let mut values = Field::zeros(around);
    values.values_mut().par_chunks_mut(px).enumerate().for_each(|(iy, row)| {
        let dy = iy.min(py - iy);
        if dy >= ny {
            // These rows lie between the pressures and their displacements. They are not read.
            return;
        }
        for (ix, value) in row.iter_mut().enumerate() {
            let dx = ix.min(px - ix);
            if dx < nx {
                *value = quadrant[dy * nx + dx];
            }
        }
    });
    let waves = half_plane_values(&values, 0.0, |wave| wave.re);
    SymbolTable::new(around, |kx, ky| waves[kx * py + ky])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padded_sides_keep_elements_apart() {
        for (n, expected) in [(1, 2), (2, 4), (3, 6), (64, 128), (100, 200), (1001, 2048), (2048, 4096), (2049, 4320)] {
            let side = padded_side(n);
            assert_eq!(side, expected, "{n}");
            assert!(side >= 2 * n - 1);
        }
        assert!((1..5000).all(|n| padded_side(n) as f64 <= 1.25 * (2 * n) as f64 || n < 12));
    }
}
