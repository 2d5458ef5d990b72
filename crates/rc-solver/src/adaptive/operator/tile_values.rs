//! Values on the tiles of a level.

use rc_quadtree::TileSet;

/// Values on tiles, one tile after the other.
#[derive(Clone, Copy)]
pub(super) struct TileValues<'a, T> {
    pub(super) values: &'a [T],
    pub(super) tiles: &'a TileSet,
}

impl<'a, T> TileValues<'a, T> {
    pub(super) fn new(values: &'a [T], tiles: &'a TileSet) -> Self {
        Self { values, tiles }
    }
}
