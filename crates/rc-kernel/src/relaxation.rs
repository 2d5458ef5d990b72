//! Linear viscoelastic materials: how the modulus relaxes.
//!
//! All moduli are relative to the relaxed modulus E∞. Poisson's ratio does not relax.

use rc_core::Complex64;
use thiserror::Error;

/// A material whose modulus relaxes from a glassy value to 1.
///
/// A Prony series has E(t)/E∞ = 1 + Σ g exp(-t/τ), the convention of Abaqus and of dynamic mechanical analysis. Its
/// complex modulus is E~(ω)/E∞ = 1 + Σ g (-iωτ)/(1 - iωτ), for a time factor exp(-iωt).
#[derive(Clone, Debug, PartialEq)]
pub struct Relaxation(Kind);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// Pairs of g and τ, in increasing order of τ.
    Prony(Vec<[f64; 2]>),
    Fractional {
        alpha: f64,
        glassy_ratio: f64,
        time: f64,
    },
}

/// A material that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum MaterialError {
    /// A term of a Prony series is not positive and finite.
    #[error("term {term}: a modulus of {modulus} and a relaxation time of {time} must both be positive and finite")]
    Term {
        /// Number of the term, from 1 on.
        term: usize,
        /// g.
        modulus: f64,
        /// τ.
        time: f64,
    },
    /// The glassy modulus is not above the relaxed one.
    #[error(
        "a glassy ratio of {value}; the glassy modulus is larger than the relaxed one, so it is above 1 and finite"
    )]
    GlassyRatio {
        /// The ratio.
        value: f64,
    },
    /// A relaxation time is not positive and finite.
    #[error("a relaxation time of {value} must be positive and finite")]
    Time {
        /// The time.
        value: f64,
    },
    /// The exponent of a fractional element is not in (0, 1].
    #[error("an exponent alpha of {value} must be above 0 and at most 1")]
    Exponent {
        /// The exponent.
        value: f64,
    },
}

impl Relaxation {
    /// A Prony series of pairs (g, τ), with g relative to the relaxed modulus. Without a term the material is elastic.
    ///
    /// Terms of the same τ are one term.
    ///
    /// # Errors
    /// [`MaterialError::Term`].
    pub fn prony(terms: &[[f64; 2]]) -> Result<Self, MaterialError> {
        let is_positive = |value: f64| value > 0.0 && value.is_finite();
        for (i, &[modulus, time]) in terms.iter().enumerate() {
            if !is_positive(modulus) || !is_positive(time) {
                return Err(MaterialError::Term { term: i + 1, modulus, time });
            }
        }
        let mut sorted = terms.to_vec();
        sorted.sort_by(|a, b| a[1].total_cmp(&b[1]));
        let mut merged: Vec<[f64; 2]> = Vec::new();
        for [g, tau] in sorted {
            match merged.last_mut() {
                Some([sum, last]) if last.to_bits() == tau.to_bits() => *sum += g,
                _ => merged.push([g, tau]),
            }
        }
        Ok(Self(Kind::Prony(merged)))
    }

    /// One relaxation time, with the ratio E0/E∞ of the glassy to the relaxed modulus.
    ///
    /// # Errors
    /// [`MaterialError::GlassyRatio`] and [`MaterialError::Time`].
    pub fn single(glassy_ratio: f64, time: f64) -> Result<Self, MaterialError> {
        check(glassy_ratio, time)?;
        Self::prony(&[[glassy_ratio - 1.0, time]])
    }

    /// The fractional Zener solid, E~/E∞ = 1 + (E0/E∞ - 1) x/(1 + x) with x = (-iωτ)^α.
    ///
    /// # Errors
    /// [`MaterialError`].
    pub fn fractional(alpha: f64, glassy_ratio: f64, time: f64) -> Result<Self, MaterialError> {
        if !(alpha > 0.0 && alpha <= 1.0) {
            return Err(MaterialError::Exponent { value: alpha });
        }
        check(glassy_ratio, time)?;
        Ok(Self(Kind::Fractional { alpha, glassy_ratio, time }))
    }

