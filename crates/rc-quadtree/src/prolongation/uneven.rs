//! Prolongation to a level without exactly twice as many cells along a side.

use rayon::prelude::*;

use super::near_contact::{MARGIN, PART_KEPT_OF_SINGLE_CELL, SIDE, is_near_contact, is_single, mark_missing};
use crate::patch::{Patch, gather};
use crate::tiles::{CELLS, TILE, TileSet};

/// Cells of the finer level along an axis, for a tile and its margin.
const WIDE: usize = TILE + 2 * MARGIN;

/// The tiles of a level of `sides` cells, below those at `places`, where the function is positive, or nearly.
///
/// The values are its positive part.
pub(super) fn prolong(
    tiles: &TileSet,
    places: &[[u32; 2]],
    function: &[f64],
    elsewhere: f64,
    sides: [usize; 2],
) -> Vec<([u32; 2], Box<[f64; CELLS]>)> {
    let near_contact = |&[column, row]: &[u32; 2]| {
        let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
        gather(function, tiles, (i64::from(column) - 1, i64::from(row) - 1), 0..SIDE, &mut patch);
        let below = || {
            tiles_under(column, sides[0], tiles.sides()[0])
                .flat_map(|x| tiles_under(row, sides[1], tiles.sides()[1]).map(move |y| [x, y]))
        };
        if is_near_contact(&patch) { below().collect() } else { Vec::new() }
    };
    let candidates: Vec<Vec<[u32; 2]>> = places.par_iter().map(near_contact).collect();
    // Sorts the tiles and removes duplicates.
    let fine = tiles.of_same_cell(sides, candidates.into_iter().flatten().collect());
    let of_tile = |&place: &[u32; 2]| {
        let along = [0, 1].map(|axis| Axis::new(place[axis], sides[axis], tiles.sides()[axis]));
        let corner = (along[0].tile, along[1].tile);
        let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
        gather(function, tiles, corner, 0..SIDE, &mut patch);
        mark_missing(tiles, corner, elsewhere, &mut patch);
        fine_tile(&patch, &along, fine.inside(place)).map(|values| (place, values))
    };
    fine.places().par_iter().filter_map(of_tile).collect()
}

/// Columns (or rows) of finer tiles that overlap a tile of the coarser level.
fn tiles_under(tile: u32, fine: usize, coarse: usize) -> impl Iterator<Item = u32> {
    let first = tile as usize * TILE * fine / coarse / TILE;
    let last = ((tile as usize + 1) * TILE * fine).div_ceil(coarse).min(fine);
    first as u32..last.div_ceil(TILE) as u32
}

/// The coarse neighbours of the fine centres along one axis.
struct Axis {
    /// The first tile of the patch.
    tile: i64,
    /// For each centre, the neighbour before it in the patch, and the distance of the centre beyond it.
    neighbours: [(usize, f64); WIDE],
}

impl Axis {
    fn new(tile: u32, fine: usize, coarse: usize) -> Self {
        let ratio = coarse as f64 / fine as f64;
        let place = |i: usize| ((TILE * tile as usize + i) as f64 - MARGIN as f64 + 0.5) * ratio - 0.5;
        // One more cell is included, to detect cells without neighbours in contact.
        let tile = (place(0).floor() as i64 - 1).div_euclid(TILE as i64);
        let neighbours = std::array::from_fn(|i| {
            let before = place(i).floor();
            ((before as i64 - tile * TILE as i64) as usize, place(i) - before)
        });
        Self { tile, neighbours }
    }
}

/// The positive part of the function on a fine tile, as for quarters.
///
/// Cells beyond `inside` are not on the level.
fn fine_tile(patch: &Patch<f64, SIDE>, along: &[Axis; 2], inside: [usize; 2]) -> Option<Box<[f64; CELLS]>> {
    let [along_x, along_y] = along;
    let nearest = |(before, beyond): (usize, f64)| if beyond < 0.5 { before } else { before + 1 };
    let (mut touched, mut values) = (false, [0.0; CELLS]);
    for (y, &(below, up)) in along_y.neighbours.iter().enumerate() {
        for (x, &(left, right)) in along_x.neighbours.iter().enumerate() {
            let blend = |x: usize| (1.0 - up) * patch[below][x] + up * patch[below + 1][x];
            let mut value = (1.0 - right) * blend(left) + right * blend(left + 1);
            let (near_x, near_y) = (nearest((left, right)), nearest((below, up)));
            if value <= 0.0 && patch[near_y][near_x] > 0.0 && is_single(patch, near_x, near_y) {
                value = PART_KEPT_OF_SINGLE_CELL * patch[near_y][near_x];
            }
            touched |= value > 0.0;
            if (MARGIN..MARGIN + inside[0]).contains(&x) && (MARGIN..MARGIN + inside[1]).contains(&y) {
                values[(y - MARGIN) * TILE + x - MARGIN] = value.max(0.0);
            }
        }
    }
    touched.then(|| Box::new(values))
}
