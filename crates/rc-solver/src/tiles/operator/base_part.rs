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
pub(crate) struct BaseValues<'a, T, F> {
    tiles: &'a TileSet,
    /// The values of all ranks. `None` for a single rank, which sets values when they are copied.
    values: Option<Vec<T>>,
    set: F,
}

impl BasePart {
    pub(crate) fn new(ranks: &Ranks, tiles: TileSet, own: Range<usize>) -> Self {
        Self { ranks: ranks.clone(), tiles, own }
    }

    /// The values of all tiles. Each rank computes those of its tiles with `set`.
    ///
    /// All ranks call this together.
    pub(crate) fn values<T, F>(&self, set: F) -> BaseValues<'_, T, F>
    where
        T: Packed + Default,
        F: Fn(&[[u32; 2]], &mut [T]) + Sync,
    {
        let values = (self.ranks.size() > 1).then(|| {
            let places = &self.tiles.places()[self.own.clone()];
            let mut own = vec![T::default(); places.len() * CELLS];
            parallel::for_each(blocks(places, &mut own), |(places, cells)| set(places, cells));
            self.ranks.concatenate(own)
        });
        BaseValues { tiles: &self.tiles, values, set }
    }
}

impl<T: Copy + Default, F: Fn(&[[u32; 2]], &mut [T])> BaseValues<'_, T, F> {
    /// Copies the values at some places. They are zero where there is no tile.
    pub(crate) fn copy(&self, places: &[[u32; 2]], cells: &mut [T]) {
        for (&place, cells) in places.iter().zip(cells.chunks_exact_mut(CELLS)) {
            match (self.tiles.find(place[0].into(), place[1].into()), &self.values) {
                (Some(tile), Some(values)) => cells.copy_from_slice(&values[tile * CELLS..][..CELLS]),
                (Some(_), None) => (self.set)(&[place], cells),
                (None, _) => cells.fill(T::default()),
            }
        }
    }
}
