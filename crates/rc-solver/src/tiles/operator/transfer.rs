//! Transfer between two levels by a filter and its transpose.
//!
//! The filter restricts pressures to the coarser level. Its transpose prolongs displacements.

use std::ops::Range;

use pulp::Simd;
use rc_kernel::Filter;
use rc_quadtree::{CELLS, Patch, TILE};

use crate::tiles::operator::real::{Arithmetic, add_product};

/// Half a tile: the coarse cells under a fine tile, along one axis.
const HALF: usize = TILE / 2;

/// A filter in the precision of the values, filled up with zeros to `N` taps.
///
/// The compiler knows the number `N`.
#[derive(Clone, Debug)]
pub(crate) struct Transfer<T> {
    taps: Vec<T>,
}

impl<T: Arithmetic> Transfer<T> {
    /// A filter with `n` taps, an even number that is at least the filter's.
    pub(crate) fn new(filter: &Filter, n: usize) -> Self {
        let more = vec![T::default(); (n - filter.taps().len()) / 2];
        let taps = filter.taps().iter().map(|&tap| T::rounded(tap));
        Self { taps: more.iter().copied().chain(taps).chain(more.iter().copied()).collect() }
    }

    /// Number of taps on either side of a coarse centre. It is the halo, in coarse cells.
    pub(crate) fn reach(&self) -> usize {
        self.taps.len() / 2
    }

    /// Rows of the coarse patch that [`Transfer::prolong`] reads for a fine tile.
    ///
    /// The tile is in the half `half_y` (0 or 1) of its parent.
    pub(crate) fn rows_to_prolong(&self, side: usize, half_y: usize) -> Range<usize> {
        let start = (side - TILE) / 2 + half_y * HALF;
        start - self.reach()..start + HALF + self.reach()
    }

    /// Rows of the fine patch that [`Transfer::restrict`] reads.
    pub(crate) fn rows_to_restrict(&self, side: usize) -> Range<usize> {
        let start = (side - 2 * TILE) / 2;
        start - 2 * self.reach()..start + 2 * TILE + 2 * self.reach()
    }

    #[inline(always)]
    fn taps<const N: usize>(&self) -> [T; N] {
        std::array::from_fn(|j| self.taps[j])
    }

    /// Interpolates to a fine tile, along y and then along x.
    ///
    /// The fine tile is in the quarter (`half_x`, `half_y`) of the tile in the middle of the coarse patch. The value at
    /// the fine centre beyond coarse centre c is `Σ_j tap_j · value(c + 1 - N/2 + j)`. The value before it has the taps
    /// in reverse, `Σ_j tap_j · value(c - 1 + N/2 - j)`.
    #[inline(always)]
    pub(crate) fn prolong<S: Simd, const N: usize, const SIDE: usize>(
        &self,
        patch: &Patch<T, SIDE>,
        (half_x, half_y): (usize, usize),
        out: &mut [T; CELLS],
    ) {
        let taps = self.taps::<N>();
        let margin = (SIDE - TILE) / 2;
        // The first coarse cell that is read, along either axis.
        let (left, below) = (margin + half_x * HALF - N / 2, margin + half_y * HALF - N / 2);
        let mut lines = [[T::default(); SIDE]; TILE];
        prolong_columns::<S, T, N, SIDE>(&taps, &patch[below..][..HALF + N], left, &mut lines);
        let (rows, _) = out.as_chunks_mut::<TILE>();
        for (row, line) in rows.iter_mut().zip(&lines) {
            prolong_row::<S, T, N>(&taps, &line[left..][..HALF + N], row);
        }
    }

    /// Sums the cells in the middle of the fine patch to a coarse tile.
    ///
    /// They are 16 × 16 cells. This is a quarter of the transpose of [`Transfer::prolong`], so that a constant stays
    /// the same.
    #[inline(always)]
    pub(crate) fn restrict<S: Simd, const N: usize, const SIDE: usize>(
        &self,
        patch: &Patch<T, SIDE>,
        out: &mut [T; CELLS],
    ) {
        let taps = self.taps::<N>();
        // The first fine cell that is read, along either axis. It is an even number.
        let start = (SIDE - 2 * TILE) / 2 - N;
        let rows = &patch[start..][..2 * TILE + 2 * N];
        for (c, row) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
            let line = restrict_columns::<S, T, N, SIDE>(&taps, &rows[2 * c..], start);
            restrict_row::<S, T, N, SIDE>(&taps, &line, start, row);
        }
    }
}

