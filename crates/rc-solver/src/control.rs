//! What is prescribed: mean pressure or penetration.

use rc_core::Units;

/// The control of a contact problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Mean pressure σ0, in E*; the penetration is a result.
    MeanPressure(f64),
    /// Penetration Δ, in λ (Sec. 2: the greatest displacement v under the rough surface); the mean pressure is a
    /// result.
    Penetration(f64),
}

impl Control {
    /// A mean pressure in Pa.
    #[must_use]
    pub fn pascals(mean_pressure: f64, units: Units) -> Self {
        Self::MeanPressure(units.pressure(mean_pressure))
    }

    /// A penetration in m.
    #[must_use]
    pub fn metres(penetration: f64, units: Units) -> Self {
        Self::Penetration(units.length(penetration))
    }
}
