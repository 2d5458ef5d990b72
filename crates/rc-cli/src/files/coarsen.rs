//! Fields averaged to a coarser grid.

use rc_core::{Field, Grid};

use crate::error::CliError;
use crate::scene::values::GridSpec;

/// Checks that each number of elements in `spec` divides that of `grid`.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check_factor(grid: Grid, spec: GridSpec) -> Result<(), CliError> {
    if divides(grid, spec) {
        Ok(())
    } else {
        Err(CliError::input(format_args!("output_grid: {spec} does not divide the grid of {grid} elements")))
    }
}

fn divides(grid: Grid, spec: GridSpec) -> bool {
    let divides = |coarse: usize, fine: usize| coarse > 0 && fine.is_multiple_of(coarse);
    divides(spec.nx, grid.nx()) && divides(spec.ny, grid.ny())
}

/// Averages over the elements of each element of a coarser grid.
///
/// It takes the rows of the finer grid one after another, so the finer field is never stored as a whole. Means over the
/// cell are kept.
#[derive(Clone, Debug)]
pub(crate) struct BlockMean {
    grid: Grid,
    sums: Field,
    next_row: usize,
}

impl BlockMean {
    /// Averages from fields on `grid` to the grid `spec`.
    ///
    /// # Panics
    /// When `spec` does not divide the grid, see [`check_factor`].
    #[must_use]
    pub(crate) fn new(grid: Grid, spec: GridSpec) -> Self {
        assert!(divides(grid, spec), "{spec} does not divide {grid}");
        let coarse = grid.with_elements(spec.nx, spec.ny).expect("the sides divide those of a grid");
        Self { grid, sums: Field::zeros(coarse), next_row: 0 }
    }

    /// Takes the next rows.
    ///
    /// # Panics
    /// When there are more rows than the grid has.
    pub(crate) fn take(&mut self, rows: &[f64]) {
        let coarse = self.sums.grid();
        let (mx, my) = (self.grid.nx() / coarse.nx(), self.grid.ny() / coarse.ny());
        for row in rows.chunks_exact(self.grid.nx()) {
            let start = coarse.index(0, self.next_row / my);
            let sums = &mut self.sums.values_mut()[start..start + coarse.nx()];
            for (sum, values) in sums.iter_mut().zip(row.chunks_exact(mx)) {
                *sum += values.iter().sum::<f64>();
            }
            self.next_row += 1;
        }
    }

    /// The field of the averages.
    #[must_use]
    pub(crate) fn finish(mut self) -> Field {
        let per_element = self.sums.grid().len() as f64 / self.grid.len() as f64;
        self.sums.values_mut().iter_mut().for_each(|value| *value *= per_element);
        self.sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_keeps_the_mean_and_the_place() {
        let grid = Grid::new(4, 2).expect("a grid");
        let mut mean = BlockMean::new(grid, GridSpec { nx: 2, ny: 1 });
        mean.take(&[1., 3., 5., 7.]);
        mean.take(&[1., 3., 9., 11.]);
        assert_eq!(mean.finish().values(), [2.0, 8.0]);
        assert!(check_factor(grid, GridSpec::square(3)).is_err());
        assert!(check_factor(grid, GridSpec::square(0)).is_err());
    }
}
