//! The base grid, and the periodic levels that operators are on.

use rc_core::{Boundary, Grid};
use rc_quadtree::TILE;

use crate::tiles::ladder::{Ladder, sides_of};
use rc_fft::has_small_factors;

/// The base grid, and the period of operators in its elements.
///
/// The period of a periodic cell is the cell. With free borders it is longer, so that no element acts on another one
/// around the period. Elements keep their places. Filters reach beyond a free border, onto tiles of the operator's
/// levels. Beyond the last tiles of the heights these are the next ones, before the first tiles the last of the period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Base {
    grid: Grid,
    period: [usize; 2],
}

/// Maximum reach of filters beyond a border, in elements of the base grid.
///
/// They reach up to 16 elements of each level, which are half as long on the next finer one.
const MARGIN: usize = 32;

/// Greatest prime factor of the period: Fourier transforms of such lengths are fast.
const GREATEST_FACTOR: usize = 5;

impl From<Grid> for Base {
    /// Of a periodic cell.
    fn from(grid: Grid) -> Self {
        Self { grid, period: sides_of(grid) }
    }
}

impl Base {
    /// Of heights on these levels, with these borders.
    pub(crate) fn new(ladder: Ladder, boundary: Boundary) -> Self {
        let base = Self::from(ladder.base());
        match boundary {
            Boundary::Periodic => base,
            Boundary::Free if ladder.is_even() => Self { period: base.period.map(padded), ..base },
            // The period of the finest level is in proportion, and whole.
            Boundary::Free => Self { period: base.period.map(|side| padded_least(side).div_ceil(side) * side), ..base },
        }
    }

    /// The base grid of the heights.
    pub(crate) fn grid(self) -> Grid {
        self.grid
    }

    /// Its elements in a period along both axes.
    pub(crate) fn period(self) -> [usize; 2] {
        self.period
    }

    /// Elements in a period of a level whose whole grid has `sides`.
    pub(crate) fn period_of(self, sides: [usize; 2]) -> [usize; 2] {
        let base = sides_of(self.grid);
        // Whole: sides are those of the base grid doubled, or the period is a multiple of the base grid.
        [0, 1].map(|axis| self.period[axis] * sides[axis] / base[axis])
    }

    /// Whether the period is larger than the heights.
    pub(crate) fn is_free(self) -> bool {
        self.period != sides_of(self.grid)
    }

    /// The elements of a period, as a grid with sides of its own.
    ///
    /// The unit of length is the side of the period.
    pub(crate) fn periodic_grid(self) -> Grid {
        let [along_x, along_y] = self.periods_per_side();
        let ratio = self.grid.cell_ratio() * along_y / along_x;
        Grid::in_cell(self.period[0], self.period[1], ratio).expect("a grid whose double can be counted was checked")
    }

    /// Sides of the period in units of those of the heights.
    pub(crate) fn periods_per_side(self) -> [f64; 2] {
        let sides = sides_of(self.grid);
        [0, 1].map(|axis| self.period[axis] as f64 / sides[axis] as f64)
    }
}

/// Minimum number of elements of a period, for heights on `side` elements.
///
/// Pressures within the reach of filters beyond one border act on displacements within it beyond the other border.
fn padded_least(side: usize) -> usize {
    2 * (side + 2 * MARGIN)
}

/// As few as that, in whole tiles.
fn padded(side: usize) -> usize {
    let least = padded_least(side).next_multiple_of(TILE);
    // A power of two is among them.
    let sides = (least..=2 * least).step_by(TILE);
    sides.clone().find(|&side| has_small_factors(side, GREATEST_FACTOR)).unwrap_or(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periods_are_twice_the_heights_and_their_margins() {
        let ladder = |base: [usize; 2], [nx, ny]: [usize; 2]| {
            Ladder::new(base, Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid"))
        };
        for (base, finest, expected) in [
            ([64, 64], [256, 256], [256, 256]),
            ([256, 128], [1024, 512], [640, 384]),
            ([512, 512], [4096, 4096], [1152, 1152]),
            // Three or more times the heights where levels do not halve.
            ([128, 64], [251, 125], [384, 256]),
        ] {
            let base = Base::new(ladder(base, finest), Boundary::Free);
            assert_eq!(base.period(), expected, "{finest:?}");
            let of_finest = base.period_of(finest);
            for axis in 0..2 {
                let (side, whole) = (sides_of(base.grid())[axis], of_finest[axis]);
                assert!(base.period()[axis] >= 2 * side + 4 * MARGIN && base.period()[axis].is_multiple_of(TILE));
                assert_eq!(whole * side, base.period()[axis] * finest[axis], "in proportion");
            }
            assert!(base.is_free() && !Base::from(base.grid()).is_free());
        }
    }
}
