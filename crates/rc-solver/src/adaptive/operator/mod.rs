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

mod coarse;
mod pass;
mod real;
mod stencil;
mod tables;
mod transfer;

use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

use pulp::Arch;
use rayon::prelude::*;
use rc_core::Grid;
use rc_fft::{BLOCK_ROWS, Convolution};
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, Elements, TILE, TileSet};

use self::coarse::{Blur, FromGhosts, Leaves, Means};
use self::pass::{Lift, Lower};
pub(crate) use self::real::Real;
use self::real::{Fused, MultiplyAdd, Separate};
use self::tables::Sizes;
pub(crate) use self::tables::{Prepared, Tables};
use super::element_blocks::blocks_of;
use crate::descent::{Blocks, Engine};

/// The tiles of all levels, coarsest first: the first is the whole base grid, the last has the finest elements.
pub(crate) struct Hierarchy {
    elements: Elements,
    blocks: Vec<(usize, Range<usize>)>,
    /// The densities of each level, coarser elements included; on the finest level, its elements.
    levels: Vec<TileSet>,
    /// The elements that are 2, 4, … times as large as the finest.
    leaves: Vec<Leaves>,
}

/// How far, in cells of a level, values go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reach {
    /// Filters, between levels and within one.
    pub(crate) filter: usize,
    /// Stencils.
    pub(crate) stencil: usize,
}

impl Hierarchy {
    /// The levels over `elements` down to the base grid of `base_side` cells per side, a multiple of 8, each with the tiles
    /// that filters need. The coarsest elements are finer than the base grid's, and elements whose sizes differ by more than
    /// a factor of 2 are farther from each other than stencils of the level between them reach.
    pub(crate) fn new(base_side: usize, elements: Elements, reach: Reach) -> Self {
        let mut levels = vec![elements.finest().clone()];
        while levels[levels.len() - 1].side() > 2 * base_side {
            let parents = levels[levels.len() - 1].parents(reach.filter);
            levels.push(match elements.levels().get(levels.len()) {
                Some(leaves) => parents.with(&leaves.around(reach.filter)),
                None => parents,
            });
        }
        levels.push(TileSet::full(base_side / TILE));
        levels.reverse();
        debug_assert!(elements.levels().len() < levels.len(), "no elements are on the base grid");
        let pairs = elements.levels().windows(2);
        let leaves = pairs.map(|pair| Leaves::new(pair[1].clone(), &pair[0], reach.stencil)).collect();
        Self { blocks: elements.blocks(), elements, levels, leaves }
    }

    /// The elements.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Grid {
        Grid::square(self.levels[0].side()).expect("the base grid is smaller than the finest")
    }

    /// Levels above the base grid.
    pub(crate) fn n_levels(&self) -> usize {
        self.levels.len() - 1
    }

    /// The elements of a level: where they are in a vector, and their tiles.
    fn elements_of(&self, level: usize) -> Option<(Range<usize>, &TileSet)> {
        let coarser = self.n_levels() - level;
        self.elements.levels().get(coarser).map(|tiles| (self.elements.cells(coarser), tiles))
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
    /// Values of the ghosts of each level of coarse elements.
    ghosts: Vec<Vec<T>>,
}

