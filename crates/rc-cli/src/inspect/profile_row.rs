//! A row of the spectra of a profile, in SI units.

use serde::Serialize;

/// A row of the spectra.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct ProfileRow {
    /// q (rad/m).
    pub(super) wavenumber: f64,
    /// C1 (m³) of the profile: ⟨h²⟩ = 2 ∫ C1 dq over q > 0.
    pub(super) psd_profile: f64,
    /// C (m⁴) of the isotropic surface with such profiles.
    pub(super) psd: f64,
}
