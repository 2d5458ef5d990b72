//! Heights of elements: at the centres of the smallest ones, means over larger ones.

use rayon::prelude::*;
use rc_quadtree::{CELLS, Elements, TileSet, means_of_quarter, quarters};

use super::heights::Heights;

/// Heights of all elements. Values that fill up a vector are the minimum height, which is never in contact.
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

/// From heights at centres to means over the centres of the smallest elements, 2^`coarser` of them per side: the displacement of a
/// larger element is such a mean too. With ⟨·⟩ over n × n centres, `⟨h⟩ - h(0) = Δh/24 (1 - 1/n²) d²` up to fourth order. The mean
/// over four centres therefore gives the mean over all.
fn to_means(heights: &Heights<'_>, tiles: &TileSet, place: [u32; 2], coarser: usize, cells: &mut [f64; CELLS]) {
    let ratio = (1.0 - 1.0 / Elements::area(coarser)) / (1.0 - 0.25);
    for quarter in quarters(place) {
        let mut fine = [0.0; CELLS];
        heights.tile(2 * tiles.side(), quarter[0] as usize, quarter[1] as usize, &mut fine);
        means_of_quarter(quarter, &fine, |cell, mean| cells[cell] += ratio * (mean - cells[cell]));
    }
}
