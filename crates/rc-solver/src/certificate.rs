//! The certificate: how far a pressure is from solving the contact problem.

/// Residuals of a contact solution, from a fresh application of L on the returned pressure.
///
/// With g the gap shifted so that its pressure-weighted mean is 0, and H = h_max - h_min.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Σ p (g - min g) / (H Σ p).
    pub complementarity: f64,
    /// max(-g) / H.
    pub penetration: f64,
    /// |mean p - σ0| / σ0 under pressure control, |deviation of Δ| / H under penetration control.
    pub load: f64,
}

impl Certificate {
    /// Bound on [`Certificate::load`] in a solution that counts as converged.
    pub const LOAD_TOLERANCE: f64 = 1e-10;
}

impl std::fmt::Display for Certificate {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { complementarity, penetration, load } = self;
        write!(
            f,
            "complementarity error {complementarity:.2e}, penetration error {penetration:.2e}, load error {load:.2e}"
        )
    }
}
