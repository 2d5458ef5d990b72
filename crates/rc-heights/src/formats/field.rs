//! Fields of values whose number is already checked.

use rc_core::{Field, Grid};

/// The field of values whose number is already checked.
pub(super) fn field(grid: Grid, values: Vec<f64>) -> Field {
    Field::new(grid, values).expect("as many values as points")
}

/// Reverses each row of row-major values (x), the order of rows (y), or both.
pub(super) fn flip(values: &mut [f64], grid: Grid, [x, y]: [bool; 2]) {
    match (x, y) {
        (true, true) => values.reverse(),
        (true, false) => values.chunks_mut(grid.nx()).for_each(<[f64]>::reverse),
        (false, true) => {
            values.reverse();
            values.chunks_mut(grid.nx()).for_each(<[f64]>::reverse);
        }
        (false, false) => {}
    }
}

/// Row-major values of an array that is stored column by column.
pub(super) fn transposed(stored: &[f64], grid: Grid) -> Vec<f64> {
    let (nx, ny) = (grid.nx(), grid.ny());
    (0..ny).flat_map(|iy| (0..nx).map(move |ix| stored[ix * ny + iy])).collect()
}
