//! What the keys of a surface say together: its kind, its file, and how the file is read.

use std::path::Path;

use rc_heights::{ReadParams, Scales};
use rc_sweep::memory::{Budget, read_limit};

use super::SurfaceKeys;

impl SurfaceKeys {
    /// The file from which the surface is read, with its key.
    ///
    /// `None` for a random surface.
    #[must_use]
    pub fn file(&self) -> Option<(&'static str, &Path)> {
        self.files().next()
    }

    /// The files that are given for the surface, with their keys. Only one of them may be given.
    pub(crate) fn files(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let files =
            [("heights", &self.heights), ("spectrum", &self.spectrum), ("psd", &self.psd), ("like", &self.like)];
        files.into_iter().filter_map(|(key, path)| path.as_deref().map(|path| (key, path)))
    }

    /// Whether the surface is a realisation of a measured spectrum, which has a seed.
    #[must_use]
    pub fn is_realisation(&self) -> bool {
        self.psd.is_some() || self.like.is_some()
    }

    /// The known units of a height map or of coefficients.
    #[must_use]
    pub fn scales(&self) -> Scales {
        Scales { unit: self.unit, height_unit: self.height_unit, height_scale: self.height_scale }
    }

    /// How a height map is read.
    #[must_use]
    pub fn read_params(&self) -> ReadParams {
        ReadParams {
            channel: self.channel.clone(),
            layout: self.layout,
            row_is_map: self.cell.is_some() && self.cell_y.is_some(),
            is_profile: self.line,
            missing: self.missing.as_ref().map(|marks| marks.0.clone()).unwrap_or_default(),
            mask: self.mask.unwrap_or_default(),
            max_bytes: read_limit(self.read_limit),
            max_plain_bytes: Budget::new(self.read_limit).available().unwrap_or(u64::MAX),
        }
    }

    /// Whether any key says how a height map is read.
    #[must_use]
    pub fn reads_in_a_way(&self) -> bool {
        self.channel.is_some() || self.layout.is_some() || self.missing.is_some() || self.mask.is_some()
    }

    /// Whether any parameter of a self-affine spectrum is given.
    #[must_use]
    pub fn has_law(&self) -> bool {
        Self { seed: None, amplitudes: None, ..self.clone() }.generates()
    }

    /// Whether the surface is a shape and nothing else.
    #[must_use]
    pub fn is_shape(&self) -> bool {
        self.shape.is_some() && self.file().is_none() && !self.generates()
    }

    /// Whether the surface has a shape, alone or under roughness.
    #[must_use]
    pub fn has_shape(&self) -> bool {
        self.shape.is_some()
    }

    /// What is added to a surface, in a cell: a shape and another body.
    #[must_use]
    pub fn added(self) -> Self {
        let Self { cell, cell_y, shape, radius, angle, wavelength, wave_amplitude, add, .. } = self;
        Self { cell, cell_y, shape, radius, angle, wavelength, wave_amplitude, add, ..Self::default() }
    }

    /// Whether any parameter of a random surface is given.
    #[must_use]
    pub fn generates(&self) -> bool {
        let Self { waves, hurst, rms, rms_slope, c0, seed, truncation, roll_off, low_cut, amplitudes, .. } = self;
        let numbers = [hurst, rms, rms_slope, c0, roll_off, low_cut].iter().any(|key| key.is_some());
        numbers || waves.is_some() || seed.is_some() || truncation.is_some() || amplitudes.is_some()
    }
}
