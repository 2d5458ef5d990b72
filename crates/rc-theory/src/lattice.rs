//! Constants of the periodic half-space.
//!
//! They describe the displacement near a point load that is repeated on a square lattice. A unit load at every point of
//! the unit lattice, balanced by a uniform counter-load, gives v(r) = φ(r)/π (E* = 1). It has zero mean, and
//!
//! ```text
//! φ(r) = Σ_{q≠0} (2π/q) exp(iq·r) = 1/r - C + (S3/4) r² + (9/64) S5 r⁴ + (35/64) C4 r⁴ cos 4θ + …
//! ```
//!
//! This is the exact limit of the paper's Eq. 5-6. The coefficients are lattice sums over R = (i, j) ≠ 0. They factor
//! into Riemann's ζ and Dirichlet's β, Σ R^-s = 4 ζ(s/2) β(s/2) (I. J. Zucker, *Exact results for some lattice sums in
//! 2, 4, 6 and 8 dimensions*, J. Phys. A 7 (1974) 1568-1575). C is the same sum continued to s = 1, with the opposite
//! sign. The tests recompute all four constants.

/// The constant part that images and counter-load add to a point load, C = -4 ζ(1/2) β(1/2).
pub const C: f64 = 3.900_264_920_001_956;

/// The lattice sum S3 = Σ R⁻³ = 4 ζ(3/2) β(3/2).
pub const S3: f64 = 9.033_621_683_100_95;

/// The lattice sum S5 = Σ R⁻⁵ = 4 ζ(5/2) β(5/2).
pub const S5: f64 = 5.090_258_233_665_483;

/// The lattice sum C4 = Σ R⁻⁵ cos 4θ, in the first term that depends on direction.
pub const C4: f64 = 3.373_865_696_467_986_3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::assert_close;

    /// Hurwitz's ζ(s, a) by Euler-Maclaurin summation, for any s ≠ 1.
    fn hurwitz_zeta(s: f64, a: f64) -> f64 {
        // B_{2j}/(2j)! for j = 1, …, 5. With 20 leading terms the next is below 1e-18.
        let bernoulli = [1.0 / 12.0, -1.0 / 720.0, 1.0 / 30_240.0, -1.0 / 1_209_600.0, 1.0 / 47_900_160.0];
        let x = 20.0 + a;
        let leading: f64 = (0..20).rev().map(|n| (f64::from(n) + a).powf(-s)).sum();
        let mut tail = x.powf(1.0 - s) / (s - 1.0) + 0.5 * x.powf(-s);
        let mut factor = s * x.powf(-s - 1.0);
        for (j, coefficient) in bernoulli.into_iter().enumerate() {
            tail += coefficient * factor;
            let order = s + 2.0 * j as f64;
            factor *= (order + 1.0) * (order + 2.0) / (x * x);
        }
        leading + tail
    }

    fn dirichlet_beta(s: f64) -> f64 {
        4.0_f64.powf(-s) * (hurwitz_zeta(s, 0.25) - hurwitz_zeta(s, 0.75))
    }

    /// The tolerance is 1e-14, because terms of size up to 9 are subtracted for s = 1/2.
    #[test]
    fn radial_sums_factor_into_zeta_and_beta() {
        for (what, constant, s) in [("-C", -C, 0.5), ("S3", S3, 1.5), ("S5", S5, 2.5)] {
            assert_close(what, constant, 4.0 * hurwitz_zeta(s, 1.0) * dirichlet_beta(s), 1e-14);
        }
    }

    /// The remainder of the sum over discs is 1e-10 at R = 400.
    ///
    /// It decreases faster than R⁻⁴, because cos 4θ averages out.
    #[test]
    fn the_anisotropic_sum_is_its_definition() {
        let reach = 400_i32;
        let mut sum = 0.0;
        for i in (1..=reach).rev() {
            for j in (0..=reach).rev().filter(|j| i * i + j * j <= reach * reach) {
                let (x, y) = (f64::from(i * i), f64::from(j * j));
                // cos 4θ = (x⁴ - 6x²y² + y⁴)/R⁴, and a factor 4 for four quadrants.
                sum += 4.0 * (x * x - 6.0 * x * y + y * y) / (x + y).powf(4.5);
            }
        }
        assert_close("C4", C4, sum, 1e-10);
    }
}
