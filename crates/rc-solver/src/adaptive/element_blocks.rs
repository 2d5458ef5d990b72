//! Vectors on elements: how they are divided into blocks, and how an observer sees them.

use std::convert::Infallible;

use rc_core::{Grid, Observer, Snapshot};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements};

use crate::descent::{BlockLayout, ObservedMesh};

/// How vectors on `elements` are divided.
pub(crate) fn blocks_of(elements: &Elements) -> BlockLayout {
    let mut centres = Vec::with_capacity(elements.len().div_ceil(CELLS));
    for (coarser, tiles) in elements.levels().iter().enumerate() {
        // Levels begin at whole blocks.
        centres.resize(elements.cells(coarser).start / CELLS, [0.0; 2]);
        let per_side = tiles.per_side() as f32;
        centres.extend(tiles.places().iter().map(|place| place.map(|i| (i as f32 + 0.5) / per_side)));
    }
    let layout = BlockLayout::of(BLOCK_CELLS).with_runs(CELLS, centres, elements.coarsest().side());
    if elements.levels().len() == 1 {
        return layout;
    }
    let areas = elements.blocks().into_iter().map(|(coarser, _)| Elements::area(coarser));
    layout.with_areas(areas.collect())
}

impl ObservedMesh for Elements {
    fn show_pressure(&self, pressure: &[f64], observer: &dyn Observer) {
        let grid = Grid::square(self.coarsest().side()).expect("a level of a checked grid");
        let rows = |take: &mut dyn FnMut(&[f64])| {
            let (tiles, pressure) = self.on_coarsest(pressure);
            let Ok(()) = tiles.rows(&pressure, |_, rows| {
                take(rows);
                Ok::<_, Infallible>(())
            });
        };
        observer.look(&Snapshot::new(grid, &rows));
    }
}