/// Interpolates to the eight rows of a fine tile along y.
///
/// The columns are those from `left` on.
#[inline(always)]
fn prolong_columns<S: Simd, T: Arithmetic, const N: usize, const SIDE: usize>(
    taps: &[T; N],
    rows: &[[T; SIDE]],
    left: usize,
    lines: &mut [[T; SIDE]; TILE],
) {
    let mut chunk = 0;
    while chunk < HALF + N {
        let from = (left + chunk).min(SIDE - TILE);
        for c in 0..HALF {
            let (mut before, mut beyond) = ([T::default(); TILE], [T::default(); TILE]);
            for j in 0..N {
                let low = &rows[c + N - 1 - j][from..][..TILE];
                let high = &rows[c + 1 + j][from..][..TILE];
                for x in 0..TILE {
                    before[x] = add_product::<S, T>(before[x], taps[j], low[x]);
                    beyond[x] = add_product::<S, T>(beyond[x], taps[j], high[x]);
                }
            }
            lines[2 * c][from..][..TILE].copy_from_slice(&before);
            lines[2 * c + 1][from..][..TILE].copy_from_slice(&beyond);
        }
        chunk += TILE;
    }
}

/// Interpolates to the eight cells of a row along x.
///
/// They are interpolated from the coarse cells of `line`.
#[inline(always)]
fn prolong_row<S: Simd, T: Arithmetic, const N: usize>(taps: &[T; N], line: &[T], row: &mut [T; TILE]) {
    let (mut before, mut beyond) = ([T::default(); HALF], [T::default(); HALF]);
    for j in 0..N {
        let low = &line[N - 1 - j..][..HALF];
        let high = &line[1 + j..][..HALF];
        for x in 0..HALF {
            before[x] = add_product::<S, T>(before[x], taps[j], low[x]);
            beyond[x] = add_product::<S, T>(beyond[x], taps[j], high[x]);
        }
    }
    for x in 0..HALF {
        row[2 * x] = before[x];
        row[2 * x + 1] = beyond[x];
    }
}

/// Sums fine rows along y for one row of coarse cells.
///
/// The columns are those from `start` on.
#[inline(always)]
fn restrict_columns<S: Simd, T: Arithmetic, const N: usize, const SIDE: usize>(
    taps: &[T; N],
    rows: &[[T; SIDE]],
    start: usize,
) -> [T; SIDE] {
    let mut line = [T::default(); SIDE];
    let mut chunk = 0;
    while chunk < 2 * (TILE + N) {
        let from = (start + chunk).min(SIDE - TILE);
        let mut sums = [T::default(); TILE];
        for j in 0..N {
            // The even one of two fine cells is before the coarse centre.
            let even = &rows[2 + 2 * j][from..][..TILE];
            let odd = &rows[2 * N - 1 - 2 * j][from..][..TILE];
            for x in 0..TILE {
                sums[x] = add_product::<S, T>(sums[x], taps[j], even[x] + odd[x]);
            }
        }
        line[from..][..TILE].copy_from_slice(&sums);
        chunk += TILE;
    }
    line
}

/// Sums fine cells along x for the eight coarse cells of a row.
#[inline(always)]
fn restrict_row<S: Simd, T: Arithmetic, const N: usize, const SIDE: usize>(
    taps: &[T; N],
    line: &[T; SIDE],
    start: usize,
    row: &mut [T; TILE],
) {
    let quarter = T::rounded(0.25);
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
            sums[x] = add_product::<S, T>(sums[x], taps[j], even[x] + odd[x]);
        }
    }
    for (value, sum) in row.iter_mut().zip(sums) {
        *value = quarter * sum;
    }
}
