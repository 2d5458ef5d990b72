//! A height map.

use rc_core::Field;

use crate::{LengthUnitError, ReadNote, Scales, Unit};

/// Heights on a measured rectangle, positive out of the material.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// Heights. `NaN` where nothing was measured.
    pub heights: Field,
    /// Unit of the heights.
    pub height_unit: Unit,
    /// Sides of the rectangle along x and y, or `None` if unknown.
    ///
    /// A side is the number of points times their distance. Some files do not contain the sides.
    pub sides: Option<[f64; 2]>,
    /// Unit of the sides.
    pub side_unit: Unit,
    /// Height of the number 1 in the file, in the unit of the heights.
    ///
    /// It is 1 for numbers as they are in the file, and a length in metres for a format or a file that names a unit.
    pub number: f64,
    /// What a reader did beyond copying numbers, and what it had to assume.
    pub notes: Vec<ReadNote>,
}

impl HeightMap {
    /// A map without notes.
    #[must_use]
    pub fn new(heights: Field, height_unit: Unit, sides: Option<[f64; 2]>, side_unit: Unit) -> Self {
        Self { heights, height_unit, sides, side_unit, number: 1.0, notes: Vec::new() }
    }

    /// A map without sides, from an array. Its heights are in metres unless the user gives a unit.
    #[must_use]
    pub fn bare(heights: Field) -> Self {
        Self::new(heights, Unit::Array, None, Unit::Unnamed)
    }

    /// The same map, whose heights are numbers of the file times `number`.
    #[must_use]
    pub fn of_numbers(self, number: f64) -> Self {
        Self { number, ..self }
    }

    /// The same map with one more note.
    #[must_use]
    pub fn with_note(mut self, note: ReadNote) -> Self {
        self.notes.push(note);
        self
    }

    /// The same map with heights and sides in metres.
    ///
    /// Units that the file does not name are taken from `scales`, and are metres if `scales` does not give them. Values
    /// that are not scaled keep their bits.
    ///
    /// # Errors
    /// [`LengthUnitError`] when levels of grey have no scale, or when `scales` gives a unit that the file names.
    pub fn in_metres(mut self, scales: Scales) -> Result<Self, LengthUnitError> {
        let scales = match scales {
            Scales { height_unit: Some(_), height_scale: Some(_), .. } => return Err(LengthUnitError::TwoScales),
            // Levels of grey and other quantities have a scale, but no unit.
            Scales { height_unit: Some(unit), .. } if unnamed(self.height_unit) || self.height_unit == Unit::Metre => {
                Scales { height_unit: None, height_scale: Some(unit.metres()), ..scales }
            }
            scales => scales,
        };
        let unit = scales.unit.map_or(1.0, crate::LengthUnit::metres);
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
            (Unit::Unnamed | Unit::Array | Unit::GreyLevel | Unit::NotLength, Some(value)) => value,
            (Unit::Unnamed | Unit::Array, None) => unit,
            // These cases are refused above.
            (Unit::GreyLevel | Unit::NotLength, None) => return Err(LengthUnitError::GreyLevels),
            (Unit::Metre, None) => 1.0,
        };
        scale(self.heights.values_mut(), factor);
        if self.height_unit == Unit::Unnamed && scales == Scales::default() {
            self.notes.push(ReadNote::HeightsAssumedMetres);
        }
        if let Some(sides) = self.sides.as_mut().filter(|_| unnamed(self.side_unit)) {
            scale(sides, unit);
            if scales.unit.is_none() && self.side_unit == Unit::Unnamed {
                self.notes.push(ReadNote::SidesAssumedMetres);
            }
        }
        (self.height_unit, self.side_unit) = (Unit::Metre, Unit::Metre);
        Ok(self)
    }

    /// Whether the file gives the sides without a unit, and nothing else named one.
    ///
    /// Such sides were taken as metres by [`HeightMap::in_metres`]. A size that the user gives is better.
    #[must_use]
    pub fn sides_are_assumed(&self) -> bool {
        self.notes.contains(&ReadNote::SidesAssumedMetres)
    }

    /// Number of points that were not measured.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.heights.values().iter().filter(|height| height.is_nan()).count()
    }

    /// Sides of the rectangle along x and y for the side `width` along x.
    ///
    /// Points have equal distances along x and y, as in an image.
    #[must_use]
    pub fn sides_of_width(&self, width: f64) -> [f64; 2] {
        let grid = self.heights.grid();
        [width, width * (grid.ny() as f64 / grid.nx() as f64)]
    }

    /// Distances of points along x and y, in the unit of the sides.
    ///
    /// Without sides, they are those of [`HeightMap::sides_of_width`] 1.
    #[must_use]
    pub fn spacing(&self) -> [f64; 2] {
        let (grid, sides) = (self.heights.grid(), self.sides.unwrap_or_else(|| self.sides_of_width(1.0)));
        [sides[0] / grid.nx() as f64, sides[1] / grid.ny() as f64]
    }
}

