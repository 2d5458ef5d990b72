//! Units of length, as written in files and by users.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use thiserror::Error;

/// A unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthUnit {
    /// m.
    Metre,
    /// cm.
    Centimetre,
    /// mm.
    Millimetre,
    /// µm.
    Micrometre,
    /// nm.
    Nanometre,
    /// Å.
    Angstrom,
    /// pm.
    Picometre,
}

impl LengthUnit {
    /// Every unit with its names and its length in m. rc writes the first name.
    const ALL: [(Self, &[&str], f64); 7] = [
        (Self::Metre, &["m", "metre", "metres", "meter", "meters"], 1.0),
        (Self::Centimetre, &["cm", "centimetre", "centimetres", "centimeter", "centimeters"], 1e-2),
        (Self::Millimetre, &["mm", "millimetre", "millimetres", "millimeter", "millimeters"], 1e-3),
        (
            Self::Micrometre,
            &["um", "µm", "μm", "micron", "microns", "micrometre", "micrometres", "micrometer", "micrometers"],
            1e-6,
        ),
        (Self::Nanometre, &["nm", "nanometre", "nanometres", "nanometer", "nanometers"], 1e-9),
        (Self::Angstrom, &["angstrom", "Å", "Å", "A", "angstroms", "ångström"], 1e-10),
        (Self::Picometre, &["pm", "picometre", "picometres", "picometer", "picometers"], 1e-12),
    ];

    /// Length of the unit in m.
    #[must_use]
    pub fn metres(self) -> f64 {
        Self::ALL.iter().find(|(unit, ..)| *unit == self).map_or(1.0, |(.., metres)| *metres)
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(Self::ALL.iter().find(|(unit, ..)| unit == self).map_or("m", |(_, names, _)| names[0]))
    }
}

impl Serialize for LengthUnit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for LengthUnit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

impl FromStr for LengthUnit {
    type Err = LengthUnitError;

    fn from_str(text: &str) -> Result<Self, LengthUnitError> {
        let name = text.trim();
        // `mm` and `Mm` are different units. Long names may have any case.
        let long = name.to_lowercase();
        let is = |other: &&str| *other == name || other.len() > 4 && *other == long;
        let unit = Self::ALL.iter().find(|(_, names, _)| names.iter().any(is));
        unit.map(|(unit, ..)| *unit).ok_or_else(|| LengthUnitError::Unknown { name: text.trim().to_owned() })
    }
}

/// Meaning of a number in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Metres, as the format or the file says.
    Metre,
    /// A length in a unit that the file does not name.
    Unnamed,
    /// A number of an array (`.npy`, memory), which is in metres by definition unless the user gives a unit.
    Array,
    /// A level of grey.
    GreyLevel,
    /// A quantity that is not a length, such as a phase or a voltage.
    ///
    /// The channel was chosen by its name.
    NotLength,
}

/// Units from the user, for a file that does not name its units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scales {
    /// The unit of coordinates, and of heights if neither of the other two is given.
    pub unit: Option<LengthUnit>,
    /// The unit of heights, where it is another one.
    pub height_unit: Option<LengthUnit>,
    /// The height (m) of the number 1, or of one level of grey.
    pub height_scale: Option<f64>,
}

/// A unit that is unknown or not applicable.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum LengthUnitError {
    /// The name is not that of a unit of length.
    #[error("'{name}' is not a unit of length; give m, cm, mm, um, nm, angstrom or pm")]
    Unknown {
        /// The name as written.
        name: String,
    },
    /// Levels of grey have no scale.
    #[error("levels of grey have no unit; give height_scale, the height (m) of one level")]
    GreyLevels,
    /// Values are not lengths and have no scale.
    #[error(
        "the values of this channel are not lengths; give height_scale, the height (m) of the value 1, or pick another channel"
    )]
    NotLength,
    /// A scale is zero or not finite.
    #[error("height_scale: must be finite (m) and different from 0, not {value}")]
    Scale {
        /// The scale as given.
        value: f64,
    },
    /// A unit and a scale are given for the same heights.
    #[error("height_unit and height_scale both say how long the height 1 is; give one of them")]
    TwoScales,
    /// A scale is given for heights that are in metres already.
    #[error("the file names the unit of its heights; omit height_scale and height_unit")]
    HeightsInMetres,
    /// A unit is given for levels of grey on a map without a size.
    #[error("unit: levels of grey have no unit, and height_scale (m) gives their height; omit unit")]
    UnitOfLevels,
    /// A unit is given for values that are not lengths, on a map without a size.
    #[error(
        "unit: the values of this channel are not lengths; height_scale is the height (m) of the value 1, so omit unit, or pick another channel"
    )]
    UnitOfNotLength,
    /// A unit is given for a file that names its units.
    #[error("unit: the file names its units; omit unit")]
    UnitsNamed,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_reads_back_as_it_is_written_and_all_names_are_read() {
        for (unit, names, metres) in LengthUnit::ALL {
            assert_eq!(unit.to_string().parse(), Ok(unit));
            for name in names {
                assert_eq!(name.parse::<LengthUnit>().map(LengthUnit::metres), Ok(metres), "{name}");
            }
        }
        for (name, metres) in [("Meters", 1.0), ("Micrometer", 1e-6), ("nanometres", 1e-9)] {
            assert_eq!(name.parse::<LengthUnit>().map(LengthUnit::metres), Ok(metres), "{name}");
        }
        assert!("Mm".parse::<LengthUnit>().is_err() && "NM".parse::<LengthUnit>().is_err());
        assert!("V".parse::<LengthUnit>().is_err(), "a volt is no length");
    }
}
