//! The multilevel operator: L, or its approximate inverse, on the tiles of an adaptive mesh, at a cost proportional to
//! their number.
//!
//! Each level adds a short-range stencil; between levels go short filters; the base grid has a Fourier transform
//! ([`rc_kernel::ScaleSplit`] has the formulas). Everything is summed target by target, so the result does not depend on
//! the number of threads.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined into the dispatched function is compiled for the least of machines: seven times slower"
)]

mod pass;
mod patch;
mod real;
mod stencil;
mod tables;
mod transfer;

use std::marker::PhantomData;
use std::sync::Arc;

use pulp::Arch;
use rayon::prelude::*;
use rc_core::Grid;

use self::pass::{Lift, Lower};
pub(crate) use self::patch::{Patch, gather};
pub(crate) use self::real::Real;
use self::real::{Fused, MultiplyAdd, Separate};
use self::tables::Sizes;
pub(crate) use self::tables::{Prepared, Tables};
use super::tiles::{CELLS, TILE, TileSet};
use crate::descent::Engine;
use crate::fft::{BLOCK_ROWS, Convolution};

/// Tiles that one thread works on at a time, and whose values a caller gets at a time.
const BLOCK_TILES: usize = 16;

/// Cells in a block.
pub(crate) const BLOCK_CELLS: usize = BLOCK_TILES * CELLS;

/// The tiles of all levels, coarsest first: the first is the whole base grid, the last has the elements.
pub(crate) struct Hierarchy {
    levels: Vec<TileSet>,
}

impl Hierarchy {
    /// The levels over `finest` down to the base grid of `base_side` cells per side, a multiple of 8, each with the tiles
    /// that a filter of reach `halo` needs.
    pub(crate) fn new(base_side: usize, finest: TileSet, halo: usize) -> Self {
        let mut levels = vec![finest];
        while levels[levels.len() - 1].side() > 2 * base_side {
            levels.push(levels[levels.len() - 1].parents(halo));
        }
        levels.push(TileSet::full(base_side / TILE));
        levels.reverse();
        Self { levels }
    }

    /// The tiles with the elements.
    pub(crate) fn finest(&self) -> &TileSet {
        &self.levels[self.levels.len() - 1]
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Grid {
        Grid::square(self.levels[0].side()).expect("the base grid is smaller than the finest")
    }

    /// Levels above the base grid.
    pub(crate) fn n_levels(&self) -> usize {
        self.levels.len() - 1
    }
}

/// Buffers for operators on one hierarchy.
pub(crate) struct TileOperator<T> {
    hierarchy: Arc<Hierarchy>,
    arch: Arch,
    convolution: Convolution<T>,
    source: Vec<T>,
    /// Densities that went up, and displacements that come down, of each level below the finest.
    up: Vec<Vec<T>>,
    down: Vec<Vec<T>>,
}

impl<T: Real> TileOperator<T> {
    pub(crate) fn new(hierarchy: Arc<Hierarchy>) -> Self {
        let n_levels = hierarchy.n_levels();
        let zeros = || hierarchy.levels[..n_levels].iter().map(|tiles| vec![T::default(); tiles.n_cells()]).collect();
        Self {
            arch: Arch::new(),
            convolution: Convolution::new(hierarchy.base()),
            source: vec![T::default(); hierarchy.finest().n_cells()],
            up: zeros(),
            down: zeros(),
            hierarchy,
        }
    }

    /// What came down to the cells of the base grid in the last [`Engine::multiply`], tile by tile, row-major: the smooth
    /// remainder of the displacement.
    pub(crate) fn base_displacement(&self) -> &[T] {
        &self.down[0]
    }

    fn spread_with<A: MultiplyAdd, const N: usize, const AROUND: usize, const UNDER: usize>(
        &mut self,
        tables: &Tables<T>,
    ) {
        let n_levels = self.hierarchy.n_levels();
        let (hierarchy, arch) = (Arc::clone(&self.hierarchy), self.arch);
        let levels = &hierarchy.levels;
        for level in (1..n_levels).rev() {
            let (coarser, finer) = self.up.split_at_mut(level + 1);
            let values = finer.first().unwrap_or(&self.source);
            let blocks = coarser[level].par_chunks_mut(BLOCK_CELLS).zip(levels[level].places().par_chunks(BLOCK_TILES));
            blocks.for_each(|(cells, places)| {
                let transfer = &tables.levels[level].1;
                let finer = (values.as_slice(), &levels[level + 1]);
                arch.dispatch(Lift::<T, A, N, UNDER> { transfer, finer, places, cells, arithmetic: PhantomData });
            });
        }
        self.convolve_base::<A, N, UNDER>(tables);
        for level in 1..n_levels {
            let (coarser, finer) = self.down.split_at_mut(level);
            let density = (self.up[level].as_slice(), &levels[level]);
            let coarser = (coarser[level - 1].as_slice(), &levels[level - 1]);
            let blocks = finer[0].par_chunks_mut(BLOCK_CELLS).zip(levels[level].places().par_chunks(BLOCK_TILES));
            blocks.for_each(|(cells, places)| {
                let table = &tables.levels[level - 1];
                arch.dispatch(Lower::<T, A, N, AROUND> {
                    table,
                    density,
                    coarser,
                    places,
                    cells,
                    arithmetic: PhantomData,
                });
            });
        }
    }

