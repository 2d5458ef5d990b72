//! Keys laid over other keys: flags over a scene file, and both over the example.

use super::{ContactKeys, RunKeys, Scene, SurfaceKeys};

/// Sets each key that `upper` does not have to the value in `lower`.
macro_rules! or_lower {
    ($upper:expr, $lower:expr, { $($key:ident),+ $(,)? }) => { $( if $upper.$key.is_none() { $upper.$key = $lower.$key; } )+ };
}

impl SurfaceKeys {
    /// These keys laid over `lower`.
    ///
    /// A key given here removes its alternatives in `lower`. A height map, a file of waves, a measured spectrum and the
    /// parameters of a random surface are alternatives; a seed alone is that of a measured spectrum in `lower`. So are
    /// `rms`, `rms_slope` and `c0`. A `cell` removes the other side, and a `shape` another shape. What is added to a
    /// surface stays when another surface takes its place.
    #[must_use]
    pub fn over(mut self, mut lower: Self) -> Self {
        if self.heights.is_some() || self.like.is_some() {
            lower = lower.added();
        } else if self.spectrum.is_some() || self.psd.is_some() {
            lower = Self { cell_y: None, ..lower.added() };
        } else if self.has_law() || self.generates() && !lower.is_realisation() {
            (lower.psd, lower.psd_convention, lower.like, lower.heights_like) = (None, None, None, None);
            lower = Self { heights: None, spectrum: None, unit: None, height_scale: None, cell_y: None, ..lower };
            (lower.channel, lower.layout, lower.height_unit) = (None, None, None);
            (lower.missing, lower.mask, lower.line) = (None, None, false);
        }
        if self.cell.is_some() {
            lower.cell_y = None;
        }
        if self.rms.is_some() || self.rms_slope.is_some() || self.c0.is_some() {
            (lower.rms, lower.rms_slope, lower.c0) = (None, None, None);
        }
        if self.shape.is_some() && self.shape != lower.shape {
            (lower.shape, lower.radius, lower.angle) = (None, None, None);
            (lower.wavelength, lower.wave_amplitude) = (None, None);
        }
        or_lower!(self, lower, {
            shape, radius, angle, wavelength, wave_amplitude, add, cell, cell_y, heights, spectrum, psd, psd_convention, like, heights_like, unit, height_unit, height_scale, missing, mask, channel, layout, waves, hurst, rms, rms_slope,
            c0, seed, truncation, roll_off, low_cut, amplitudes, grid, read_limit
        });
        self.line |= lower.line;
        self
    }
}

impl ContactKeys {
    /// These keys laid over `lower`.
    ///
    /// A key given here removes its alternatives in `lower`. These are `pressure`, `penetration`, `force` and `history`,
    /// `tolerance` and `energy_tolerance`, `e_star` and the moduli and ratios that it contains, the two kinds of shear, and the materials that
    /// relax.
    #[must_use]
    pub fn over(mut self, mut lower: Self) -> Self {
        if self.n_loads() > 0 {
            (lower.pressure, lower.penetration, lower.force) = (None, None, None);
            (lower.history, lower.history_steps) =
                (None, if self.history.is_some() { lower.history_steps } else { None });
        }
        if self.e_star.is_some() {
            (lower.young, lower.poisson, lower.young2, lower.poisson2) = (None, None, None, None);
        } else if self.young.is_some() || self.poisson.is_some() {
            lower.e_star = None;
        }
        if self.prony.is_some() || self.fractional.is_some() {
            lower = lower.elastic();
        } else if self.glassy_ratio.is_some() || self.relaxation_time.is_some() {
            (lower.prony, lower.fractional) = (None, None);
        }
        if self.shear_pressure.is_some() || self.shear_displacement.is_some() {
            (lower.shear_pressure, lower.shear_displacement) = (None, None);
        }
        if self.tolerance.is_some() || self.energy_tolerance.is_some() {
            (lower.tolerance, lower.energy_tolerance) = (None, None);
        }
        or_lower!(self, lower, {
            young, poisson, young2, poisson2, e_star, pressure, penetration, force, hardness, history, history_steps, fluid_pressure, speed, direction, prony, glassy_ratio, relaxation_time, fractional, friction, shear_pressure, shear_displacement, shear_angle, conductivity, jump_distance, kernel, boundary, layer_thickness, layer_poisson, substrate_young, substrate_poisson, method, border_level,
            energy_tolerance, tolerance, area_error, viscosity, pressure_drop, output_grid, precision
        });
        self.leakage |= lower.leakage;
        self.elements |= lower.elements;
        self.uncoupled |= lower.uncoupled;
        self
    }
}

impl ContactKeys {
    /// These keys without a material that relaxes.
    #[must_use]
    pub fn elastic(self) -> Self {
        Self { prony: None, glassy_ratio: None, relaxation_time: None, fractional: None, ..self }
    }

    /// The keys of the material that relaxes alone.
    pub(crate) fn relaxing(self) -> Self {
        let Self { prony, glassy_ratio, relaxation_time, fractional, .. } = self;
        Self { prony, glassy_ratio, relaxation_time, fractional, ..Self::default() }
    }
}

impl RunKeys {
    /// These keys laid over `lower`. `quiet`, `json` and `strict` are set if either sets them.
    #[must_use]
    pub fn over(mut self, lower: Self) -> Self {
        or_lower!(self, lower, { out, threads, memory_limit, time_limit });
        self.quiet |= lower.quiet;
        self.json |= lower.json;
        self.strict |= lower.strict;
        self
    }
}

impl Scene {
    /// This scene laid over `lower`, group by group.
    #[must_use]
    pub fn over(self, mut lower: Self) -> Self {
        if self.contact.area_error.is_some() {
            lower.surface.grid = None;
        } else if self.surface.grid.is_some() {
            lower.contact.area_error = None;
        }
        Self {
            surface: self.surface.over(lower.surface),
            contact: self.contact.over(lower.contact),
            run: self.run.over(lower.run),
        }
    }
}
