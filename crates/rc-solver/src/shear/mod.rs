//! Partial slip: a shear force on bodies that have been pressed together.
//!
//! The bodies are uncoupled, so the pressure is that of the normal contact. The tangential traction t obeys |t| ≤ μp.
//! [`door`] solves a second normal contact, whose difference to the first one gives t (Ciavarella, J. Mech. Phys. Solids
//! 46, 1998; Jäger, Arch. Appl. Mech. 68, 1998). [`rounds`] corrects t where Poisson's ratio matters or the second solve
//! is not accurate enough, and [`certificate`] bounds its error.

pub(crate) mod door;
pub(crate) mod error;
pub(crate) mod params;
pub(crate) mod solution;

mod certificate;
mod discs;
mod operator;
mod problem;
mod response;
mod rounds;
