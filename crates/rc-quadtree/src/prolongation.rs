//! Prolongation: a function that is positive in contact, interpolated from the elements of one mesh to elements half as large.
//!
//! Interpolation is bilinear between centres. The function should be nearly linear across the edges of contacts; the edges are then
//! kept to a fraction of an element.

use rayon::prelude::*;

use crate::elements::Elements;
use crate::patch::{Patch, gather};
use crate::tiles::{CELLS, TILE, TileSet, quarters};

/// Cells around a tile that must be out of contact for it to be left out: contacts may grow a little.
const MARGIN: usize = 2;

/// Side of the patches that hold a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// Part of the function that a contact of a single cell keeps when the interpolation leaves nothing of it.
const PART_KEPT_OF_SINGLE_CELL: f64 = 0.25;

/// The tiles of the next finer level where `function` is positive, or within two cells of them, and its positive part on their cells.
///
/// `function` has a value for each cell of `tiles`; `elsewhere` is its value where there is no tile.
///
/// # Panics
/// When there are fewer values than cells.
#[must_use]
pub fn prolong(tiles: &TileSet, function: &[f64], elsewhere: f64) -> (TileSet, Vec<f64>) {
    let children: Vec<[Option<Box<[f64; CELLS]>>; 4]> =
        tiles.places().par_iter().map(|&place| quarters_in_contact(tiles, function, elsewhere, place)).collect();
    let place = |tile: usize, child: usize| quarters(tiles.places()[tile])[child];
    let chosen = children.iter().enumerate().flat_map(|(tile, children)| {
        children.iter().enumerate().filter_map(move |(child, values)| values.as_ref().map(|v| (tile, child, v)))
    });
    let fine = TileSet::new(2 * tiles.per_side(), chosen.clone().map(|(tile, child, _)| place(tile, child)).collect());
    let mut result = vec![0.0; fine.n_cells()];
    for (tile, child, values) in chosen {
        let [column, row] = place(tile, child).map(i64::from);
        let at = fine.find(column, row).expect("it was just put there");
        result[at * CELLS..][..CELLS].copy_from_slice(values.as_slice());
    }
    (fine, result)
}

/// Fills `values` on the smallest elements of `refined`, which are quarters of the smallest of `elements`, with the positive part of
/// `function`. Other values stay.
///
/// `function` has a value for each of `elements`; `elsewhere` is its value where there is no element.
///
/// # Panics
/// When a vector is shorter than [`Elements::len`] of its mesh.
pub fn prolong_onto(elements: &Elements, function: &[f64], elsewhere: f64, refined: &Elements, values: &mut [f64]) {
    let sinks = values[refined.cells(0)].par_chunks_mut(CELLS).zip(refined.finest().places());
    sinks.for_each(|(cells, &[column, row])| {
        let patch = elements.around(function, 0, [column / 2, row / 2], elsewhere);
        match fine_tile(&patch, (column as usize % 2, row as usize % 2)) {
            Some(fine) => cells.copy_from_slice(fine.as_slice()),
            None => cells.fill(0.0),
        }
    });
}

/// The positive part of `function` on the quarters of a tile; none for those that no contact is in or near.
fn quarters_in_contact(
    tiles: &TileSet,
    function: &[f64],
    elsewhere: f64,
    [column, row]: [u32; 2],
) -> [Option<Box<[f64; CELLS]>>; 4] {
    let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
    let corner = (i64::from(column) - 1, i64::from(row) - 1);
    gather(function, tiles, corner, TILE - 3..2 * TILE + 3, &mut patch);
    if !patch[TILE - 2..2 * TILE + 2].iter().flat_map(|row| &row[TILE - 2..2 * TILE + 2]).any(|&f| f > 0.0) {
        return [const { None }; 4];
    }
    mark_missing(tiles, corner, elsewhere, &mut patch);
    std::array::from_fn(|child| fine_tile(&patch, (child % 2, child / 2)))
}

fn mark_missing(tiles: &TileSet, (column, row): (i64, i64), elsewhere: f64, patch: &mut Patch<f64, SIDE>) {
    for y in 0..3 {
        for x in 0..3 {
            if tiles.find(column + x as i64, row + y as i64).is_none() {
                for line in &mut patch[y * TILE..][..TILE] {
                    line[x * TILE..][..TILE].fill(elsewhere);
                }
            }
        }
    }
}

