//! Transforms between a real field and its waves in the half plane kx ≥ 0.
//!
//! The other waves are their complex conjugates.

use std::f64::consts::PI;

use rayon::prelude::*;
use rc_core::{Field, Grid};
use rustfft::num_complex::Complex64;

use crate::TransformReal;

/// Number of columns, or rows, that a second pass gathers at once.
///
/// Every cache line of the result of the first pass is then read once.
const PANEL: usize = 8;

/// `value(w)` for every wave w = Σ f exp(-2πi k·x) of a real field f minus `offset`.
///
/// The result has the half plane 0 ≤ kx ≤ nx/2 column by column: `values[kx * ny + (ky mod ny)]`. Phases are relative
/// to the centre of the first element, which has x = 0 here.
#[must_use]
pub fn half_plane_values<T: Copy + Default + Send>(
    field: &Field,
    offset: f64,
    value: impl Fn(Complex64) -> T + Sync,
) -> Vec<T> {
    let ny = field.grid().ny();
    let width = field.grid().nx() / 2 + 1;
    let rows = transformed_rows(field, offset);
    let fft = f64::complex_forward(ny);
    let buffers = || (vec![Complex64::ZERO; PANEL * ny], vec![Complex64::ZERO; fft.get_inplace_scratch_len()]);
    let mut values = vec![T::default(); width * ny];
    values.par_chunks_mut(PANEL * ny).enumerate().for_each_init(buffers, |(panel, scratch), (number, values)| {
        let panel = &mut panel[..values.len()];
        let (first, n_columns) = (number * PANEL, values.len() / ny);
        for (iy, row) in rows.chunks_exact(width).enumerate() {
            for (column, &wave) in row[first..first + n_columns].iter().enumerate() {
                panel[column * ny + iy] = wave;
            }
        }
        fft.process_with_scratch(panel, scratch);
        for (of_wave, &wave) in values.iter_mut().zip(&*panel) {
            *of_wave = value(wave);
        }
    });
    values
}

/// The transform of every row minus `offset`, as ny rows of nx/2 + 1 complex numbers.
fn transformed_rows(field: &Field, offset: f64) -> Vec<Complex64> {
    let (nx, ny) = (field.grid().nx(), field.grid().ny());
    let width = nx / 2 + 1;
    let fft = f64::real_forward(nx);
    let mut rows = vec![Complex64::ZERO; width * ny];
    let buffers = || (fft.make_input_vec(), fft.make_scratch_vec());
    rows.par_chunks_exact_mut(width).enumerate().for_each_init(buffers, |(row, scratch), (iy, spectrum)| {
        for (shifted, value) in row.iter_mut().zip(field.row(iy)) {
            *shifted = value - offset;
        }
        fft.process_with_scratch(row, spectrum, scratch).expect("every length is the plan's own");
    });
    rows
}

/// The real field Σ a exp(2πi k·x) on `grid`, from `waves` in the layout of [`half_plane_values`].
///
/// The waves of [`half_plane_values`] divided by the number of elements give the field back. In the columns kx = 0 and
/// nx/2, which contain both k and -k, only the conjugate part counts.
///
/// # Panics
/// Unless there are (nx/2 + 1) ny waves.
#[must_use]
pub fn field_of_half_plane(mut waves: Vec<Complex64>, grid: Grid) -> Field {
    let (nx, ny) = (grid.nx(), grid.ny());
    let width = nx / 2 + 1;
    assert_eq!(waves.len(), width * ny, "waves of another grid");
    let fft = f64::complex_inverse(ny);
    let scratch = || vec![Complex64::ZERO; fft.get_inplace_scratch_len()];
    waves.par_chunks_exact_mut(ny).enumerate().for_each_init(scratch, |scratch, (kx, column)| {
        fft.process_with_scratch(column, scratch);
        if kx > 0 && 2 * kx == nx {
            // The sum over rows counts kx and -kx, which are one wave here.
            for wave in column {
                *wave *= 0.5;
            }
        }
    });
    let mut field = Field::zeros(grid);
    transform_rows(&waves, width, &mut field);
    field
}

