//! The places where contact is possible. Bounds exclude it everywhere else.
//!
//! The displacement has a smooth part, which is interpolated from the base grid, and short-range parts. The short-range
//! parts are not negative where there is no pressure. Between the points of the base grid, the smooth part has a lower
//! bound and the height an upper bound. The difference of the two bounds is a lower bound of the gap. Fine cells are
//! computed only where this bound admits contact.

use rayon::prelude::*;
use rc_comm::Ranks;
use rc_quadtree::{CELLS, Patch, TILE, TileSet, gather};

use crate::tiles::base::Base;
use crate::tiles::deal::Deal;
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::ladder::sides_of;

/// Side of a patch that holds a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// Factor of the bound of a function between points of a grid.
///
/// Between points, a function is above their minimum, minus an eighth of its second derivative along either axis times
/// the square of the spacing.
const SAGITTA: f64 = 0.25;

/// Factor of the correction of values on the base grid.
///
/// To leading order, these values are the smooth displacement, minus 1/48 of its Laplacian times the square of the
/// finest elements' side. The reason is that the filter to the finest level holds the square root of the mean over an
/// element. Where levels halve, the side of the finest elements is at most half of the spacing.
const DECONVOLUTION: f64 = 1.0 / 96.0;

/// The smooth part of the displacement.
pub(crate) struct SmoothDisplacement<'a> {
    /// Values at the centres of the base grid's period, in λ, tile by tile. Tiles are row by row.
    pub(crate) values: &'a [f64],
    /// Bound of the second derivatives of the values, along the axes.
    pub(crate) curvature: f64,
    /// Bound of the error of the values, in λ.
    pub(crate) error: f64,
}

/// The tiles where the gap `v - h` may be less than `contact_gap`.
///
/// They are tiles of a level with the columns and rows of `extent`.
pub(crate) fn possible_contact(
    smooth: &SmoothDisplacement<'_>,
    (heights, base): (&Heights<'_>, Base),
    contact_gap: f64,
    (extent, ranks): ([usize; 2], &Ranks),
) -> Vec<[u32; 2]> {
    let ladder = heights.ladder();
    let (period, base) = (TileSet::full(base.period()), TileSet::full(sides_of(base.grid())));
    let spacing = ladder.base().spacing().max_element();
    let from_half = (2.0 * ladder.finest().spacing().max_element() / spacing).max(1.0);
    let slack = (SAGITTA + DECONVOLUTION * from_half * from_half) * smooth.curvature * spacing * spacing + smooth.error;
    let cells = Cells { base: base.sides(), extent, finest: (!ladder.is_even()).then_some(sides_of(ladder.finest())) };
    let of_tile = |&[column, row]: &[u32; 2]| {
        let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
        let corner = (i64::from(column) - 1, i64::from(row) - 1);
        gather(smooth.values, &period, corner, TILE - 1..2 * TILE + 1, &mut patch);
        let mut tiles = Vec::new();
        for cell in 0..CELLS {
            let (x, y) = (cell % TILE, cell / TILE);
            let minimum = minimum_around(&patch, TILE + x, TILE + y) - slack;
            let at = [column as usize * TILE + x, row as usize * TILE + y];
            if minimum - heights.upper_bound(base.sides(), at) < contact_gap {
                let may_touch = |tile| minimum - cells.upper_bound(heights, tile) < contact_gap;
                cells.append_tiles(at, &may_touch, &mut tiles);
            }
        }
        tiles.sort_unstable();
        tiles.dedup();
        tiles
    };
    // Each rank checks some tiles of the base grid.
    let own = Deal::equal(base.len(), ranks).range(ranks.rank());
    let tiles: Vec<Vec<[u32; 2]>> = base.places()[own].par_iter().map(of_tile).collect();
    ranks.concatenate(tiles.into_iter().flatten().collect())
}

/// The cells of the base grid over tiles of a level.
struct Cells {
    base: [usize; 2],
    /// Numbers of columns and rows of tiles.
    extent: [usize; 2],
    /// Sides of the level, if tiles are not whole parts of cells, nor cells whole parts of tiles.
    finest: Option<[usize; 2]>,
}

impl Cells {
    /// Upper bound of the heights in a tile.
    fn upper_bound(&self, heights: &Heights<'_>, tile: [usize; 2]) -> f64 {
        match self.finest {
            None => heights.upper_bound(self.extent, tile),
            Some(_) => heights.upper_bound_of_tile(tile),
        }
    }

    /// Appends the tiles at a cell of the base grid.
    ///
    /// This is the tile that contains the cell. If tiles are smaller, it is those in the cell that pass `may_touch`
    /// themselves.
    fn append_tiles(&self, at: [usize; 2], may_touch: &impl Fn([usize; 2]) -> bool, tiles: &mut Vec<[u32; 2]>) {
        let Self { base, extent, finest } = *self;
        if finest.is_none() && extent[0] <= base[0] {
            tiles.push([0, 1].map(|axis| (at[axis] / (base[axis] / extent[axis])) as u32));
            return;
        }
        let [columns, rows] = [0, 1].map(|axis| match finest {
            None => {
                let parts = extent[axis] / base[axis];
                at[axis] * parts..(at[axis] + 1) * parts
            }
            // Tiles that have a part in the cell.
            Some(sides) => {
                let last = ((at[axis] + 1) * sides[axis]).div_ceil(base[axis]).div_ceil(TILE);
                at[axis] * sides[axis] / base[axis] / TILE..last
            }
        });
        for y in rows {
            for x in columns.clone() {
                if may_touch([x, y]) {
                    tiles.push([x as u32, y as u32]);
                }
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

    /// A displacement that touches a flat surface only between four points of the base grid.
    ///
    /// Its minimum is at the corner between them.
    #[test]
    fn a_displacement_that_dips_between_points_is_not_excluded() {
        let (side, extent) = (32_usize, [8, 8]);
        let flat = Field::zeros(Grid::square(64).expect("a grid"));
        let heights = Heights::new(HeightSource::Map(&flat), [side, side]).expect("heights");
        let sagitta = 2.0 * (1.0 - (PI / side as f64).cos());
        let error = 0.5 * sagitta;
        let wave = |i: usize| (TAU * (i as f64 + 0.5 - 0.5 * side as f64) / side as f64).cos();
        let base = TileSet::full([side, side]);
        let of_tile = |&[column, row]: &[u32; 2]| {
            let at = move |place: u32, i: usize| wave(place as usize * TILE + i);
            (0..CELLS).map(move |cell| error - at(column, cell % TILE) - at(row, cell / TILE))
        };
        let values: Vec<f64> = base.places().iter().flat_map(of_tile).collect();
        let smooth = SmoothDisplacement { values: &values, curvature: TAU * TAU, error };
        let minimum = -2.0;
        let scene = || (&heights, Base::from(heights.ladder().base()));
        let touched = possible_contact(&smooth, scene(), minimum + 0.01 * sagitta, (extent, &Ranks::alone()));
        for place in [[3, 3], [4, 3], [3, 4], [4, 4]] {
            assert!(touched.contains(&place), "{place:?} is not among {touched:?}");
        }
        assert!(!touched.contains(&[0, 0]), "{touched:?}");
        let below = minimum - 0.01 * sagitta - 2.0 * error;
        assert!(possible_contact(&smooth, scene(), below, (extent, &Ranks::alone())).is_empty());
    }
}
