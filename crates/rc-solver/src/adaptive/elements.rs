//! The elements of a mesh: tiles of the finest level, and tiles of coarser ones where the pressure is smooth.

use std::borrow::Cow;
use std::convert::Infallible;
use std::ops::Range;

use rayon::prelude::*;
use rc_core::{Grid, Observer, Snapshot};

use super::operator::{BLOCK_CELLS, Patch};
use super::tiles::{CELLS, TILE, TileSet, cell_over, means_of_quarter, quarters};
use crate::descent::{Blocks, Shown};

/// Disjoint tiles of one or more levels, finest first.
///
/// Vectors have the cells of the finest level first, then those of the next coarser one and so on; each level begins at a
/// whole block, so that all cells of a block are of one size. What fills a block up has no tile.
#[derive(Clone, Debug)]
pub(crate) struct Elements {
    levels: Vec<TileSet>,
    starts: Vec<usize>,
}

impl Elements {
    /// Elements of one size.
    pub(crate) fn uniform(tiles: TileSet) -> Self {
        Self::new(vec![tiles])
    }

    /// The tiles of the finest level, of the next coarser one, and so on.
    pub(crate) fn new(levels: Vec<TileSet>) -> Self {
        let mut starts = Vec::with_capacity(levels.len());
        let mut next = 0_usize;
        for tiles in &levels {
            let start = next.next_multiple_of(BLOCK_CELLS);
            starts.push(start);
            next = start + tiles.n_cells();
        }
        Self { levels, starts }
    }

    /// Tiles of each level, finest first.
    pub(crate) fn levels(&self) -> &[TileSet] {
        &self.levels
    }

    /// The tiles of the finest level.
    pub(crate) fn finest(&self) -> &TileSet {
        &self.levels[0]
    }

    /// Number of elements.
    pub(crate) fn n_cells(&self) -> usize {
        self.levels.iter().map(TileSet::n_cells).sum()
    }

    /// Has it the tile at a place of the level with `side` cells per side?
    pub(crate) fn has(&self, side: usize, [column, row]: [u32; 2]) -> bool {
        let level = self.levels.iter().find(|tiles| tiles.side() == side);
        level.is_some_and(|tiles| tiles.find(column.into(), row.into()).is_some())
    }

    /// Length of vectors.
    pub(crate) fn len(&self) -> usize {
        let last = self.levels.len() - 1;
        self.starts[last] + self.levels[last].n_cells()
    }

    /// The tiles of the coarsest level.
    pub(crate) fn coarsest(&self) -> &TileSet {
        &self.levels[self.levels.len() - 1]
    }

    /// With tiles of the coarsest level at all of `places` that have no elements yet.
    pub(crate) fn with(&self, places: &[[u32; 2]]) -> Self {
        let last = self.levels.len() - 1;
        let mut levels = self.levels.clone();
        let new = places.iter().filter(|&&[column, row]| !self.cover(last, column, row));
        levels[last] =
            TileSet::new(levels[last].per_side(), levels[last].places().iter().chain(new).copied().collect());
        Self::new(levels)
    }

    /// The tiles for which `wanted` is true; it gets the cells per side of the level, the place and where the cells are.
    pub(crate) fn filtered(&self, wanted: impl Fn(usize, [u32; 2], Range<usize>) -> bool) -> Self {
        let level = |(tiles, &start): (&TileSet, &usize)| {
            let places = tiles.places().iter().enumerate();
            let cells = |tile: usize| start + tile * CELLS..start + (tile + 1) * CELLS;
            let chosen =
                places.filter(|&(tile, &place)| wanted(tiles.side(), place, cells(tile))).map(|(_, &place)| place);
            TileSet::new(tiles.per_side(), chosen.collect())
        };
        Self::new(self.levels.iter().zip(&self.starts).map(level).collect())
    }

