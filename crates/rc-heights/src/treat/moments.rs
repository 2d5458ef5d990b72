//! Mean, rms height and rms slope of the measured points.

use rc_core::Field;

/// rms about the mean of the values that are not `NaN`.
///
/// It is `NaN` without such values.
pub(super) fn rms_height(heights: &Field) -> f64 {
    let (mean, n) = mean(heights);
    let squares = sum_rows(heights, |height| (height - mean) * (height - mean));
    (squares / n as f64).sqrt()
}

/// Mean of the values that are not `NaN`, and their number.
pub(crate) fn mean(heights: &Field) -> (f64, usize) {
    let n = heights.values().iter().filter(|height| !height.is_nan()).count();
    (sum_rows(heights, |height| height) / n as f64, n)
}

/// Sum over the values that are not `NaN`, row by row.
fn sum_rows(heights: &Field, term: impl Fn(f64) -> f64) -> f64 {
    let rows = heights.values().chunks_exact(heights.grid().nx());
    rows.map(|row| row.iter().filter(|height| !height.is_nan()).map(|height| term(*height)).sum::<f64>()).sum()
}

/// √(⟨(∂h/∂x)²⟩ + ⟨(∂h/∂y)²⟩) from differences of measured neighbours.
pub(crate) fn rms_slope(heights: &Field, [dx, dy]: [f64; 2]) -> f64 {
    let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
    let mean_square = |differences: &mut dyn Iterator<Item = f64>| {
        let there = differences.filter(|difference| !difference.is_nan());
        let (sum, n) = there.fold((0.0, 0_usize), |(sum, n), difference| (sum + difference * difference, n + 1));
        if n > 0 { sum / n as f64 } else { 0.0 }
    };
    let along_x = (0..ny).flat_map(|iy| heights.row(iy).windows(2).map(move |pair| (pair[1] - pair[0]) / dx));
    let along_y = (1..ny)
        .flat_map(|iy| (0..nx).map(move |ix| (iy, ix)))
        .map(|(iy, ix)| (heights.at(ix, iy) - heights.at(ix, iy - 1)) / dy);
    (mean_square(&mut { along_x }) + mean_square(&mut { along_y })).sqrt()
}
