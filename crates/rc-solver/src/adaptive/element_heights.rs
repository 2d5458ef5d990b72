//! Heights of elements: of the smallest at their centres, of larger ones in the mean.

use rayon::prelude::*;

use super::elements::Elements;
use super::heights::Heights;
use super::tiles::{CELLS, TileSet, means_of_quarter, quarters};

/// Heights of all elements. What fills a vector up gets the least height there is, which is never in contact.
pub(super) fn element_heights(heights: &Heights<'_>, elements: &Elements) -> Vec<f64> {
    let mut result = vec![heights.extremes().least; elements.len()];
    for (coarser, tiles) in elements.levels().iter().enumerate() {
        let (cells, _) = result[elements.cells(coarser)].as_chunks_mut::<CELLS>();
        cells.par_iter_mut().zip(tiles.places()).with_min_len(16).for_each(|(cells, &place)| {
            heights.tile(tiles.side(), place[0] as usize, place[1] as usize, cells);
            if coarser > 0 {
                to_means(heights, tiles, place, coarser, cells);
            }
        });
    }
    result
}

/// From heights at centres to means over the centres of the finest elements, 2^`coarser` of them per side, as the displacement
/// of larger elements is one: with ⟨·⟩ over n × n centres, `⟨h⟩ - h(0) = Δh/24 (1 - 1/n²) d²` up to fourth order, so that
/// the mean over four gives the one over all.
fn to_means(heights: &Heights<'_>, tiles: &TileSet, place: [u32; 2], coarser: usize, cells: &mut [f64; CELLS]) {
    let ratio = (1.0 - 1.0 / Elements::area(coarser)) / (1.0 - 0.25);
    for quarter in quarters(place) {
        let mut fine = [0.0; CELLS];
        heights.tile(2 * tiles.side(), quarter[0] as usize, quarter[1] as usize, &mut fine);
        means_of_quarter(quarter, &fine, |cell, mean| cells[cell] += ratio * (mean - cells[cell]));
    }
}
