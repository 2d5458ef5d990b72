//! The two passes over the tiles of a level, up and down, as operations of the machine's vector instructions.

use std::marker::PhantomData;

use pulp::{Simd, WithSimd};
use rc_quadtree::{CELLS, TILE, TileSet, gather};

use super::real::{MultiplyAdd, Real};
use super::stencil::Taps;
use super::transfer::Transfer;

/// The densities of tiles from those of the next finer level.
pub(super) struct Lift<'a, T, A, const N: usize, const UNDER: usize> {
    pub(super) transfer: &'a Transfer<T>,
    pub(super) finer: (&'a [T], &'a TileSet),
    pub(super) places: &'a [[u32; 2]],
    pub(super) cells: &'a mut [T],
    pub(super) arithmetic: PhantomData<A>,
}

impl<T: Real, A: MultiplyAdd, const N: usize, const UNDER: usize> WithSimd for Lift<'_, T, A, N, UNDER> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let margin = ((UNDER - 2 * TILE) / 2 / TILE) as i64;
        let mut patch = [[T::default(); UNDER]; UNDER];
        for (out, &[column, row]) in self.cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(self.places) {
            let corner = (2 * i64::from(column) - margin, 2 * i64::from(row) - margin);
            if gather(self.finer.0, self.finer.1, corner, self.transfer.rows_up(UNDER), &mut patch) {
                self.transfer.up::<A, N, UNDER>(&patch, out);
            } else {
                *out = [T::default(); CELLS];
            }
        }
    }
}

/// The displacements of tiles: the level's stencil on its density, and what comes down from the coarser level.
pub(super) struct Lower<'a, T, A, const N: usize, const AROUND: usize> {
    pub(super) table: &'a (Taps<T>, Transfer<T>),
    pub(super) density: (&'a [T], &'a TileSet),
    pub(super) coarser: (&'a [T], &'a TileSet),
    pub(super) places: &'a [[u32; 2]],
    pub(super) cells: &'a mut [T],
    pub(super) arithmetic: PhantomData<A>,
}

impl<T: Real, A: MultiplyAdd, const N: usize, const AROUND: usize> WithSimd for Lower<'_, T, A, N, AROUND> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let (taps, transfer) = self.table;
        let margin = ((AROUND - TILE) / 2 / TILE) as i64;
        let mut patch = [[T::default(); AROUND]; AROUND];
        for (out, &[column, row]) in self.cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(self.places) {
            let half = (column as usize % 2, row as usize % 2);
            let corner = (i64::from(column / 2) - margin, i64::from(row / 2) - margin);
            gather(self.coarser.0, self.coarser.1, corner, transfer.rows_down(AROUND, half.1), &mut patch);
            transfer.down::<A, N, AROUND>(&patch, half, out);
            let corner = (i64::from(column) - margin, i64::from(row) - margin);
            if gather(self.density.0, self.density.1, corner, taps.rows(AROUND), &mut patch) {
                taps.add::<A, AROUND>(&patch, out);
            }
        }
    }
}
