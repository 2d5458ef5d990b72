//! Where contact is possible: bounds that exclude it everywhere else.
//!
//! The displacement is a smooth part, interpolated from the base grid, plus short-range parts, which are not negative where no
//! pressure is. The smooth part minus the height, both bounded between the points of the base grid, is then a lower bound of the
//! gap. Fine cells are looked at only where this bound admits contact.

use rayon::prelude::*;
use rc_quadtree::{CELLS, Patch, TILE, TileSet, gather};

use super::heights::Heights;

/// Side of a patch that holds a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// Between points of a grid a function is above their minimum less an eighth of its second derivative along either axis, times the square
/// of the spacing.
const SAGITTA: f64 = 0.25;

/// The values on the base grid are the smooth displacement less 1/48 of its Laplacian, times the square of the finest elements' side, to leading
/// order: the filter to the finest level holds the square root of the mean over an element. Those elements are at most half as large as
/// the spacing.
const DECONVOLUTION: f64 = 1.0 / 96.0;

/// The smooth part of the displacement.
pub(super) struct SmoothDisplacement<'a> {
    /// Values at the centres of the base grid, tile by tile, tiles row by row, in λ.
    pub(super) values: &'a [f64],
    /// Bound of its second derivatives along the axes.
    pub(super) curvature: f64,
    /// Bound of the error of the values, in λ.
    pub(super) error: f64,
}

/// The tiles of the level of `per_side` tiles per side where the gap `v - h` may be less than `contact_gap`.
pub(super) fn possible_contact(
    smooth: &SmoothDisplacement<'_>,
    heights: &Heights<'_>,
    contact_gap: f64,
    per_side: usize,
) -> Vec<[u32; 2]> {
    let base = TileSet::full(heights.base().grid().nx() / TILE);
    let spacing = 1.0 / base.side() as f64;
    let slack = (SAGITTA + DECONVOLUTION) * smooth.curvature * spacing * spacing + smooth.error;
    let of_tile = |&[column, row]: &[u32; 2]| {
        let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
        let corner = (i64::from(column) - 1, i64::from(row) - 1);
        gather(smooth.values, &base, corner, TILE - 1..2 * TILE + 1, &mut patch);
        let mut tiles = Vec::new();
        for cell in 0..CELLS {
            let (x, y) = (cell % TILE, cell / TILE);
            let minimum = minimum_around(&patch, TILE + x, TILE + y) - slack;
            let (bx, by) = (column as usize * TILE + x, row as usize * TILE + y);
            let may_touch =
                |blocks: usize, ix: usize, iy: usize| minimum - heights.upper_bound(blocks, ix, iy) < contact_gap;
            if may_touch(base.side(), bx, by) {
                append_tiles_of_cell(base.side(), per_side, (bx, by), &may_touch, &mut tiles);
            }
        }
        tiles.sort_unstable();
        tiles.dedup();
        tiles
    };
    let tiles: Vec<Vec<[u32; 2]>> = base.places().par_iter().map(of_tile).collect();
    tiles.into_iter().flatten().collect()
}

/// Appends the tile that a cell of the base grid is in, or those tiles in the cell that pass `may_touch` themselves.
fn append_tiles_of_cell(
    base_side: usize,
    per_side: usize,
    (bx, by): (usize, usize),
    may_touch: &impl Fn(usize, usize, usize) -> bool,
    tiles: &mut Vec<[u32; 2]>,
) {
    if per_side <= base_side {
        let cells = base_side / per_side;
        tiles.push([(bx / cells) as u32, (by / cells) as u32]);
        return;
    }
    let parts = per_side / base_side;
    for y in by * parts..(by + 1) * parts {
        for x in bx * parts..(bx + 1) * parts {
            if may_touch(per_side, x, y) {
                tiles.push([x as u32, y as u32]);
            }
        }
    }
}

/// Minimum over a cell and its eight neighbours.
fn minimum_around(patch: &Patch<f64, SIDE>, x: usize, y: usize) -> f64 {
    patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]).copied().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use rc_core::{Field, Grid, HeightSource};

    use super::*;

    /// A displacement whose minimum, at the corner between four points of the base grid, touches a flat surface. At the points it does not.
    #[test]
    fn a_displacement_that_dips_between_points_is_not_excluded() {
        let (side, per_side) = (32_usize, 8);
        let flat = Field::zeros(Grid::square(64).expect("a grid"));
        let heights = Heights::new(HeightSource::Map(&flat), side).expect("heights");
        let sagitta = 2.0 * (1.0 - (PI / side as f64).cos());
        let error = 0.5 * sagitta;
        let wave = |i: usize| (TAU * (i as f64 + 0.5 - 0.5 * side as f64) / side as f64).cos();
        let base = TileSet::full(side / TILE);
        let of_tile = |&[column, row]: &[u32; 2]| {
            let at = move |place: u32, i: usize| wave(place as usize * TILE + i);
            (0..CELLS).map(move |cell| error - at(column, cell % TILE) - at(row, cell / TILE))
        };
        let values: Vec<f64> = base.places().iter().flat_map(of_tile).collect();
        let smooth = SmoothDisplacement { values: &values, curvature: TAU * TAU, error };
        let minimum = -2.0;
        let touched = possible_contact(&smooth, &heights, minimum + 0.01 * sagitta, per_side);
        for place in [[3, 3], [4, 3], [3, 4], [4, 4]] {
            assert!(touched.contains(&place), "{place:?} is not among {touched:?}");
        }
        assert!(!touched.contains(&[0, 0]), "{touched:?}");
        assert!(possible_contact(&smooth, &heights, minimum - 0.01 * sagitta - 2.0 * error, per_side).is_empty());
    }
}