    /// The base grid: its density from level 1, its convolution, its displacement as tiles.
    fn convolve_base<A: MultiplyAdd, const N: usize, const UNDER: usize>(&mut self, tables: &Tables<T>) {
        let side = self.hierarchy.base().nx();
        let per_side = side / TILE;
        let (levels, arch) = (&self.hierarchy.levels, self.arch);
        let values = self.up.get(1).unwrap_or(&self.source);
        let blocks = levels[0].places().par_chunks(BLOCK_ROWS / TILE * per_side);
        self.convolution.transform_rows(blocks, |places, rows| {
            let mut tiles = vec![T::default(); rows.len()];
            let (transfer, finer) = (&tables.levels[0].1, (values.as_slice(), &levels[1]));
            let cells = tiles.as_mut_slice();
            arch.dispatch(Lift::<T, A, N, UNDER> { transfer, finer, places, cells, arithmetic: PhantomData });
            for (lines, tiles) in rows.chunks_exact_mut(TILE * side).zip(tiles.chunks_exact(TILE * side)) {
                for (row, line) in lines.chunks_exact_mut(side).enumerate() {
                    for (values, tile) in line.as_chunks_mut::<TILE>().0.iter_mut().zip(tiles.as_chunks::<CELLS>().0) {
                        values.copy_from_slice(&tile[row * TILE..][..TILE]);
                    }
                }
            }
        });
        self.convolution.multiply(&tables.base);
        let sinks = self.down[0].par_chunks_mut(BLOCK_ROWS * side);
        self.convolution.take_rows(sinks, |cells, rows| {
            for (tiles, lines) in cells.chunks_exact_mut(TILE * side).zip(rows.chunks_exact(TILE * side)) {
                for (row, line) in lines.chunks_exact(side).enumerate() {
                    for (tile, values) in tiles.as_chunks_mut::<CELLS>().0.iter_mut().zip(line.as_chunks::<TILE>().0) {
                        tile[row * TILE..][..TILE].copy_from_slice(values);
                    }
                }
            }
        });
    }

    fn take_with<A: MultiplyAdd, const N: usize, const AROUND: usize, K, R>(
        &self,
        tables: &Tables<T>,
        sinks: K,
        take: impl Fn(K::Item, &[T]) -> R + Sync,
    ) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        let (hierarchy, level) = (self.hierarchy.as_ref(), self.hierarchy.n_levels());
        let blocks = hierarchy.finest().places().par_chunks(BLOCK_TILES);
        blocks
            .zip_eq(sinks)
            .map(|(places, sink)| {
                let mut block = [T::default(); BLOCK_CELLS];
                let (table, cells) = (&tables.levels[level - 1], block.as_mut_slice());
                let density = (self.source.as_slice(), &hierarchy.levels[level]);
                let coarser = (self.down[level - 1].as_slice(), &hierarchy.levels[level - 1]);
                self.arch.dispatch(Lower::<T, A, N, AROUND> {
                    table,
                    density,
                    coarser,
                    places,
                    cells,
                    arithmetic: PhantomData,
                });
                take(sink, &block[..places.len() * CELLS])
            })
            .collect()
    }
}

/// Blocks are of [`BLOCK_CELLS`] cells. What [`Engine::take`] does on the way is the finest level's own part.
impl<T: Real> Engine<T> for TileOperator<T> {
    type Table = Tables<T>;

    fn block_len(&self) -> usize {
        BLOCK_CELLS
    }

    fn fill<S, R>(&mut self, sources: S, fill: impl Fn(S::Item, &mut [T]) -> R + Sync) -> Vec<R>
    where
        S: IndexedParallelIterator,
        R: Send,
    {
        self.source.par_chunks_mut(BLOCK_CELLS).zip_eq(sources).map(|(cells, source)| fill(source, cells)).collect()
    }

    fn multiply(&mut self, tables: &Tables<T>) {
        match (tables.sizes, self.arch) {
            (Sizes::Small, Arch::Scalar) => self.spread_with::<Separate, 4, 24, 32>(tables),
            (Sizes::Small, _) => self.spread_with::<Fused, 4, 24, 32>(tables),
            (Sizes::Medium, Arch::Scalar) => self.spread_with::<Separate, 16, 24, 48>(tables),
            (Sizes::Medium, _) => self.spread_with::<Fused, 16, 24, 48>(tables),
            (Sizes::Large, Arch::Scalar) => self.spread_with::<Separate, 32, 40, 80>(tables),
            (Sizes::Large, _) => self.spread_with::<Fused, 32, 40, 80>(tables),
        }
    }

    fn take<K, R>(&self, tables: &Tables<T>, sinks: K, take: impl Fn(K::Item, &[T]) -> R + Sync) -> Vec<R>
    where
        K: IndexedParallelIterator,
        R: Send,
    {
        match (tables.sizes, self.arch) {
            (Sizes::Small, Arch::Scalar) => self.take_with::<Separate, 4, 24, K, R>(tables, sinks, take),
            (Sizes::Small, _) => self.take_with::<Fused, 4, 24, K, R>(tables, sinks, take),
            (Sizes::Medium, Arch::Scalar) => self.take_with::<Separate, 16, 24, K, R>(tables, sinks, take),
            (Sizes::Medium, _) => self.take_with::<Fused, 16, 24, K, R>(tables, sinks, take),
            (Sizes::Large, Arch::Scalar) => self.take_with::<Separate, 32, 40, K, R>(tables, sinks, take),
            (Sizes::Large, _) => self.take_with::<Fused, 32, 40, K, R>(tables, sinks, take),
        }
    }

    fn set_mean(&self, tables: &mut Tables<T>, eigenvalue: f64) {
        let value = eigenvalue / self.hierarchy.base().len() as f64;
        tables.base.set_mean(T::rounded(value));
    }
}

#[cfg(test)]
mod tests;
