//! The prescribed quantity: mean pressure or penetration.

use rc_core::Units;

/// The control of a contact problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Mean pressure σ0, in E*. The penetration is a result.
    MeanPressure(f64),
    /// Penetration Δ, in λ. The mean pressure is a result.
    ///
    /// Δ is the maximum displacement v under the rough surface (Sec. 2).
    Penetration(f64),
}

impl Control {
    /// Control by a mean pressure in Pa.
    #[must_use]
    pub fn pascals(mean_pressure: f64, units: Units) -> Self {
        Self::MeanPressure(units.pressure(mean_pressure))
    }

    /// Control by a penetration in m.
    #[must_use]
    pub fn metres(penetration: f64, units: Units) -> Self {
        Self::Penetration(units.length(penetration))
    }
}
