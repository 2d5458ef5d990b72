//! The keys of a surface that slides over a solid that relaxes.

use rc_core::quantity::{count, digits, engineering};
use rc_core::{DVec2, Grid};
use rc_kernel::{MaterialError, Relaxation};

use super::checks::missing;
use crate::error::CliError;
use crate::scene::file;
use crate::scene::keys::ContactKeys;
use crate::scene::material::{FractionalSpec, PronySpec};
use crate::scene::prony_file::PronyFile;

/// Steady sliding over a material that relaxes.
#[derive(Clone, Debug)]
pub struct SlidingSolid {
    /// The material.
    pub material: Relaxation,
    /// Speed (m/s) of the surface, at least 0.
    pub speed: f64,
    /// Direction of the speed, in degrees from the x axis to the y axis.
    pub direction: f64,
}

impl SlidingSolid {
    /// The velocity in sides of the cell per second, for the side `side` (m).
    #[must_use]
    pub fn velocity(&self, side: f64) -> DVec2 {
        self.speed / side * unit_vector(self.direction)
    }

    /// The unit vector along the velocity; `None` at rest.
    #[must_use]
    pub fn heading(&self) -> Option<DVec2> {
        (self.speed > 0.0).then(|| unit_vector(self.direction))
    }

    /// Refuses a direction across a profile, which is one row.
    pub(crate) fn check_on(&self, grid: Grid) -> Result<(), CliError> {
        if grid.ny() == 1 && unit_vector(self.direction).y != 0.0 {
            return Err(CliError::input(format_args!(
                "direction: a profile slides along x; give 0 or 180, not {}",
                self.direction
            )));
        }
        Ok(())
    }
}

/// Speed, direction and material of these keys in words; `None` without a speed.
pub(crate) fn in_words(keys: &ContactKeys) -> Option<String> {
    let speed = engineering(keys.speed?, "m/s");
    let direction = keys.direction.unwrap_or(0.0);
    let (_, material) = material(keys).ok()??;
    let times = match (&keys.prony, keys.relaxation_time, keys.fractional) {
        (Some(PronySpec::Terms(terms)), ..) => count(terms.len(), "relaxation time"),
        (_, Some(time), _) => format!("the relaxation time {}", engineering(time, "s")),
        (.., Some(solid)) => {
            format!(
                "a fractional relaxation of the exponent {} and the time {}",
                solid.alpha,
                engineering(solid.tau, "s")
            )
        }
        _ => return None,
    };
    let ratio = digits(material.glassy_ratio(), 4);
    Some(format!("{speed} along {direction}°, over a solid of {times} and the glassy ratio {ratio}"))
}

/// The unit vector at this angle (degrees), which is exact along the axes.
pub(super) fn unit_vector(degrees: f64) -> DVec2 {
    let turned = degrees.rem_euclid(360.0);
    let axes = [(0.0, DVec2::X), (90.0, DVec2::Y), (180.0, DVec2::NEG_X), (270.0, DVec2::NEG_Y)];
    let axis = axes.into_iter().find(|(angle, _)| (turned - angle).abs() <= 0.0);
    axis.map_or_else(|| DVec2::from_angle(turned.to_radians()), |(_, axis)| axis)
}

/// The keys with the terms of a Prony series in place of its file, relative to the relaxed modulus.
pub(super) fn with_terms(keys: ContactKeys) -> Result<ContactKeys, CliError> {
    let Some(PronySpec::File(path)) = &keys.prony else { return Ok(keys) };
    let PronyFile { mut terms, is_in_pascals } = PronyFile::read(path)?;
    if is_in_pascals {
        let relaxed = keys.young.filter(|young| *young > 0.0).ok_or_else(|| {
            CliError::in_file(
                path,
                "its moduli are in Pa, so the relaxed modulus must be given as young (with poisson), not as e_star",
            )
        })?;
        for [modulus, _] in &mut terms {
            *modulus /= relaxed;
        }
    }
    Ok(ContactKeys { prony: Some(PronySpec::Terms(terms)), ..keys })
}

