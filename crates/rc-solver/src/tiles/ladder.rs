//! The nested grids of a problem.

use rc_core::Grid;

/// The base grid, finer grids that double the elements, and the finest grid.
///
/// The sides are doubled one grid after the other, starting at the base grid. The finest grid has twice as many
/// elements along both sides as the last of these grids, or a little less. Level 0 is the base grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ladder {
    base: Grid,
    finest: Grid,
}

impl Ladder {
    /// The ladder from the sides of the base grid, in elements, to the finest grid.
    ///
    /// The sides are below those of the finest grid.
    pub(crate) fn new(base: [usize; 2], finest: Grid) -> Self {
        let base = finest.with_elements(base[0], base[1]).expect("a base grid is smaller than the finest");
        Self { base, finest }
    }

    pub(crate) fn base(self) -> Grid {
        self.base
    }

    pub(crate) fn finest(self) -> Grid {
        self.finest
    }

    /// Number of levels above the base grid.
    pub(crate) fn n_levels(self) -> usize {
        n_levels(self.base, self.finest)
    }

    /// The whole grid of a level.
    pub(crate) fn grid(self, level: usize) -> Grid {
        if level == self.n_levels() { self.finest } else { doubled(self.base, level) }
    }

    /// The level whose whole grid has these sides, in elements.
    pub(crate) fn level_of(self, sides: [usize; 2]) -> usize {
        if sides == sides_of(self.finest) {
            self.n_levels()
        } else {
            (sides[0] / self.base.nx()).max(1).ilog2() as usize
        }
    }

    /// Whether the finest grid doubles the level below it along both sides.
    pub(crate) fn is_even(self) -> bool {
        is_even(self.base, self.finest)
    }
}

/// Number of elements along x and y.
pub(crate) fn sides_of(grid: Grid) -> [usize; 2] {
    [grid.nx(), grid.ny()]
}

/// Number of levels from a base grid to a finer one.
///
/// It is the minimum number of doublings after which the doubled grid is not the coarser one.
pub(crate) fn n_levels(base: Grid, finest: Grid) -> usize {
    let doublings = |coarse: usize, fine: usize| fine.div_ceil(coarse).next_power_of_two().ilog2() as usize;
    doublings(base.nx(), finest.nx()).max(doublings(base.ny(), finest.ny()))
}

/// Whether a grid has 2^k times the elements of the base grid along both sides.
pub(crate) fn is_even(base: Grid, finest: Grid) -> bool {
    sides_of(doubled(base, n_levels(base, finest))) == sides_of(finest)
}

/// The grid with 2^`level` times as many elements along both sides.
pub(crate) fn doubled(base: Grid, level: usize) -> Grid {
    base.with_elements(base.nx() << level, base.ny() << level).expect("a level of a checked grid")
}

/// Whether elements are squares, except for the rounding of the lengths of the cell.
pub(crate) fn has_squares(grid: Grid) -> bool {
    let spacing = grid.spacing();
    spacing.max_element() < (1.0 + ROUNDING) * spacing.min_element()
}

const ROUNDING: f64 = 1e-9;
