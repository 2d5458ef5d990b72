//! Vectors on elements: their division into blocks, and their view by an observer.

use std::convert::Infallible;

use rc_core::{Grid, Observer, Snapshot};
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, Elements, TILE};

use crate::descent::layout::BlockLayout;
use crate::descent::observed::ObservedMesh;
use crate::descent::values::Values;
use crate::tiles::mesh::Mesh;

impl Mesh {
    /// The division of vectors into blocks.
    pub(crate) fn layout(&self) -> BlockLayout {
        let mut centres = Vec::with_capacity(self.n_own().div_ceil(CELLS));
        for (coarser, places, values) in self.own_levels() {
            // Levels begin with whole blocks.
            centres.resize(values.start / CELLS, [0.0; 2]);
            let per_side = self.levels()[coarser].sides().map(|side| side as f32 / TILE as f32);
            let centre = |place: &[u32; 2]| [0, 1].map(|axis| (place[axis] as f32 + 0.5) / per_side[axis]);
            centres.extend(places.iter().map(centre));
        }
        let layout = BlockLayout::of(BLOCK_CELLS).with_runs(CELLS, centres, self.coarsest().sides()).over(self.ranks());
        let layout = layout.with_ends(self.block_ends());
        if self.levels().len() == 1 {
            return layout;
        }
        let areas = self.own_levels().flat_map(|(coarser, places, _)| {
            std::iter::repeat_n(Elements::area(coarser), places.len().div_ceil(BLOCK_TILES))
        });
        layout.with_areas(areas.collect())
    }
}

impl ObservedMesh for Mesh {
    /// Shows the pressure to the observer, if this rank has the whole pressure.
    fn show_pressure(&self, pressure: &Values, observer: &dyn Observer) {
        if self.n_own() < self.len() {
            return;
        }
        let [nx, ny] = self.coarsest().sides();
        // Elements are squares.
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a level of a checked grid");
        let rows = |take: &mut dyn FnMut(&[f64])| {
            let all = pressure.all();
            let (tiles, pressure) = self.on_coarsest(&all);
            let Ok(()) = tiles.rows(&pressure, |_, rows| {
                take(rows);
                Ok::<_, Infallible>(())
            });
        };
        observer.look(&Snapshot::new(grid, &rows));
    }
}

#[cfg(test)]
mod tests {
    use rc_quadtree::TileSet;

    use super::*;

    #[test]
    fn tiles_of_all_levels_are_around_their_centres() {
        let fine: Vec<[u32; 2]> = (0..40).map(|i| [i % 8 + 4, i / 8 + 1]).collect();
        let coarse: Vec<[u32; 2]> = vec![[0, 5], [7, 7], [1, 6]];
        let elements = Elements::new(vec![TileSet::new([128, 128], fine), TileSet::new([64, 64], coarse)]);
        let elements = Mesh::from(elements);
        let layout = elements.layout();
        for (coarser, tiles) in elements.levels().iter().enumerate() {
            for (tile, place) in tiles.places().iter().enumerate() {
                let cell = elements.cells(coarser).start + tile * CELLS;
                let (block, first) = (cell / BLOCK_CELLS, cell % BLOCK_CELLS);
                let mut found = None;
                layout.for_each_run(block, BLOCK_CELLS.min(elements.len() - block * BLOCK_CELLS), |run, centre| {
                    if run == (first..first + CELLS) {
                        found = Some(centre);
                    }
                });
                let expected = place.map(|i| (f64::from(i) + 0.5) / tiles.extent()[0] as f64);
                assert_eq!(found, Some(expected), "level {coarser}, {place:?}");
            }
        }
    }
}
