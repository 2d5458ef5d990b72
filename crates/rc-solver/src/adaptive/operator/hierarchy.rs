//! The tiles of all levels between the base grid and the finest elements.

use std::ops::Range;

use rc_core::Grid;
use rc_quadtree::{Elements, TILE, TileSet};

use super::coarse::Leaves;

/// The tiles of all levels, coarsest first: the first is the whole base grid, the last has the finest elements.
pub(crate) struct Hierarchy {
    elements: Elements,
    /// The blocks of a vector: how much coarser than the finest level, and which of its tiles.
    pub(super) blocks: Vec<(usize, Range<usize>)>,
    /// The densities of each level, coarser elements included; on the finest level, its elements.
    pub(super) levels: Vec<TileSet>,
    /// The elements that are 2, 4, … times as large as the finest.
    pub(super) leaves: Vec<Leaves>,
}

/// How far, in cells of a level, values go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reach {
    /// Filters, between levels and within one.
    pub(crate) filter: usize,
    /// Stencils.
    pub(crate) stencil: usize,
}

impl Hierarchy {
    /// The levels over `elements` down to the base grid of `base_side` cells per side, a multiple of 8, each with the tiles
    /// that filters need. The coarsest elements are finer than the base grid's, and elements whose sizes differ by more than
    /// a factor of 2 are farther from each other than stencils of the level between them reach.
    pub(crate) fn new(base_side: usize, elements: Elements, reach: Reach) -> Self {
        let mut levels = vec![elements.finest().clone()];
        while levels[levels.len() - 1].side() > 2 * base_side {
            let parents = levels[levels.len() - 1].parents(reach.filter);
            levels.push(match elements.levels().get(levels.len()) {
                Some(leaves) => parents.with(&leaves.around(reach.filter)),
                None => parents,
            });
        }
        levels.push(TileSet::full(base_side / TILE));
        levels.reverse();
        debug_assert!(elements.levels().len() < levels.len(), "no elements are on the base grid");
        let pairs = elements.levels().windows(2);
        let leaves = pairs.map(|pair| Leaves::new(pair[1].clone(), &pair[0], reach.stencil)).collect();
        Self { blocks: elements.blocks(), elements, levels, leaves }
    }

    /// The elements.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Grid {
        Grid::square(self.levels[0].side()).expect("the base grid is smaller than the finest")
    }

    /// Levels above the base grid.
    pub(crate) fn n_levels(&self) -> usize {
        self.levels.len() - 1
    }

    /// The elements of a level: where they are in a vector, and their tiles.
    pub(super) fn elements_of(&self, level: usize) -> Option<(Range<usize>, &TileSet)> {
        let coarser = self.n_levels() - level;
        self.elements.levels().get(coarser).map(|tiles| (self.elements.cells(coarser), tiles))
    }
}
