//! Shear of a contact with partial slip, in SI units.

use rc_core::Units;
use rc_solver::ShearInfo;
use serde::{Deserialize, Serialize};

/// Keys of a summary for a contact that is sheared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShearSummary {
    /// Coulomb's coefficient of friction, which was given.
    pub coulomb_friction: f64,
    /// Shear force per nominal area, along the direction of shear (Pa).
    pub shear_pressure: f64,
    /// Shear force on the cell (N).
    pub shear_force: f64,
    /// Tangential displacement of the bodies far from the contact (m).
    pub shear_displacement: f64,
    /// Area where the surfaces stick, relative to the nominal area.
    pub stick_area_fraction: f64,
    /// Area where they slip, relative to the nominal area.
    pub slip_area_fraction: f64,
    /// Stiffness dτ/dd before slip begins (Pa/m). It is null in full contact, where it is infinite.
    pub tangential_stiffness: Option<f64>,
    /// Energy of the cell that slip dissipates (J).
    pub slip_work: f64,
    /// Bound √(G/U) of the relative error of the tractions in the energy norm, for this pressure.
    pub shear_error: f64,
    /// Rounds of projected gradients that corrected the difference of two normal contacts.
    pub shear_rounds: usize,
    /// What the shear neglects, if anything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_note: Option<String>,
}

impl ShearSummary {
    /// The keys of a solved shear.
    #[must_use]
    pub fn of(info: &ShearInfo, units: Units, shear_note: Option<String>) -> Self {
        let shear_pressure = units.pascals(info.mean_shear);
        let stiffness = units.pascals_per_metre(info.stiffness);
        Self {
            coulomb_friction: info.friction,
            shear_pressure,
            shear_force: shear_pressure * units.cell().nominal_area(),
            shear_displacement: units.metres(info.displacement),
            stick_area_fraction: info.stick_area,
            slip_area_fraction: info.slip_area,
            tangential_stiffness: Some(stiffness).filter(|value| value.is_finite()),
            slip_work: units.joules(info.slip_work),
            shear_error: info.error,
            shear_rounds: info.rounds,
            shear_note,
        }
    }
}
