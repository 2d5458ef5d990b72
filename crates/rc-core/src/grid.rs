//! The uniform grid on the unit cell.

use thiserror::Error;

/// A uniform grid of `nx` × `ny` elements on the square periodic cell of side 1.
///
/// Elements are squares when `nx == ny`, rectangles otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Grid {
    nx: usize,
    ny: usize,
}

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
}

impl Grid {
    /// Largest number of elements per side: 2^20, far beyond memory, so that index arithmetic cannot overflow.
    pub const MAX_SIDE: usize = 1 << 20;

    /// A grid of `nx` × `ny` elements.
    ///
    /// # Errors
    /// [`GridError::Side`] when a side is 0 or above [`Grid::MAX_SIDE`].
    pub fn new(nx: usize, ny: usize) -> Result<Self, GridError> {
        let side_ok = |n: usize| (1..=Self::MAX_SIDE).contains(&n);
        if side_ok(nx) && side_ok(ny) { Ok(Self { nx, ny }) } else { Err(GridError::Side { nx, ny }) }
    }

    /// A grid of `n` × `n` elements.
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

    /// Number of elements.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a grid is never empty")]
    pub fn len(self) -> usize {
        self.nx * self.ny
    }

    /// Element sides (along x, along y), in λ.
    #[must_use]
    pub fn spacing(self) -> (f64, f64) {
        (1.0 / self.nx as f64, 1.0 / self.ny as f64)
    }

    /// Centre of element (`ix`, `iy`), in λ.
    #[must_use]
    pub fn centre(self, ix: usize, iy: usize) -> (f64, f64) {
        ((ix as f64 + 0.5) / self.nx as f64, (iy as f64 + 0.5) / self.ny as f64)
    }

    /// Index of element (`ix`, `iy`) in a field.
    #[must_use]
    pub fn index(self, ix: usize, iy: usize) -> usize {
        iy * self.nx + ix
    }

    /// Largest wavenumber that the grid resolves in every direction: waves strictly below half its smaller side.
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
