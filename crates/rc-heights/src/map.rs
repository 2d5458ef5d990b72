//! The height map itself.

use rc_core::Field;

use crate::{LengthUnitError, Scales, Unit};

/// Heights of a measured rectangle, positive out of the material.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// Heights; `NaN` where nothing was measured.
    pub heights: Field,
    /// What the heights are in.
    pub height_unit: Unit,
    /// Sides of the rectangle along x and y, each the number of points times their distance; `None` where the file does
    /// not say.
    pub sides: Option<[f64; 2]>,
    /// What the sides are in.
    pub side_unit: Unit,
}

impl HeightMap {
    /// Heights in a unit that is not named, without sides: a bare array.
    #[must_use]
    pub fn bare(heights: Field) -> Self {
        Self { heights, height_unit: Unit::Unnamed, sides: None, side_unit: Unit::Unnamed }
    }

    /// The same map with heights and sides in metres; what the file does not name is taken from `scales`, and is metres
    /// where these say nothing. Values that are not scaled keep their bits.
    ///
    /// # Errors
    /// [`LengthUnitError`] when levels of grey have no scale, or when the file names what `scales` gives.
    pub fn in_metres(mut self, scales: Scales) -> Result<Self, LengthUnitError> {
        let unit = scales.unit.map_or(1.0, crate::LengthUnit::metres);
        let unnamed = |is: Unit| is == Unit::Unnamed;
        let unit_has_use = unnamed(self.height_unit) || self.sides.is_some() && unnamed(self.side_unit);
        match (self.height_unit, scales) {
            (Unit::GreyLevel, Scales { height_scale: None, .. }) => return Err(LengthUnitError::GreyLevels),
            (Unit::NotLength, Scales { height_scale: None, .. }) => return Err(LengthUnitError::NotLength),
            (Unit::GreyLevel, Scales { unit: Some(_), .. }) if !unit_has_use => {
                return Err(LengthUnitError::UnitOfLevels);
            }
            (Unit::NotLength, Scales { unit: Some(_), .. }) if !unit_has_use => {
                return Err(LengthUnitError::UnitOfNotLength);
            }
            (_, Scales { unit: Some(_), .. }) if !unit_has_use => return Err(LengthUnitError::UnitsNamed),
            _ => {}
        }
        let factor = match (self.height_unit, scales.height_scale) {
            (_, Some(value)) if value == 0.0 || !value.is_finite() => return Err(LengthUnitError::Scale { value }),
            (Unit::Metre, Some(_)) => return Err(LengthUnitError::HeightsInMetres),
            (Unit::Unnamed | Unit::GreyLevel | Unit::NotLength, Some(value)) => value,
            (Unit::Unnamed, None) => unit,
            // Refused above.
            (Unit::GreyLevel | Unit::NotLength, None) => return Err(LengthUnitError::GreyLevels),
            (Unit::Metre, None) => 1.0,
        };
        scale(self.heights.values_mut(), factor);
        if let Some(sides) = self.sides.as_mut().filter(|_| unnamed(self.side_unit)) {
            scale(sides, unit);
        }
        (self.height_unit, self.side_unit) = (Unit::Metre, Unit::Metre);
        Ok(self)
    }

    /// Number of points that were not measured.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.heights.values().iter().filter(|height| height.is_nan()).count()
    }

    /// Sides of the rectangle along x and y if that along x is `width` and points are equally far apart along both, as
    /// of an image.
    #[must_use]
    pub fn sides_of_width(&self, width: f64) -> [f64; 2] {
        let grid = self.heights.grid();
        [width, width * (grid.ny() as f64 / grid.nx() as f64)]
    }

    /// Distances of points along x and y, in the unit of the sides; with no sides, those of
    /// [`HeightMap::sides_of_width`] 1.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        let (grid, sides) = (self.heights.grid(), self.sides.unwrap_or_else(|| self.sides_of_width(1.0)));
        [sides[0] / grid.nx() as f64, sides[1] / grid.ny() as f64]
    }
}

/// Multiplies by `factor`, which leaves the bits alone when it is 1.
#[expect(clippy::float_cmp, reason = "a factor of exactly 1 is no change")]
pub(crate) fn scale(values: &mut [f64], factor: f64) {
    if factor != 1.0 {
        for value in values {
            *value *= factor;
        }
    }
}

/// How far a map is from periodic: the step from the last to the first row and column, against those inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderStep {
    /// Rms difference of heights across the border.
    pub border: f64,
    /// Rms difference of neighbouring heights inside.
    pub inside: f64,
}