/// The field Σ a_k exp(2πi k·x) at the element centres of `grid`.
///
/// `columns[kx][reach + ky]` is a_k for kx = 0, 1, …. The column of kx has 2·reach + 1 entries, and columns may have
/// different reaches. Waves with -kx are the complex conjugates. So the column kx = 0 must be its own conjugate.
///
/// Waves that are too short for the grid are folded onto the waves with the same values at the element centres. So the
/// result is the direct sum on any grid. *Memory*: besides the result, ny complex numbers for each column.
#[must_use]
pub fn field_of_columns(columns: &[Vec<Complex64>], grid: Grid) -> Field {
    let waves_by_row = transformed_columns(columns, grid);
    let mut field = Field::zeros(grid);
    transform_rows(&waves_by_row, columns.len(), &mut field);
    field
}

/// First pass: the sums over ky of each column, at the ny centres y.
///
/// A sum is Σ `a_k` exp(2πi (ky y + kx/(2 nx))). The term kx/(2 nx) shifts by half an element, from the corner of the
/// cell to the first centre.
fn transformed_columns(columns: &[Vec<Complex64>], grid: Grid) -> Vec<Complex64> {
    let ny = grid.ny();
    let fft = f64::complex_inverse(ny);
    let largest_ky = columns.iter().map(|column| reach(column)).max().unwrap_or(0);
    let to_centre_y: Vec<Complex64> = (0..=largest_ky).map(|ky| half_element(ky, ny)).collect();
    let mut result = vec![Complex64::ZERO; columns.len() * ny];
    let scratch = || vec![Complex64::ZERO; fft.get_inplace_scratch_len()];
    result.par_chunks_exact_mut(ny).zip(columns).enumerate().for_each_init(scratch, |scratch, (kx, (line, column))| {
        let reach = reach(column);
        let to_centre_x = half_element(kx, grid.nx());
        line[0] = column[reach] * to_centre_x;
        for ky in 1..=reach {
            let alias = ky % ny;
            line[alias] += column[reach + ky] * to_centre_y[ky] * to_centre_x;
            line[(ny - alias) % ny] += column[reach - ky] * to_centre_y[ky].conj() * to_centre_x;
        }
        fft.process_with_scratch(line, scratch);
    });
    result
}

/// Second pass: complex-to-real transforms of rows.
///
/// The transform of each column is ny contiguous values.
fn transform_rows(waves_by_row: &[Complex64], n_columns: usize, field: &mut Field) {
    let (nx, ny) = (field.grid().nx(), field.grid().ny());
    let fft = f64::real_inverse(nx);
    let folds: Vec<Fold> = (0..n_columns).map(|kx| Fold::of(kx, nx)).collect();
    let buffers = || (vec![Complex64::ZERO; PANEL * n_columns], fft.make_input_vec(), fft.make_scratch_vec());
    let blocks = field.values_mut().par_chunks_mut(PANEL * nx).enumerate();
    blocks.for_each_init(buffers, |(tile, spectrum, scratch), (number, rows)| {
        let (first, n_rows) = (number * PANEL, rows.len() / nx);
        for (kx, line) in waves_by_row.chunks_exact(ny).enumerate() {
            for (row, &wave) in line[first..first + n_rows].iter().enumerate() {
                tile[row * n_columns + kx] = wave;
            }
        }
        for (row, waves) in rows.chunks_exact_mut(nx).zip(tile.chunks_exact(n_columns)) {
            spectrum.fill(Complex64::ZERO);
            for (fold, &wave) in folds.iter().zip(waves) {
                spectrum[fold.target] += Complex64::new(fold.re * wave.re, fold.im * wave.im);
            }
            fft.process_with_scratch(spectrum, row, scratch).expect("lengths are the plan's, end values are real");
        }
    });
}

/// Target of a wave in the half spectrum of a real row, and factors of its two parts.
struct Fold {
    target: usize,
    re: f64,
    im: f64,
}

