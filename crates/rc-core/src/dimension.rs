//! Numbers with units, as people write them: `10kPa`, `25 um`, `200GPa`, `5deg`.

use std::fmt;

/// A physical dimension of numbers that may carry a unit.
///
/// A number without a unit is in SI units, and an angle in degrees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A length (m).
    Length,
    /// A pressure or an elastic modulus (Pa).
    Pressure,
    /// A force (N).
    Force,
    /// An angle (degrees).
    Angle,
    /// A dynamic viscosity (Pa s).
    Viscosity,
}

/// How many base units one unit is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Size {
    /// 10 to this power. Such a number is read with its unit at once, so that `0.3um` is exactly 3e-7.
    Power(i32),
    /// Another factor.
    Factor(f64),
}

/// Units that have decimal prefixes.
const PREFIXED: [(&str, Dimension); 4] =
    [("m", Dimension::Length), ("Pa", Dimension::Pressure), ("N", Dimension::Force), ("Pas", Dimension::Viscosity)];

const PREFIXES: [(&str, i32); 10] =
    [("", 0), ("T", 12), ("G", 9), ("M", 6), ("k", 3), ("m", -3), ("u", -6), ("µ", -6), ("\u{3bc}", -6), ("n", -9)];

/// All other units.
const UNITS: [(&str, Dimension, Size); 16] = [
    ("cm", Dimension::Length, Size::Power(-2)),
    ("pm", Dimension::Length, Size::Power(-12)),
    ("angstrom", Dimension::Length, Size::Power(-10)),
    ("Å", Dimension::Length, Size::Power(-10)),
    ("hPa", Dimension::Pressure, Size::Power(2)),
    ("bar", Dimension::Pressure, Size::Power(5)),
    ("mbar", Dimension::Pressure, Size::Power(2)),
    ("N/m2", Dimension::Pressure, Size::Power(0)),
    ("N/m²", Dimension::Pressure, Size::Power(0)),
    ("N/mm2", Dimension::Pressure, Size::Power(6)),
    ("N/mm²", Dimension::Pressure, Size::Power(6)),
    ("cP", Dimension::Viscosity, Size::Power(-3)),
    ("P", Dimension::Viscosity, Size::Power(-1)),
    ("deg", Dimension::Angle, Size::Power(0)),
    ("°", Dimension::Angle, Size::Power(0)),
    ("rad", Dimension::Angle, Size::Factor(180.0 / std::f64::consts::PI)),
];

impl Dimension {
    /// Reads a number, with or without a unit, in SI units (an angle in degrees).
    ///
    /// # Errors
    /// One line that says what is wrong and what would be right.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        let text = text.trim();
        if let Ok(number) = text.parse() {
            return Ok(number);
        }
        let wanted = || format!("must be {self}, not '{text}'");
        let (number, unit) = text.split_at(end_of_number(text));
        let (value, unit): (f64, _) = (number.parse().map_err(|_| wanted())?, unit.trim());
        // Products are written with a blank or a dot.
        match of_unit(&unit.replace([' ', '.', '·'], "")) {
            None => Err(format!("{}; '{unit}' is not a known unit", wanted())),
            Some((other, _)) if other != self => Err(format!("{}, which is {}", wanted(), other.name())),
            Some((_, Size::Power(power))) => Ok(shifted(number, power).unwrap_or(value)),
            Some((_, Size::Factor(factor))) => Ok(value * factor),
        }
    }

    /// The dimension with its article.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Pressure => "a pressure",
            Self::Force => "a force",
            Self::Angle => "an angle",
            Self::Viscosity => "a viscosity",
        }
    }
}

/// What a value must be: `a pressure in Pa, or with a unit such as 10kPa`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "a length in m, or with a unit such as 25um",
            Self::Pressure => "a pressure in Pa, or with a unit such as 10kPa",
            Self::Force => "a force in N, or with a unit such as 20mN",
            Self::Angle => "an angle in degrees, or with a unit such as 0.1rad",
            Self::Viscosity => "a viscosity in Pa s, or with a unit such as 1mPas",
        })
    }
}

