//! Heights of elements: at the centres of the smallest elements, and means over larger ones.

use std::ops::Range;

use rc_quadtree::{CELLS, Elements, TileSet, means_of_quarter, quarters};

use crate::parallel;
use crate::problem::steps::Step;
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::mesh::Mesh;

/// Heights of the elements that this rank has.
///
/// Values that fill up a vector, and those beyond a level, get the height `elsewhere`, which must be out of reach
/// ([`Problem::out_of_reach`]).
///
/// [`Problem::out_of_reach`]: crate::problem::checked::Problem::out_of_reach
pub(crate) fn element_heights(heights: &Heights<'_>, mesh: &Mesh, elsewhere: f64) -> Vec<f64> {
    let _running = Step::Heights.begin();
    let (layout, mut result) = (mesh.layout(), vec![elsewhere; mesh.n_own()]);
    let blocks = layout.ranges(result.len()).zip(layout.chunks_mut(&mut result));
    parallel::for_each(blocks, |(block, cells)| block_heights(heights, (mesh, block), cells));
    result
}

/// Writes the heights of the elements of one block of vectors, as [`element_heights`] does.
///
/// Other values of the block stay.
pub(crate) fn block_heights(heights: &Heights<'_>, (mesh, block): (&Mesh, Range<usize>), cells: &mut [f64]) {
    let (coarser, _, places) = mesh.tiles_of(block);
    let tiles = &mesh.levels()[coarser];
    for (cells, &place) in cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(places) {
        heights.tile(tiles.sides(), place.map(|i| i as usize), cells);
        if coarser > 0 {
            to_means(heights, tiles, place, coarser, cells);
        }
    }
}

/// Changes heights at centres to means over the centres of the smallest elements.
///
/// There are n = 2^`coarser` of these per side, and the displacement of a larger element is such a mean too. Let ⟨·⟩ be
/// the mean over n × n centres. Then `⟨h⟩ - h(0) = Δh/24 (1 - 1/n²) d²` up to fourth order. The mean over four centres
/// therefore gives the mean over all.
fn to_means(heights: &Heights<'_>, tiles: &TileSet, place: [u32; 2], coarser: usize, cells: &mut [f64; CELLS]) {
    let ratio = (1.0 - 1.0 / Elements::area(coarser)) / (1.0 - 0.25);
    for quarter in quarters(place) {
        let mut fine = [0.0; CELLS];
        heights.tile(tiles.sides().map(|side| 2 * side), quarter.map(|i| i as usize), &mut fine);
        means_of_quarter(quarter, &fine, |cell, mean| cells[cell] += ratio * (mean - cells[cell]));
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid, HeightField, HeightSource};

    use super::*;

    /// Two waves, of which the shorter has 16 of the largest elements.
    struct TwoWaves;

    impl HeightField for TwoWaves {
        fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
            let wave = |t: f64| (std::f64::consts::TAU * t).cos();
            wave(3.0 * x + y + 0.1) + wave(2.0 * x - 3.0 * y + 0.4)
        }

        fn band_limit(&self) -> Option<usize> {
            Some(4)
        }
    }

    #[test]
    fn a_larger_element_is_as_high_as_the_smallest_in_it_on_average() {
        let finest = Grid::square(256).expect("a grid");
        let heights =
            Heights::new(HeightSource::Surface { surface: &TwoWaves, grid: finest }, [64, 64]).expect("heights");
        let sampled = TwoWaves.sample(finest);
        let tiles = [(32, [16, 16]), (16, [4, 4]), (8, [0, 0])];
        let elements =
            Elements::new(tiles.map(|(per_side, place)| TileSet::new([8 * per_side; 2], vec![place])).to_vec());
        let values = element_heights(&heights, &Mesh::from(elements.clone()), 0.0);
        for (coarser, (_, [column, row])) in tiles.into_iter().enumerate() {
            let (n, start) = (1 << coarser, elements.cells(coarser).start);
            for cell in 0..CELLS {
                let (x, y) = (n * (8 * column as usize + cell % 8), n * (8 * row as usize + cell / 8));
                let sum: f64 = (0..n * n).map(|i| sampled.at(x + i % n, y + i / n)).sum();
                let error = values[start + cell] - sum / (n * n) as f64;
                // The error is of fourth order: (2π/16)⁴ / 1920 of a wave, and the interpolation.
                assert!(error.abs() < 3e-5, "{n} x {n} elements, cell {cell}: off by {error:e}");
            }
        }
    }
}
