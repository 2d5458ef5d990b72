//! The rule that says where smaller elements are needed (Sec. 2, Fig. 3).
//!
//! They are needed at the edges of contacts, and where a larger element may hide a contact.

use rayon::prelude::*;

use crate::elements::Elements;
use crate::patch::Patch;
use crate::tiles::TILE;

/// Number of cells around a tile that the rule examines.
///
/// Edges keep this distance from larger elements.
pub const RING: usize = 2;

/// Side of a patch of a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// Pressure and gap on a mesh, with one value for each element.
#[derive(Clone, Copy, Debug)]
pub struct ContactFields<'a> {
    /// The mesh.
    pub elements: &'a Elements,
    /// Pressure in any unit, positive in contact.
    pub pressure: &'a [f64],
    /// The pressure where there is no element.
    pub beyond: f64,
    /// Gap, in λ.
    pub gap: &'a [f64],
    /// The gap of elements in contact.
    pub contact_gap: f64,
}

impl ContactFields<'_> {
    /// Flags for the tiles whose elements must be divided, for each level, finest first.
    ///
    /// The elements of a tile must be divided if an edge of a contact is within [`RING`] cells. They must also be
    /// divided if the gap between centres of elements may be as small as the gap of contact.
    ///
    /// `curvature` returns a bound of the second derivatives of the gap along the axes, in 1/λ, for the elements of
    /// each level. It applies to tiles that have no pressure on them or within [`RING`] cells of them.
    #[must_use]
    pub fn too_coarse(&self, curvature: impl Fn(usize) -> f64) -> Vec<Vec<bool>> {
        let levels = self.elements.levels().iter().enumerate();
        levels
            .map(|(coarser, tiles)| {
                let side = self.elements.side(coarser);
                let second_difference = curvature(coarser) * side * side;
                let places = tiles.places().par_iter().with_min_len(16);
                places.map(|&place| self.is_too_coarse(coarser, place, second_difference)).collect()
            })
            .collect()
    }

    /// Whether the elements of one tile must be divided. `bound` limits second differences of the gap.
    fn is_too_coarse(&self, coarser: usize, place: [u32; 2], bound: f64) -> bool {
        let pressure = self.elements.around(self.pressure, coarser, place, self.beyond);
        let near = TILE - RING..2 * TILE + RING;
        let (mut pressed, mut free) = (false, false);
        for &p in pressure[near.clone()].iter().flat_map(|row| &row[near.clone()]) {
            pressed |= p > 0.0;
            free |= p <= 0.0;
        }
        if pressed || !free {
            return pressed && free;
        }
        let mut gap = self.elements.around(self.gap, coarser, place, f64::NAN);
        extrapolate(&mut gap, bound);
        let inside = TILE..2 * TILE;
        inside.clone().any(|y| inside.clone().any(|x| minimum_within(&gap, x, y, bound) <= self.contact_gap))
    }
}

/// Fills missing values beside the middle tile with lower bounds.
///
/// Second differences are at most `bound`.
fn extrapolate(patch: &mut Patch<f64, SIDE>, bound: f64) {
    let (first, last) = (TILE, 2 * TILE - 1);
    let beyond = |near: f64, next: f64| 2.0 * near - next - bound;
    for row in &mut patch[first..=last] {
        for (out, near, next) in [(first - 1, first, first + 1), (last + 1, last, last - 1)] {
            if row[out].is_nan() {
                row[out] = beyond(row[near], row[next]);
            }
        }
    }
    for (out, near, next) in [(first - 1, first, first + 1), (last + 1, last, last - 1)] {
        let [inner, further] = [patch[near], patch[next]];
        let row = patch[out].iter_mut().zip(inner.iter().zip(further)).skip(first - 1).take(TILE + 2);
        for (value, (&near, next)) in row {
            if value.is_nan() {
                *value = beyond(near, next);
            }
        }
    }
}

