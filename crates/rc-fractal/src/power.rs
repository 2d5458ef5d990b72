//! Squared wave amplitudes of a height map.

use rc_core::Field;
use rc_fft::half_plane_values;

/// |`a_k`|² of a height map minus its mean, for the half plane 0 ≤ kx ≤ nx/2.
pub(crate) struct PowerSpectrum {
    nx: usize,
    ny: usize,
    /// Column by column: `values[kx * ny + (ky mod ny)]`.
    values: Vec<f64>,
}

/// The waves with one kx ≥ 0.
pub(crate) struct PowerColumn<'a> {
    pub(crate) kx: usize,
    /// 2 when the column also represents -kx, whose waves are the conjugates. 1 for kx = 0 and for half the side.
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
    /// Transforms a height map.
    ///
    /// The result is bitwise the same for any number of threads, because each value is computed by one thread.
    pub(crate) fn of(heights: &Field) -> Self {
        let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
        let per_element = 1.0 / (nx * ny) as f64;
        let mut values = half_plane_values(heights, heights.mean(), |wave| (wave * per_element).norm_sqr());
        // Rounding leaves a remainder of the mean, which is not a wave.
        values[0] = 0.0;
        Self { nx, ny, values }
    }

    /// The value of kx, and of the ky at this place of its column.
    pub(crate) fn value(&self, kx: usize, place: usize) -> f64 {
        self.values[kx * self.ny + place]
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
