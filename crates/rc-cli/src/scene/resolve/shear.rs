//! The keys of friction with partial slip.

use rc_core::quantity::engineering;
use rc_core::{DVec2, Units};
use rc_solver::{Control, ShearControl, ShearParams};

use super::checks::positive;
use super::sliding::unit_vector;
use crate::error::CliError;
use crate::scene::keys::ContactKeys;

/// What couples normal and tangential tractions of two bodies, relative to their stiffness (Dundurs' β), if it is
/// rounding.
const SMALLEST_BETA: f64 = 1e-9;

/// A shear of the solved contact.
#[derive(Clone, Debug)]
pub struct ShearSetup {
    /// Friction, shear and Poisson's ratio, in units of the solver.
    pub params: ShearParams,
    /// What is neglected, if anything.
    pub note: Option<String>,
}

/// The elastic constants that shear needs.
pub(crate) struct Coupling {
    /// Poisson's ratio of the tangential response; 0 if only E* is known.
    pub(crate) poisson: f64,
    /// Dundurs' β; `None` if only E* is known.
    pub(crate) beta: Option<f64>,
}

impl Coupling {
    /// The constants of the bodies of `keys`.
    ///
    /// With G = E/(2 (1 + ν)), the tangential response of two bodies is that of one with the mean of ν weighted by 1/G,
    /// and β is ((1 - 2ν)/G - (1 - 2ν₂)/G₂)/(2 ((1 - ν)/G + (1 - ν₂)/G₂)) (Dundurs, J. Appl. Mech. 36, 1969).
    pub(crate) fn of(keys: &ContactKeys) -> Self {
        let compliance = |young: f64, poisson: f64| 2.0 * (1.0 + poisson) / young;
        let (Some(young), Some(poisson), None) = (keys.young, keys.poisson, keys.e_star) else {
            return Self { poisson: 0.0, beta: None };
        };
        let first = (compliance(young, poisson), poisson);
        let second = keys.young2.zip(keys.poisson2).map_or((0.0, 0.0), |(e, nu)| (compliance(e, nu), nu));
        let sum = |of: fn(f64) -> f64, sign: f64| first.0 * of(first.1) + sign * second.0 * of(second.1);
        let beta = sum(|nu| 1.0 - 2.0 * nu, -1.0) / (2.0 * sum(|nu| 1.0 - nu, 1.0));
        Self { poisson: sum(|nu| nu, 1.0) / sum(|_| 1.0, 1.0), beta: Some(beta) }
    }

    /// Whether a shear does not change the pressure.
    fn is_none(&self) -> bool {
        self.beta.is_some_and(|beta| beta.abs() < SMALLEST_BETA)
    }

    /// What a shear of these bodies neglects; `None` if nothing.
    fn note(&self) -> Option<String> {
        match self.beta {
            None => Some(
                "note: E* does not tell Poisson's ratio, so the shear is that of ν = 0; give young and poisson for another"
                    .to_owned(),
            ),
            Some(_) if self.is_none() => None,
            Some(beta) => Some(format!(
                "note: the shear neglects that unlike bodies couple pressure and traction (Dundurs' β = {beta:.3})"
            )),
        }
    }
}

/// Largest coefficient of friction, beyond any that is measured.
const MAX_FRICTION: f64 = 1e3;

/// Refuses a coefficient that is not positive, or beyond any that is measured.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn check_friction(friction: f64) -> Result<(), CliError> {
    if friction > 0.0 && friction <= MAX_FRICTION {
        return Ok(());
    }
    Err(CliError::input(format_args!(
        "friction: must be above 0 and at most {MAX_FRICTION} (a coefficient such as 0.3), not {friction}"
    )))
}

