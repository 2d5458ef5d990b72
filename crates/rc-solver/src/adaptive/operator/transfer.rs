//! Between two levels: pressures go up by the filter, displacements come down by its transpose.

use rc_kernel::Filter;
use rc_quadtree::{CELLS, Patch, TILE};

use super::real::{MultiplyAdd, Real};

/// Half a tile: what a fine tile covers of a coarse one.
const HALF: usize = TILE / 2;

/// A filter in the precision of the values, filled up with zeros to `N` taps: a number the compiler knows.
#[derive(Clone, Debug)]
pub(crate) struct Transfer<T> {
    taps: Vec<T>,
}

impl<T: Real> Transfer<T> {
    /// `n` taps, an even number not below the filter's.
    pub(crate) fn new(filter: &Filter, n: usize) -> Self {
        let more = vec![T::default(); (n - filter.taps().len()) / 2];
        let taps = filter.taps().iter().map(|&tap| T::rounded(tap));
        Self { taps: more.iter().copied().chain(taps).chain(more.iter().copied()).collect() }
    }

    /// Taps on either side of a coarse centre: the halo, in coarse cells.
    pub(crate) fn reach(&self) -> usize {
        self.taps.len() / 2
    }

    /// Rows of the coarse patch that [`Transfer::down`] reads, for a fine tile in the half `half_y` (0 or 1) of its parent.
    pub(crate) fn rows_down(&self, side: usize, half_y: usize) -> std::ops::Range<usize> {
        let start = (side - TILE) / 2 + half_y * HALF;
        start - self.reach()..start + HALF + self.reach()
    }

    /// Rows of the fine patch that [`Transfer::up`] reads.
    pub(crate) fn rows_up(&self, side: usize) -> std::ops::Range<usize> {
        let start = (side - 2 * TILE) / 2;
        start - 2 * self.reach()..start + 2 * TILE + 2 * self.reach()
    }

    #[inline(always)]
    fn taps<const N: usize>(&self) -> [T; N] {
        std::array::from_fn(|j| self.taps[j])
    }

    /// Interpolates to a fine tile in the quarter (`half_x`, `half_y`) of the tile in the middle of the coarse patch.
    ///
    /// The value at the fine centre beyond coarse centre c is `Σ_j tap_j · value(c + 1 - N/2 + j)`; the one before it has the
    /// taps in reverse, `Σ_j tap_j · value(c - 1 + N/2 - j)`.
    #[inline(always)]
    pub(crate) fn down<A: MultiplyAdd, const N: usize, const SIDE: usize>(
        &self,
        patch: &Patch<T, SIDE>,
        (half_x, half_y): (usize, usize),
        out: &mut [T; CELLS],
    ) {
        let taps = self.taps::<N>();
        let margin = (SIDE - TILE) / 2;
        // The first coarse cell that matters, along either axis.
        let (left, below) = (margin + half_x * HALF - N / 2, margin + half_y * HALF - N / 2);
        let rows = &patch[below..][..HALF + N];
        let mut columns = [[T::default(); SIDE]; TILE];
        let mut chunk = 0;
        while chunk < HALF + N {
            let from = (left + chunk).min(SIDE - TILE);
            for c in 0..HALF {
                let (mut before, mut beyond) = ([T::default(); TILE], [T::default(); TILE]);
                for j in 0..N {
                    let low = &rows[c + N - 1 - j][from..][..TILE];
                    let high = &rows[c + 1 + j][from..][..TILE];
                    for x in 0..TILE {
                        before[x] = A::add(before[x], taps[j], low[x]);
                        beyond[x] = A::add(beyond[x], taps[j], high[x]);
                    }
                }
                columns[2 * c][from..][..TILE].copy_from_slice(&before);
                columns[2 * c + 1][from..][..TILE].copy_from_slice(&beyond);
            }
            chunk += TILE;
        }
        let (rows, _) = out.as_chunks_mut::<TILE>();
        for (row, line) in rows.iter_mut().zip(&columns) {
            let line = &line[left..][..HALF + N];
            let (mut before, mut beyond) = ([T::default(); HALF], [T::default(); HALF]);
            for j in 0..N {
                let low = &line[N - 1 - j..][..HALF];
                let high = &line[1 + j..][..HALF];
                for x in 0..HALF {
                    before[x] = A::add(before[x], taps[j], low[x]);
                    beyond[x] = A::add(beyond[x], taps[j], high[x]);
                }
            }
            for x in 0..HALF {
                row[2 * x] = before[x];
                row[2 * x + 1] = beyond[x];
            }
        }
    }

    /// The coarse tile under the 16 × 16 cells in the middle of the fine patch: a quarter of the transpose of
    /// [`Transfer::down`], so that a constant stays what it is.
    #[inline(always)]
    pub(crate) fn up<A: MultiplyAdd, const N: usize, const SIDE: usize>(
        &self,
        patch: &Patch<T, SIDE>,
        out: &mut [T; CELLS],
    ) {
        let taps = self.taps::<N>();
        // The first fine cell that matters, along either axis; an even number.
        let start = (SIDE - 2 * TILE) / 2 - N;
        let rows = &patch[start..][..2 * TILE + 2 * N];
        let quarter = T::rounded(0.25);
        for (c, row) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
            let mut line = [T::default(); SIDE];
            let mut chunk = 0;
            while chunk < 2 * (TILE + N) {
                let from = (start + chunk).min(SIDE - TILE);
                let mut sums = [T::default(); TILE];
                for j in 0..N {
                    // Fine cell 2c of coarse cell c is the one before its centre.
                    let even = &rows[2 * c + 2 + 2 * j][from..][..TILE];
                    let odd = &rows[2 * c + 2 * N - 1 - 2 * j][from..][..TILE];
                    for x in 0..TILE {
                        sums[x] = A::add(sums[x], taps[j], even[x] + odd[x]);
                    }
                }
                line[from..][..TILE].copy_from_slice(&sums);
                chunk += TILE;
            }
            let (mut even, mut odd) = ([T::default(); SIDE], [T::default(); SIDE]);
            for x in 0..SIDE / 2 {
                even[x] = line[2 * x];
                odd[x] = line[2 * x + 1];
            }
            let (even, odd) = (&even[start / 2..][..TILE + N], &odd[start / 2..][..TILE + N]);
            let mut sums = [T::default(); TILE];
            for j in 0..N {
                let even = &even[1 + j..][..TILE];
                let odd = &odd[N - 1 - j..][..TILE];
                for x in 0..TILE {
                    sums[x] = A::add(sums[x], taps[j], even[x] + odd[x]);
                }
            }
            for (value, sum) in row.iter_mut().zip(sums) {
                *value = quarter * sum;
            }
        }
    }
}
