//! Values of the extension on the tiles of a level.
//!
//! A rank sets its own values, as means over finer levels.

use std::ops::Range;

use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, TileSet, means_of_quarter, quarters};

use crate::parallel;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::part::Part;

/// The tiles, block by block. There may be more values than tiles.
pub(super) fn blocks<'a>(
    places: &'a [[u32; 2]],
    cells: &'a mut [f32],
) -> impl Iterator<Item = (&'a [[u32; 2]], &'a mut [f32])> {
    places.chunks(BLOCK_TILES).zip(cells.chunks_mut(BLOCK_CELLS))
}

/// The own tiles of a level, block by block, from the values of all tiles.
pub(super) fn own_blocks<'a>(
    part: &'a Part,
    cells: &'a mut [f32],
) -> impl Iterator<Item = (&'a [[u32; 2]], &'a mut [f32])> {
    blocks(part.own_places(), &mut cells[part.own_cells()])
}

/// Sets the values of the base grid. Each rank sets those of its tiles.
pub(super) fn set_base(hierarchy: &Hierarchy, base: &mut [f32], set: impl Fn(&[[u32; 2]], &mut [f32]) + Sync) {
    let places = hierarchy.levels[0].tiles().places();
    let Some(part) = &hierarchy.base_part else {
        parallel::for_each(blocks(places, base), |(places, cells)| set(places, cells));
        return;
    };
    let mut own = vec![0.0; part.own_places().len() * CELLS];
    parallel::for_each(blocks(part.own_places(), &mut own), |(places, cells)| set(places, cells));
    let gathered = part.gathered(own);
    parallel::for_each(blocks(places, base), |(places, cells)| part.copy(&gathered, places, cells));
}

/// Means over the cells of a level.
pub(super) struct Means<'a> {
    /// Tiles of the next finer level. The values below are missing if it has the finest elements.
    tiles: &'a TileSet,
    finer: Option<&'a [f32]>,
    /// Range of the elements of the level in a vector, and their tiles.
    elements: Option<(Range<usize>, &'a TileSet)>,
    of_element: &'a (dyn Fn(usize) -> f32 + Sync),
}

impl<'a> Means<'a> {
    pub(super) fn new(
        hierarchy: &'a Hierarchy,
        level: usize,
        finer: Option<&'a [f32]>,
        of_element: &'a (dyn Fn(usize) -> f32 + Sync),
    ) -> Self {
        let tiles = hierarchy.levels[level + 1].tiles();
        Self { tiles, finer, elements: hierarchy.elements_of(level), of_element }
    }

    pub(super) fn set(&self, places: &[[u32; 2]], cells: &mut [f32]) {
        let child = |tile: usize, cell: usize| match self.finer {
            Some(finer) => finer[tile * CELLS + cell],
            None => (self.of_element)(tile * CELLS + cell),
        };
        for (&place, cells) in places.iter().zip(cells.as_chunks_mut::<CELLS>().0) {
            // Finer levels reach beyond their elements, over larger elements.
            if let Some((range, leaves)) = &self.elements
                && let Some(tile) = leaves.find(place[0].into(), place[1].into())
            {
                *cells = std::array::from_fn(|i| (self.of_element)(range.start + tile * CELLS + i));
                continue;
            }
            *cells = [0.0; CELLS];
            for quarter in quarters(place) {
                let Some(tile) = self.tiles.find(quarter[0].into(), quarter[1].into()) else { continue };
                let fine: [f32; CELLS] = std::array::from_fn(|cell| child(tile, cell));
                means_of_quarter(quarter, &fine, |cell, mean| cells[cell] = mean);
            }
        }
    }
}
