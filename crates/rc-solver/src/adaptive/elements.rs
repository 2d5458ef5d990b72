//! The elements of a mesh: tiles of the finest level, and tiles of coarser ones where the pressure is smooth.

use std::ops::Range;

use super::operator::BLOCK_CELLS;
use super::tiles::{CELLS, TileSet};

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

    /// Length of vectors.
    pub(crate) fn len(&self) -> usize {
        let last = self.levels.len() - 1;
        self.starts[last] + self.levels[last].n_cells()
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

    /// Area of an element in units of the finest ones.
    pub(crate) fn area(coarser: usize) -> f64 {
        f64::from(1_u32 << (2 * coarser))
    }
}
