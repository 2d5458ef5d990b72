//! Values on the tiles of a level.

use rc_quadtree::{CELLS, TileSet};

/// Values on tiles, one tile after the other.
#[derive(Clone, Copy)]
pub(crate) struct TileValues<'a, T> {
    pub(crate) values: &'a [T],
    pub(crate) tiles: &'a TileSet,
}

impl<'a, T> TileValues<'a, T> {
    pub(crate) fn new(values: &'a [T], tiles: &'a TileSet) -> Self {
        Self { values, tiles }
    }

    /// The values of the tile at a place, if there is one.
    pub(crate) fn tile(&self, [column, row]: [u32; 2]) -> Option<&'a [T]> {
        let tile = self.tiles.find(column.into(), row.into())?;
        Some(&self.values[tile * CELLS..][..CELLS])
    }
}
