//! The base grid over ranks.
//!
//! Each rank computes a part of its tiles, and all ranks have all tiles.

use std::ops::Range;

use rc_comm::{Packed, Ranks};
use rc_quadtree::{CELLS, TileSet};

/// The tiles of the base grid that have values, and those that this rank computes.
#[derive(Debug)]
pub(crate) struct BasePart {
    ranks: Ranks,
    tiles: TileSet,
    own: Range<usize>,
}

impl BasePart {
    pub(crate) fn new(ranks: &Ranks, tiles: TileSet, own: Range<usize>) -> Self {
        Self { ranks: ranks.clone(), tiles, own }
    }

    /// The places of the tiles that this rank computes.
    pub(crate) fn own_places(&self) -> &[[u32; 2]] {
        &self.tiles.places()[self.own.clone()]
    }

    /// The values of all tiles, from the own values of each rank.
    ///
    /// All ranks call this together.
    pub(crate) fn gathered<T: Packed>(&self, own: Vec<T>) -> Vec<T> {
        self.ranks.concatenate(own)
    }

    /// Copies the `gathered` values at some places. They are zero where there is no tile.
    pub(crate) fn copy<T: Copy + Default>(&self, gathered: &[T], places: &[[u32; 2]], cells: &mut [T]) {
        for (&[column, row], cells) in places.iter().zip(cells.chunks_exact_mut(CELLS)) {
            match self.tiles.find(column.into(), row.into()) {
                Some(tile) => cells.copy_from_slice(&gathered[tile * CELLS..][..CELLS]),
                None => cells.fill(T::default()),
            }
        }
    }
}
