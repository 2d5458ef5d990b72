//! What is prescribed: mean pressure or penetration.

/// The control of a contact problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    /// Mean pressure σ0, in E*; the penetration is a result.
    MeanPressure(f64),
    /// Penetration Δ, in λ (Sec. 2: the greatest displacement v under the rough surface); the mean pressure is a result.
    Penetration(f64),
}
