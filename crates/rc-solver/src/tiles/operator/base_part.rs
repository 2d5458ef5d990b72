//! The base grid over ranks.
//!
//! Each rank computes a part of its tiles, and all ranks have all tiles.

use std::ops::Range;

use rc_comm::{Packed, Ranks};
use rc_quadtree::{CELLS, TileSet};

use crate::parallel;
use crate::tiles::part::blocks;

/// The tiles of the base grid that have values, and those that this rank computes.
#[derive(Debug)]
pub(crate) struct BasePart {
    ranks: Ranks,
    tiles: TileSet,
    own: Range<usize>,
}

/// Values of the base grid.
pub(crate) struct BaseValues<'a, T> {
    tiles: &'a TileSet,
    values: Vec<T>,
}

impl BasePart {
    pub(crate) fn new(ranks: &Ranks, tiles: TileSet, own: Range<usize>) -> Self {
        Self { ranks: ranks.clone(), tiles, own }
    }

    /// The values of all tiles. Each rank computes those of its tiles with `set`.
    ///
    /// All ranks call this together.
    pub(crate) fn values<T: Packed + Default>(&self, set: impl Fn(&[[u32; 2]], &mut [T]) + Sync) -> BaseValues<'_, T> {
        let places = &self.tiles.places()[self.own.clone()];
        let mut own = vec![T::default(); places.len() * CELLS];
        parallel::for_each(blocks(places, &mut own), |(places, cells)| set(places, cells));
        BaseValues { tiles: &self.tiles, values: self.ranks.concatenate(own) }
    }
}

impl<T: Copy + Default> BaseValues<'_, T> {
    /// Copies the values at some places. They are zero where there is no tile.
    pub(crate) fn copy(&self, places: &[[u32; 2]], cells: &mut [T]) {
        for (&[column, row], cells) in places.iter().zip(cells.chunks_exact_mut(CELLS)) {
            match self.tiles.find(column.into(), row.into()) {
                Some(tile) => cells.copy_from_slice(&self.values[tile * CELLS..][..CELLS]),
                None => cells.fill(T::default()),
            }
        }
    }
}
