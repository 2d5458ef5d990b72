//! Vectors on elements: how they are divided into blocks, and how an observer sees them.

use std::convert::Infallible;

use rc_core::{Grid, Observer, Snapshot};
use rc_quadtree::{BLOCK_CELLS, Elements};

use crate::descent::{BlockLayout, ObservedMesh};

/// How vectors on `elements` are divided.
pub(crate) fn blocks_of(elements: &Elements) -> BlockLayout {
    if elements.levels().len() == 1 {
        return BlockLayout::of(BLOCK_CELLS);
    }
    let areas = elements.blocks().into_iter().map(|(coarser, _)| Elements::area(coarser));
    BlockLayout::with_areas(BLOCK_CELLS, areas.collect())
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
