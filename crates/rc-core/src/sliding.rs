//! A surface that slides over a material that relaxes.

use std::sync::Arc;

use glam::DVec2;
use num_complex::Complex64;

/// A material's compliance at an angular frequency, relative to its relaxed compliance: J~(ω) = E∞/E~(ω), J~(0) = 1.
pub type Compliance = Arc<dyn Fn(f64) -> Complex64 + Send + Sync>;

/// Steady sliding: the velocity of the surface over the solid, and the compliance of the solid.
///
/// In the frame of the surface, a point of the solid passes the wave exp(i q·x) with the angular frequency q·v. A
/// material that relaxes like exp(-t/τ) has the factor 1/(1 - iωτ), so that the displacement at a place follows the
/// pressure at places ahead of it.
#[derive(Clone)]
pub struct Sliding {
    velocity: DVec2,
    compliance: Compliance,
}

impl Sliding {
    /// Sliding with this velocity, in λ per unit of time, over a material with this compliance.
    #[must_use]
    pub fn new(velocity: DVec2, compliance: Compliance) -> Self {
        Self { velocity, compliance }
    }

    /// The velocity of the surface, in λ per unit of time.
    #[must_use]
    pub fn velocity(&self) -> DVec2 {
        self.velocity
    }

    /// J~ of the wave exp(i q·x), with q in radians per λ.
    #[must_use]
    pub fn compliance(&self, q: DVec2) -> Complex64 {
        (self.compliance)(q.dot(self.velocity))
    }
}

impl std::fmt::Debug for Sliding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sliding").field("velocity", &self.velocity).finish_non_exhaustive()
    }
}