    /// E~(ω)/E∞. The real part is the storage modulus; the imaginary part is minus the loss modulus for ω > 0.
    #[must_use]
    pub fn modulus(&self, omega: f64) -> Complex64 {
        // The square of a larger number would overflow in the division.
        let element = |x: Complex64| if x.norm() < 1e100 { x / (1.0 + x) } else { 1.0.into() };
        match &self.0 {
            Kind::Prony(terms) => {
                let term = |&[g, tau]: &[f64; 2]| g * element(Complex64::new(0.0, -omega * tau));
                1.0 + terms.iter().map(term).sum::<Complex64>()
            }
            Kind::Fractional { alpha, glassy_ratio, time } => {
                let angle = -omega.signum() * alpha * std::f64::consts::FRAC_PI_2;
                let x = Complex64::from_polar((omega * time).abs().powf(*alpha), angle);
                1.0 + (glassy_ratio - 1.0) * element(x)
            }
        }
    }

    /// J~(ω) = E∞/E~(ω).
    #[must_use]
    pub fn compliance(&self, omega: f64) -> Complex64 {
        self.modulus(omega).inv()
    }

    /// Pairs of g and τ of a Prony series, in increasing order of τ. `None` if the material is not one.
    pub(crate) fn prony_terms(&self) -> Option<&[[f64; 2]]> {
        match &self.0 {
            Kind::Prony(terms) => Some(terms),
            Kind::Fractional { .. } => None,
        }
    }

    /// E0/E∞, the ratio of the glassy to the relaxed modulus.
    #[must_use]
    pub fn glassy_ratio(&self) -> f64 {
        match &self.0 {
            Kind::Prony(terms) => 1.0 + terms.iter().map(|[g, _]| g).sum::<f64>(),
            Kind::Fractional { glassy_ratio, .. } => *glassy_ratio,
        }
    }

    /// The ratio of loss to storage modulus at an angular frequency.
    #[must_use]
    pub fn loss_tangent(&self, omega: f64) -> f64 {
        let modulus = self.modulus(omega);
        -omega.signum() * modulus.im / modulus.re
    }
}

fn check(glassy_ratio: f64, time: f64) -> Result<(), MaterialError> {
    if !(glassy_ratio > 1.0 && glassy_ratio.is_finite()) {
        return Err(MaterialError::GlassyRatio { value: glassy_ratio });
    }
    if !(time > 0.0 && time.is_finite()) {
        return Err(MaterialError::Time { value: time });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_modulus_goes_from_relaxed_to_glassy() {
        let materials = [
            Relaxation::prony(&[[3.0, 1e-3], [5.0, 1.0], [1.0, 1e-3]]).expect("a series"),
            Relaxation::single(10.0, 0.1).expect("one time"),
            Relaxation::fractional(0.4, 10.0, 0.1).expect("a fractional solid"),
        ];
        for material in materials {
            assert!((material.modulus(0.0) - 1.0).norm() < 1e-15);
            let glassy = material.glassy_ratio();
            assert!((glassy - 10.0).abs() < 1e-14);
            for fast in [1e40, 1e120, 1e305, f64::INFINITY] {
                assert!((material.modulus(fast) - glassy).norm() < 1e-12 * glassy, "{material:?} at {fast}");
            }
            for omega in [1e-3, 1.0, 20.0, 1e4] {
                let modulus = material.modulus(omega);
                assert!(modulus.re > 1.0 && modulus.im < 0.0, "{material:?} at {omega}: {modulus}");
                assert!((material.modulus(-omega) - modulus.conj()).norm() < 1e-15 * glassy);
            }
        }
        // A fractional solid of exponent 1 is that of one relaxation time.
        let [one, other] = [Relaxation::fractional(1.0, 4.0, 0.3), Relaxation::single(4.0, 0.3)].map(Result::unwrap);
        assert!((one.modulus(7.0) - other.modulus(7.0)).norm() < 1e-14);
    }

    #[test]
    fn what_cannot_relax_is_refused() {
        for terms in [[[0.0, 1.0]], [[1.0, 0.0]], [[-1.0, 1.0]], [[f64::NAN, 1.0]], [[1.0, f64::INFINITY]]] {
            assert!(matches!(Relaxation::prony(&terms), Err(MaterialError::Term { term: 1, .. })), "{terms:?}");
        }
        assert!(Relaxation::single(1.0, 1.0).is_err() && Relaxation::single(2.0, -1.0).is_err());
        assert!(Relaxation::fractional(1.1, 2.0, 1.0).is_err());
    }
}
