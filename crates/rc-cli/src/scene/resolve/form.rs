//! The step from keys to a shape.

use rc_core::PeriodicCell;

use super::checks::positive;
use crate::error::CliError;
use crate::scene::form::{Form, FormName};
use crate::scene::keys::SurfaceKeys;

/// A parameter of shapes: its key, its unit, and its value.
type Parameter = (&'static str, &'static str, Option<f64>);

/// The shape of the keys in λ; `None` without a shape.
///
/// # Errors
/// [`CliError::Input`] for parameters that are missing, out of range, or of another shape.
pub(super) fn form(keys: &SurfaceKeys, cell: PeriodicCell) -> Result<Option<Form>, CliError> {
    let radius = ("radius", "m", keys.radius);
    let angle = ("angle", "degrees", keys.angle);
    let [wavelength, amplitude] = [("wavelength", "m", keys.wavelength), ("wave_amplitude", "m", keys.wave_amplitude)];
    let wanted: &[Parameter] = match keys.shape {
        Some(FormName::Sphere | FormName::Cylinder) => &[radius],
        Some(FormName::Cone) => &[angle],
        Some(FormName::Wave) => &[wavelength, amplitude],
        Some(FormName::Flat) | None => &[],
    };
    let of_another = |(key, _, value): &Parameter| value.is_some() && !wanted.iter().any(|(other, ..)| other == key);
    if let Some((key, ..)) = [radius, angle, wavelength, amplitude].iter().find(|parameter| of_another(parameter)) {
        let message = match keys.shape {
            None => format!("{key}: belongs to a shape; give --shape too"),
            Some(shape) => format!("{key}: does not belong to the shape {}; omit it", name(shape)),
        };
        return Err(CliError::input(message));
    }
    let Some(shape) = keys.shape else { return Ok(None) };
    let mut values = [0.0; 2];
    for (value, (key, unit, given)) in values.iter_mut().zip(wanted) {
        let missing = || CliError::input(format_args!("{key}: the shape {} needs it ({unit})", name(shape)));
        *value = positive(key, unit, Some(given.ok_or_else(missing)?))?;
    }
    let [first, second] = values;
    let side = cell.side();
    Ok(Some(match shape {
        FormName::Sphere => Form::Sphere { radius: first / side },
        FormName::Cylinder => Form::Cylinder { radius: first / side },
        FormName::Cone if first >= 90.0 => {
            return Err(CliError::input(format_args!(
                "angle: must be below 90 degrees, between the flank and the plane, not {first}"
            )));
        }
        FormName::Cone => Form::Cone { slope: first.to_radians().tan() },
        FormName::Wave => Form::Wave { amplitude: second / side, waves: whole(side / first) },
        FormName::Flat => Form::Flat,
    }))
}

/// The name of a shape in scenes.
fn name(shape: FormName) -> String {
    format!("{shape:?}").to_lowercase()
}

/// Relative distance from a whole number within which a number of waves is meant to be whole.
const ROUNDING: f64 = 1e-9;

/// The number, or the whole number that it is but for rounding.
fn whole(waves: f64) -> f64 {
    let nearest = waves.round();
    if nearest >= 1.0 && (waves / nearest - 1.0).abs() <= ROUNDING { nearest } else { waves }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file;

    fn of(text: &str) -> Result<Option<Form>, CliError> {
        form(&file::parse(text).expect("a scene").surface, PeriodicCell::new(1e-3).expect("a cell"))
    }

    #[test]
    fn parameters_arrive_in_units_of_the_cell() {
        assert_eq!(of("shape = \"sphere\"\nradius = \"10mm\""), Ok(Some(Form::Sphere { radius: 1e-2 / 1e-3 })));
        assert_eq!(of("shape = \"cylinder\"\nradius = 2e-3"), Ok(Some(Form::Cylinder { radius: 2.0 })));
        let waves = of("shape = \"wave\"\nwavelength = \"0.2mm\"\nwave_amplitude = \"1um\"").expect("a wave");
        assert_eq!(waves, Some(Form::Wave { amplitude: 1e-6 / 1e-3, waves: 5.0 }));
        let Some(Form::Cone { slope }) = of("shape = \"cone\"\nangle = \"45deg\"").expect("a cone") else {
            panic!("not a cone");
        };
        assert!((slope - 1.0).abs() < 1e-15, "{slope}");
        assert_eq!(of("shape = \"flat\""), Ok(Some(Form::Flat)));
        assert_eq!(of("cell = 1.0"), Ok(None));
    }

    #[test]
    fn a_parameter_that_is_missing_or_does_not_belong_is_named() {
        for (text, expected) in [
            ("shape = \"sphere\"", "radius: the shape sphere needs it (m)"),
            ("shape = \"wave\"\nwavelength = 1e-4", "wave_amplitude: the shape wave needs it (m)"),
            ("shape = \"sphere\"\nradius = -1.0", "radius: must be positive"),
            ("shape = \"cone\"\nangle = 90", "angle: must be below 90 degrees"),
            ("shape = \"cone\"\nangle = 5.0\nradius = 1.0", "radius: does not belong to the shape cone"),
            ("radius = 1.0", "radius: belongs to a shape; give --shape too"),
        ] {
            let error = of(text).expect_err(text).to_string();
            assert!(error.starts_with(expected), "{text}: {error}");
        }
    }
}
