//! From the pressure on the tiles of one level to a start, and the tiles it needs, on the next finer one.
//!
//! What is interpolated is the level function φ of [`crate::uniform`]'s prolongation: p² inside, and -c² times the distance
//! to the edge outside, which is linear across the edge of a contact.

use rayon::prelude::*;

use super::elements::Elements;
use super::level::Mesh;
use super::operator::{Patch, gather};
use super::tiles::{CELLS, TILE, TileSet, quarters};
use crate::uniform::outside_level;

/// Cells around a tile that must be out of contact for it to be left out: contacts may grow a little.
const MARGIN: usize = 2;

/// Side of the patches that hold a tile and its neighbours.
const SIDE: usize = 3 * TILE;

/// φ on the elements, from pressure and gap there.
pub(super) fn level_function(elements: &Elements, pressure: &[f64], gap: &[f64], contact_gap: f64) -> Vec<f64> {
    let mut level = vec![0.0; pressure.len()];
    for (coarser, tiles) in elements.levels().iter().enumerate() {
        let (cells, spacing) = (elements.cells(coarser), elements.side(coarser));
        let gaps = gap[cells.clone()].par_chunks(CELLS);
        let sinks = level[cells].par_chunks_mut(CELLS).zip(gaps).zip(tiles.places());
        sinks.for_each(|((level, gap), &place)| {
            let patch = elements.around(pressure, coarser, place, 0.0);
            for (cell, (value, gap)) in level.iter_mut().zip(gap).enumerate() {
                let (x, y) = (TILE + cell % TILE, TILE + cell / TILE);
                let here = patch[y][x];
                *value = if here > 0.0 {
                    here * here
                } else {
                    let near = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
                    outside_level(near, (gap - contact_gap).max(0.0), spacing)
                };
            }
        });
    }
    level
}

/// φ where no element is: there is no contact for a long way.
fn far(level: &[f64]) -> f64 {
    let contact: Vec<f64> = level.iter().copied().filter(|&l| l > 0.0).collect();
    -contact.iter().sum::<f64>() / contact.len().max(1) as f64
}

/// Fills the pressure on the finest of `refined`, a mesh whose finest elements are quarters of those of `elements`, from φ there.
pub(super) fn prolong_to(elements: &Elements, level: &[f64], refined: &Elements, pressure: &mut [f64]) {
    let far = far(level);
    let sinks = pressure[refined.cells(0)].par_chunks_mut(CELLS).zip(refined.finest().places());
    sinks.for_each(|(cells, &[column, row])| {
        let patch = elements.around(level, 0, [column / 2, row / 2], far);
        match fine_tile(&patch, (column as usize % 2, row as usize % 2)) {
            Some(pressure) => cells.copy_from_slice(pressure.as_slice()),
            None => cells.fill(0.0),
        }
    });
}

/// The tiles of the next finer level that the start presses, or nearly, and the pressure on them.
pub(super) fn prolong(tiles: &TileSet, level: &[f64]) -> Mesh {
    let far = far(level);
    let children: Vec<[Option<Box<[f64; CELLS]>>; 4]> = tiles
        .places()
        .par_iter()
        .map(|&[column, row]| {
            let mut patch: Patch<f64, SIDE> = [[0.0; SIDE]; SIDE];
            let corner = (i64::from(column) - 1, i64::from(row) - 1);
            gather(level, tiles, corner, TILE - 3..2 * TILE + 3, &mut patch);
            if !patch[TILE - 2..2 * TILE + 2].iter().flat_map(|row| &row[TILE - 2..2 * TILE + 2]).any(|&l| l > 0.0) {
                return [const { None }; 4];
            }
            mark_missing(tiles, corner, far, &mut patch);
            std::array::from_fn(|child| fine_tile(&patch, (child % 2, child / 2)))
        })
        .collect();
    let place = |tile: usize, child: usize| quarters(tiles.places()[tile])[child];
    let chosen = children.iter().enumerate().flat_map(|(tile, children)| {
        children.iter().enumerate().filter_map(move |(child, pressure)| pressure.as_ref().map(|p| (tile, child, p)))
    });
    let fine = TileSet::new(2 * tiles.per_side(), chosen.clone().map(|(tile, child, _)| place(tile, child)).collect());
    let mut pressure = vec![0.0; fine.n_cells()];
    for (tile, child, values) in chosen {
        let [column, row] = place(tile, child).map(i64::from);
        let at = fine.find(column, row).expect("it was just put there");
        pressure[at * CELLS..][..CELLS].copy_from_slice(values.as_slice());
    }
    Mesh { elements: Elements::uniform(fine), pressure }
}

fn mark_missing(tiles: &TileSet, (column, row): (i64, i64), far: f64, patch: &mut Patch<f64, SIDE>) {
    for y in 0..3 {
        for x in 0..3 {
            if tiles.find(column + x as i64, row + y as i64).is_none() {
                for line in &mut patch[y * TILE..][..TILE] {
                    line[x * TILE..][..TILE].fill(far);
                }
            }
        }
    }
}

/// The pressure of the fine tile in a quarter of the middle of the patch; none when nothing presses on it or near it.
fn fine_tile(patch: &Patch<f64, SIDE>, (half_x, half_y): (usize, usize)) -> Option<Box<[f64; CELLS]>> {
    const WIDE: usize = TILE + 2 * MARGIN;
    // Coarse cell and its neighbour on the side of the fine cell; fine cells are counted from the margin's corner.
    let near = |i: usize, half: usize| {
        let fine = TILE * 2 + half * TILE + i - MARGIN;
        let coarse = fine / 2;
        (coarse, if fine.is_multiple_of(2) { coarse - 1 } else { coarse + 1 })
    };
    let mut touched = false;
    let mut pressure = [0.0; CELLS];
    for y in 0..WIDE {
        let (near_y, far_y) = near(y, half_y);
        for x in 0..WIDE {
            let (near_x, far_x) = near(x, half_x);
            let blend = |x: usize| 0.75 * patch[near_y][x] + 0.25 * patch[far_y][x];
            let mut level = 0.75 * blend(near_x) + 0.25 * blend(far_x);
            if level <= 0.0 && patch[near_y][near_x] > 0.0 && is_alone(patch, near_x, near_y) {
                // Between nothing but free cells no fine centre may be left inside the edge; the contact must not get lost.
                level = LEFT_OF_ALONE * patch[near_y][near_x];
            }
            touched |= level > 0.0;
            let inside = |i: usize| (MARGIN..MARGIN + TILE).contains(&i);
            if inside(x) && inside(y) {
                pressure[(y - MARGIN) * TILE + x - MARGIN] = level.max(0.0).sqrt();
            }
        }
    }
    touched.then(|| Box::new(pressure))
}

/// Part of the level function that a contact of a single cell keeps when the interpolation leaves nothing of it.
const LEFT_OF_ALONE: f64 = 0.25;

/// Is none of the neighbours of this cell in contact?
fn is_alone(patch: &Patch<f64, SIDE>, x: usize, y: usize) -> bool {
    let around = patch[y - 1..=y + 1].iter().flat_map(|row| &row[x - 1..=x + 1]);
    let pressed = around.filter(|&&l| l > 0.0).count();
    pressed == 1
}