/// The shear of these keys; `None` without one.
///
/// # Errors
/// [`CliError::Input`] for keys without their partners, values that cannot be, and bodies that are coupled.
pub(super) fn shear(keys: &ContactKeys, (control, units): (Control, Units)) -> Result<Option<ShearSetup>, CliError> {
    let Some(friction) = keys.friction else { return without_friction(keys) };
    check_friction(friction)?;
    let control = match (keys.shear_pressure, keys.shear_displacement) {
        (Some(shear), None) => {
            let shear = positive("shear_pressure", "Pa", Some(shear))?;
            check_limit(shear, friction, (control, units))?;
            ShearControl::MeanShear(units.pressure(shear))
        }
        (None, Some(displacement)) => {
            ShearControl::Displacement(units.length(positive("shear_displacement", "m", Some(displacement))?))
        }
        (None, None) => {
            return Err(CliError::input(
                "friction: Coulomb's coefficient belongs to a shear; give shear_pressure (Pa) or shear_displacement (m) too",
            ));
        }
        (Some(_), Some(_)) => {
            return Err(CliError::input("shear_displacement: give it or shear_pressure, not both"));
        }
    };
    let angle = keys.shear_angle.unwrap_or(0.0);
    if !angle.is_finite() {
        return Err(CliError::input(format_args!("shear_angle: must be an angle in degrees, not {angle}")));
    }
    let coupling = Coupling::of(keys);
    if let Some(beta) = coupling.beta.filter(|_| coupling.poisson != 0.0 && !coupling.is_none() && !keys.uncoupled) {
        return Err(CliError::input(format_args!(
            "friction: these bodies couple pressure and traction (Dundurs' β = {beta:.3}), which is not solved; give poisson 0.5 \
             (rubber), two like bodies (young2, poisson2) or poisson 0, or neglect the coupling with uncoupled"
        )));
    }
    let params = ShearParams { friction, control, direction: direction(keys), poisson: coupling.poisson };
    Ok(Some(ShearSetup { params, note: coupling.note() }))
}

/// The unit vector along the shear of these keys.
pub(crate) fn direction(keys: &ContactKeys) -> DVec2 {
    unit_vector(keys.shear_angle.unwrap_or(0.0))
}

/// Refuses keys of a shear without a friction.
fn without_friction(keys: &ContactKeys) -> Result<Option<ShearSetup>, CliError> {
    let given = [
        ("shear_pressure", keys.shear_pressure.is_some()),
        ("shear_displacement", keys.shear_displacement.is_some()),
        ("shear_angle", keys.shear_angle.is_some()),
        ("uncoupled", keys.uncoupled),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        None => Ok(None),
        Some((key, _)) => {
            Err(CliError::input(format_args!("{key}: a shear needs friction, Coulomb's coefficient; give it too")))
        }
    }
}

/// Refuses a shear (Pa) that the friction of the whole contact does not hold.
fn check_limit(shear: f64, friction: f64, (control, units): (Control, Units)) -> Result<(), CliError> {
    let Control::MeanPressure(load) = control else { return Ok(()) };
    let limit = friction * units.pascals(load);
    if shear < limit { Ok(()) } else { Err(slides(shear, limit)) }
}

/// The error for a shear (Pa) under which the surface slides.
pub(crate) fn slides(shear: f64, limit: f64) -> CliError {
    CliError::input(format_args!(
        "shear_pressure: {} slides as a whole, because friction holds {}; give less",
        engineering(shear, "Pa"),
        engineering(limit, "Pa")
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bodies(young: [f64; 2], poisson: [f64; 2]) -> Coupling {
        let (young2, poisson2) = (Some(young[1]).filter(|e| e.is_finite()), Some(poisson[1]));
        let poisson2 = poisson2.filter(|_| young2.is_some());
        let keys =
            ContactKeys { young: Some(young[0]), poisson: Some(poisson[0]), young2, poisson2, ..Default::default() };
        Coupling::of(&keys)
    }

    #[test]
    fn rubber_on_a_rigid_body_and_like_bodies_are_uncoupled() {
        assert!(bodies([1e6, f64::INFINITY], [0.5, 0.0]).is_none());
        assert!(bodies([1e6, 1e6], [0.3, 0.3]).is_none());
        // Steel on brass is not, and a body without lateral expansion on a rigid one has the largest β.
        let mixed = bodies([210e9, 100e9], [0.29, 0.34]);
        assert!(!mixed.is_none() && mixed.poisson > 0.29 && mixed.poisson < 0.34);
        let beta = bodies([1.0, f64::INFINITY], [0.0, 0.0]).beta;
        assert_eq!(beta, Some(0.5));
    }
}
