//! Keys that are numbers with units, on the command line and in scene files.

use std::fmt;

use rc_core::Dimension;
use rc_sweep::Loads;
use serde::de::{Deserializer, Error, Visitor};

/// The quantity of a key.
#[derive(Clone, Copy)]
enum Quantity {
    Of(Dimension),
    /// A speed (m/s), which is a length per second.
    Speed,
    /// A time (s). Its decimal prefixes are those of lengths.
    Time,
}

/// The readers of keys of one quantity, for clap and for serde.
macro_rules! readers {
    ($name:ident, $quantity:expr) => {
        pub(crate) mod $name {
            use serde::Deserializer;

            use super::Quantity;

            /// Reads a value of the command line.
            pub(crate) fn parse(text: &str) -> Result<f64, String> {
                Quantity::parse($quantity, text)
            }

            /// Reads a value of a scene file: a number, or text with a unit.
            pub(crate) fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
                super::read($quantity, deserializer).map(Some)
            }
        }
    };
}

readers!(length, Quantity::Of(rc_core::Dimension::Length));
readers!(pressure, Quantity::Of(rc_core::Dimension::Pressure));
readers!(force, Quantity::Of(rc_core::Dimension::Force));
readers!(angle, Quantity::Of(rc_core::Dimension::Angle));
readers!(viscosity, Quantity::Of(rc_core::Dimension::Viscosity));
readers!(speed, Quantity::Speed);
readers!(time, Quantity::Time);

impl Quantity {
    /// Reads a number, with or without a unit, in SI units (an angle in degrees).
    fn parse(self, text: &str) -> Result<f64, String> {
        let text = text.trim();
        let in_metres = |text: String| Dimension::Length.parse(&text).ok();
        let read = match self {
            Self::Of(dimension) => return dimension.parse(text),
            Self::Speed => text.parse().ok().or_else(|| in_metres(text.strip_suffix("/s")?.to_owned())),
            Self::Time => text.parse().ok().or_else(|| in_metres(format!("{}m", text.strip_suffix('s')?))),
        };
        read.ok_or_else(|| format!("must be {self}, not '{text}'"))
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Of(dimension) => dimension.fmt(f),
            Self::Speed => f.write_str("a speed in m/s, such as 0.1 or \"1mm/s\""),
            Self::Time => f.write_str("a time in s, such as 1e-3 or \"1ms\""),
        }
    }
}

/// Reads mean pressures of the command line.
pub(crate) fn pressures(text: &str) -> Result<Loads, String> {
    Loads::with_units(text, Dimension::Pressure)
}

/// Reads penetrations of the command line.
pub(crate) fn penetrations(text: &str) -> Result<Loads, String> {
    Loads::with_units(text, Dimension::Length)
}

/// Checks a list of speeds, or the ends of a range.
///
/// # Errors
/// One line about what is no speed.
pub(crate) fn check_speeds(text: &str) -> Result<(), String> {
    let ends: Vec<&str> = text.splitn(3, ':').collect();
    let is_range = ends.len() == 3;
    let parts = if is_range { ends[..2].to_vec() } else { text.split(',').collect() };
    for part in parts {
        let speed = speed::parse(part)?;
        if !speed.is_finite() {
            return Err(format!("must be finite speeds (m/s), not '{part}'"));
        }
        if is_range && speed <= 0.0 {
            return Err("a range must begin and end above 0 (m/s); give 0 in a list, such as 0,1mm/s,1cm/s".to_owned());
        }
    }
    Ok(())
}

/// Reads times of the command line.
pub(crate) fn times(text: &str) -> Result<Loads, String> {
    // The ends of a range, or all values.
    let n_times = if text.contains(':') { 2 } else { usize::MAX };
    let is_separator = |c: char| c == ':' || c == ',';
    let number = |(i, part): (usize, &str)| {
        if i >= n_times {
            return Ok(part.to_owned());
        }
        let time = Quantity::Time.parse(part.trim_end_matches(is_separator))?;
        if !(time > 0.0 && time.is_finite()) {
            return Err(format!("each time must be above 0 and finite (s), not {time}"));
        }
        Ok(format!("{time}{}", &part[part.trim_end_matches(is_separator).len()..]))
    };
    text.split_inclusive(is_separator).enumerate().map(number).collect::<Result<String, String>>()?.parse()
}

fn read<'de, D: Deserializer<'de>>(quantity: Quantity, deserializer: D) -> Result<f64, D::Error> {
    deserializer.deserialize_any(NumberWithUnit(quantity))
}

struct NumberWithUnit(Quantity);

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
