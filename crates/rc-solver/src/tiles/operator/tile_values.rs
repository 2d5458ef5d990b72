//! Values on the tiles of a level.

use rc_quadtree::TileSet;

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
}