impl Fold {
    /// Target and factors of wave `kx` in a row of `nx` elements.
    ///
    /// The complex-to-real transform adds the conjugate of every wave by itself. Exceptions are the first wave (0) and,
    /// for even `nx`, the last wave (nx/2). These two are real, so a wave that is folded onto them adds its own
    /// conjugate.
    fn of(kx: usize, nx: usize) -> Self {
        let alias = kx % nx;
        if kx == 0 {
            Self { target: 0, re: 1.0, im: 0.0 }
        } else if alias == 0 || 2 * alias == nx {
            Self { target: alias, re: 2.0, im: 0.0 }
        } else if 2 * alias < nx {
            Self { target: alias, re: 1.0, im: 1.0 }
        } else {
            Self { target: nx - alias, re: 1.0, im: -1.0 }
        }
    }
}

/// Largest ky of a column that holds -reach to reach.
fn reach(column: &[Complex64]) -> usize {
    column.len() / 2
}

/// exp(2πi k s) for half an element, s = 1/(2n).
fn half_element(k: usize, n: usize) -> Complex64 {
    Complex64::cis(PI * k as f64 / n as f64)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn half_plane_values_are_those_of_direct_sums() {
        for (nx, ny) in [(6, 5), (7, 20), (1, 3), (19, 1)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            let field = Field::from_fn(grid, |at| (9.0 * at.x).sin() + (at.y - 0.3).exp());
            let values = half_plane_values(&field, 0.5, |wave| wave.re - 2.0 * wave.im);
            assert_eq!(values.len(), (nx / 2 + 1) * ny);
            for (place, value) in values.iter().enumerate() {
                let (kx, ky) = (place / ny, place % ny);
                let term = |i: usize| {
                    let turns = (kx * (i % nx)) as f64 / nx as f64 + (ky * (i / nx)) as f64 / ny as f64;
                    Complex64::cis(-TAU * turns) * (field.values()[i] - 0.5)
                };
                let wave: Complex64 = (0..grid.len()).map(term).sum();
                let error = (value - (wave.re - 2.0 * wave.im)).abs();
                assert!(error <= 1e-12, "({kx}, {ky}) on {grid}: off by {error:.1e}");
            }
        }
    }

    #[test]
    fn a_field_comes_back_from_its_half_plane() {
        for (nx, ny) in [(6, 5), (7, 20), (16, 12), (1, 3), (19, 1)] {
            let field =
                Field::from_fn(Grid::new(nx, ny).expect("a grid"), |at| (9.0 * at.x).sin() + (at.y - 0.3).exp());
            let per_element = 1.0 / field.grid().len() as f64;
            let waves = half_plane_values(&field, 0.0, |wave| wave * per_element);
            let back = field_of_half_plane(waves, field.grid());
            let error = field.values().iter().zip(back.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-14 * 20.0, "{nx} x {ny}: off by {error:.1e}");
        }
    }

    /// Tests grids that resolve all waves, and coarser grids on which waves are folded.
    #[test]
    fn a_field_of_columns_is_the_direct_sum() {
        let wave = |kx: usize, ky: i32| Complex64::new(1.0 / (1.0 + kx as f64), 0.3 * f64::from(ky));
        // The column kx = 0 is its own conjugate. Columns have different numbers of waves.
        let columns: Vec<Vec<Complex64>> = vec![
            (-2..=2).map(|ky| wave(0, ky)).collect(),
            (-4..=4).map(|ky| wave(1, ky)).collect(),
            (-1..=1).map(|ky| wave(2, ky)).collect(),
        ];
        for (nx, ny) in [(16, 16), (5, 9), (2, 3), (3, 1)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            let field = field_of_columns(&columns, grid);
            let direct = Field::from_fn(grid, |at| {
                let term = |(kx, column): (usize, &Vec<Complex64>)| {
                    let waves = column.iter().zip(-(reach(column) as i32)..);
                    let sum: Complex64 =
                        waves.map(|(a, ky)| a * Complex64::cis(TAU * (kx as f64 * at.x + f64::from(ky) * at.y))).sum();
                    if kx == 0 { sum.re } else { 2.0 * sum.re }
                };
                columns.iter().enumerate().map(term).sum()
            });
            let error = field.values().iter().zip(direct.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(error <= 1e-13, "{grid}: off by {error:.1e}");
        }
    }
}
