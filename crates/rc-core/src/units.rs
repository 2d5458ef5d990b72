//! From SI to the units of the libraries, and back.

use thiserror::Error;

/// A physical quantity that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum UnitError {
    /// A quantity that must be positive and finite is not.
    #[error("{what} must be positive and finite, not {value}")]
    NotPositive {
        /// Name of the quantity.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// Poisson's ratio outside the range of stable isotropic solids.
    #[error("Poisson's ratio must be above -1 and at most 0.5, not {value}")]
    Poisson {
        /// The value given.
        value: f64,
    },
}

fn positive(what: &'static str, value: f64) -> Result<f64, UnitError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(UnitError::NotPositive { what, value }) }
}

/// The periodic cell: a square of side λ, or a rectangle whose side along x is λ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicCell {
    side: f64,
    side_y: f64,
}

impl PeriodicCell {
    /// A square of side `side` (m).
    ///
    /// # Errors
    /// [`UnitError::NotPositive`].
    pub fn new(side: f64) -> Result<Self, UnitError> {
        Self::rectangle(side, side)
    }

    /// A rectangle of sides `side` along x and `side_y` along y (m).
    ///
    /// # Errors
    /// [`UnitError::NotPositive`].
    pub fn rectangle(side: f64, side_y: f64) -> Result<Self, UnitError> {
        Ok(Self { side: positive("the cell side", side)?, side_y: positive("the cell side along y", side_y)? })
    }

    /// Side λ along x (m), the unit of length.
    #[must_use]
    pub fn side(self) -> f64 {
        self.side
    }

    /// Sides along x and y (m).
    #[must_use]
    pub fn sides(self) -> [f64; 2] {
        [self.side, self.side_y]
    }

    /// Side along y over side along x, as [`crate::Grid::cell_ratio`].
    #[must_use]
    pub fn ratio(self) -> f64 {
        self.side_y / self.side
    }

    /// Nominal area A0 (m²); λ² for a square.
    #[must_use]
    pub fn nominal_area(self) -> f64 {
        self.side * self.side_y
    }
}

/// The elastic half-space against a rigid surface: E* = E/(1-ν²) (below Eq. 5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elasticity {
    e_star: f64,
}

impl Elasticity {
    /// From Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// [`UnitError`] for a modulus that is not positive or a ratio outside (-1, 0.5].
    pub fn from_young_poisson(young: f64, poisson: f64) -> Result<Self, UnitError> {
        let young = positive("Young's modulus", young)?;
        if poisson > -1.0 && poisson <= 0.5 {
            Self::from_e_star(young / (1.0 - poisson * poisson))
        } else {
            Err(UnitError::Poisson { value: poisson })
        }
    }

    /// From E* (Pa) itself.
    ///
    /// # Errors
    /// [`UnitError::NotPositive`].
    pub fn from_e_star(e_star: f64) -> Result<Self, UnitError> {
        Ok(Self { e_star: positive("E*", e_star)? })
    }

    /// E* (Pa).
    #[must_use]
    pub fn e_star(self) -> f64 {
        self.e_star
    }
}
