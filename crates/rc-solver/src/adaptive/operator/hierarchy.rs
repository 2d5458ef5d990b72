//! The tiles of all levels between the base grid and the finest elements.

use std::ops::Range;
use std::sync::Arc;

use rc_core::Grid;
use rc_quadtree::{Elements, TileSet};

use super::coarse::Leaves;
use crate::adaptive::ladder::{self, sides_of};

/// The tiles of all levels, coarsest first: the first is the whole base grid, the last has the finest elements.
pub(crate) struct Hierarchy {
    base: Grid,
    reach: Reach,
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
    /// The levels over `elements` down to the base grid, whose sides are multiples of 8, each with the tiles
    /// that filters need. The coarsest elements are finer than the base grid's, and elements whose sizes differ by more than
    /// a factor of 2 are farther from each other than stencils of the level between them reach.
    pub(crate) fn new(base: Grid, elements: Elements, reach: Reach) -> Self {
        let mut levels = vec![elements.finest().clone()];
        let [nx, ny] = elements.finest().sides();
        let finest = base.with_elements(nx, ny).expect("a level of a checked grid");
        for level in (1..ladder::n_levels(base, finest)).rev() {
            let sides = sides_of(ladder::doubled(base, level));
            let parents = levels[levels.len() - 1].on_coarser(sides, reach.filter);
            levels.push(match elements.levels().get(levels.len()) {
                Some(leaves) => parents.with(&leaves.around(reach.filter)),
                None => parents,
            });
        }
        levels.push(TileSet::full(sides_of(base)));
        levels.reverse();
        debug_assert!(elements.levels().len() < levels.len(), "no elements are on the base grid");
        let pairs = elements.levels().windows(2);
        let leaves = pairs.map(|pair| Leaves::new(pair[1].clone(), &pair[0], reach.stencil)).collect();
        Self { base, reach, blocks: elements.blocks(), elements, levels, leaves }
    }

    /// The elements.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Grid {
        self.base
    }

    /// The same for the preconditioner, which halves every level: where the finest has not twice as many elements as the level below
    /// it, a strip without elements takes the place of what is missing, along the seam.
    pub(super) fn halved(self: &Arc<Self>) -> Arc<Self> {
        let sides = sides_of(ladder::doubled(self.base, self.n_levels()));
        if self.elements.finest().sides() == sides {
            return Arc::clone(self);
        }
        let tiles = TileSet::new(sides, self.elements.finest().places().to_vec());
        Arc::new(Self::new(self.base, Elements::uniform(tiles), self.reach))
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