/// The sliding solid of the keys; `None` without a speed.
///
/// # Errors
/// [`CliError::Input`] for a material without a speed, a speed without a material, and values that cannot be.
pub(super) fn solid(keys: &ContactKeys) -> Result<Option<SlidingSolid>, CliError> {
    let material = material(keys)?;
    match (keys.speed, material) {
        (None, None) if keys.direction.is_some() => {
            Err(CliError::input("direction: is that of a surface that slides; give speed (m/s) too"))
        }
        (None, None) => Ok(None),
        (Some(_), None) => Err(CliError::input(
            "speed: sliding changes nothing without a material that relaxes; give prony, or glassy_ratio and relaxation_time",
        )),
        (None, Some((key, _))) => Err(CliError::input(format_args!(
            "{key}: a material that relaxes needs speed (m/s); give it too, or a list of speeds or times in a sweep"
        ))),
        (Some(speed), Some((_, material))) => {
            check_speed(speed)?;
            let direction = keys.direction.unwrap_or(0.0);
            if !direction.is_finite() {
                return Err(CliError::input(format_args!("direction: must be an angle in degrees, not {direction}")));
            }
            Ok(Some(SlidingSolid { material, speed, direction }))
        }
    }
}

/// The material of these keys for creep at rest, and the keys with its terms.
///
/// # Errors
/// [`CliError::Input`] without a Prony series, and for a surface that slides or a hardness.
pub(crate) fn creeping(keys: &ContactKeys) -> Result<(Relaxation, ContactKeys), CliError> {
    if keys.speed.is_some() || keys.direction.is_some() {
        return Err(CliError::input("times: the surface is at rest; omit speed and direction, or times"));
    }
    if keys.substrate_young.is_some() {
        return Err(CliError::input(
            "times: a coating creeps on a substrate that does not; omit times, or substrate_young",
        ));
    }
    if keys.hardness.is_some() {
        return Err(CliError::input("times: a solid with a hardness does not creep by this rule; omit one of them"));
    }
    let defaults = ContactKeys { young: file::example().contact.young, ..ContactKeys::default() };
    let keys = with_terms(keys.clone().over(defaults))?;
    match material(&keys)? {
        Some((_, material)) if material.creep(0.0).is_some() => Ok((material, keys)),
        Some((key, _)) => Err(CliError::input(format_args!("{key}: its creep is not known; give prony"))),
        None => Err(CliError::input(
            "times: an elastic solid does not creep; give prony, or glassy_ratio and relaxation_time",
        )),
    }
}

fn check_speed(speed: f64) -> Result<(), CliError> {
    match speed {
        speed if speed < 0.0 => Err(CliError::input(format_args!(
            "speed: must be at least 0 (m/s), not {speed}; for the other way give --direction 180"
        ))),
        speed if speed <= MAX_SPEED => Ok(()),
        speed if speed.is_finite() => {
            Err(CliError::input(format_args!("speed: must be at most {MAX_SPEED:e} (m/s), not {speed:e}")))
        }
        speed => Err(CliError::input(format_args!("speed: must be a finite speed (m/s), not {speed}"))),
    }
}

/// The speed of light, about.
const MAX_SPEED: f64 = 3e8;

/// Relaxation times (s) with which no result underflows or overflows.
const TIMES: [f64; 2] = [1e-30, 1e30];

/// Refuses times (s) of a material that are beyond all that is measured.
fn check_times(key: &str, keys: &ContactKeys) -> Result<(), CliError> {
    let of_terms = match &keys.prony {
        Some(PronySpec::Terms(terms)) => terms.iter().map(|term| term[1]).collect(),
        _ => Vec::new(),
    };
    let of_fractional = keys.fractional.map(|solid| solid.tau);
    let mut times = of_terms.into_iter().chain(of_fractional).chain(keys.relaxation_time);
    match times.find(|time| !(TIMES[0]..=TIMES[1]).contains(time)) {
        None => Ok(()),
        Some(time) => Err(CliError::input(format_args!(
            "{key}: relaxation times must be from {:e} to {:e} s, not {time:e}",
            TIMES[0], TIMES[1]
        ))),
    }
}

