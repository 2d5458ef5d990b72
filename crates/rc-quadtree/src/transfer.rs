//! Transfer of values from elements to tiles, patches and elements of another mesh.

use std::borrow::Cow;

use rayon::prelude::*;
use rc_core::Boundary;

use crate::elements::Elements;
use crate::patch::{Patch, gather_cells};
use crate::tiles::{CELLS, TILE, TileSet, cell_over, means_of_quarter, quarters};

impl Elements {
    /// Copies the values at the place of a tile.
    ///
    /// The elements there may have the size of this level, or be twice or half as large. The value of a larger element
    /// is copied to its quarters, and smaller elements are averaged. Returns false, and copies nothing, where there are
    /// no elements.
    fn tile_values(
        &self,
        values: &[f64],
        coarser: usize,
        (column, row): (i64, i64),
        mut put: impl FnMut(usize, usize, f64),
    ) -> bool {
        if let Some(start) = self.find(coarser, column, row) {
            for (cell, &value) in values[start..start + CELLS].iter().enumerate() {
                put(cell % TILE, cell / TILE, value);
            }
            return true;
        }
        if self.quarter_values(values, coarser + 1, (column, row), &mut put) {
            return true;
        }
        let Some(finer) = coarser.checked_sub(1) else { return false };
        let mut any = false;
        let [columns, rows] = self.levels()[coarser].extent().map(|n| n as i64);
        let is_inside = (0..columns).contains(&column) && (0..rows).contains(&row);
        if !is_inside && self.levels()[coarser].boundary() == Boundary::Free {
            return false;
        }
        for quarter in quarters([column.rem_euclid(columns) as u32, row.rem_euclid(rows) as u32]) {
            let Some(start) = self.find(finer, quarter[0].into(), quarter[1].into()) else { continue };
            any = true;
            means_of_quarter(quarter, &values[start..start + CELLS], |cell, mean| put(cell % TILE, cell / TILE, mean));
        }
        any
    }

    /// Copies the values at the place of a tile half as large.
    ///
    /// The tile is half as large as tiles of the level `coarser`. The values come from that level only. Returns false
    /// where it has no tile.
    fn quarter_values(
        &self,
        values: &[f64],
        coarser: usize,
        (column, row): (i64, i64),
        mut put: impl FnMut(usize, usize, f64),
    ) -> bool {
        let Some(start) = self.find(coarser, column.div_euclid(2), row.div_euclid(2)) else { return false };
        let quarter = [column, row].map(|i| i.rem_euclid(2) as u32);
        for cell in 0..CELLS {
            let (x, y) = (cell % TILE, cell / TILE);
            put(x, y, values[start + cell_over(quarter, x, y)]);
        }
        true
    }

    /// The values on a tile and its eight neighbours, `missing` where there are no elements.
    ///
    /// The value of an element twice as large is copied to its quarters. Elements half as large are averaged.
    #[must_use]
    pub fn around(
        &self,
        values: &[f64],
        coarser: usize,
        [column, row]: [u32; 2],
        missing: f64,
    ) -> Patch<f64, { 3 * TILE }> {
        let mut patch = [[missing; 3 * TILE]; 3 * TILE];
        let (tiles, corner) = (&self.levels()[coarser], (i64::from(column) - 1, i64::from(row) - 1));
        if tiles.is_cut(corner, 3) {
            gather_cells(&values[self.cells(coarser)], tiles, corner, (0..3 * TILE, missing), &mut patch);
            return patch;
        }
        for j in 0..3 {
            for i in 0..3 {
                let place = (i64::from(column) + i as i64 - 1, i64::from(row) + j as i64 - 1);
                self.tile_values(values, coarser, place, |x, y, value| patch[j * TILE + y][i * TILE + x] = value);
            }
        }
        patch
    }

    /// The mesh without its finest level, and the values on it.
    ///
    /// Values of the finest level are averaged over elements twice as large.
    fn without_finest(&self, values: &[f64]) -> (Self, Vec<f64>) {
        let mut levels = self.levels()[1..].to_vec();
        levels[0] = levels[0].with(&self.levels()[0].parents(0));
        let coarser = Self::new(levels);
        let values = self.moved(&coarser, values, 0.0);
        (coarser, values)
    }

    /// The mesh without its coarsest level, and the values on it.
    ///
    /// An element of the coarsest level stands for its quarters.
    fn without_coarsest(&self, values: &[f64]) -> (Self, Vec<f64>) {
        let (coarsest, finer) = self.levels().split_last().expect("a mesh has at least one level");
        let mut levels = finer.to_vec();
        let parts = coarsest.places().iter().copied().flat_map(quarters).collect();
        let last = levels.len() - 1;
        levels[last] = levels[last].with(&levels[last].of_same_cell(levels[last].sides(), parts));
        let finer = Self::new(levels);
        let values = self.moved(&finer, values, 0.0);
        (finer, values)
    }

    /// The mesh with elements of the coarsest level only, and the values on it.
    ///
    /// There is a tile wherever there are elements. Values are means over smaller elements.
    #[must_use]
    pub fn on_coarsest<'a>(&self, values: &'a [f64]) -> (TileSet, Cow<'a, [f64]>) {
        self.on_one_level(values, Self::without_finest)
    }

    /// The mesh with elements of the finest level only, and the values on it.
    ///
    /// There is a tile wherever there are elements. A larger element stands for its parts.
    #[must_use]
    pub fn on_finest<'a>(&self, values: &'a [f64]) -> (TileSet, Cow<'a, [f64]>) {
        self.on_one_level(values, Self::without_coarsest)
    }

    /// The mesh after steps that each take one level away, and the values on it.
    fn on_one_level<'a>(
        &self,
        values: &'a [f64],
        step: impl Fn(&Self, &[f64]) -> (Self, Vec<f64>),
    ) -> (TileSet, Cow<'a, [f64]>) {
        let (mut mesh, mut values) = (Cow::Borrowed(self), Cow::Borrowed(values));
        while mesh.levels().len() > 1 {
            let (other, on_other) = step(&mesh, &values);
            (mesh, values) = (Cow::Owned(other), Cow::Owned(on_other));
        }
        (mesh.finest().clone(), values)
    }

    /// Values on the elements of another mesh `to`.
    ///
    /// The tiles of `to` are tiles of this mesh, quarters of them, unions of four, or new tiles. New tiles, and the
    /// values that complete blocks of vectors, get the value `elsewhere`.
    #[must_use]
    pub fn moved(&self, to: &Self, values: &[f64], elsewhere: f64) -> Vec<f64> {
        let mut result = vec![elsewhere; to.len()];
        for (coarser, tiles) in to.levels().iter().enumerate() {
            // The same level of this mesh, unless the other mesh has a finer level.
            let here = self.levels().iter().position(|level| level.sides() == tiles.sides());
            let cells = &mut result[to.cells(coarser)];
            let sinks = cells.par_chunks_mut(CELLS).zip(tiles.places()).with_min_len(64);
            sinks.for_each(|(cells, &place)| {
                let (place, put) =
                    (place.map(i64::from).into(), |x: usize, y: usize, value| cells[y * TILE + x] = value);
                match here {
                    Some(here) => self.tile_values(values, here, place, put),
                    None => self.quarter_values(values, 0, place, put),
                };
            });
        }
        result
    }
}
