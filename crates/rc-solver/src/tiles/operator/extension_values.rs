//! Values of the extension on the tiles of a level.
//!
//! A rank sets its own values, as means over finer levels.

use rc_quadtree::{CELLS, means_of_quarter, quarters};

use crate::parallel;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tile_values::TileValues;
use crate::tiles::part::blocks;

/// Sets the values of the base grid. Each rank sets those of its tiles.
pub(super) fn set_base(hierarchy: &Hierarchy, base: &mut [f32], set: impl Fn(&[[u32; 2]], &mut [f32]) + Sync) {
    let values = hierarchy.base_part.values(set);
    let places = hierarchy.levels[0].tiles().places();
    parallel::for_each(blocks(places, base), |(places, cells)| values.copy(places, cells));
}

/// Means over the cells of a level.
pub(super) struct Means<'a> {
    finer: TileValues<'a, f32>,
    /// The elements of the level.
    elements: Option<TileValues<'a, f32>>,
}

impl<'a> Means<'a> {
    /// Means over the values of the next `finer` level. Those of the level's own elements are among `elements`.
    pub(super) fn new(hierarchy: &'a Hierarchy, level: usize, finer: &'a [f32], elements: &'a [f32]) -> Self {
        let of_level = |(range, tiles)| TileValues::new(&elements[range], tiles);
        let finer = TileValues::new(finer, hierarchy.levels[level + 1].tiles());
        Self { finer, elements: hierarchy.elements_of(level).map(of_level) }
    }

    pub(super) fn set(&self, places: &[[u32; 2]], cells: &mut [f32]) {
        for (&place, cells) in places.iter().zip(cells.as_chunks_mut::<CELLS>().0) {
            // Finer levels reach beyond their elements, over larger elements.
            if let Some(elements) = self.elements.and_then(|elements| elements.tile(place)) {
                cells.copy_from_slice(elements);
                continue;
            }
            *cells = [0.0; CELLS];
            for quarter in quarters(place) {
                if let Some(fine) = self.finer.tile(quarter) {
                    means_of_quarter(quarter, fine, |cell, mean| cells[cell] = mean);
                }
            }
        }
    }
}
