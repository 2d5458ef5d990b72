//! The contact area on a mesh.

use rayon::prelude::*;
use rc_core::{Grid, Kernel};
use rc_kernel::Love;
use rc_quadtree::{CELLS, Elements, TILE};

use crate::ContactArea;
use crate::contact_area::EdgeSums;

/// Tiles that are summed together; sums have this order for any number of threads.
const TILES_AT_ONCE: usize = 64;

/// From pressure and gap on `elements`, the smallest of which are those of `finest`; `contact_gap` is the gap of what is in contact.
pub(super) fn contact_area(
    elements: &Elements,
    pressure: &[f64],
    (gap, contact_gap): (&[f64], f64),
    finest: Grid,
) -> ContactArea {
    let of_level = |coarser: usize| {
        let (side, first) = (elements.side(coarser), elements.cells(coarser).start);
        let tiles = &elements.levels()[coarser];
        let of_tile = |(tile, &place): (usize, &[u32; 2])| {
            let start = first + tile * CELLS;
            if pressure[start..start + CELLS].iter().all(|&p| p <= 0.0) {
                return EdgeSums::default();
            }
            let pressure = elements.around(pressure, coarser, place, 0.0);
            // Where no element is the gap is not known.
            let gap = elements.around(gap, coarser, place, f64::NAN);
            let mut sums = EdgeSums::default();
            // What reaches beyond the grid is across the seam.
            let [width, height] = tiles.inside(place);
            let cells = (0..CELLS).map(|cell| (cell % TILE, cell / TILE)).filter(|&(x, y)| x < width && y < height);
            for (x, y) in cells.map(|(x, y)| (TILE + x, TILE + y)) {
                if pressure[y][x] > 0.0 {
                    sums.add([side; 2], &|dx, dy| {
                        let (x, y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                        [pressure[y][x], gap[y][x] - contact_gap]
                    });
                }
            }
            sums
        };
        let chunks = tiles.places().par_chunks(TILES_AT_ONCE).enumerate();
        let chunks: Vec<EdgeSums> = chunks
            .map(|(chunk, places)| {
                let tiles = places.iter().enumerate();
                let sums = tiles.map(|(tile, place)| of_tile((chunk * TILES_AT_ONCE + tile, place)));
                sums.fold(EdgeSums::default(), |a, b| a + b)
            })
            .collect();
        chunks.into_iter().fold(EdgeSums::default(), |a, b| a + b)
    };
    let sums: Vec<EdgeSums> = (0..elements.levels().len()).map(of_level).collect();
    ContactArea::from_sums(&sums, finest, Love.edge_bias())
}
