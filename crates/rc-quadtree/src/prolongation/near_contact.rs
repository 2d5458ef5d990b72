//! Tests of a patch of three by three tiles for contact near the middle.

use rc_core::Boundary;

use crate::patch::Patch;
use crate::tiles::{TILE, TileSet};

/// Width in cells of the margin around a tile that must be out of contact.
///
/// Only then is the tile omitted, because contacts may grow a little.
pub(super) const MARGIN: usize = 2;

/// Part of the function that remains on a contact of a single cell.
///
/// It is used when the interpolation would remove the contact.
pub(super) const PART_KEPT_OF_SINGLE_CELL: f64 = 0.25;

/// Side of a patch of a tile and its neighbours.
pub(super) const SIDE: usize = 3 * TILE;

/// Whether the function is positive on the middle tile or near it.
///
/// Near means within two cells.
pub(super) fn is_near_contact(patch: &Patch<f64, SIDE>) -> bool {
    let near = TILE - MARGIN..2 * TILE + MARGIN;
    patch[near.clone()].iter().flat_map(|row| &row[near.clone()]).any(|&f| f > 0.0)
}

/// Fills the parts of a patch without a tile.
///
/// Beyond a free border, the function has its value at the border.
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

/// Whether none of the neighbours of this cell is in contact.
pub(super) fn is_single(patch: &Patch<f64, SIDE>, x: usize, y: usize) -> bool {
    let around = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
    let positive = around.filter(|&&f| f > 0.0).count();
    positive == 1
}