    /// Whether they cover the whole cell.
    pub(crate) fn cover_cell(&self) -> bool {
        let areas = self.levels.iter().enumerate().map(|(coarser, tiles)| tiles.n_cells() << (2 * coarser));
        areas.sum::<usize>() == self.finest().side().pow(2)
    }

    /// Where the cells of the level `coarser` times coarser than the finest are in a vector.
    pub(crate) fn cells(&self, coarser: usize) -> Range<usize> {
        self.starts[coarser]..self.starts[coarser] + self.levels[coarser].n_cells()
    }

    /// The blocks of a vector: how much coarser than the finest level, and which of its tiles.
    pub(crate) fn blocks(&self) -> Vec<(usize, Range<usize>)> {
        let per_block = BLOCK_CELLS / CELLS;
        let blocks = |(coarser, tiles): (usize, &TileSet)| {
            let n = tiles.len();
            (0..n.div_ceil(per_block)).map(move |i| (coarser, i * per_block..((i + 1) * per_block).min(n)))
        };
        self.levels.iter().enumerate().flat_map(blocks).collect()
    }

    /// How vectors are divided.
    pub(crate) fn division(&self) -> Blocks {
        if self.levels.len() == 1 {
            return Blocks::of(BLOCK_CELLS);
        }
        Blocks::with_areas(BLOCK_CELLS, self.blocks().into_iter().map(|(coarser, _)| Self::area(coarser)).collect())
    }

    /// Area of an element in units of the finest ones.
    pub(crate) fn area(coarser: usize) -> f64 {
        f64::from(1_u32 << (2 * coarser))
    }

    /// Side of an element, in λ.
    pub(crate) fn side(&self, coarser: usize) -> f64 {
        1.0 / self.levels[coarser].side() as f64
    }

