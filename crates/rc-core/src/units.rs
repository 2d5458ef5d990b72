//! Conversion from SI units to the units of the libraries, and back.

use thiserror::Error;

use crate::{Field, Grid, GridError};

/// A physical quantity with an impossible value.
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
    /// Poisson's ratio is outside the range of stable isotropic solids.
    #[error("Poisson's ratio must be above -1 and at most 0.5, not {value}")]
    Poisson {
        /// The value given.
        value: f64,
    },
}

fn positive(what: &'static str, value: f64) -> Result<f64, UnitError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(UnitError::NotPositive { what, value }) }
}

/// The periodic cell. It is a square of side λ, or a rectangle whose side along x is λ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "CellData"))]
pub struct PeriodicCell {
    side: f64,
    side_y: f64,
}

/// Cell data that are not yet checked. `side_y` may be omitted for a square.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct CellData {
    side: f64,
    side_y: Option<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<CellData> for PeriodicCell {
    type Error = UnitError;

    fn try_from(data: CellData) -> Result<Self, UnitError> {
        Self::rectangle(data.side, data.side_y.unwrap_or(data.side))
    }
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

    /// Side along y divided by side along x, as [`crate::Grid::cell_ratio`].
    #[must_use]
    pub fn ratio(self) -> f64 {
        self.side_y / self.side
    }

    /// Nominal area A0 (m²). It is λ² for a square.
    #[must_use]
    pub fn nominal_area(self) -> f64 {
        self.side * self.side_y
    }
}

/// The elastic half-space against a rigid surface, E* = E/(1-ν²) (below Eq. 5).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(try_from = "ElasticityData"))]
pub struct Elasticity {
    e_star: f64,
}

/// Data of a half-space that are not yet checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct ElasticityData {
    e_star: f64,
}

#[cfg(feature = "serde")]
impl TryFrom<ElasticityData> for Elasticity {
    type Error = UnitError;

    fn try_from(data: ElasticityData) -> Result<Self, UnitError> {
        Self::from_e_star(data.e_star)
    }
}

impl Elasticity {
    /// A half-space with a given Young's modulus (Pa) and Poisson's ratio.
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

    /// A half-space with a given E* (Pa).
    ///
    /// # Errors
    /// [`UnitError::NotPositive`].
    pub fn from_e_star(e_star: f64) -> Result<Self, UnitError> {
        Ok(Self { e_star: positive("E*", e_star)? })
    }

    /// Two elastic bodies in contact, this one and `other`: 1/E* is the sum of both 1/E*.
    ///
    /// # Errors
    /// [`UnitError::NotPositive`] when the sum is out of range.
    pub fn against(self, other: Self) -> Result<Self, UnitError> {
        Self::from_e_star((self.e_star.recip() + other.e_star.recip()).recip())
    }

    /// E* (Pa).
    #[must_use]
    pub fn e_star(self) -> f64 {
        self.e_star
    }
}

/// The units of a scene.
///
/// Lengths are multiples of the side λ of its cell, pressures multiples of its E*.
///
/// ```
/// use rc_core::{Elasticity, PeriodicCell, Units};
///
/// let units = Units::new(PeriodicCell::new(10e-3)?, Elasticity::from_young_poisson(210e9, 0.3)?);
/// assert_eq!(units.length(5e-3), 0.5);
/// assert!((units.pressure(1e6) - 4.333e-6).abs() < 1e-9);
/// assert_eq!(units.metres(0.5), 5e-3);
/// # Ok::<(), rc_core::UnitError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Units {
    cell: PeriodicCell,
    elasticity: Elasticity,
}

impl Units {
    /// The units of a cell and a half-space.
    #[must_use]
    pub fn new(cell: PeriodicCell, elasticity: Elasticity) -> Self {
        Self { cell, elasticity }
    }

    /// The cell.
    #[must_use]
    pub fn cell(self) -> PeriodicCell {
        self.cell
    }

    /// The half-space.
    #[must_use]
    pub fn elasticity(self) -> Elasticity {
        self.elasticity
    }

    /// Converts a length from metres to λ.
    #[must_use]
    pub fn length(self, metres: f64) -> f64 {
        metres / self.cell.side()
    }

    /// Converts a pressure from pascals to E*.
    #[must_use]
    pub fn pressure(self, pascals: f64) -> f64 {
        pascals / self.elasticity.e_star()
    }

    /// Converts a length from λ to metres.
    #[must_use]
    pub fn metres(self, length: f64) -> f64 {
        length * self.cell.side()
    }

    /// Converts a pressure from E* to pascals.
    #[must_use]
    pub fn pascals(self, pressure: f64) -> f64 {
        pressure * self.elasticity.e_star()
    }

    /// Converts a stiffness per area from E*/λ to Pa/m.
    #[must_use]
    pub fn pascals_per_metre(self, stiffness: f64) -> f64 {
        stiffness * self.elasticity.e_star() / self.cell.side()
    }

    /// Energy of the whole cell in J, from an energy per nominal area in E* λ.
    #[must_use]
    pub fn joules(self, energy: f64) -> f64 {
        energy * self.elasticity.e_star() * self.cell.side().powi(3) * self.cell.ratio()
    }

    /// Converts a height map from metres to λ.
    ///
    /// The result is on a grid with the numbers of points of the map and the shape of the cell.
    ///
    /// # Errors
    /// [`GridError::CellRatio`] when the sides of the cell differ by too large a factor.
    pub fn heights(self, map: &Field) -> Result<Field, GridError> {
        let grid = Grid::in_cell(map.grid().nx(), map.grid().ny(), self.cell.ratio())?;
        let mut heights = Field::zeros(grid);
        for (height, &metres) in heights.values_mut().iter_mut().zip(map.values()) {
            *height = self.length(metres);
        }
        Ok(heights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring has the same properties in both systems of units. Its stiffness is pressure over length, and its energy
    /// half their product times the area.
    #[test]
    fn stiffness_and_energy_follow_from_pressure_and_length() {
        let cell = PeriodicCell::rectangle(2e-3, 5e-3).expect("a cell");
        let units = Units::new(cell, Elasticity::from_e_star(7e10).expect("a solid"));
        let (pressure, length) = (3e-4, 2e-5);
        let stiffness = units.pascals(pressure) / units.metres(length);
        assert!((units.pascals_per_metre(pressure / length) / stiffness - 1.0).abs() < 1e-14);
        let energy = 0.5 * units.pascals(pressure) * units.metres(length) * cell.nominal_area();
        assert!((units.joules(0.5 * pressure * length) / energy - 1.0).abs() < 1e-14);
    }
}
