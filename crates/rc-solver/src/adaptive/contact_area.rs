//! The contact area on a mesh.

use rayon::prelude::*;
use rc_core::{Grid, Kernel};
use rc_kernel::Love;
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet};

use super::element_blocks::blocks_of;
use crate::ContactArea;
use crate::contact_area::{EdgeSums, PlasticEdges, left};

/// Tiles that are summed together; sums have this order for any number of threads.
const TILES_AT_ONCE: usize = 64;

/// Pressure and gap on elements.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    pub(super) elements: &'a Elements,
    pub(super) pressure: &'a [f64],
    pub(super) gap: &'a [f64],
    /// The gap of what is in contact.
    pub(super) contact_gap: f64,
    /// No pressure is greater.
    pub(super) hardness: f64,
}

impl Values<'_> {
    /// The contact area, where the smallest elements are those of `finest`.
    pub(super) fn contact_area(&self, finest: Grid) -> ContactArea {
        ContactArea::from_sums(&self.edge_sums(|at| at), finest, Love.edge_bias())
    }

    /// The plastic part of it; none without a hardness.
    pub(super) fn plastic_edges(&self, finest: Grid) -> Option<PlasticEdges> {
        let Self { elements, pressure, gap, contact_gap, hardness } = *self;
        if hardness.is_infinite() {
            return None;
        }
        let mut sums = self.edge_sums(|at| left(at, hardness));
        // Where no element is, nothing presses.
        let covered = |(coarser, tiles): (usize, &TileSet)| tiles.n_inside() << (2 * coarser);
        let covered: usize = elements.levels().iter().enumerate().map(covered).sum();
        sums[0].n_contact += finest.len() - covered;
        let blocks = pressure.par_chunks(BLOCK_CELLS).zip(gap.par_chunks(BLOCK_CELLS)).map(|(pressure, gap)| {
            let pairs = pressure.iter().zip(gap).filter(|(p, _)| **p >= hardness);
            [pairs.map(|(_, g)| (contact_gap - g).max(0.0)).sum()]
        });
        let [flow] = blocks_of(elements).total(blocks.collect());
        Some(PlasticEdges::from_sums(&sums, finest, Love.edge_bias(), flow / finest.len() as f64))
    }

    /// Sums over the elements of each size, of pressure and gap as `seen`.
    fn edge_sums(&self, seen: impl Fn([f64; 2]) -> [f64; 2] + Sync) -> Vec<EdgeSums> {
        (0..self.elements.levels().len()).map(|coarser| self.sums_of_level(coarser, &seen)).collect()
    }

    fn sums_of_level(&self, coarser: usize, seen: &(impl Fn([f64; 2]) -> [f64; 2] + Sync)) -> EdgeSums {
        let Self { elements, pressure, gap, contact_gap, hardness } = *self;
        let (side, first) = (elements.side(coarser), elements.cells(coarser).start);
        let tiles = &elements.levels()[coarser];
        let of_tile = |(tile, &place): (usize, &[u32; 2])| {
            let start = first + tile * CELLS;
            if pressure[start..start + CELLS].iter().all(|&p| seen([p, 0.0])[0] <= 0.0) {
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
                if seen([pressure[y][x], 0.0])[0] > 0.0 {
                    sums.add([side; 2], hardness, &|dx, dy| {
                        let (x, y) = (x.wrapping_add_signed(dx), y.wrapping_add_signed(dy));
                        seen([pressure[y][x], gap[y][x] - contact_gap])
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
    }
}