    /// All tiles: how much coarser than the finest, the index among those of its level, and the first cell.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        let of_level = |(coarser, tiles): (usize, &TileSet)| {
            let start = self.starts[coarser];
            (0..tiles.len()).map(move |tile| (coarser, tile, start + tile * CELLS))
        };
        self.levels.iter().enumerate().flat_map(of_level)
    }

    /// The first cell of the tile at a place of a level, when its elements are of that size.
    fn find(&self, coarser: usize, column: i64, row: i64) -> Option<usize> {
        let tile = self.levels.get(coarser)?.find(column, row)?;
        Some(self.starts[coarser] + tile * CELLS)
    }

    /// Are there elements, of this size or smaller ones, at a place of a level?
    pub(crate) fn cover(&self, coarser: usize, column: u32, row: u32) -> bool {
        // A tile that is divided has all its quarters.
        let (mut x, mut y) = (i64::from(column), i64::from(row));
        (0..=coarser).rev().any(|coarser| {
            let found = self.levels.get(coarser).is_some_and(|tiles| tiles.find(x, y).is_some());
            (x, y) = (2 * x, 2 * y);
            found
        })
    }

    /// Copies the values of a tile's place of a level, whatever the size of the elements there up to a factor of 2: larger ones
    /// stand for their quarters, smaller ones are averaged. False, and nothing copied, where there are none.
    pub(crate) fn tile_values(
        &self,
        values: &[f64],
        coarser: usize,
        (column, row): (i64, i64),
        mut put: impl FnMut(usize, usize, f64),
    ) -> bool {
        if let Some(start) = self.find(coarser, column, row) {
            for (cell, &value) in values[start..start + CELLS].iter().enumerate() {
                put(cell % TILE, cell / TILE, value);
            }
            return true;
        }
        if self.quarter_values(values, coarser + 1, (column, row), &mut put) {
            return true;
        }
        let Some(finer) = coarser.checked_sub(1) else { return false };
        let mut any = false;
        let wrap = |i: i64| i.rem_euclid(self.levels[coarser].per_side() as i64) as u32;
        for quarter in quarters([wrap(column), wrap(row)]) {
            let Some(start) = self.find(finer, quarter[0].into(), quarter[1].into()) else { continue };
            any = true;
            means_of_quarter(quarter, &values[start..start + CELLS], |cell, mean| put(cell % TILE, cell / TILE, mean));
        }
        any
    }

    /// The same for the place of a tile half as large as those of the level `coarser`, from that level only.
    fn quarter_values(
        &self,
        values: &[f64],
        coarser: usize,
        (column, row): (i64, i64),
        mut put: impl FnMut(usize, usize, f64),
    ) -> bool {
        let Some(start) = self.find(coarser, column.div_euclid(2), row.div_euclid(2)) else { return false };
        let quarter = [column, row].map(|i| i.rem_euclid(2) as u32);
        for cell in 0..CELLS {
            let (x, y) = (cell % TILE, cell / TILE);
            put(x, y, values[start + cell_over(quarter, x, y)]);
        }
        true
    }

    /// The values on a tile and its neighbours, `missing` where there are no elements.
    pub(crate) fn around(
        &self,
        values: &[f64],
        coarser: usize,
        [column, row]: [u32; 2],
        missing: f64,
    ) -> Patch<f64, { 3 * TILE }> {
        let mut patch = [[missing; 3 * TILE]; 3 * TILE];
        for j in 0..3 {
            for i in 0..3 {
                let place = (i64::from(column) + i as i64 - 1, i64::from(row) + j as i64 - 1);
                self.tile_values(values, coarser, place, |x, y, value| patch[j * TILE + y][i * TILE + x] = value);
            }
        }
        patch
    }

    /// The mesh without its finest level: what was there is averaged over elements twice as large.
    pub(crate) fn without_finest(&self, values: &[f64]) -> (Self, Vec<f64>) {
        let mut levels = self.levels[1..].to_vec();
        levels[0] = levels[0].with(&self.levels[0].parents(0));
        let coarser = Self::new(levels);
        let values = self.moved(&coarser, values, 0.0);
        (coarser, values)
    }

    /// Tiles of the coarsest level, and the mean over smaller elements on their cells.
    pub(crate) fn on_coarsest<'a>(&self, values: &'a [f64]) -> (TileSet, Cow<'a, [f64]>) {
        if self.levels.len() == 1 {
            return (self.finest().clone(), Cow::Borrowed(values));
        }
        let (mut coarser, mut values) = self.without_finest(values);
        while coarser.levels.len() > 1 {
            (coarser, values) = coarser.without_finest(&values);
        }
        (coarser.finest().clone(), Cow::Owned(values))
    }

    /// Values on the elements of `to`, whose tiles are those here, parts of them, or new ones; `elsewhere` on new ones, and in
    /// what fills vectors up.
    pub(crate) fn moved(&self, to: &Self, values: &[f64], elsewhere: f64) -> Vec<f64> {
        let mut result = vec![elsewhere; to.len()];
        for (coarser, tiles) in to.levels.iter().enumerate() {
            // The same level here, unless the other mesh has a finer one.
            let here = self.levels.iter().position(|level| level.side() == tiles.side());
            let cells = &mut result[to.cells(coarser)];
            let sinks = cells.par_chunks_mut(CELLS).zip(tiles.places()).with_min_len(64);
            sinks.for_each(|(cells, &place)| {
                let (place, put) =
                    (place.map(i64::from).into(), |x: usize, y: usize, value| cells[y * TILE + x] = value);
                match here {
                    Some(here) => self.tile_values(values, here, place, put),
                    None => self.quarter_values(values, 0, place, put),
                };
            });
        }
        result
    }
}

impl Shown for Elements {
    fn show(&self, pressure: &[f64], observer: &dyn Observer) {
        let grid = Grid::square(self.coarsest().side()).expect("a level of a checked grid");
        let rows = |take: &mut dyn FnMut(&[f64])| {
            let (tiles, pressure) = self.on_coarsest(pressure);
            let Ok(()) = tiles.rows(&pressure, |_, rows| {
                take(rows);
                Ok::<_, Infallible>(())
            });
        };
        observer.look(&Snapshot::new(grid, &rows));
    }
}
