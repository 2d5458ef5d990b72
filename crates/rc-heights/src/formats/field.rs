//! Fields of values whose number is known to be right.

use rc_core::{Field, Grid};

/// The field of values that were counted.
pub(super) fn field(grid: Grid, values: Vec<f64>) -> Field {
    Field::new(grid, values).expect("as many values as points")
}
