//! Squared wave amplitudes of a height map, by a real-to-complex Fourier transform in two passes.

use rayon::prelude::*;
use rc_core::Field;
use rc_fft::{Complex64, Plan};

/// Columns that the second pass gathers at once, so that every cache line of the first pass's result is read once.
const PANEL: usize = 8;

/// |`a_k`|² of a height map without its mean, for the half plane 0 ≤ kx ≤ nx/2.
pub(crate) struct PowerSpectrum {
    nx: usize,
    ny: usize,
    /// Column by column: `values[kx * ny + (ky mod ny)]`.
    values: Vec<f64>,
}

/// The waves that share one kx ≥ 0.
pub(crate) struct PowerColumn<'a> {
    pub(crate) kx: usize,
    /// 2 when the column also stands for -kx, whose waves are the conjugates; 1 for kx = 0 and for half the side.
    pub(crate) multiplicity: usize,
    values: &'a [f64],
}

impl PowerColumn<'_> {
    /// (|ky|, |a|²) of every wave of the column.
    pub(crate) fn powers(&self) -> impl Iterator<Item = (usize, f64)> {
        let ny = self.values.len();
        self.values.iter().enumerate().map(move |(index, &power)| (index.min(ny - index), power))
    }
}

impl PowerSpectrum {
    /// Transforms a height map. Bitwise the same for any number of threads: each value is computed by one of them.
    pub(crate) fn of(heights: &Field) -> Self {
        let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
        let width = nx / 2 + 1;
        let rows = transform_rows(heights, width);
        let fft = f64::complex_forward(ny);
        let per_element = 1.0 / (nx * ny) as f64;
        let buffers = || (vec![Complex64::ZERO; PANEL * ny], vec![Complex64::ZERO; fft.get_inplace_scratch_len()]);
        let mut values = vec![0.0; width * ny];
        values.par_chunks_mut(PANEL * ny).enumerate().for_each_init(buffers, |(panel, scratch), (number, powers)| {
            let panel = &mut panel[..powers.len()];
            let (first, n_columns) = (number * PANEL, powers.len() / ny);
            for (iy, row) in rows.chunks_exact(width).enumerate() {
                for (column, &wave) in row[first..first + n_columns].iter().enumerate() {
                    panel[column * ny + iy] = wave;
                }
            }
            fft.process_with_scratch(panel, scratch);
            for (power, wave) in powers.iter_mut().zip(panel) {
                *power = (*wave * per_element).norm_sqr();
            }
        });
        // Rounding leaves a trace of the mean, which is not a wave.
        values[0] = 0.0;
        Self { nx, ny, values }
    }

    /// The columns kx = 0, 1, …, nx/2.
    pub(crate) fn columns(&self) -> impl Iterator<Item = PowerColumn<'_>> {
        let own_mirror = |kx: usize| kx == 0 || 2 * kx == self.nx;
        self.values.chunks_exact(self.ny).enumerate().map(move |(kx, values)| PowerColumn {
            kx,
            multiplicity: if own_mirror(kx) { 1 } else { 2 },
            values,
        })
    }
}

/// The transform of every row less the mean height: ny rows of `width` complex numbers.
fn transform_rows(heights: &Field, width: usize) -> Vec<Complex64> {
    let nx = heights.grid().nx();
    let mean = heights.mean();
    let fft = f64::real_forward(nx);
    let mut rows = vec![Complex64::ZERO; width * heights.grid().ny()];
    let buffers = || (fft.make_input_vec(), fft.make_scratch_vec());
    rows.par_chunks_exact_mut(width).enumerate().for_each_init(buffers, |(row, scratch), (iy, spectrum)| {
        for (centred, height) in row.iter_mut().zip(heights.row(iy)) {
            *centred = height - mean;
        }
        fft.process_with_scratch(row, spectrum, scratch).expect("every length is the plan's own");
    });
    rows
}
