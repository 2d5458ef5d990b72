//! Keys that are numbers with units, on the command line and in scene files.

use std::fmt;

use rc_core::Dimension;
use rc_sweep::Loads;
use serde::de::{Deserializer, Error, Visitor};

/// The readers of keys of one dimension, for clap and for serde.
macro_rules! readers {
    ($name:ident, $dimension:expr) => {
        pub(crate) mod $name {
            use rc_core::Dimension;
            use serde::Deserializer;

            /// Reads a value of the command line.
            pub(crate) fn parse(text: &str) -> Result<f64, String> {
                Dimension::parse($dimension, text)
            }

            /// Reads a value of a scene file: a number, or text with a unit.
            pub(crate) fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
                super::read($dimension, deserializer).map(Some)
            }
        }
    };
}

readers!(length, Dimension::Length);
readers!(pressure, Dimension::Pressure);
readers!(force, Dimension::Force);
readers!(angle, Dimension::Angle);
readers!(viscosity, Dimension::Viscosity);

/// Reads mean pressures of the command line.
pub(crate) fn pressures(text: &str) -> Result<Loads, String> {
    Loads::with_units(text, Dimension::Pressure)
}

/// Reads penetrations of the command line.
pub(crate) fn penetrations(text: &str) -> Result<Loads, String> {
    Loads::with_units(text, Dimension::Length)
}

fn read<'de, D: Deserializer<'de>>(dimension: Dimension, deserializer: D) -> Result<f64, D::Error> {
    deserializer.deserialize_any(NumberWithUnit(dimension))
}

struct NumberWithUnit(Dimension);

impl Visitor<'_> for NumberWithUnit {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The message begins with "must be".
        fmt::Display::fmt(&self.0, f)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<f64, E> {
        self.0.parse(value).map_err(E::custom)
    }
}
