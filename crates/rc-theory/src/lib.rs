//! Closed forms of contact mechanics with their sources, for comparison with numerical solutions.
//!
//! Units are those of all libraries of this workspace. Lengths are in λ and pressures in E*, so forces are in E* λ² and
//! energies in E* λ³. Shapes are those of the rigid body, with heights up towards the half-space. Penetration Δ is
//! counted from first touch. It follows the convention of Eq. 3, a displacement of zero mean, unless a type says that
//! its half-space is infinite.
//!
//! | module | contact | valid |
//! |---|---|---|
//! | [`hertz`] | sphere, on an infinite half-space and in the periodic cell | exact; contact radius up to 0.25 λ |
//! | [`elliptic`] | ellipsoidal peak on an infinite half-space | exact |
//! | [`cone`] | cone on an infinite half-space | exact |
//! | [`thin_layer`] | sphere on a layer bonded to a rigid base | layer thin relative to the contact |
//! | [`hunter`] | cylinder that slides over a viscoelastic half-plane | exact for one relaxation time |
//! | [`westergaard`] | one-dimensional wave | exact at every load |
//! | [`bisinusoidal`] | two-dimensional wave | both ends of the load range |
//! | [`full_contact`] | any band-limited surface | exact, above a load |
//! | [`persson`] | random surface, Eq. 7 | a theory, not exact in partial contact |
//! | [`persson_gap`] | mean gap of a random surface at low loads | a theory; not near first touch, because its surface has no highest point |
//!
//! [`partial_slip`] makes shear curves from any load curve, for friction under a tangential force. Module [`lattice`] has the constants of the periodic half-space.
//!
//! ```
//! use rc_theory::hertz::{Hertz, PeriodicHertz};
//! use rc_theory::persson::Persson;
//!
//! // A sphere of radius λ, pressed until the contact has the radius λ/10. Its copies hardly change its load.
//! let (free, periodic) = (Hertz { radius: 1.0 }, PeriodicHertz { radius: 1.0 });
//! let contact = periodic.at_contact_radius(0.1)?;
//! assert!((contact.load / free.load(0.1) - 1.0).abs() < 0.02);
//! assert!((contact.peak_pressure / free.peak_pressure(0.1) - 1.0).abs() < 0.02);
//!
//! // Contact area of a random surface with rms slope 0.03 at σ0 = 1e-3 E*: κ σ0/slope with κ = 1.6.
//! let area = Persson::from_rms_slope(1e-3, 0.03).area_fraction();
//! assert!((area / (Persson::KAPPA * 1e-3 / 0.03) - 1.0).abs() < 1e-3);
//! # Ok::<(), rc_theory::OutOfRange>(())
//! ```

use thiserror::Error;

pub mod bisinusoidal;
pub mod cone;
pub mod elliptic;
pub mod full_contact;
pub mod hertz;
pub mod hunter;
pub mod lattice;
pub mod partial_slip;
pub mod persson;
pub mod persson_gap;
pub mod thin_layer;
pub mod westergaard;

mod root;

#[cfg(test)]
mod testing;

/// An argument for which the formula has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{quantity} {value:e} is out of range: it must be between 0 and {max:e}")]
pub struct OutOfRange {
    /// Name of the quantity.
    pub quantity: &'static str,
    /// The value as given.
    pub value: f64,
    /// The maximum value with an answer.
    pub max: f64,
}

/// Returns the value if it is in [0, `max`]. `NaN` is not.
fn within(quantity: &'static str, value: f64, max: f64) -> Result<f64, OutOfRange> {
    if (0.0..=max).contains(&value) { Ok(value) } else { Err(OutOfRange { quantity, value, max }) }
}
