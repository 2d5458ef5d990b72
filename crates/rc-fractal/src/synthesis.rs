//! From amplitudes to heights: a pruned inverse Fourier transform at element centres.
//!
//! Only the N + 1 columns kx = 0, …, N hold waves. Each is transformed along y (length ny); then each row is transformed along x
//! from its N + 1 values to nx real heights. Besides the result, only (N + 1)·ny complex numbers are stored.

use std::f64::consts::PI;

use rayon::prelude::*;
use rc_core::{Field, Grid};
use rc_fft::{Complex64, Plan};

use crate::surface::reach;

/// Rows that the second pass gathers at once, so that every cache line of the first pass's result is read once.
const BLOCK: usize = 8;

/// Heights Σ `a_k` exp(2πi k·x) at the centres of `grid`, for `columns[kx][reach + ky]`, kx ≥ 0, the rest being conjugates.
///
/// Waves too short for the grid are folded onto those with the same values at its centres, so the result is the direct sum
/// on any grid. Bitwise the same for any number of threads.
pub(crate) fn synthesise(columns: &[Vec<Complex64>], grid: Grid) -> Field {
    let waves_by_row = transform_columns(columns, grid);
    let mut field = Field::zeros(grid);
    transform_rows(&waves_by_row, columns.len(), &mut field);
    field
}

/// First pass. Column by column: Σ `a_k` exp(2πi (ky y + kx/(2 nx))) over ky, for the ny centres y; the last factor is the half
/// element by which the first centre is off the corner.
fn transform_columns(columns: &[Vec<Complex64>], grid: Grid) -> Vec<Complex64> {
    let ny = grid.ny();
    let fft = f64::complex_inverse(ny);
    let to_centre_y: Vec<Complex64> = (0..columns.len()).map(|ky| half_element(ky, ny)).collect();
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

/// Second pass: row by row from complex to real.
fn transform_rows(waves_by_row: &[Complex64], n_columns: usize, field: &mut Field) {
    let (nx, ny) = (field.grid().nx(), field.grid().ny());
    let fft = f64::real_inverse(nx);
    let folds: Vec<Fold> = (0..n_columns).map(|kx| Fold::of(kx, nx)).collect();
    let buffers = || (vec![Complex64::ZERO; BLOCK * n_columns], fft.make_input_vec(), fft.make_scratch_vec());
    let blocks = field.values_mut().par_chunks_mut(BLOCK * nx).enumerate();
    blocks.for_each_init(buffers, |(tile, spectrum, scratch), (number, rows)| {
        let (first, n_rows) = (number * BLOCK, rows.len() / nx);
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

/// Where a wave goes in the half spectrum of a real row, and with which factors of its parts.
struct Fold {
    target: usize,
    re: f64,
    im: f64,
}

impl Fold {
    /// The complex-to-real transform adds the conjugate of every wave by itself, except of its first (0) and, for even `nx`, last
    /// (nx/2) one: these are real, and a wave folded onto them brings its conjugate along.
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

/// exp(2πi k s) for half an element s = 1/(2n).
fn half_element(k: usize, n: usize) -> Complex64 {
    Complex64::cis(PI * k as f64 / n as f64)
}
