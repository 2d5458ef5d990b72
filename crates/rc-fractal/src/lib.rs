//! Periodic self-affine rough surfaces and their statistics.
//!
//! The crate has spectra, phases, synthesis, exact moments and estimators of spectra. The surface of the paper's
//! appendix A is a sum of waves on the unit cell,
//!
//! ```text
//! h(x) = Σ_k a_k exp(2πi k·x),    a_{-k} = conj(a_k),  a_00 = 0                              (Eq. 10)
//! ⟨|a_k|²⟩ = (2π)² C(q),          C(q) = C0 (max(|k|, k_r) / k_r)^(-2(1+H)),   q = 2πk        (Eq. 1, 9, 12, 13)
//! ```
//!
//! The wave vectors k = (kx, ky) are integers (waves per cell). H is the Hurst exponent. C is constant (the plateau)
//! below `k_r`, the roll-off wavenumber. The paper has `k_r` = 1, so there is no constant part. N =
//! [`SpectrumParams::waves`] is the largest wavenumber. Eq. 12 contains a Dirac delta δ(0). In a periodic cell of side
//! λ it is 1/q0² with q0 = 2π/λ. This gives the factor (2π)² for λ = 1. C is in λ⁴, a in λ.
//!
//! [`Surface`] is a realisation of such a spectrum, or the sum of given waves ([`Surface::from_waves`]). The phase of a
//! wave depends only on the seed and on k. A seed therefore gives the same surface on every grid. Surfaces with
//! different N share their long waves.
//!
//! The other functions measure surfaces. [`Surface::moments`] needs no grid. [`moments_of_grid`] and
//! [`radial_spectrum`] take any height map.
//!
//! ```
//! use rc_core::Grid;
//! use rc_fractal::{SpectrumParams, Surface};
//!
//! let surface = Surface::new(&SpectrumParams::paper(64, 1))?;
//! assert!((surface.moments().rms_slope - 0.026_232_747_0).abs() < 1e-10);
//! let heights = surface.sample_on(Grid::square(256)?)?;
//! assert!((heights.rms() / 1.3e-3 - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bins;
mod draws;
mod gaussian;
mod hurst;
mod law;
mod moments;
mod params;
mod power;
mod profile;
mod radial;
mod roughness;
mod surface;
mod table;
mod texture;
mod twin;
mod waves;

pub use bins::{Limit, Measured};
pub use gaussian::gaussian_mean_line;
pub use hurst::{HurstFit, fit_hurst};
pub use moments::{Moments, height_and_slope_of_grid, height_and_slope_of_patch, moments_of_grid};
pub use params::{Amplitudes, MAX_WAVES, Normalisation, SpectrumError, SpectrumParams, Truncation};
pub use profile::{LEAST_POINTS, ProfileSpectrumRow, spectra_of_profile, spectrum_of_profile};
pub use radial::{SpectrumBin, radial_spectrum};
pub use rc_fft::Complex64;
pub use surface::{SampleError, Surface};
pub use table::{SpectrumTable, TableError};
pub use texture::{Aspect, Texture};
pub use twin::{Twin, TwinParams};
pub use waves::{Wave, WaveError};
