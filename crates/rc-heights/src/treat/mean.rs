//! The mean of what was measured.

use rc_core::Field;

/// Mean of the values that are there, and their number.
pub(super) fn mean(heights: &Field) -> (f64, usize) {
    let n = heights.values().iter().filter(|height| !height.is_nan()).count();
    (sum_rows(heights, |height| height) / n as f64, n)
}

/// Sum over the values that are there, row by row.
pub(super) fn sum_rows(heights: &Field, term: impl Fn(f64) -> f64) -> f64 {
    let rows = heights.values().chunks_exact(heights.grid().nx());
    rows.map(|row| row.iter().filter(|height| !height.is_nan()).map(|height| term(*height)).sum::<f64>()).sum()
}
