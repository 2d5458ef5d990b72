//! Transforms of the lines of a real field, along one axis at a time.
//!
//! They need no second field.

use rayon::prelude::*;
use rc_core::Field;

use crate::TransformReal;

/// Number of columns that are gathered at once. Fewer columns would use little of each cache line.
const PANEL: usize = 32;

/// Weighted powers of the waves along rows and along columns, of a field minus `offset`.
///
/// The first value is the sum over all rows of `Σ weights[k] |w_k|²`, and the second is the sum over all columns. The
/// waves of a line of n values f are w_k = Σ f exp(-2πi jk/n), k = 0, …, n/2.
///
/// The result is bitwise the same for any number of threads. *Memory*: a few lines.
///
/// # Panics
/// When there are not n/2 + 1 weights for the n elements along each axis.
#[must_use]
pub fn powers_of_lines(field: &Field, offset: f64, [of_rows, of_columns]: [&[f64]; 2]) -> [f64; 2] {
    let (nx, ny) = (field.grid().nx(), field.grid().ny());
    assert!(of_rows.len() == nx / 2 + 1 && of_columns.len() == ny / 2 + 1, "one weight for each wave");
    let rows = sum(ny, nx, of_rows, |first, lines| {
        for (shifted, value) in lines.iter_mut().zip(&field.values()[first * nx..]) {
            *shifted = value - offset;
        }
    });
    let columns = sum(nx, ny, of_columns, |first, lines| {
        let n = lines.len() / ny;
        for iy in 0..ny {
            for (column, value) in field.row(iy)[first..first + n].iter().enumerate() {
                lines[column * ny + iy] = value - offset;
            }
        }
    });
    [rows, columns]
}

/// The sum over `n_lines` lines of `length` values. `read(first, lines)` writes the lines from `first` on.
fn sum(n_lines: usize, length: usize, weights: &[f64], read: impl Fn(usize, &mut [f64]) + Sync) -> f64 {
    let fft = f64::real_forward(length);
    let panel = PANEL.min(n_lines);
    let buffers = || (vec![0.0; panel * length], fft.make_output_vec(), fft.make_scratch_vec());
    let sums: Vec<f64> = (0..n_lines.div_ceil(panel))
        .into_par_iter()
        .map_init(buffers, |(lines, waves, scratch), i| {
            let first = i * panel;
            let lines = &mut lines[..panel.min(n_lines - first) * length];
            read(first, lines);
            let of_line = |line: &mut [f64]| -> f64 {
                fft.process_with_scratch(line, waves, scratch).expect("every length is the plan's own");
                waves.iter().zip(weights).map(|(wave, weight)| weight * wave.norm_sqr()).sum()
            };
            lines.chunks_exact_mut(length).map(of_line).sum()
        })
        .collect();
    sums.into_iter().sum()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::Grid;

    use super::*;

    #[test]
    fn lines_along_both_axes_have_their_own_waves() {
        for (nx, ny) in [(16, 12), (9, 25), (40, 7), (1, 6)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            let field = Field::from_fn(grid, |at| (TAU * at.y).cos() + 5.0);
            let of =
                |n: usize, wave: usize| -> Vec<f64> { (0..=n / 2).map(|k| f64::from(u8::from(k == wave))).collect() };
            let [constant, along_y] = powers_of_lines(&field, 3.0, [&of(nx, 0), &of(ny, 1)]);
            // Σ over rows of (nx f)², and Σ over columns of (ny/2)².
            let squares: f64 = (0..ny).map(|iy| (field.row(iy)[0] - 3.0).powi(2)).sum();
            let expected = [(nx * nx) as f64 * squares, (nx * ny * ny) as f64 / 4.0];
            for (found, expected) in [constant, along_y].into_iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-12, "{grid}: {found} for {expected}");
            }
        }
    }
}