/// Largest ratio of the glassy to the relaxed modulus. That of rubbers is up to 1e4.
const MAX_GLASSY_RATIO: f64 = 1e9;

/// The material of the keys, and the key that gives it.
fn material(keys: &ContactKeys) -> Result<Option<(&'static str, Relaxation)>, CliError> {
    let given = [
        ("prony", keys.prony.is_some()),
        ("glassy_ratio", keys.glassy_ratio.is_some()),
        ("relaxation_time", keys.relaxation_time.is_some()),
        ("fractional", keys.fractional.is_some()),
    ];
    let given: Vec<&'static str> = given.into_iter().filter_map(|(key, is_given)| is_given.then_some(key)).collect();
    let (key, found) = match given[..] {
        [] => return Ok(None),
        [key @ "prony"] => (key, of_prony(keys)?),
        [key @ "fractional"] => (key, of_fractional(keys)?),
        ["glassy_ratio"] => return Err(missing("relaxation_time")),
        ["relaxation_time"] => return Err(missing("glassy_ratio")),
        [key @ "glassy_ratio", "relaxation_time"] => {
            let [ratio, time] = [keys.glassy_ratio, keys.relaxation_time].map(|value| value.unwrap_or(f64::NAN));
            (key, Relaxation::single(ratio, time))
        }
        [first, .., last] => {
            return Err(CliError::input(format_args!(
                "{first}: is given with {last}; a solid has one material, so give one"
            )));
        }
        [key] => unreachable!("{key} is no material"),
    };
    let material = found.map_err(|cause| {
        let key =
            if matches!(cause, MaterialError::Time { .. }) && key == "glassy_ratio" { "relaxation_time" } else { key };
        CliError::input(format_args!("{key}: {cause}"))
    })?;
    check_times(if key == "glassy_ratio" { "relaxation_time" } else { key }, keys)?;
    if material.glassy_ratio() > MAX_GLASSY_RATIO {
        return Err(CliError::input(format_args!(
            "{key}: the glassy modulus is {:.1e} times the relaxed one; give a series relative to the relaxed modulus, at most {MAX_GLASSY_RATIO:e}",
            material.glassy_ratio()
        )));
    }
    if keys.young2.is_some() || keys.poisson2.is_some() {
        return Err(CliError::input(format_args!("young2: the other body is rigid; omit young2, or {key}")));
    }
    Ok(Some((key, material)))
}

fn of_prony(keys: &ContactKeys) -> Result<Result<Relaxation, MaterialError>, CliError> {
    match &keys.prony {
        Some(PronySpec::Terms(terms)) if terms.is_empty() => {
            Err(CliError::input("prony: has no terms; give pairs (g, tau)"))
        }
        Some(PronySpec::Terms(terms)) => Ok(Relaxation::prony(terms)),
        _ => Err(CliError::input("prony: the file has not been read")),
    }
}

fn of_fractional(keys: &ContactKeys) -> Result<Result<Relaxation, MaterialError>, CliError> {
    let FractionalSpec { alpha, glassy_ratio, tau } = keys.fractional.ok_or_else(|| missing("fractional"))?;
    Ok(Relaxation::fractional(alpha, glassy_ratio, tau))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_exact() {
        for (angle, expected) in [(0.0, DVec2::X), (90.0, DVec2::Y), (180.0, DVec2::NEG_X), (-90.0, DVec2::NEG_Y)] {
            assert_eq!(unit_vector(angle), expected);
        }
        assert!((unit_vector(45.0) - DVec2::splat(0.5_f64.sqrt())).length() < 1e-15);
    }
}
