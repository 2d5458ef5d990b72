//! The uniform grid on the periodic cell.

use glam::DVec2;
use thiserror::Error;

/// A uniform grid of `nx` × `ny` elements on the periodic cell.
///
/// The side of the cell along x is 1. The cell is a square unless [`Grid::in_cell`] says otherwise. On a square cell,
/// elements are squares when `nx == ny`, and rectangles otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "GridData"))]
pub struct Grid {
    nx: usize,
    ny: usize,
    cell_ratio: f64,
}

/// Grid data that are not yet checked. `cell_ratio` may be omitted for a square cell.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct GridData {
    nx: usize,
    ny: usize,
    cell_ratio: Option<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<GridData> for Grid {
    type Error = GridError;

    fn try_from(data: GridData) -> Result<Self, GridError> {
        Self::in_cell(data.nx, data.ny, data.cell_ratio.unwrap_or(1.0))
    }
}

// The ratio is never NaN.
impl Eq for Grid {}

/// A grid that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum GridError {
    /// A side is 0 or above [`Grid::MAX_SIDE`].
    #[error("a grid needs 1 to {max} elements per side, not {nx} x {ny}", max = Grid::MAX_SIDE)]
    Side {
        /// Elements along x, as given.
        nx: usize,
        /// Elements along y, as given.
        ny: usize,
    },
    /// The sides of a cell differ by more than a factor of [`Grid::MAX_CELL_RATIO`].
    #[error("the sides of a cell may differ by a factor of {} at most", Grid::MAX_CELL_RATIO)]
    CellRatio,
}

impl Grid {
    /// Maximum number of elements per side, 2^20.
    ///
    /// A square grid of this size exceeds any memory, and its indices cannot overflow.
    pub const MAX_SIDE: usize = 1 << 20;

    /// Maximum ratio of the longer to the shorter side of a cell.
    pub const MAX_CELL_RATIO: f64 = 1e4;

    /// A grid of `nx` × `ny` elements on the square cell.
    ///
    /// # Errors
    /// [`GridError::Side`] when a side is 0 or above [`Grid::MAX_SIDE`].
    pub fn new(nx: usize, ny: usize) -> Result<Self, GridError> {
        Self::in_cell(nx, ny, 1.0)
    }

    /// A grid of `nx` × `ny` elements on a rectangular cell.
    ///
    /// The side of the cell along y is `cell_ratio` times the side along x.
    ///
    /// # Errors
    /// [`GridError::Side`] as for [`Grid::new`]. [`GridError::CellRatio`] when `cell_ratio` is not between
    /// 1/[`Grid::MAX_CELL_RATIO`] and [`Grid::MAX_CELL_RATIO`].
    pub fn in_cell(nx: usize, ny: usize, cell_ratio: f64) -> Result<Self, GridError> {
        let side_ok = |n: usize| (1..=Self::MAX_SIDE).contains(&n);
        if !(side_ok(nx) && side_ok(ny)) {
            return Err(GridError::Side { nx, ny });
        }
        // A quotient of lengths may have a rounding error.
        let maximum = Self::MAX_CELL_RATIO * (1.0 + 1e-12);
        if !(maximum.recip()..=maximum).contains(&cell_ratio) {
            return Err(GridError::CellRatio);
        }
        Ok(Self { nx, ny, cell_ratio })
    }

