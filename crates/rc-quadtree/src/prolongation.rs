//! Prolongation of a function that is positive in contact, to elements half as large.
//!
//! The function is interpolated bilinearly between the centres of elements. It should be nearly linear across the edges
//! of contacts. The error of an edge is then a fraction of an element.

use std::ops::Range;

use rayon::prelude::*;

use crate::elements::Elements;
use crate::patch::{Patch, gather};
use crate::tiles::{CELLS, TILE, TileSet, quarters};

mod near_contact;
mod uneven;

use near_contact::{MARGIN, PART_KEPT_OF_SINGLE_CELL, SIDE, is_near_contact, is_single, mark_missing};

/// Interpolates the positive part of `function` to the next finer level, of `sides` cells.
///
/// Returns the tiles below those in the range `which` on which, or within two cells of which, `function` is positive.
/// Each has the values on its cells. The finer level has twice as many cells along both sides, or slightly fewer. In
/// the latter case, two ranges may both have a tile that is below both.
///
/// `function` has a value for each cell of `tiles`. None of these tiles may extend beyond the level. `elsewhere` is the
/// value of the function where there is no tile. Beyond a free border, the function has its value at the border.
///
/// # Panics
/// When there are fewer values than cells, or when `which` is outside `tiles`.
#[must_use]
pub fn prolong(
    tiles: &TileSet,
    which: Range<usize>,
    function: &[f64],
    elsewhere: f64,
    sides: [usize; 2],
) -> Vec<([u32; 2], Box<[f64; CELLS]>)> {
    let places = &tiles.places()[which];
    if sides != tiles.sides().map(|side| 2 * side) {
        return uneven::prolong(tiles, places, function, elsewhere, sides);
    }
    let of_tile = |&place: &[u32; 2]| {
        let children = quarters(place).into_iter().zip(quarters_in_contact(tiles, function, elsewhere, place));
        children.filter_map(|(place, values)| values.map(|values| (place, values))).collect()
    };
    places.par_iter().map(of_tile).collect::<Vec<Vec<_>>>().into_iter().flatten().collect()
}

/// Fills `values` on the smallest elements of `refined` with the positive part of `function`.
///
/// These elements are quarters of the smallest of `elements`. Other values do not change. `function` has a value for
/// each of `elements`, and `elsewhere` is its value where there is no element.
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

/// The positive part of `function` on the quarters of a tile.
///
/// `None` for quarters that are neither in contact nor near contact.
fn quarters_in_contact(
    tiles: &TileSet,
    function: &[f64],
    elsewhere: f64,
    [column, row]: [u32; 2],
) -> [Option<Box<[f64; CELLS]>>; 4] {
    let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
    let corner = (i64::from(column) - 1, i64::from(row) - 1);
    gather(function, tiles, corner, TILE - 3..2 * TILE + 3, &mut patch);
    if !is_near_contact(&patch) {
        return [const { None }; 4];
    }
    mark_missing(tiles, corner, elsewhere, &mut patch);
    std::array::from_fn(|child| fine_tile(&patch, (child % 2, child / 2)))
}

