//! Full contact, a linear problem in which the half-space follows the surface everywhere.
//!
//! Each wave `a_k` exp(2πi k·x) of the surface has the pressure wave ½ q `a_k`, with q = 2π|k| (the inverse of the
//! symbol 2/q). A mean pressure is added. So the solution is valid for every mean pressure at which the pressure is
//! nowhere negative, see [`smallest_mean_pressure`]. Then Δ = `h_max` for heights of zero mean.
//!
//! Source: K. L. Johnson, *Contact Mechanics*, Cambridge University Press 1985, chapter 13. Sums over waves follow from
//! Parseval's theorem.

use std::f64::consts::PI;

use rc_core::Field;

/// Amplitude of the pressure wave of a height wave, in E*: ½ q |a| = π |k| |a|.
///
/// The height wave has `wavenumber` |k| (waves per cell) and amplitude `height_amplitude` (λ).
#[must_use]
pub fn pressure_amplitude(wavenumber: f64, height_amplitude: f64) -> f64 {
    PI * wavenumber * height_amplitude
}

/// rms of the pressure about its mean, in E*.
///
/// It is half the rms slope √⟨|∇h|²⟩ for any spectrum.
#[must_use]
pub fn rms_pressure(rms_slope: f64) -> f64 {
    0.5 * rms_slope
}

/// Elastic energy per nominal area, in E* λ.
///
/// It is a quarter of the sum over all waves Σ q |`a_k`|² (in λ).
#[must_use]
pub fn energy(sum_of_q_power: f64) -> f64 {
    0.25 * sum_of_q_power
}

/// The smallest mean pressure with full contact, in E*.
///
/// It is the mean minus the minimum of the full-contact pressure at any mean. A field samples this minimum at the
/// centres of elements, so the result is slightly too low.
#[must_use]
pub fn smallest_mean_pressure(full_contact_pressure: &Field) -> f64 {
    full_contact_pressure.mean() - full_contact_pressure.min()
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::*;
    use crate::testing::{assert_close, assert_printed};
    use crate::westergaard::Westergaard;

    /// One wave A cos(2πx) is Westergaard's, with amplitudes A/2 at k = ±1.
    #[test]
    fn one_wave_is_westergaards() {
        let wave = Westergaard { amplitude: 0.03 };
        let full = wave.full_contact_pressure();
        assert_close("p^", 2.0 * pressure_amplitude(1.0, 0.015), full, 1e-15);
        assert_close("energy", energy(2.0 * 2.0 * PI * 0.015 * 0.015), wave.energy(full), 1e-15);
        let rms_slope = 2.0 * PI * 0.03 / 2.0_f64.sqrt();
        assert_close("rms pressure", rms_pressure(rms_slope), full / 2.0_f64.sqrt(), 1e-15);
    }

    #[test]
    fn full_contact_begins_when_the_deepest_point_is_loaded() {
        let wave = Westergaard { amplitude: 0.03 };
        let full = wave.full_contact_pressure();
        // An odd number, so that the trough x = ½ is the centre of an element.
        let grid = Grid::new(15, 2).expect("small");
        let pressure = Field::from_fn(grid, |at| wave.pressure(at.x, 2.0 * full));
        assert_close("p^", smallest_mean_pressure(&pressure), full, 1e-14);
    }

    /// rms stress and energy of the paper's surfaces in full contact.
    ///
    /// The stress is in MPa, and the energy per area and E* in 1e-8 m.
    #[test]
    fn the_papers_surfaces_in_full_contact() {
        let surfaces = [(0.026_232_747_0, "6.578745"), (0.030_810_458_3, "7.726761"), (0.026_990_361_7, "6.768743")];
        for (slope, stress) in surfaces {
            assert_printed("rms stress", rms_pressure(slope) * 501.567_398_119, stress);
        }
        assert_printed("energy (1e-8 m)", energy(19.325_121_3), "4.8313");
    }
}