/// Whether a number is a length whose unit the user may give.
fn unnamed(unit: Unit) -> bool {
    matches!(unit, Unit::Unnamed | Unit::Array)
}

/// Multiplies values by `factor`. A factor of 1 does not change any bit.
#[expect(clippy::float_cmp, reason = "a factor of exactly 1 is no change")]
pub(crate) fn scale(values: &mut [f64], factor: f64) {
    if factor != 1.0 {
        for value in values {
            *value *= factor;
        }
    }
}

/// Deviation of a map from periodicity.
///
/// It compares the step from the last to the first row and column with the steps inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorderStep {
    /// rms difference of heights across the border.
    pub border: f64,
    /// rms difference of neighbouring heights inside.
    pub inside: f64,
}

impl BorderStep {
    /// The steps of a map without missing points.
    #[must_use]
    pub fn of(heights: &Field) -> Self {
        let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
        let (mut border, mut inside) = (0.0, 0.0);
        for iy in 0..ny {
            let (row, next) = (heights.row(iy), heights.row((iy + 1) % ny));
            inside += squares(&row[..nx - 1], &row[1..]);
            border += squares(&row[nx - 1..], &row[..1]);
            let along_y = squares(row, next);
            *(if iy + 1 == ny { &mut border } else { &mut inside }) += along_y;
        }
        let rms = |sum: f64, n: usize| if n > 0 { (sum / n as f64).sqrt() } else { 0.0 };
        let (border, inside) = (rms(border, nx + ny), rms(inside, (nx - 1) * ny + nx * (ny - 1)));
        Self { border, inside }
    }

    /// Whether the steps are those of a periodic map. Their ratio is at most 3 then.
    #[must_use]
    pub fn is_periodic(self) -> bool {
        self.ratio() <= 3.0
    }

    /// Ratio of the step at the border to the step inside.
    ///
    /// It is about 1 for a periodic map, and much larger for a map that was cut out of a larger surface. It is 1 if
    /// both steps are zero.
    #[must_use]
    pub fn ratio(self) -> f64 {
        if self.border == 0.0 && self.inside == 0.0 { 1.0 } else { self.border / self.inside }
    }
}

/// The sum of squared differences, as eight sums that a processor computes at once.
fn squares(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    for (a, b) in a.chunks(8).zip(b.chunks(8)) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += (a - b) * (a - b);
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use rc_core::{DVec2, Grid};

    use super::*;
    use crate::LengthUnit;
    use crate::Unit::{GreyLevel, Metre, NotLength, Unnamed};

    fn map(height_unit: Unit, side_unit: Unit) -> HeightMap {
        let heights = Field::new(Grid::new(2, 1).expect("a grid"), vec![1.0, 2.0]).expect("two heights");
        HeightMap::new(heights, height_unit, Some([3.0, 4.0]), side_unit)
    }

    #[test]
    fn units_of_the_file_and_of_the_user_are_applied_once() {
        let um = Scales { unit: Some(LengthUnit::Micrometre), ..Scales::default() };
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
        // Differences across the border have one phase, and differences inside have all phases. The ratio is within √2.
        assert!(wave.ratio() < 1.5, "ratio of a wave {}", wave.ratio());
        let ramp = BorderStep::of(&Field::from_fn(grid, |at| at.x));
        assert!(ramp.ratio() > 40.0, "ratio of a ramp {}", ramp.ratio());
    }
}