impl BorderStep {
    /// Of a map without missing points.
    #[must_use]
    pub fn of(heights: &Field) -> Self {
        let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
        let mut sums = [(0.0, 0_usize); 2];
        let mut add = |at_border: bool, a: f64, b: f64| {
            let sum = &mut sums[usize::from(!at_border)];
            *sum = (sum.0 + (a - b) * (a - b), sum.1 + 1);
        };
        for iy in 0..ny {
            let (row, next) = (heights.row(iy), heights.row((iy + 1) % ny));
            for ix in 0..nx {
                add(ix + 1 == nx, row[ix], row[(ix + 1) % nx]);
                add(iy + 1 == ny, row[ix], next[ix]);
            }
        }
        let [border, inside] = sums.map(|(sum, n)| if n > 0 { (sum / n as f64).sqrt() } else { 0.0 });
        Self { border, inside }
    }

    /// Whether it is that of a periodic map, whose ratio is about 1: at most 3.
    #[must_use]
    pub fn is_periodic(self) -> bool {
        self.ratio() <= 3.0
    }

    /// Border over inside: about 1 for a periodic map, far more for one that was cut out of a larger surface. 1 where
    /// both are zero.
    #[must_use]
    pub fn ratio(self) -> f64 {
        if self.border == 0.0 && self.inside == 0.0 { 1.0 } else { self.border / self.inside }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid};

    use super::*;
    use crate::LengthUnit;
    use crate::Unit::{GreyLevel, Metre, NotLength, Unnamed};

    fn map(height_unit: Unit, side_unit: Unit) -> HeightMap {
        let heights = Field::new(Grid::new(2, 1).expect("a grid"), vec![1.0, 2.0]).expect("two heights");
        HeightMap { heights, height_unit, sides: Some([3.0, 4.0]), side_unit }
    }

    #[test]
    fn units_of_the_file_and_of_the_user_are_applied_once() {
        let um = Scales { unit: Some(LengthUnit::Micrometre), height_scale: None };
        let nm = Scales { height_scale: Some(1e-9), ..um };
        let none = Scales::default();
        let cases = [
            (Metre, Metre, none, Ok((1.0, 3.0))),
            (Unnamed, Unnamed, none, Ok((1.0, 3.0))),
            (Unnamed, Unnamed, um, Ok((1e-6, 3e-6))),
            (Unnamed, Unnamed, nm, Ok((1e-9, 3e-6))),
            (Metre, Unnamed, um, Ok((1.0, 3e-6))),
            (Metre, Metre, um, Err(LengthUnitError::UnitsNamed)),
            (Metre, Metre, Scales { unit: None, ..nm }, Err(LengthUnitError::HeightsInMetres)),
            (GreyLevel, Metre, none, Err(LengthUnitError::GreyLevels)),
            (GreyLevel, Unnamed, um, Err(LengthUnitError::GreyLevels)),
            (GreyLevel, Metre, nm, Err(LengthUnitError::UnitOfLevels)),
            (NotLength, Metre, none, Err(LengthUnitError::NotLength)),
            (NotLength, Metre, Scales { unit: None, ..nm }, Ok((1e-9, 3.0))),
            (GreyLevel, Unnamed, nm, Ok((1e-9, 3e-6))),
            (GreyLevel, Metre, Scales { unit: None, ..nm }, Ok((1e-9, 3.0))),
        ];
        for (heights, sides, scales, expected) in cases {
            let scaled = map(heights, sides).in_metres(scales);
            let found = scaled.map(|map| (map.heights.values()[0], map.sides.map_or(0.0, |sides| sides[0])));
            match (found, expected) {
                (Ok((height, side)), Ok((h, s))) => {
                    assert!((height / h - 1.0).abs() < 1e-15 && (side / s - 1.0).abs() < 1e-15, "{height} {side}");
                }
                (found, expected) => assert_eq!(found, expected, "{heights:?} {sides:?} {scales:?}"),
            }
        }
    }

    #[test]
    fn a_wave_is_periodic_and_a_ramp_is_not() {
        let grid = Grid::square(64).expect("a grid");
        let wave =
            BorderStep::of(&Field::from_fn(grid, |DVec2 { x, y }| (std::f64::consts::TAU * (x + 2.0 * y)).sin()));
        // Differences across the border are those at one phase, inside at all phases: within √2.
        assert!(wave.ratio() < 1.5, "ratio of a wave {}", wave.ratio());
        let ramp = BorderStep::of(&Field::from_fn(grid, |at| at.x));
        assert!(ramp.ratio() > 40.0, "ratio of a ramp {}", ramp.ratio());
    }
}