    /// A grid of `n` × `n` elements on the square cell.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn square(n: usize) -> Result<Self, GridError> {
        Self::new(n, n)
    }

    /// Elements along x.
    #[must_use]
    pub fn nx(self) -> usize {
        self.nx
    }

    /// Elements along y.
    #[must_use]
    pub fn ny(self) -> usize {
        self.ny
    }

    /// Side of the cell along y divided by the side along x.
    ///
    /// It is 1 for a square. The side along x is the unit of length, so this is also the area of the cell.
    #[must_use]
    pub fn cell_ratio(self) -> f64 {
        self.cell_ratio
    }

    /// Whether the cell is a square.
    #[must_use]
    #[expect(clippy::float_cmp, reason = "a square cell has exactly 1")]
    pub fn has_square_cell(self) -> bool {
        self.cell_ratio == 1.0
    }

    /// Whether x and y may be exchanged: a square cell with `nx == ny`.
    #[must_use]
    pub fn is_square(self) -> bool {
        self.nx == self.ny && self.has_square_cell()
    }

    /// A grid on the same cell with other numbers of elements.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub fn with_elements(self, nx: usize, ny: usize) -> Result<Self, GridError> {
        Self::in_cell(nx, ny, self.cell_ratio)
    }

    /// Number of elements.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(self) -> usize {
        self.nx * self.ny
    }

    /// Sides of an element along x and y, in λ.
    #[must_use]
    pub fn spacing(self) -> DVec2 {
        DVec2::new(1.0 / self.nx as f64, self.cell_ratio / self.ny as f64)
    }

    /// Centre of element (`ix`, `iy`), in λ.
    #[must_use]
    pub fn centre(self, ix: usize, iy: usize) -> DVec2 {
        DVec2::new((ix as f64 + 0.5) / self.nx as f64, self.cell_ratio * (iy as f64 + 0.5) / self.ny as f64)
    }

    /// Index of element (`ix`, `iy`) in a field.
    #[must_use]
    pub fn index(self, ix: usize, iy: usize) -> usize {
        iy * self.nx + ix
    }

    /// Wavenumber |k| of the wave with `kx` and `ky` periods per side, in waves per λ.
    #[must_use]
    pub fn waves(self, kx: usize, ky: usize) -> f64 {
        self.squared_waves(kx, ky).sqrt()
    }

    /// Wave vector q of the wave with `kx` and `ky` periods per side, in radians per λ. Periods may be negative.
    #[must_use]
    pub fn angular_wave(self, kx: i64, ky: i64) -> DVec2 {
        std::f64::consts::TAU * DVec2::new(kx as f64, ky as f64 / self.cell_ratio)
    }

    /// Squared wavenumber |k|² of the wave with `kx` and `ky` periods per side.
    #[must_use]
    pub fn squared_waves(self, kx: usize, ky: usize) -> f64 {
        (kx as f64).powi(2) + (ky as f64 / self.cell_ratio).powi(2)
    }

    /// Largest number of waves per side that the grid resolves along x and y.
    ///
    /// It is strictly below half the smaller number of elements.
    #[must_use]
    pub fn resolved_wavenumber(self) -> usize {
        (self.nx.min(self.ny) - 1) / 2
    }
}

impl std::fmt::Display for Grid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} x {}", self.nx, self.ny)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_may_be_a_rectangle() {
        let grid = Grid::in_cell(8, 4, 0.5).expect("a grid");
        assert_eq!(grid.spacing(), DVec2::splat(0.125));
        assert_eq!(grid.centre(7, 3), DVec2::new(0.9375, 0.4375));
        assert!((grid.waves(3, 2) - 5.0).abs() < 1e-15, "3 along x, 2 on half the length");
        assert_eq!(grid.with_elements(4, 2), Grid::in_cell(4, 2, 0.5));
        assert!(!grid.is_square() && !Grid::in_cell(4, 4, 0.5).expect("a grid").is_square());
        assert!(Grid::square(4).expect("a grid").is_square());
        for ratio in [0.0, -1.0, f64::NAN, f64::INFINITY, 10_001.0, 9e-5] {
            assert_eq!(Grid::in_cell(8, 4, ratio), Err(GridError::CellRatio), "{ratio}");
        }
        assert!(Grid::in_cell(8, 4, 7.0 / 7e-4).is_ok(), "a rounding above the limit");
        assert_eq!(Grid::in_cell(0, 4, 1.0), Err(GridError::Side { nx: 0, ny: 4 }));
    }
}
