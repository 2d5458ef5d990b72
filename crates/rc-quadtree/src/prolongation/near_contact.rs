//! Which tiles are near contact, as patches of the function on three by three coarser tiles show.

use rc_core::Boundary;

use crate::patch::Patch;
use crate::tiles::{TILE, TileSet};

/// Cells around a tile that must be out of contact for it to be left out: contacts may grow a little.
pub(super) const MARGIN: usize = 2;

/// Part of the function that a contact of a single cell keeps when the interpolation leaves nothing of it.
pub(super) const PART_KEPT_OF_SINGLE_CELL: f64 = 0.25;

/// Side of the patches that hold a tile and its neighbours.
pub(super) const SIDE: usize = 3 * TILE;

/// Is the function positive anywhere on the tile in the middle of the patch, or within two cells of it?
pub(super) fn is_near_contact(patch: &Patch<f64, SIDE>) -> bool {
    let near = TILE - MARGIN..2 * TILE + MARGIN;
    patch[near.clone()].iter().flat_map(|row| &row[near.clone()]).any(|&f| f > 0.0)
}

/// Fills what of a patch has no tile. Beyond a free border the function goes on as it is there.
pub(super) fn mark_missing(tiles: &TileSet, (column, row): (i64, i64), elsewhere: f64, patch: &mut Patch<f64, SIDE>) {
    for y in 0..3 {
        for x in 0..3 {
            if tiles.find(column + x as i64, row + y as i64).is_none() {
                for line in &mut patch[y * TILE..][..TILE] {
                    line[x * TILE..][..TILE].fill(elsewhere);
                }
            }
        }
    }
    if tiles.boundary() == Boundary::Free {
        let inside = [(column, 0), (row, 1)].map(|(first, axis)| {
            // Of a patch beside the level nothing is looked at.
            let place = move |i: usize| (first * TILE as i64 + i as i64).clamp(0, tiles.sides()[axis] as i64 - 1);
            move |i: usize| (place(i) - first * TILE as i64).clamp(0, SIDE as i64 - 1) as usize
        });
        let [along_x, along_y] = inside;
        let values = *patch;
        for (y, row) in patch.iter_mut().enumerate() {
            for (x, value) in row.iter_mut().enumerate() {
                *value = values[along_y(y)][along_x(x)];
            }
        }
    }
}

/// Is none of the neighbours of this cell in contact?
pub(super) fn is_single(patch: &Patch<f64, SIDE>, x: usize, y: usize) -> bool {
    let around = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
    let positive = around.filter(|&&f| f > 0.0).count();
    positive == 1
}
