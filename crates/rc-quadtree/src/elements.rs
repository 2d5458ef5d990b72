//! The elements of a mesh.
//!
//! They are cells of the finest level, and of coarser levels where the pressure is smooth.

use std::ops::Range;

use crate::tiles::{CELLS, TileSet};

/// Number of tiles that one thread processes at a time.
pub const BLOCK_TILES: usize = 16;

/// Number of cells in a block of a vector.
pub const BLOCK_CELLS: usize = BLOCK_TILES * CELLS;

/// Elements of one or more sizes.
///
/// They are the cells of disjoint tiles of one or more levels, finest first. The elements of the level `coarser` have
/// 2^`coarser` times the side of the finest elements.
///
/// Vectors have one value for each cell. The values of the finest level come first, then those of the next coarser
/// level, and so on. Each level begins at a whole block of [`BLOCK_CELLS`], so all cells of a block have the same size.
///
/// Some values of a vector have no element. These are values between the last cell of a level and the next block, and
/// cells beyond the level in a tile that extends beyond it ([`TileSet`]). A mesh with such tiles has only one level.
#[derive(Clone, Debug)]
pub struct Elements {
    levels: Vec<TileSet>,
    starts: Vec<usize>,
}

impl Elements {
    /// Elements of one size.
    #[must_use]
    pub fn uniform(tiles: TileSet) -> Self {
        Self::new(vec![tiles])
    }

    /// Elements of the tiles of several levels.
    ///
    /// The finest level is first. Each further level has half as many cells per side.
    ///
    /// # Panics
    /// When there is no level.
    #[must_use]
    pub fn new(levels: Vec<TileSet>) -> Self {
        assert!(!levels.is_empty(), "a mesh has at least one level");
        let mut starts = Vec::with_capacity(levels.len());
        let mut next = 0_usize;
        for tiles in &levels {
            let start = next.next_multiple_of(BLOCK_CELLS);
            starts.push(start);
            next = start + tiles.n_cells();
        }
        Self { levels, starts }
    }

    /// The tiles of each level, finest first.
    #[must_use]
    pub fn levels(&self) -> &[TileSet] {
        &self.levels
    }

    /// The tiles of the finest level.
    #[must_use]
    pub fn finest(&self) -> &TileSet {
        &self.levels[0]
    }

    /// Number of elements.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.levels.iter().map(TileSet::n_inside).sum()
    }

    /// Number of cells of the finest size that would cover the elements.
    #[must_use]
    pub fn n_finest(&self) -> usize {
        self.levels.iter().enumerate().map(|(coarser, tiles)| tiles.n_inside() << (2 * coarser)).sum()
    }

    /// Whether there is a tile at a place of the level with `sides` cells.
    #[must_use]
    pub fn has(&self, sides: [usize; 2], [column, row]: [u32; 2]) -> bool {
        let level = self.levels.iter().find(|tiles| tiles.sides() == sides);
        level.is_some_and(|tiles| tiles.find(column.into(), row.into()).is_some())
    }

    /// Length of vectors: [`Elements::n_cells`] plus the values that complete blocks.
    #[must_use]
    pub fn len(&self) -> usize {
        let last = self.levels.len() - 1;
        self.starts[last] + self.levels[last].n_cells()
    }

    /// Whether there are no elements.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.levels.iter().all(TileSet::is_empty)
    }

    /// The tiles of the coarsest level.
    #[must_use]
    pub fn coarsest(&self) -> &TileSet {
        &self.levels[self.levels.len() - 1]
    }

    /// This mesh with more tiles of the coarsest level.
    ///
    /// It gets a tile at each of `places` that has no elements yet.
    #[must_use]
    pub fn with(&self, places: &[[u32; 2]]) -> Self {
        let last = self.levels.len() - 1;
        let mut levels = self.levels.clone();
        let new = places.iter().filter(|&&[column, row]| !self.cover(last, column, row));
        let places = levels[last].places().iter().chain(new).copied().collect();
        levels[last] = levels[last].of_same_cell(levels[last].sides(), places);
        Self::new(levels)
    }

    /// Whether the elements cover the whole periodic cell.
    #[must_use]
    pub fn cover_cell(&self) -> bool {
        let areas = self.levels.iter().enumerate().map(|(coarser, tiles)| tiles.n_inside() << (2 * coarser));
        areas.sum::<usize>() == self.finest().sides().into_iter().product::<usize>()
    }

    /// Range of the cells of a level in a vector.
    #[must_use]
    pub fn cells(&self, coarser: usize) -> Range<usize> {
        self.starts[coarser]..self.starts[coarser] + self.levels[coarser].n_cells()
    }

    /// Area of an element of a level, in units of the smallest elements.
    #[must_use]
    pub fn area(coarser: usize) -> f64 {
        f64::from(1_u32 << (2 * coarser))
    }

    /// Side of an element of a level, in λ.
    ///
    /// λ is the side of the periodic cell along x. Elements are squares, or nearly squares.
    #[must_use]
    pub fn side(&self, coarser: usize) -> f64 {
        1.0 / self.levels[coarser].sides()[0] as f64
    }

    /// All tiles.
    ///
    /// Each is given by the number of its level, its index there, and its first cell.
    pub fn tiles(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        let of_level = |(coarser, tiles): (usize, &TileSet)| {
            let start = self.starts[coarser];
            (0..tiles.len()).map(move |tile| (coarser, tile, start + tile * CELLS))
        };
        self.levels.iter().enumerate().flat_map(of_level)
    }

    /// The first cell of the tile at a place of a level, if it exists.
    pub(crate) fn find(&self, coarser: usize, column: i64, row: i64) -> Option<usize> {
        let tile = self.levels.get(coarser)?.find(column, row)?;
        Some(self.starts[coarser] + tile * CELLS)
    }

    /// Whether there are elements of this size or smaller at a place.
    #[must_use]
    pub fn cover(&self, coarser: usize, column: u32, row: u32) -> bool {
        // If a tile is divided, all of its quarters exist.
        let (mut x, mut y) = (i64::from(column), i64::from(row));
        (0..=coarser).rev().any(|coarser| {
            let found = self.levels.get(coarser).is_some_and(|tiles| tiles.find(x, y).is_some());
            (x, y) = (2 * x, 2 * y);
            found
        })
    }
}
