//! Surfaces of waves that come from a file: Fourier coefficients, or a tabulated spectrum.

use std::io;
use std::path::Path;
use std::sync::Arc;

use rc_fractal::{Complex64, Moments, Surface, Wave};
use rc_heights::spectrum::{self, Coefficient};
use rc_heights::{LengthUnit, Scales, pairs};

use super::keys::SurfaceKeys;
use crate::error::CliError;
use crate::files::names::{PSD_FILE, WAVES_FILE};

/// The content of a file and its surface.
///
/// The content is kept as read, since a result is repeated bit for bit only from it.
#[derive(Clone, Debug)]
pub struct WaveFile {
    content: Content,
    surface: Arc<Surface>,
}

#[derive(Clone, Debug)]
enum Content {
    Coefficients(Vec<Coefficient>),
    /// Wavenumbers (rad/m) and spectrum (m⁴) in the convention of the keys.
    Spectrum(Vec<[f64; 2]>),
}

impl WaveFile {
    /// Reads the coefficients in `path`.
    ///
    /// `scales` tells the height of the number 1, `max_bytes` limits the memory, and `side` is λ (m).
    ///
    /// # Errors
    /// [`CliError::Input`] when the file cannot be read, or its waves do not make a surface.
    pub(super) fn read(path: &Path, (scales, max_bytes): (Scales, u64), side: f64) -> Result<Self, CliError> {
        let one = scales.height_scale.unwrap_or_else(|| scales.unit.map_or(1.0, LengthUnit::metres));
        if !(one.is_finite() && one != 0.0) {
            return Err(CliError::input(format_args!(
                "height_scale: must be finite (m) and different from 0, not {one}"
            )));
        }
        let coefficients = spectrum::read_within(path, max_bytes)?;
        let wave = |&Coefficient { kx, ky, re, im }: &Coefficient| Wave { kx, ky, amplitude: Complex64::new(re, im) };
        let surface = Surface::from_waves(coefficients.iter().map(wave).collect());
        let surface = surface.map_err(|cause| CliError::in_file(path, cause))?.scaled(one / side);
        let Moments { rms_height, rms_slope, .. } = surface.moments();
        if ![rms_height, rms_slope].iter().all(|moment| moment.is_finite() && *moment > 0.0) {
            let message =
                format_args!("an rms height of {rms_height:e} cell sides is out of range; check cell and unit");
            return Err(CliError::in_file(path, message));
        }
        Ok(Self { content: Content::Coefficients(coefficients), surface: Arc::new(surface) })
    }

    /// A realisation of the spectrum in `rows` (rad/m, m⁴).
    pub(super) fn of_spectrum(rows: Vec<[f64; 2]>, surface: Surface) -> Self {
        Self { content: Content::Spectrum(rows), surface: Arc::new(surface) }
    }

    /// The surface on the unit cell.
    #[must_use]
    pub fn surface(&self) -> &Arc<Surface> {
        &self.surface
    }

    /// Name of the file in a result folder.
    #[must_use]
    pub(crate) fn name(&self) -> &'static str {
        match self.content {
            Content::Coefficients(_) => WAVES_FILE,
            Content::Spectrum(_) => PSD_FILE,
        }
    }

    /// The keys of a surface from this file in a result folder; `keys` are its other keys.
    #[must_use]
    pub(super) fn keys(&self, keys: SurfaceKeys) -> SurfaceKeys {
        let path = Some(self.name().into());
        match self.content {
            Content::Coefficients(_) => SurfaceKeys { spectrum: path, ..keys },
            Content::Spectrum(_) => SurfaceKeys { psd: path, like: None, ..keys },
        }
    }

    /// Writes the content as it was read.
    ///
    /// # Errors
    /// Errors of the file system.
    pub(crate) fn write(&self, path: &Path) -> io::Result<()> {
        match &self.content {
            Content::Coefficients(coefficients) => spectrum::write(path, coefficients),
            Content::Spectrum(rows) => pairs::write(path, "q (rad/m), C (m^4)", rows),
        }
    }
}
