//! The multilevel operator as an [`Operator`], for tests, benchmarks and forks.

use std::sync::{Arc, Mutex};

use rc_core::{Grid, Operator};
use rc_kernel::{ScaleSplit, SplitParams};
use rc_quadtree::{BLOCK_CELLS, Elements, TILE, TileSet};

use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::problem::adaptive_error::AdaptiveError;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tables::{Prepared, Tables};
use crate::tiles::operator::tile_operator::TileOperator;

/// `v = L p` (Eq. 4) for Love's squares of one size on tiles of 8 × 8 of them.
///
/// Any tiles may be left out. Pressures are zero there, and displacements are not computed. The cost is proportional to
/// the number of tiles, plus a Fourier transform of the base grid. Element i is cell i % 64 (row by row) of tile i
/// / 64.
pub struct MultilevelOperator {
    n_elements: usize,
    places: Vec<[u32; 2]>,
    operator: Mutex<TileOperator<f64, Tables<f64>>>,
}

impl std::fmt::Debug for MultilevelOperator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("MultilevelOperator").field("n_elements", &self.n_elements).finish_non_exhaustive()
    }
}

impl MultilevelOperator {
    /// The operator on the tiles at `places` (column, row) of a grid.
    ///
    /// The grid has `side` elements per side, and its base grid `base_side`. The error is at most `error` of the rms
    /// displacement (see [`SplitParams::for_error`]). Tiles are sorted, and duplicates are dropped: see
    /// [`MultilevelOperator::places`].
    ///
    /// # Errors
    /// [`AdaptiveError::Base`] if `base_side` is not a multiple of 8, or `side` is not 2^k times it with k ≥ 1. Also if
    /// a place is outside the grid. [`AdaptiveError::OperatorError`] if `error` is out of reach.
    pub fn new(base_side: usize, side: usize, places: Vec<[u32; 2]>, error: f64) -> Result<Self, AdaptiveError> {
        let bad = AdaptiveError::Base { base: base_side, waves: 0, finest: side };
        let divides = base_side >= TILE && base_side.is_multiple_of(TILE) && side > base_side;
        if !(divides && side.is_multiple_of(base_side) && (side / base_side).is_power_of_two()) {
            return Err(bad);
        }
        let (Ok(base), Ok(grid)) = (Grid::square(base_side), Grid::square(side)) else { return Err(bad) };
        if places.iter().flatten().any(|&i| i as usize >= side / TILE) {
            return Err(bad);
        }
        let smallest = SplitParams::SMALLEST_ERROR;
        let split = SplitParams::for_error(error).ok_or(AdaptiveError::OperatorError { value: error, smallest })?;
        let prepared = Prepared::displacement(&ScaleSplit::new(split), base, 0);
        let tiles = TileSet::new([side, side], places);
        let (n_elements, places) = (tiles.n_cells(), tiles.places().to_vec());
        let hierarchy = Arc::new(Hierarchy::new(base, Elements::uniform(tiles), prepared.reach()));
        let operator = Mutex::new(TileOperator::new(hierarchy, prepared.tables(grid)));
        Ok(Self { n_elements, places, operator })
    }

    /// Column and row of each tile, in the order of elements.
    #[must_use]
    pub fn places(&self) -> &[[u32; 2]] {
        &self.places
    }
}

impl Operator for MultilevelOperator {
    fn n_elements(&self) -> usize {
        self.n_elements
    }

    fn scratch_len(&self) -> usize {
        0
    }

    fn apply(&self, pressure: &[f64], displacement: &mut [f64], _scratch: &mut [f64]) {
        assert_eq!(pressure.len(), self.n_elements, "one pressure for each element");
        assert_eq!(displacement.len(), self.n_elements, "one displacement for each element");
        let mut operator = self.operator.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        write_blocks(&mut *operator, pressure.chunks(BLOCK_CELLS), |pressure, cells| cells.copy_from_slice(pressure));
        operator.apply();
        read_blocks(&*operator, displacement.chunks_mut(BLOCK_CELLS), |block, cells| block.copy_from_slice(cells));
    }
}

#[cfg(test)]
mod tests {
    use rc_core::testing::check_operator;

    use super::*;

    #[test]
    fn on_all_tiles_it_meets_the_contract() {
        let places = (0..16).flat_map(|row| (0..16).map(move |column| [column, row])).collect();
        check_operator(&MultilevelOperator::new(32, 128, places, 1e-6).expect("a valid operator"));
    }

    #[test]
    fn what_does_not_divide_is_refused() {
        for (base, side, places) in [(12, 24, vec![]), (32, 96, vec![]), (32, 32, vec![]), (32, 64, vec![[8, 0]])] {
            assert!(MultilevelOperator::new(base, side, places, 1e-6).is_err(), "{base} to {side}");
        }
        assert!(MultilevelOperator::new(32, 64, vec![[0, 0]], 1e-12).is_err(), "an error out of reach");
    }
}
