//! From the pressure on one level to the start on the next finer one.
//!
//! The elements of the finer level are found too. The edge function φ of [`crate::levels::uniform`]'s prolongation is
//! interpolated. It is p² inside, and -c² times the distance to the edge outside, so it is linear across the edge of a
//! contact.

use std::ops::Range;

use rayon::prelude::*;
use rc_comm::Ranks;
use rc_core::Grid;
use rc_quadtree::{CELLS, Elements, TILE, TileSet, prolong, prolong_onto};

use crate::grid::prolongation::edge_function_outside;
use crate::tiles::deal::Deal;
use crate::tiles::ladder::sides_of;
use crate::tiles::mesh::Mesh;

/// Elements, and the pressure on them from which an iteration starts.
///
/// The pressure is zero everywhere else.
#[derive(Clone)]
pub(crate) struct MeshStart {
    pub(crate) elements: Mesh,
    pub(crate) pressure: Vec<f64>,
}

/// The edge function φ on the elements, from pressure and gap there.
pub(crate) fn edge_function(mesh: &Mesh, pressure: &[f64], gap: &[f64], contact_gap: f64) -> Vec<f64> {
    let mut function = vec![0.0; pressure.len()];
    let around = mesh.surroundings(pressure);
    for (coarser, places, cells) in mesh.own_levels() {
        let spacing = mesh.side(coarser);
        let gaps = gap[cells.clone()].par_chunks(CELLS);
        let sinks = function[cells].par_chunks_mut(CELLS).zip(gaps).zip(places);
        sinks.for_each(|((values, gaps), &place)| {
            let patch = around.elements.around(&around.values, coarser, place, 0.0);
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

/// The start on the next finer `grid`, from φ on the base grid.
///
/// The start has the elements in contact or nearly so. φ is given on all tiles of the base grid, which all ranks have.
pub(crate) fn refine_base(tiles: &TileSet, function: &[f64], grid: Grid, ranks: &Ranks) -> MeshStart {
    let elsewhere = far_from_contact(function, &Ranks::alone());
    let own = Deal::equal(tiles.len(), ranks).range(ranks.rank());
    refined(tiles, own, (function, elsewhere), grid, ranks)
}

/// The start on the next finer `grid`, from φ on elements of one size.
pub(crate) fn refine_all(mesh: &Mesh, function: &[f64], grid: Grid) -> MeshStart {
    let elsewhere = far_from_contact(function, mesh.ranks());
    let around = mesh.surroundings(function);
    let tiles = around.elements.finest();
    refined(tiles, around.own_tiles.clone(), (&around.values, elsewhere), grid, mesh.ranks())
}

/// The start under the `own` tiles among `tiles`.
fn refined(
    tiles: &TileSet,
    own: Range<usize>,
    (function, elsewhere): (&[f64], f64),
    grid: Grid,
    ranks: &Ranks,
) -> MeshStart {
    let sides = sides_of(grid);
    let children = prolong(tiles, own, function, elsewhere, sides);
    let places = children.iter().map(|(place, _)| *place).collect();
    let fine = tiles.of_same_cell(sides, ranks.concatenate(places));
    let elements = Mesh::new(Elements::uniform(fine), ranks);
    let mut pressure = vec![0.0; elements.n_own()];
    elements.deliver(children.iter().map(|(place, values)| (*place, &**values)), &mut pressure);
    to_pressure(&mut pressure);
    MeshStart { elements, pressure }
}

/// The start on `refined`, whose smallest elements are quarters of those of `elements`.
///
/// Elements that stay keep their `pressure`. The pressure of new ones comes from φ. Elements have several sizes, so
/// this rank is the only one.
pub(crate) fn refine_some(elements: &Elements, pressure: &[f64], function: &[f64], refined: Elements) -> MeshStart {
    let mut start = elements.moved(&refined, pressure, 0.0);
    prolong_onto(elements, function, far_from_contact(function, &Ranks::alone()), &refined, &mut start);
    to_pressure(&mut start[refined.cells(0)]);
    MeshStart { elements: refined.into(), pressure: start }
}

/// The value of φ where there is no element, far from contact.
fn far_from_contact(function: &[f64], ranks: &Ranks) -> f64 {
    let [sum, n] = ranks.fold([-0.0, 0.0], |sums| {
        let contact = function.iter().copied().filter(|&value| value > 0.0);
        contact.fold(sums, |[sum, n], value| [sum + value, n + 1.0])
    });
    -sum / n.max(1.0)
}

/// Replaces φ by the pressure. Inside contact φ is its square.
fn to_pressure(positive_part: &mut [f64]) {
    positive_part.par_iter_mut().for_each(|value| *value = value.sqrt());
}