/// The positive part of the function on the fine tile in a quarter of the middle of the patch; none when it is not positive anywhere
/// on the tile or near it.
fn fine_tile(patch: &Patch<f64, SIDE>, (half_x, half_y): (usize, usize)) -> Option<Box<[f64; CELLS]>> {
    const WIDE: usize = TILE + 2 * MARGIN;
    // Coarse cell and its neighbour on the side of the fine cell; fine cells are counted from the margin's corner.
    let near = |i: usize, half: usize| {
        let fine = TILE * 2 + half * TILE + i - MARGIN;
        let coarse = fine / 2;
        (coarse, if fine.is_multiple_of(2) { coarse - 1 } else { coarse + 1 })
    };
    let mut touched = false;
    let mut values = [0.0; CELLS];
    for y in 0..WIDE {
        let (near_y, far_y) = near(y, half_y);
        for x in 0..WIDE {
            let (near_x, far_x) = near(x, half_x);
            let blend = |x: usize| 0.75 * patch[near_y][x] + 0.25 * patch[far_y][x];
            let mut value = 0.75 * blend(near_x) + 0.25 * blend(far_x);
            if value <= 0.0 && patch[near_y][near_x] > 0.0 && is_single(patch, near_x, near_y) {
                // Between free cells no fine centre may be left inside the edge; the contact must not get lost.
                value = PART_KEPT_OF_SINGLE_CELL * patch[near_y][near_x];
            }
            touched |= value > 0.0;
            let inside = |i: usize| (MARGIN..MARGIN + TILE).contains(&i);
            if inside(x) && inside(y) {
                values[(y - MARGIN) * TILE + x - MARGIN] = value.max(0.0);
            }
        }
    }
    touched.then(|| Box::new(values))
}

/// Is none of the neighbours of this cell in contact?
fn is_single(patch: &Patch<f64, SIDE>, x: usize, y: usize) -> bool {
    let around = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
    let positive = around.filter(|&&f| f > 0.0).count();
    positive == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance inside a disc in λ, negative outside.
    fn disc(tiles: &TileSet, radius: f64) -> Vec<f64> {
        let side = tiles.side() as f64;
        let centre = |i: u32, cell: usize| (i as usize * TILE + cell) as f64 + 0.5;
        let of_tile = |&[column, row]: &[u32; 2]| {
            let distance = move |cell: usize| {
                let (x, y) = (centre(column, cell % TILE) / side, centre(row, cell / TILE) / side);
                radius - (x - 0.5).hypot(y - 0.5)
            };
            (0..CELLS).map(distance)
        };
        tiles.places().iter().flat_map(of_tile).collect()
    }

    #[test]
    fn the_edge_of_a_disc_stays_where_it_is() {
        let tiles = TileSet::full(8);
        let (fine, values) = prolong(&tiles, &disc(&tiles, 0.2), -1.0);
        assert!(fine.len() < 4 * tiles.len() / 2, "only the disc and its surroundings have tiles");
        let exact = disc(&fine, 0.2);
        for (value, exact) in values.iter().zip(&exact) {
            // The cone's tip is smoothed; along edges bilinear interpolation errs by d²/(4r), and d = 1/64.
            let allowed = if *exact > 0.15 { 0.02 } else { 1e-3 };
            assert!((value - exact.max(0.0)).abs() < allowed, "{value} for {exact}");
        }
    }

    #[test]
    fn a_single_cell_in_contact_is_kept() {
        let tiles = TileSet::full(4);
        let mut function = vec![-1.0; tiles.n_cells()];
        function[CELLS + 27] = 0.1;
        let (fine, values) = prolong(&tiles, &function, -1.0);
        assert_eq!(values.iter().filter(|&&value| value > 0.0).count(), 4, "its four quarters");
        assert!(fine.len() < 5, "tiles near the cell");
    }

    #[test]
    fn on_elements_of_one_size_both_ways_agree() {
        let tiles = TileSet::full(8);
        let function = disc(&tiles, 0.3);
        let (fine, values) = prolong(&tiles, &function, -1.0);
        let (elements, refined) = (Elements::uniform(tiles), Elements::uniform(fine));
        let mut onto = vec![f64::NAN; refined.len()];
        prolong_onto(&elements, &function, -1.0, &refined, &mut onto);
        assert_eq!(onto, values);
    }
}