fn of_unit(unit: &str) -> Option<(Dimension, Size)> {
    let prefixed = |(base, dimension): (&str, Dimension)| {
        let prefix = unit.strip_suffix(base)?;
        let (_, power) = PREFIXES.into_iter().find(|(name, _)| *name == prefix)?;
        Some((dimension, Size::Power(power)))
    };
    let other = UNITS.into_iter().find(|(name, ..)| *name == unit).map(|(_, dimension, size)| (dimension, size));
    other.or_else(|| PREFIXED.into_iter().find_map(prefixed))
}

/// The length of the number that `text` begins with.
fn end_of_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize, others: &[u8]| {
        from + bytes[from..].iter().take_while(|byte| byte.is_ascii_digit() || others.contains(byte)).count()
    };
    let mantissa = digits(usize::from(matches!(bytes.first(), Some(b'+' | b'-'))), b".");
    if !matches!(bytes.get(mantissa), Some(b'e' | b'E')) {
        return mantissa;
    }
    let sign = usize::from(matches!(bytes.get(mantissa + 1), Some(b'+' | b'-')));
    let (first, end) = (mantissa + 1 + sign, digits((mantissa + 1 + sign).min(bytes.len()), b""));
    if end > first { end } else { mantissa }
}

/// The number times 10 to a power, rounded once. `None` for an exponent out of range.
fn shifted(number: &str, power: i32) -> Option<f64> {
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let exponent = exponent.parse::<i32>().ok()?.checked_add(power)?;
    format!("{mantissa}e{exponent}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_with_a_unit_is_the_same_number_in_si() {
        for (dimension, text, value) in [
            (Dimension::Length, "0.3um", 3e-7),
            (Dimension::Length, "25 µm", 25e-6),
            (Dimension::Length, "1.5e-3mm", 1.5e-6),
            (Dimension::Length, "1e-3", 1e-3),
            (Dimension::Length, "2Å", 2e-10),
            (Dimension::Length, "-7m", -7.0),
            (Dimension::Pressure, "10kPa", 1e4),
            (Dimension::Pressure, "200GPa", 2e11),
            (Dimension::Pressure, "3N/mm2", 3e6),
            (Dimension::Pressure, "1E1 bar", 1e6),
            (Dimension::Force, "20mN", 0.02),
            (Dimension::Force, "1MN", 1e6),
            (Dimension::Viscosity, "1 mPa s", 1e-3),
            (Dimension::Viscosity, "20cP", 0.02),
            (Dimension::Angle, "5deg", 5.0),
            (Dimension::Angle, "5", 5.0),
            (Dimension::Angle, "0.5rad", 90.0 / std::f64::consts::PI),
        ] {
            assert_eq!(dimension.parse(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn another_dimension_or_an_unknown_unit_is_named() {
        for (dimension, text, expected) in [
            (
                Dimension::Pressure,
                "5mm",
                "must be a pressure in Pa, or with a unit such as 10kPa, not '5mm', which is a length",
            ),
            (Dimension::Length, "5N", "which is a force"),
            (Dimension::Force, "1MPa", "which is a pressure"),
            (Dimension::Length, "5parsec", "'parsec' is not a known unit"),
            (Dimension::Length, "5em", "'em' is not a known unit"),
            (Dimension::Length, "1e", "'e' is not a known unit"),
            (Dimension::Pressure, "10KPa", "'KPa' is not a known unit"),
            (Dimension::Length, "mm", "must be a length"),
            (Dimension::Length, "", "must be a length"),
            (Dimension::Length, "1.2.3m", "must be a length"),
        ] {
            let error = dimension.parse(text).expect_err(text);
            assert!(error.contains(expected), "'{text}': {error}");
        }
    }
}