/// A lower bound of the gap and of its mean in one cell.
///
/// The cell is at (`x`, `y`). Along an axis a function is above its chord minus an eighth of `bound`. A chord from a
/// centre reaches the edge of the cell half-way to the next centre. Values are means over cells. They differ from the
/// value at the centre by at most a twelfth of `bound`.
fn minimum_within(gap: &Patch<f64, SIDE>, x: usize, y: usize, bound: f64) -> f64 {
    let half_way = |here: f64, there: f64| here.min(0.5 * (here + there));
    let row = |y: usize| half_way(gap[y][x], gap[y][x - 1]).min(half_way(gap[y][x], gap[y][x + 1]));
    let (below, here, above) = (row(y - 1), row(y), row(y + 1));
    half_way(here, below).min(half_way(here, above)) - (0.25 + 1.0 / 12.0) * bound
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tiles::{CELLS, TileSet};

    /// A parabola that is negative only between centres is found. One that stays positive is not.
    #[test]
    fn a_dip_between_centres_is_found() {
        let elements = Elements::uniform(TileSet::new([32, 32], vec![[1, 1]]));
        let side = elements.side(0);
        let curvature = 8.0 / (side * side);
        for (minimum, found) in [(-1.0, true), (20.0, false)] {
            let gap: Vec<f64> = (0..CELLS)
                .map(|cell| {
                    // Distance from the corner between the four cells in the middle of the tile.
                    let distance = |i: usize| (i as f64 - 3.5) * side;
                    minimum + 0.5 * curvature * (distance(cell % TILE).powi(2) + distance(cell / TILE).powi(2))
                })
                .collect();
            assert!(gap.iter().all(|&g| g > 0.5), "no centre touches");
            let pressure = vec![0.0; CELLS];
            let fields =
                ContactFields { elements: &elements, pressure: &pressure, beyond: 0.0, gap: &gap, contact_gap: 0.0 };
            assert_eq!(fields.too_coarse(|_| curvature), [[found]], "minimum gap {minimum}");
        }
    }

    #[test]
    fn edges_are_refined_and_interiors_are_not() {
        let elements = Elements::uniform(TileSet::full([64, 64]));
        let mut pressure = vec![0.0; elements.len()];
        for (tile, &[column, _]) in elements.levels()[0].places().iter().enumerate() {
            pressure[tile * CELLS..(tile + 1) * CELLS].fill(if column < 4 { 1.0 } else { 0.0 });
        }
        let gap: Vec<f64> = pressure.iter().map(|&p| if p > 0.0 { 0.0 } else { 1.0 }).collect();
        let fields =
            ContactFields { elements: &elements, pressure: &pressure, beyond: 0.0, gap: &gap, contact_gap: 0.0 };
        // Flat heights, and the displacement beside a pressure of 1 (E* = 1).
        let chosen = fields.too_coarse(|coarser| 4.0 / ((RING - 1) as f64 * elements.side(coarser)));
        for (&[column, _], &chosen) in elements.levels()[0].places().iter().zip(&chosen[0]) {
            assert_eq!(chosen, [0, 3, 4, 7].contains(&column), "column {column}");
        }
    }

    /// Tiles beside an edge are divided too, if the edge is within [`RING`] cells.
    #[test]
    fn edges_keep_two_cells_from_larger_elements() {
        let elements = Elements::uniform(TileSet::full([64, 64]));
        // Number of cells under pressure in the tiles of column 4. All cells of columns 0 to 3 are under pressure. The
        // other edge is on the seam.
        for (n_pressed, third_column) in [(0, true), (1, true), (2, false), (3, false)] {
            let column_of = |cell: usize, column: u32| column as usize * TILE + cell % TILE;
            let places = elements.levels()[0].places().iter();
            let columns = places.flat_map(|&[column, _]| (0..CELLS).map(move |cell| column_of(cell, column)));
            let pressure: Vec<f64> = columns.map(|x| if x < 4 * TILE + n_pressed { 1.0 } else { 0.0 }).collect();
            let gap: Vec<f64> = pressure.iter().map(|&p| if p > 0.0 { 0.0 } else { 1.0 }).collect();
            let fields =
                ContactFields { elements: &elements, pressure: &pressure, beyond: 0.0, gap: &gap, contact_gap: 0.0 };
            let chosen = fields.too_coarse(|_| 0.0);
            for (&[column, _], &chosen) in elements.levels()[0].places().iter().zip(&chosen[0]) {
                if column == 3 {
                    assert_eq!(chosen, third_column, "{n_pressed} cells from the edge");
                }
            }
        }
    }
}
