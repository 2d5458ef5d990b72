//! Units as written in headers.

use super::fields::refused;
use crate::{Format, FormatError, LengthUnit, Unit};

/// The unit of length with a given name. `A` is an ampere in files.
pub(super) fn length(name: &str) -> Option<LengthUnit> {
    name.parse().ok().filter(|_| name.trim() != "A")
}

/// Unit of the values of a channel, and the factor that converts lengths to metres.
///
/// An empty name means a unit that is not given. A name that is not a unit of length belongs to another quantity.
pub(super) fn of_values(name: &str) -> (Unit, f64) {
    match (name.trim(), length(name)) {
        ("", _) => (Unit::Unnamed, 1.0),
        (_, Some(unit)) => (Unit::Metre, unit.metres()),
        (_, None) => (Unit::NotLength, 1.0),
    }
}

/// Unit of coordinates, and the factor that converts them to metres.
///
/// An empty name means a unit that is not given.
///
/// # Errors
/// [`FormatError::Field`] when the name belongs to another quantity.
pub(super) fn of_sides(format: Format, field: &'static str, name: &str) -> Result<(Unit, f64), FormatError> {
    match of_values(name) {
        (Unit::NotLength, _) => Err(refused(format, field, name.trim(), "a unit of length, as m")),
        unit => Ok(unit),
    }
}

/// The factors of two sides and their common unit. A unit that only one side has applies to both.
pub(super) fn of_both([x, y]: [(Unit, f64); 2]) -> ([f64; 2], Unit) {
    match (x.0, y.0) {
        (Unit::Metre, Unit::Metre) => ([x.1, y.1], Unit::Metre),
        (Unit::Metre, _) => ([x.1; 2], Unit::Metre),
        (_, Unit::Metre) => ([y.1; 2], Unit::Metre),
        _ => ([1.0; 2], Unit::Unnamed),
    }
}

/// Whether channels in these units can be heights.
///
/// These are the channels that are lengths. If no channel is a length by its unit, they are the channels without a
/// unit.
pub(super) fn are_heights(units: &[Unit]) -> Vec<bool> {
    let wanted = if units.contains(&Unit::Metre) { Unit::Metre } else { Unit::Unnamed };
    units.iter().map(|unit| *unit == wanted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_other_quantities_are_not_lengths() {
        assert_eq!(of_values("A"), (Unit::NotLength, 1.0), "an ampere");
        assert_eq!(of_values("meters"), (Unit::Metre, 1.0));
        assert_eq!(of_values(" "), (Unit::Unnamed, 1.0));
        let error = of_sides(Format::Ibw, "unit of x", "degrees_east").expect_err("an angle").to_string();
        assert!(error.contains("unit of x is 'degrees_east'"), "{error}");
        assert_eq!(of_both([(Unit::Unnamed, 1.0), (Unit::Metre, 1e-6)]), ([1e-6; 2], Unit::Metre));
    }

    #[test]
    fn a_named_length_goes_before_a_unit_that_is_not_named() {
        assert_eq!(are_heights(&[Unit::Unnamed, Unit::NotLength, Unit::Metre]), [false, false, true]);
        assert_eq!(are_heights(&[Unit::Unnamed, Unit::NotLength]), [true, false]);
    }
}
