//! The contact area on a mesh.

use std::ops::Range;

use rayon::prelude::*;
use rc_core::{Grid, Kernel};
use rc_kernel::Love;
use rc_quadtree::{CELLS, TILE};

use super::mesh::Mesh;
use crate::ContactArea;
use crate::contact_area::EdgeSums;

/// Tiles that are summed together; sums have this order for any number of threads.
const TILES_AT_ONCE: usize = 64;

/// From pressure and gap on `mesh`, the smallest elements of which are those of `finest`; `contact_gap` is the gap of what is in contact.
pub(super) fn contact_area(
    mesh: &Mesh,
    pressure: &[f64],
    (gap, contact_gap): (&[f64], f64),
    finest: Grid,
) -> ContactArea {
    let (pressures, gaps) = (mesh.surroundings(pressure), mesh.surroundings(gap));
    let of_level = |(coarser, places, values): (usize, &[[u32; 2]], Range<usize>)| {
        let (side, tiles) = (mesh.side(coarser), &mesh.levels()[coarser]);
        let of_tile = |(tile, &place): (usize, &[u32; 2])| {
            let start = values.start + tile * CELLS;
            if pressure[start..start + CELLS].iter().all(|&p| p <= 0.0) {
                return EdgeSums::default();
            }
            let pressure = pressures.elements.around(&pressures.values, coarser, place, 0.0);
            // Where no element is the gap is not known.
            let gap = gaps.elements.around(&gaps.values, coarser, place, f64::NAN);
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
        let chunks = places.par_chunks(TILES_AT_ONCE).enumerate();
        let chunks: Vec<EdgeSums> = chunks
            .map(|(chunk, places)| {
                let tiles = places.iter().enumerate();
                let sums = tiles.map(|(tile, place)| of_tile((chunk * TILES_AT_ONCE + tile, place)));
                sums.fold(EdgeSums::default(), |a, b| a + b)
            })
            .collect();
        let total = mesh.ranks().fold(EdgeSums::default().to_values(), |sum| {
            chunks.into_iter().fold(EdgeSums::from_values(sum), |a, b| a + b).to_values()
        });
        EdgeSums::from_values(total)
    };
    let sums: Vec<EdgeSums> = mesh.own_levels().map(of_level).collect();
    ContactArea::from_sums(&sums, finest, Love.edge_bias())
}
