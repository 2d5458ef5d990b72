//! The parameters of a spectrum, and their ranges.

use thiserror::Error;

/// Maximum of [`SpectrumParams::waves`], 4096.
///
/// Such a surface holds 26 million (disc) or 34 million (square) complex amplitudes, about half a gigabyte.
pub const MAX_WAVES: usize = 4096;

/// Set of wave vectors of a spectrum with N waves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Truncation {
    /// |k| ≤ N, "Fourier components up to q1 = N q0" (below Eq. 1).
    ///
    /// This set is isotropic. It is the default of this project.
    Disc,
    /// max(|kx|, |ky|) ≤ N, the double sum of Eq. 10 as written.
    ///
    /// The slope is 2.9 % larger at N = 64 and H = 0.8.
    Square,
}

/// Distribution of |`a_k`| about its mean square of Eq. 13.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Amplitudes {
    /// |`a_k`| is its root mean square in every realisation (Eq. 14, Dirac's delta).
    ///
    /// All realisations have the same moments.
    Fixed,
    /// `a_k` is complex Gaussian, so |`a_k`| follows Rayleigh's distribution.
    ///
    /// The surface is truly Gaussian. Phases are the same as for [`Amplitudes::Fixed`] with the same seed.
    Random,
}

/// Quantity that determines the size of the heights. Every value must be positive and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Normalisation {
    /// rms height √⟨h²⟩ of this realisation, in λ.
    RmsHeight(f64),
    /// rms slope √⟨|∇h|²⟩ of this realisation.
    RmsSlope(f64),
    /// Prefactor C0 of Eq. 1 and 9, in λ⁴.
    ///
    /// ⟨|`a_k`|²⟩ of the ensemble is (2π)² C0 up to the roll-off wavenumber (at |k| = 1 without roll-off). With
    /// [`Amplitudes::Random`] a realisation scatters about this value.
    C0(f64),
}

/// The spectrum of a surface, and the seed of one realisation. All lengths are in λ.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpectrumParams {
    /// N, the largest wavenumber in waves per cell, from 1 to [`MAX_WAVES`].
    pub waves: usize,
    /// Hurst exponent H in (0, 1]. The fractal dimension is 3 - H.
    pub hurst: f64,
    /// Wavenumber `k_r` in [1, N] (waves per cell) below which the spectrum is flat.
    ///
    /// 1 means that no part of the spectrum is flat.
    pub roll_off: f64,
    /// Wavenumber in [1, N] (waves per cell) below which there are no waves.
    ///
    /// 1 means that no waves are missing. The plateau of a roll-off lies between this wavenumber and `roll_off`.
    #[cfg_attr(feature = "serde", serde(default = "no_cut"))]
    pub low_cut: f64,
    /// Set of wave vectors.
    pub truncation: Truncation,
    /// Distribution of the |`a_k`|.
    pub amplitudes: Amplitudes,
    /// Size of the heights.
    pub normalisation: Normalisation,
    /// Seed of the realisation. Any number is as good as any other.
    pub seed: u64,
}

/// A spectrum that cannot be realised.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SpectrumError {
    /// N is 0 or above [`MAX_WAVES`].
    #[error("a surface needs 1 to {MAX_WAVES} waves, not {waves}")]
    Waves {
        /// N as given.
        waves: usize,
    },
    /// H is outside (0, 1].
    #[error("the Hurst exponent must be above 0 and at most 1, not {hurst}")]
    Hurst {
        /// H as given.
        hurst: f64,
    },
    /// The roll-off is below one wave per cell or beyond the shortest wave.
    #[error("the roll-off wavenumber must be between 1 and the number of waves ({waves}), not {roll_off}")]
    RollOff {
        /// `k_r` as given.
        roll_off: f64,
        /// N.
        waves: usize,
    },
    /// The low cut is below one wave per cell or beyond the shortest wave.
    #[error("the lowest wavenumber must be between 1 and the number of waves ({waves}), not {low_cut}")]
    LowCut {
        /// The wavenumber as given.
        low_cut: f64,
        /// N.
        waves: usize,
    },
    /// The value of a normalisation is not positive and finite.
    #[error("the {what} must be positive and finite, not {value}")]
    Normalisation {
        /// Name of the normalisation.
        what: &'static str,
        /// The value given.
        value: f64,
    },
}

impl SpectrumParams {
    /// The paper's surface with `waves` waves (64 or 128 in the paper).
    ///
    /// H = 0.8, no roll-off, disc, fixed amplitudes, rms height 13 µm in a cell of 1 cm, that is 1.3e-3 λ.
    #[must_use]
    pub fn paper(waves: usize, seed: u64) -> Self {
        Self {
            waves,
            hurst: 0.8,
            roll_off: 1.0,
            low_cut: 1.0,
            truncation: Truncation::Disc,
            amplitudes: Amplitudes::Fixed,
            normalisation: Normalisation::RmsHeight(1.3e-3),
            seed,
        }
    }

    /// Checks all parameters. `NaN` is refused for each of them.
    pub(crate) fn validate(&self) -> Result<(), SpectrumError> {
        let &Self { waves, hurst, roll_off, low_cut, .. } = self;
        if !(1..=MAX_WAVES).contains(&waves) {
            return Err(SpectrumError::Waves { waves });
        }
        if !(hurst > 0.0 && hurst <= 1.0) {
            return Err(SpectrumError::Hurst { hurst });
        }
        if !(1.0..=waves as f64).contains(&roll_off) {
            return Err(SpectrumError::RollOff { roll_off, waves });
        }
        if !(1.0..=waves as f64).contains(&low_cut) {
            return Err(SpectrumError::LowCut { low_cut, waves });
        }
        let (what, value) = match self.normalisation {
            Normalisation::RmsHeight(value) => ("rms height", value),
            Normalisation::RmsSlope(value) => ("rms slope", value),
            Normalisation::C0(value) => ("spectrum prefactor C0", value),
        };
        if value > 0.0 && value.is_finite() { Ok(()) } else { Err(SpectrumError::Normalisation { what, value }) }
    }

    /// Largest ky of the waves with this kx (at most N).
    pub(crate) fn reach(&self, kx: usize) -> usize {
        match self.truncation {
            Truncation::Disc => (self.waves * self.waves - kx * kx).isqrt(),
            Truncation::Square => self.waves,
        }
    }

    /// √(C(q)/C0) of the power law, Eq. (1), for a given |k|².
    ///
    /// It is (max(|k|, `k_r`)/`k_r`)^(-(1+H)), and 0 below the low cut.
    pub(crate) fn relative_amplitude(&self, k_squared: f64) -> f64 {
        if k_squared < self.low_cut * self.low_cut {
            return 0.0;
        }
        let beyond_plateau = (k_squared / (self.roll_off * self.roll_off)).max(1.0);
        beyond_plateau.powf(-0.5 * (1.0 + self.hurst))
    }
}

/// The low cut of data that were written before this field existed.
#[cfg(feature = "serde")]
fn no_cut() -> f64 {
    1.0
}