impl<T: Real> TileOperator<T> {
    pub(crate) fn new(hierarchy: Arc<Hierarchy>) -> Self {
        let n_levels = hierarchy.n_levels();
        let zeros = || hierarchy.levels[..n_levels].iter().map(|tiles| vec![T::default(); tiles.n_cells()]).collect();
        Self {
            arch: Arch::new(),
            convolution: Convolution::new(hierarchy.base()),
            source: vec![T::default(); hierarchy.elements.len()],
            up: zeros(),
            down: zeros(),
            ghosts: hierarchy.leaves.iter().map(|leaves| vec![T::default(); leaves.ghosts.n_cells()]).collect(),
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
        self.spread_to_ghosts();
        for level in (1..n_levels).rev() {
            let (coarser, finer) = self.up.split_at_mut(level + 1);
            let values = finer.first().unwrap_or(&self.source);
            let blocks = coarser[level].par_chunks_mut(BLOCK_CELLS).zip(levels[level].places().par_chunks(BLOCK_TILES));
            blocks.for_each(|(cells, places)| {
                let transfer = &tables.levels[level].1;
                let finer = (values.as_slice(), &levels[level + 1]);
                arch.dispatch(Lift::<T, A, N, UNDER> { transfer, finer, places, cells, arithmetic: PhantomData });
            });
            self.add_coarse_elements::<A, AROUND>(level, tables);
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

    fn spread_to_ghosts(&mut self) {
        let elements = &self.hierarchy.elements;
        for (i, (leaves, ghosts)) in self.hierarchy.leaves.iter().zip(&mut self.ghosts).enumerate() {
            let values = &self.source[elements.cells(i + 1)];
            let blocks = ghosts.par_chunks_mut(BLOCK_CELLS).zip(leaves.ghosts.places().par_chunks(BLOCK_TILES));
            blocks.for_each(|(ghosts, places)| leaves.spread_to_ghosts(values, places, ghosts));
        }
    }

    /// Adds the elements of a level that is not the finest to its density.
    fn add_coarse_elements<A: MultiplyAdd, const AROUND: usize>(&mut self, level: usize, tables: &Tables<T>) {
        let Some((cells, tiles)) = self.hierarchy.elements_of(level) else { return };
        let table = tables.coarse_table(self.hierarchy.n_levels() - level);
        let (values, arch) = ((&self.source[cells], tiles), self.arch);
        let places = self.hierarchy.levels[level].places();
        let blocks = self.up[level].par_chunks_mut(BLOCK_CELLS).zip(places.par_chunks(BLOCK_TILES));
        blocks.for_each(|(cells, places)| {
            arch.dispatch(Blur::<T, A, AROUND> { table, values, places, cells, arithmetic: PhantomData });
        });
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
        let blocks = self.hierarchy.blocks.par_iter().enumerate();
        blocks
            .zip_eq(sinks)
            .map(|((i, (coarser, tiles)), sink)| {
                let mut block = [T::default(); BLOCK_CELLS];
                let cells = &mut block[..tiles.len() * CELLS];
                if *coarser == 0 {
                    self.lower_finest::<A, N, AROUND>(tables, tiles.clone(), cells);
                } else {
                    self.lower_coarse::<A, AROUND>(tables, *coarser, tiles.clone(), cells);
                }
                self.add_ghosts::<A, AROUND>(tables, *coarser, tiles.clone(), cells);
                // What fills up the last block of a level has no displacement.
                take(sink, &block[..(self.source.len() - i * BLOCK_CELLS).min(BLOCK_CELLS)])
            })
            .collect()
    }

    /// The displacement of some tiles of the finest elements.
    fn lower_finest<A: MultiplyAdd, const N: usize, const AROUND: usize>(
        &self,
        tables: &Tables<T>,
        tiles: Range<usize>,
        cells: &mut [T],
    ) {
        let (levels, level) = (&self.hierarchy.levels, self.hierarchy.n_levels());
        let finest = self.hierarchy.elements.cells(0);
        self.arch.dispatch(Lower::<T, A, N, AROUND> {
            table: &tables.levels[level - 1],
            density: (&self.source[finest], &levels[level]),
            coarser: (self.down[level - 1].as_slice(), &levels[level - 1]),
            places: &levels[level].places()[tiles],
            cells,
            arithmetic: PhantomData,
        });
    }

    /// The displacement of some tiles of elements 2^`coarser` times as large as the finest.
    fn lower_coarse<A: MultiplyAdd, const AROUND: usize>(
        &self,
        tables: &Tables<T>,
        coarser: usize,
        tiles: Range<usize>,
        cells: &mut [T],
    ) {
        let Hierarchy { elements, levels, leaves, .. } = self.hierarchy.as_ref();
        let level = self.hierarchy.n_levels() - coarser;
        let leaves = &leaves[coarser - 1];
        self.arch.dispatch(Means::<T, A, AROUND> {
            table: tables.coarse_table(coarser),
            elements: (&self.source[elements.cells(coarser)], &leaves.tiles),
            finer: (&self.source[elements.cells(coarser - 1)], &elements.levels()[coarser - 1]),
            ghosts: &leaves.ghosts,
            level: (self.down[level].as_slice(), &levels[level]),
            places: &leaves.tiles.places()[tiles],
            cells,
            arithmetic: PhantomData,
        });
    }

    /// Adds what larger elements nearby add to the displacement of some tiles of elements 2^`coarser` times as large as the
    /// finest.
    fn add_ghosts<A: MultiplyAdd, const AROUND: usize>(
        &self,
        tables: &Tables<T>,
        coarser: usize,
        tiles: Range<usize>,
        cells: &mut [T],
    ) {
        let Some(larger) = self.hierarchy.leaves.get(coarser) else { return };
        let Some(table) = tables.coarse_table(coarser + 1) else { return };
        self.arch.dispatch(FromGhosts::<T, A, AROUND> {
            taps: &table.across,
            ghosts: (&self.ghosts[coarser], &larger.ghosts),
            places: &self.hierarchy.elements.levels()[coarser].places()[tiles],
            cells,
            arithmetic: PhantomData,
        });
    }
}

/// Blocks are of [`BLOCK_CELLS`] cells. What [`Engine::take`] does on the way is the finest level's own part.
impl<T: Real> Engine<T> for TileOperator<T> {
    type Table = Tables<T>;

    fn blocks(&self) -> Blocks {
        blocks_of(&self.hierarchy.elements)
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
