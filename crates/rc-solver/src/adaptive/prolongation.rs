//! From the pressure on the elements of one level to the start, and the elements it needs, on the next finer one.
//!
//! The edge function φ of [`crate::uniform`]'s prolongation is interpolated: p² inside, and -c² times the distance to the edge
//! outside, which is linear across the edge of a contact.

use rayon::prelude::*;
use rc_core::Grid;
use rc_quadtree::{CELLS, Elements, TILE, TileSet, prolong, prolong_onto};

use super::ladder::sides_of;
use crate::uniform::edge_function_outside;

/// Elements, and the pressure that an iteration on them starts from; the pressure is zero everywhere else.
pub(super) struct MeshStart {
    pub(super) elements: Elements,
    pub(super) pressure: Vec<f64>,
}

/// φ on the elements, from pressure and gap there.
pub(super) fn edge_function(elements: &Elements, pressure: &[f64], gap: &[f64], contact_gap: f64) -> Vec<f64> {
    let mut function = vec![0.0; pressure.len()];
    for (coarser, tiles) in elements.levels().iter().enumerate() {
        let (cells, spacing) = (elements.cells(coarser), elements.side(coarser));
        let gaps = gap[cells.clone()].par_chunks(CELLS);
        let sinks = function[cells].par_chunks_mut(CELLS).zip(gaps).zip(tiles.places());
        sinks.for_each(|((values, gaps), &place)| {
            let patch = elements.around(pressure, coarser, place, 0.0);
            for (cell, (value, gap)) in values.iter_mut().zip(gaps).enumerate() {
                let (x, y) = (TILE + cell % TILE, TILE + cell / TILE);
                let here = patch[y][x];
                *value = if here > 0.0 {
                    here * here
                } else {
                    let near = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
                    edge_function_outside(near, (gap - contact_gap).max(0.0), spacing)
                };
            }
        });
    }
    function
}

/// The start on the elements of the next finer `grid`, where there is contact or nearly, from φ on tiles of one size.
pub(super) fn refine_all(tiles: &TileSet, function: &[f64], grid: Grid) -> MeshStart {
    let (fine, mut pressure) = prolong(tiles, function, far_from_contact(function), sides_of(grid));
    to_pressure(&mut pressure);
    MeshStart { elements: Elements::uniform(fine), pressure }
}

/// The start on `refined`, whose smallest elements are quarters of those of `elements`. Elements that stay keep their `pressure`;
/// that of new ones comes from φ.
pub(super) fn refine_some(elements: &Elements, pressure: &[f64], function: &[f64], refined: Elements) -> MeshStart {
    let mut start = elements.moved(&refined, pressure, 0.0);
    prolong_onto(elements, function, far_from_contact(function), &refined, &mut start);
    to_pressure(&mut start[refined.cells(0)]);
    MeshStart { elements: refined, pressure: start }
}

/// φ where no element is: there is no contact for a long way.
fn far_from_contact(function: &[f64]) -> f64 {
    let contact: Vec<f64> = function.iter().copied().filter(|&value| value > 0.0).collect();
    -contact.iter().sum::<f64>() / contact.len().max(1) as f64
}

/// Inside contact φ is the square of the pressure.
fn to_pressure(positive_part: &mut [f64]) {
    positive_part.par_iter_mut().for_each(|value| *value = value.sqrt());
}
