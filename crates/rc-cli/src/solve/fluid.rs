//! A fluid that presses on the surfaces of a contact.

use rc_core::Field;
use rc_solver::UnderFluid;

/// A fluid that presses on the surfaces of a solved contact.
#[derive(Clone, Debug)]
pub struct SolvedFluid {
    /// Its pressure (Pa), as it was given.
    pub pressure: Field,
    /// The results of fluid and contact together.
    pub both: UnderFluid,
}
