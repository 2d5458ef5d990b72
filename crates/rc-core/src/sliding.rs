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

/// What a sliding surface makes of the compliance of a wave along x: J0 + Σ J/(1 - i q ℓ).
///
/// Lengths are in any unit. With ℓ > 0 the displacement at x follows the pressure at larger x. With ℓ < 0 it follows
/// that at smaller x. J0 and all J of a solid are not negative.
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingCompliance {
    /// J0, the part that follows at once.
    pub instantaneous: f64,
    /// Pairs of J and ℓ.
    pub modes: Vec<[f64; 2]>,
}

impl SlidingCompliance {
    /// The compliance of a wave of `q` radians per unit of length along x.
    #[must_use]
    pub fn at(&self, q: f64) -> Complex64 {
        let modes = self.modes.iter().map(|&[part, length]| part / Complex64::new(1.0, -q * length));
        self.instantaneous + modes.sum::<Complex64>()
    }

    /// The same, with lengths in another unit.
    #[must_use]
    pub fn in_units_of(&self, unit: f64) -> Self {
        let modes = self.modes.iter().map(|&[part, length]| [part, length / unit]).collect();
        Self { instantaneous: self.instantaneous, modes }
    }
}

impl SlidingCompliance {
    /// The factor of -⟨p ∂u⟩, the force against a velocity along x, without modes of lengths below `shortest`.
    ///
    /// ∂u of a mode is (F - 1) L p/ℓ, with F p the exponential average of p, and ⟨p ∂L p⟩ = 0. So the force is ⟨p G L p⟩
    /// with G = Σ J/|ℓ| (1 - 1/(1 - i q ℓ)). Only the symmetric part of G matters, which is the same for both
    /// directions of the velocity.
    #[must_use]
    pub fn dissipation(&self, shortest: f64) -> Self {
        let long = self.modes.iter().filter(|[_, length]| length.abs() >= shortest);
        let modes: Vec<[f64; 2]> = long.map(|&[part, length]| [-part / length.abs(), length]).collect();
        Self { instantaneous: -modes.iter().map(|[part, _]| part).sum::<f64>(), modes }
    }
}

/// A solid of finitely many retardation times under a surface that slides along x.
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingModes {
    /// The compliance J~ = 1/E~ of a wave, relative to that of the relaxed solid. Lengths are in λ.
    pub compliance: SlidingCompliance,
    /// The inverse 1/Re E~ of the storage modulus: a real factor, as lengths come in pairs ℓ and -ℓ of the same part.
    pub storage: SlidingCompliance,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dissipation_is_the_lag_times_the_wavenumber() {
        let compliance = SlidingCompliance { instantaneous: 0.2, modes: vec![[0.5, 0.1], [0.75, 3.0]] };
        let dissipation = compliance.dissipation(1e-3);
        for q in [0.0, 0.3, -7.0, 200.0] {
            let expected = q * compliance.at(q).im;
            assert!((dissipation.at(q).re - expected).abs() < 1e-12 * (1.0 + expected), "{q}");
        }
        assert_eq!(compliance.dissipation(1.0).modes, [[-0.25, 3.0]]);
    }
}
