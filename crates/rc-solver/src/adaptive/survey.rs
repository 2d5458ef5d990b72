//! Where contact is possible: bounds that prove it is not, everywhere else.
//!
//! The displacement is what comes down from the base grid, a smooth remainder, plus short-range parts, which are not
//! negative where no pressure is. So remainder less height, both bounded between the points of the base grid, is a lower
//! bound of the gap; fine cells are looked at only where it is not positive.

use rayon::prelude::*;

use super::heights::Heights;
use super::operator::{Patch, Real, gather};
use super::tiles::{CELLS, TILE, TileSet};

/// Side of a patch that holds a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// What is known of the displacement outside contact.
pub(super) struct Remainder<'a, T> {
    /// The smooth remainder at the centres of the base grid, tile by tile, tiles row by row.
    pub(super) values: &'a [T],
    /// What the values are multiples of, in λ.
    pub(super) unit: f64,
    /// Bound of its second derivatives along the axes.
    pub(super) curvature: f64,
    /// Bound of the error of the values.
    pub(super) error: f64,
}

/// The tiles of the level of `per_side` tiles per side where the gap `v - h` may be less than `contact_gap`.
pub(super) fn possible_contact<T: Real + Into<f64>>(
    remainder: &Remainder<'_, T>,
    heights: &Heights<'_>,
    contact_gap: f64,
    per_side: usize,
) -> Vec<[u32; 2]> {
    let base = TileSet::full(heights.base().grid().nx() / TILE);
    let spacing = 1.0 / base.side() as f64;
    // Between points of a grid a function is above their least value less the sagitta, along either axis.
    let slack = 0.25 * remainder.curvature * spacing * spacing + remainder.error;
    let blocks: Vec<Vec<[u32; 2]>> = base
        .places()
        .par_iter()
        .map(|&[column, row]| {
            let mut patch: Patch<T, SIDE> = [[T::default(); SIDE]; SIDE];
            let corner = (i64::from(column) - 1, i64::from(row) - 1);
            gather(remainder.values, &base, corner, TILE - 1..2 * TILE + 1, &mut patch);
            let mut found = Vec::new();
            for cell in 0..CELLS {
                let (x, y) = (cell % TILE, cell / TILE);
                let least = remainder.unit * least_around(&patch, TILE + x, TILE + y) - slack;
                let (bx, by) = (column as usize * TILE + x, row as usize * TILE + y);
                let reaches =
                    |blocks: usize, ix: usize, iy: usize| least - heights.upper_bound(blocks, ix, iy) < contact_gap;
                if reaches(base.side(), bx, by) {
                    tiles_of_cell(base.side(), per_side, (bx, by), &reaches, &mut found);
                }
            }
            found.sort_unstable();
            found.dedup();
            found
        })
        .collect();
    blocks.into_iter().flatten().collect()
}

/// The tiles that a cell of the base grid is in, or those in it that pass `reaches` themselves.
fn tiles_of_cell(
    base_side: usize,
    per_side: usize,
    (bx, by): (usize, usize),
    reaches: &impl Fn(usize, usize, usize) -> bool,
    found: &mut Vec<[u32; 2]>,
) {
    if per_side <= base_side {
        let cells = base_side / per_side;
        found.push([(bx / cells) as u32, (by / cells) as u32]);
        return;
    }
    let parts = per_side / base_side;
    for y in by * parts..(by + 1) * parts {
        for x in bx * parts..(bx + 1) * parts {
            if reaches(per_side, x, y) {
                found.push([x as u32, y as u32]);
            }
        }
    }
}

/// Least value at a cell and its eight neighbours.
fn least_around<T: Real + Into<f64>>(patch: &Patch<T, SIDE>, x: usize, y: usize) -> f64 {
    patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]).map(|&v| v.into()).fold(f64::INFINITY, f64::min)
}
