//! A stencil applied to one tile.

use pulp::Simd;
use rc_kernel::Stencil;
use rc_quadtree::{CELLS, Patch, TILE, gather};

use crate::tiles::operator::real::{Arithmetic, add_product};
use crate::tiles::operator::tile_values::TileValues;

/// The weights of a stencil, with their places in a patch of given side.
#[derive(Clone, Debug)]
pub(crate) struct Taps<T> {
    /// Offset in the patch of the first cell that a weight reads, and the weight.
    taps: Vec<(usize, T)>,
    radius: usize,
}

impl<T: Arithmetic> Taps<T> {
    /// Taps of `factor` times the `stencil`, for patches of `side`.
    ///
    /// Weights too small to matter are omitted.
    pub(crate) fn new(stencil: &Stencil, factor: f64, side: usize) -> Self {
        let negligible = 1e-15 * stencil.weight(0, 0).abs();
        Self::of_weights(stencil.radius(), side, |dx, dy| {
            let weight = stencil.weight(dx, dy);
            if weight.abs() > negligible { factor * weight } else { 0.0 }
        })
    }

    /// Taps of the weights that are not zero at offsets up to `radius`, for patches of `side`.
    pub(crate) fn of_weights(radius: usize, side: usize, weight: impl Fn(i32, i32) -> f64) -> Self {
        let (reach, margin) = (radius as i32, (side - TILE) as i32 / 2);
        let mut taps = Vec::new();
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let weight = weight(dx, dy);
                if weight != 0.0 {
                    let offset = (margin + dy) * side as i32 + margin + dx;
                    taps.push((offset as usize, T::rounded(weight)));
                }
            }
        }
        Self { taps, radius }
    }

    /// Rows of the patch that are read.
    pub(crate) fn rows(&self, side: usize) -> std::ops::Range<usize> {
        let margin = (side - TILE) / 2;
        margin - self.radius..margin + TILE + self.radius
    }

    /// Adds the stencil's sum over the patch around a tile to `out`.
    #[inline(always)]
    pub(crate) fn add<S: Simd, const SIDE: usize>(&self, patch: &Patch<T, SIDE>, out: &mut [T; CELLS]) {
        let cells = patch.as_flattened();
        if T::ROWS == TILE {
            self.add_rows::<S, SIDE, 8>(cells, out);
        } else {
            let (low, high) = out.split_at_mut(CELLS / 2);
            self.add_rows::<S, SIDE, 4>(cells, low);
            self.add_rows::<S, SIDE, 4>(&cells[4 * SIDE..], high);
        }
    }

    #[inline(always)]
    fn add_rows<S: Simd, const SIDE: usize, const ROWS: usize>(&self, cells: &[T], out: &mut [T]) {
        let mut sums = [[T::default(); TILE]; ROWS];
        for &(offset, weight) in &self.taps {
            let window = &cells[offset..][..(ROWS - 1) * SIDE + TILE];
            for (y, sums) in sums.iter_mut().enumerate() {
                for (x, sum) in sums.iter_mut().enumerate() {
                    *sum = add_product::<S, T>(*sum, weight, window[y * SIDE + x]);
                }
            }
        }
        for (out, sum) in out.iter_mut().zip(sums.as_flattened()) {
            *out = *out + *sum;
        }
    }
}

/// Adds the sum of a stencil around the tile at a place to `out`.
///
/// Returns false when there are no values.
#[inline(always)]
pub(crate) fn add_short_range<S: Simd, T: Arithmetic, const SIDE: usize>(
    taps: &Taps<T>,
    around: TileValues<'_, T>,
    [column, row]: [u32; 2],
    patch: &mut Patch<T, SIDE>,
    out: &mut [T; CELLS],
) -> bool {
    let margin = ((SIDE - TILE) / 2 / TILE) as i64;
    let corner = (i64::from(column) - margin, i64::from(row) - margin);
    let any = gather(around.values, around.tiles, corner, taps.rows(SIDE), patch);
    if any {
        taps.add::<S, SIDE>(patch, out);
    }
    any
}
