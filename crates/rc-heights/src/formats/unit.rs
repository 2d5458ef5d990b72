//! Units as headers name them.

use crate::{LengthUnit, Unit};

/// What the values of a channel are in, and the factor that makes metres of lengths: an empty name is a unit that is not named, a
/// name that is no unit of length that of another quantity.
pub(super) fn of_values(name: &str) -> (Unit, f64) {
    match (name.trim(), name.parse::<LengthUnit>()) {
        ("", _) => (Unit::Unnamed, 1.0),
        (_, Ok(unit)) => (Unit::Metre, unit.metres()),
        (_, Err(_)) => (Unit::NotLength, 1.0),
    }
}

/// What coordinates are in, and the factor that makes metres of them.
pub(super) fn of_sides(name: &str) -> (Unit, f64) {
    match name.parse::<LengthUnit>() {
        Ok(unit) => (Unit::Metre, unit.metres()),
        Err(_) => (Unit::Unnamed, 1.0),
    }
}
