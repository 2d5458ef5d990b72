//! Fields averaged to a coarser grid.

use rc_core::{Field, Grid};

use crate::error::CliError;
use crate::values::GridSpec;

/// Checks that each side of `spec` divides that of `grid`.
///
/// # Errors
/// [`CliError::Input`].
pub fn check_factor(grid: Grid, spec: GridSpec) -> Result<(), CliError> {
    let divides = |coarse: usize, fine: usize| coarse > 0 && fine.is_multiple_of(coarse);
    if divides(spec.nx, grid.nx()) && divides(spec.ny, grid.ny()) {
        Ok(())
    } else {
        Err(CliError::input(format_args!("output_grid: {spec} does not divide the grid of {grid} elements")))
    }
}

/// `field` on the coarser grid `spec`: the mean over the elements of each new one, so means over the cell are kept.
///
/// # Panics
/// When `spec` does not divide the grid, see [`check_factor`].
#[must_use]
pub fn averaged(field: &Field, spec: GridSpec) -> Field {
    let grid = field.grid();
    let coarse = Grid::new(spec.nx, spec.ny).expect("the caller has checked the grid");
    let (mx, my) = (grid.nx() / spec.nx, grid.ny() / spec.ny);
    assert!(mx * spec.nx == grid.nx() && my * spec.ny == grid.ny(), "{spec} does not divide {grid}");
    let mut mean = Field::zeros(coarse);
    for iy in 0..grid.ny() {
        let start = coarse.index(0, iy / my);
        let sums = &mut mean.values_mut()[start..start + spec.nx];
        for (sum, values) in sums.iter_mut().zip(field.row(iy).chunks_exact(mx)) {
            *sum += values.iter().sum::<f64>();
        }
    }
    let per_element = 1.0 / (mx * my) as f64;
    mean.values_mut().iter_mut().for_each(|value| *value *= per_element);
    mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_keeps_the_mean_and_the_place() {
        let field =
            Field::new(Grid::new(4, 2).expect("a grid"), vec![1., 3., 5., 7., 1., 3., 9., 11.]).expect("a field");
        let coarse = averaged(&field, GridSpec { nx: 2, ny: 1 });
        assert_eq!(coarse.values(), [2.0, 8.0]);
        assert!(check_factor(field.grid(), GridSpec::square(3)).is_err());
        assert!(check_factor(field.grid(), GridSpec::square(0)).is_err());
    }
}