/// The positive part of the function on a fine tile.
///
/// The tile is a quarter of the middle of the patch. `None` when the function is not positive anywhere on the tile or
/// near it.
fn fine_tile(patch: &Patch<f64, SIDE>, (half_x, half_y): (usize, usize)) -> Option<Box<[f64; CELLS]>> {
    const WIDE: usize = TILE + 2 * MARGIN;
    // A coarse cell and its neighbour on the side of the fine cell. Fine cells are counted from the corner of the
    // margin.
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
                // Between free cells, no fine centre may lie inside the edge. The contact must not be lost.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The finer tiles below all tiles, and the values on them.
    fn prolonged(tiles: &TileSet, function: &[f64], sides: [usize; 2]) -> (TileSet, Vec<f64>) {
        let mut children = prolong(tiles, 0..tiles.len(), function, -1.0, sides);
        let fine = tiles.of_same_cell(sides, children.iter().map(|(place, _)| *place).collect());
        children.sort_by_key(|([column, row], _)| fine.find((*column).into(), (*row).into()));
        (fine, children.iter().flat_map(|(_, values)| **values).collect())
    }

    /// Distance from the edge of a disc in λ, positive inside and negative outside.
    fn disc(tiles: &TileSet, radius: f64) -> Vec<f64> {
        let side = tiles.sides()[0] as f64;
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
        let tiles = TileSet::full([64, 64]);
        let (fine, values) = prolonged(&tiles, &disc(&tiles, 0.2), [128, 128]);
        assert!(fine.len() < 4 * tiles.len() / 2, "only the disc and its surroundings have tiles");
        let exact = disc(&fine, 0.2);
        for (value, exact) in values.iter().zip(&exact) {
            // The tip of the cone is smoothed. Along edges, bilinear interpolation has an error of d²/(4r), and d =
            // 1/64.
            let allowed = if *exact > 0.15 { 0.02 } else { 1e-3 };
            assert!((value - exact.max(0.0)).abs() < allowed, "{value} for {exact}");
        }
    }

    #[test]
    fn the_edge_of_a_disc_stays_where_it_is_on_a_level_of_any_size() {
        let tiles = TileSet::full([64, 64]);
        for sides in [[125, 125], [120, 120], [113, 113]] {
            let (fine, values) = prolonged(&tiles, &disc(&tiles, 0.2), sides);
            assert!(fine.len() < TileSet::full(sides).len() / 2, "only the disc and its surroundings have tiles");
            for (value, exact) in values.iter().zip(&disc(&fine, 0.2)) {
                let allowed = if *exact > 0.15 { 0.02 } else { 1e-3 };
                assert!((value - exact.max(0.0)).abs() < allowed, "{sides:?}: {value} for {exact}");
            }
            // Without tiles around the disc, and across a seam.
            let corner = |at: f64| at.min(1.0 - at);
            let near_corner = |tiles: &TileSet| -> Vec<f64> {
                let centre = |i: u32, cell: usize, side: usize| ((i as usize * TILE + cell) as f64 + 0.5) / side as f64;
                let of_tile = |&[column, row]: &[u32; 2]| {
                    let [nx, ny] = tiles.sides();
                    (0..CELLS).map(move |cell| {
                        let (x, y) = (centre(column, cell % TILE, nx), centre(row, cell / TILE, ny));
                        if x < 1.0 && y < 1.0 { 0.2 - corner(x).hypot(corner(y)) } else { 0.0 }
                    })
                };
                tiles.places().iter().flat_map(of_tile).collect()
            };
            let function = near_corner(&tiles);
            let near = tiles.places().iter().zip(function.chunks(CELLS)).filter(|(_, f)| f.iter().any(|&f| f > -0.05));
            let some = TileSet::new([64, 64], near.map(|(&place, _)| place).collect());
            assert!(some.len() < 40);
            let (fine, values) = prolonged(&some, &near_corner(&some), sides);
            for (value, exact) in values.iter().zip(&near_corner(&fine)) {
                let allowed = if *exact > 0.15 { 0.02 } else { 1e-3 };
                assert!((value - exact.max(0.0)).abs() < allowed, "{sides:?}: {value} for {exact}");
            }
        }
    }

    #[test]
    fn a_single_cell_in_contact_is_kept() {
        let tiles = TileSet::full([32, 32]);
        let mut function = vec![-1.0; tiles.n_cells()];
        function[CELLS + 27] = 0.1;
        let (fine, values) = prolonged(&tiles, &function, [64, 64]);
        assert_eq!(values.iter().filter(|&&value| value > 0.0).count(), 4, "its four quarters");
        assert!(fine.len() < 5, "tiles near the cell");
    }

    #[test]
    fn on_elements_of_one_size_both_ways_agree() {
        let tiles = TileSet::full([64, 64]);
        let function = disc(&tiles, 0.3);
        let (fine, values) = prolonged(&tiles, &function, [128, 128]);
        let (elements, refined) = (Elements::uniform(tiles), Elements::uniform(fine));
        let mut onto = vec![f64::NAN; refined.len()];
        prolong_onto(&elements, &function, -1.0, &refined, &mut onto);
        assert_eq!(onto, values);
    }
}
