//! Where smaller elements are needed (Sec. 2, Fig. 3): at the edges of contacts, and where a larger element may hide a
//! contact.

use rayon::prelude::*;

use super::elements::Elements;
use super::operator::Patch;
use super::tiles::TILE;

/// Cells around a tile that are looked at, and that edges keep away from larger elements.
const RING: usize = 2;

const SIDE: usize = 3 * TILE;

/// Pressure and gap on a mesh, and what bounds the gap between centres.
pub(super) struct State<'a> {
    pub(super) elements: &'a Elements,
    pub(super) pressure: &'a [f64],
    pub(super) gap: &'a [f64],
    /// The gap of elements in contact.
    pub(super) contact_gap: f64,
    /// Bound of the second derivatives of the heights along the axes.
    pub(super) height_curvature: f64,
}

impl State<'_> {
    /// For each tile of each level: must its elements be divided?
    pub(super) fn too_coarse(&self) -> Vec<Vec<bool>> {
        let greatest = self.pressure.par_iter().copied().reduce(|| 0.0, f64::max);
        let levels = self.elements.levels().iter().enumerate();
        levels
            .map(|(coarser, tiles)| {
                let side = self.elements.side(coarser);
                // No pressure is nearer than the ring: ∫ p |∂²(1/πr)/∂x²| dA ≤ max p ∫ 2/(π r³) dA.
                let curvature = self.height_curvature + 4.0 * greatest / ((RING - 1) as f64 * side);
                let bend = curvature * side * side;
                tiles
                    .places()
                    .par_iter()
                    .with_min_len(16)
                    .map(|&place| self.is_too_coarse(coarser, place, bend))
                    .collect()
            })
            .collect()
    }

    /// `bend` bounds second differences of the gap.
    fn is_too_coarse(&self, coarser: usize, place: [u32; 2], bend: f64) -> bool {
        let pressure = self.elements.around(self.pressure, coarser, place, 0.0);
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
        extrapolate(&mut gap, bend);
        let inside = TILE..2 * TILE;
        inside.clone().any(|y| inside.clone().any(|x| least_within(&gap, x, y, bend) <= self.contact_gap))
    }
}

/// Fills what is missing beside the tile in the middle with lower bounds: second differences are at most `bend`.
fn extrapolate(patch: &mut Patch<f64, SIDE>, bend: f64) {
    let (first, last) = (TILE, 2 * TILE - 1);
    let beyond = |near: f64, next: f64| 2.0 * near - next - bend;
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

/// A lower bound of the gap in the cell at (`x`, `y`) and of its mean: along an axis a function is above its chord less an
/// eighth of `bend`, and a chord from a centre reaches the cell's edge half-way to the next centre. The mean over a cell, which
/// values are, differs from the value at its centre by a twelfth of it at most.
fn least_within(gap: &Patch<f64, SIDE>, x: usize, y: usize, bend: f64) -> f64 {
    let half_way = |here: f64, there: f64| here.min(0.5 * (here + there));
    let row = |y: usize| half_way(gap[y][x], gap[y][x - 1]).min(half_way(gap[y][x], gap[y][x + 1]));
    let (below, here, above) = (row(y - 1), row(y), row(y + 1));
    half_way(here, below).min(half_way(here, above)) - (0.25 + 1.0 / 12.0) * bend
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::adaptive::tiles::{CELLS, TileSet};

    /// A parabola that dips below zero between centres only is found, one that stays above is not.
    #[test]
    fn a_dip_between_centres_is_found() {
        let elements = Elements::uniform(TileSet::new(4, vec![[1, 1]]));
        let side = elements.side(0);
        let curvature = 8.0 / (side * side);
        for (least, found) in [(-1.0, true), (20.0, false)] {
            let gap: Vec<f64> = (0..CELLS)
                .map(|cell| {
                    // From the corner between the four cells in the middle of the tile.
                    let distance = |i: usize| (i as f64 - 3.5) * side;
                    least + 0.5 * curvature * (distance(cell % TILE).powi(2) + distance(cell / TILE).powi(2))
                })
                .collect();
            assert!(gap.iter().all(|&g| g > 0.5), "no centre touches");
            let state = State {
                elements: &elements,
                pressure: &vec![0.0; CELLS],
                gap: &gap,
                contact_gap: 0.0,
                height_curvature: curvature,
            };
            assert_eq!(state.too_coarse(), [[found]], "least gap {least}");
        }
    }

    #[test]
    fn edges_are_refined_and_interiors_are_not() {
        let elements = Elements::uniform(TileSet::full(8));
        let mut pressure = vec![0.0; elements.len()];
        for (tile, &[column, _]) in elements.levels()[0].places().iter().enumerate() {
            pressure[tile * CELLS..(tile + 1) * CELLS].fill(if column < 4 { 1.0 } else { 0.0 });
        }
        let gap: Vec<f64> = pressure.iter().map(|&p| if p > 0.0 { 0.0 } else { 1.0 }).collect();
        let state =
            State { elements: &elements, pressure: &pressure, gap: &gap, contact_gap: 0.0, height_curvature: 0.0 };
        let chosen = state.too_coarse();
        for (&[column, _], &chosen) in elements.levels()[0].places().iter().zip(&chosen[0]) {
            assert_eq!(chosen, [0, 3, 4, 7].contains(&column), "column {column}");
        }
    }
}
