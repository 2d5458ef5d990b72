//! The scene: every key of a scene file.
//!
//! Each key is also a flag of the command line.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use rc_core::Boundary;
use rc_fractal::{Amplitudes, Truncation};
use rc_heights::{Layout, LengthUnit, ReadParams, Scales};
use rc_solver::Method;
use rc_sweep::memory::ByteSize;
use serde::{Deserialize, Serialize};

use super::names::{amplitudes, boundaries, methods, truncations};
use super::time_limit::TimeLimit;
use super::values::{Fraction, GridSpec, ToleranceSpec};

/// The embedded example: the paper's surface with N = 64 at σ0/E* = 8.9e-4.
///
/// It is also the source of defaults.
pub const EXAMPLE: &str = include_str!("../../assets/paper-n64.toml");

/// The rough surface: a file of heights or of waves, or the parameters of a random one (Eq. 9-14).
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = "Surface")]
pub struct SurfaceKeys {
    /// Side λ of the periodic cell (m), along x [default: that of the height map if its file says it; 0.01 of a random
    /// surface]
    #[arg(long, allow_hyphen_values = true)]
    pub cell: Option<f64>,
    /// Side of a rectangular cell along y (m), of a height map [default: that of the height map if its file says it,
    /// else that along x]
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub cell_y: Option<f64>,
    /// Height map instead of a random surface: text, .xyz, .npy, .mat, .h5, .nc, .gwy, .gsf, .grd, .ibw, .sdf, .x3p,
    /// .sur, .spm, .opd, .dat, .al3d, .plu, .plux, .vk4, 16-bit .png or .tif; positive towards the half-space
    #[arg(long, value_name = "FILE")]
    pub heights: Option<PathBuf>,
    /// Fourier coefficients instead of a random surface: text, a line of kx ky Re Im for each wave, kx and ky in waves
    /// per cell, Re and Im in m
    #[arg(long, value_name = "FILE")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<PathBuf>,
    /// Unit of the lengths of a height map that names none, or of coefficients: m, mm, um, nm [default: m]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<LengthUnit>,
    /// Height (m) of 1 in a height map that names no unit, as of one level of grey of an image, or in coefficients;
    /// goes before --unit
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    pub height_scale: Option<f64>,
    /// Channel of a height map that has several, as rc inspect lists them [default: the first with heights]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// How a text of numbers is laid out, where it could be either: matrix (a row of the map a line) or xyz (a point a
    /// line)
    #[arg(long, value_name = "matrix|xyz")]
    pub layout: Option<Layout>,
    /// N, waves per cell of the shortest wave
    #[arg(long, allow_hyphen_values = true)]
    pub waves: Option<usize>,
    /// Hurst exponent H
    #[arg(long, allow_hyphen_values = true)]
    pub hurst: Option<f64>,
    /// Rms height (m); or give --rms-slope or --c0
    #[arg(long, allow_hyphen_values = true)]
    pub rms: Option<f64>,
    /// Rms slope of the surface, instead of --rms
    #[arg(long, allow_hyphen_values = true)]
    pub rms_slope: Option<f64>,
    /// C0 of Eq. 9 (m⁴), instead of --rms
    #[arg(long, allow_hyphen_values = true)]
    pub c0: Option<f64>,
    /// Seed of the random phases
    #[arg(long, allow_hyphen_values = true)]
    pub seed: Option<u64>,
    /// Which waves take part: |k| ≤ N or max(|kx|, |ky|) ≤ N
    #[arg(long, value_parser = truncations())]
    pub truncation: Option<Truncation>,
    /// Below this number of waves per cell the spectrum is flat (1: no roll-off)
    #[arg(long, allow_hyphen_values = true)]
    pub roll_off: Option<f64>,
    /// No waves below this number of waves per cell [default: 1]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub low_cut: Option<f64>,
    /// Amplitudes exactly of the spectrum (Eq. 14), or random about it
    #[arg(long, value_parser = amplitudes())]
    pub amplitudes: Option<Amplitudes>,
    /// Finest elements per side: 512, or 512x256 along x and y [default: 32 per shortest wave; a height map has its
    /// own]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub grid: Option<GridSpec>,
}

/// The elastic half-space, the load, and how the problem is solved.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = "Contact")]
pub struct ContactKeys {
    /// Young's modulus (Pa)
    #[arg(long, allow_hyphen_values = true)]
    pub young: Option<f64>,
    /// Poisson's ratio
    #[arg(long, allow_hyphen_values = true)]
    pub poisson: Option<f64>,
    /// E* = E/(1-ν²) (Pa), instead of --young and --poisson
    #[arg(long, allow_hyphen_values = true)]
    pub e_star: Option<f64>,
    /// Mean pressure σ0 (Pa)
    #[arg(long, allow_hyphen_values = true)]
    pub pressure: Option<f64>,
    /// Penetration Δ (m), instead of --pressure
    #[arg(long, allow_hyphen_values = true)]
    pub penetration: Option<f64>,
    /// Hardness (Pa): no pressure is greater, the usual first model of plastic contact [default: none, an elastic
    /// contact]
    #[arg(long, allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardness: Option<f64>,
    /// Discretisation of the half-space: the paper's uniformly loaded square, or the Fourier symbol
    #[arg(long)]
    pub kernel: Option<KernelName>,
    /// What is beyond the heights: the same heights again, or the free surface of the half-space, for a patch
    #[arg(long, value_parser = boundaries())]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub boundary: Option<Boundary>,
    /// Thickness (m) of an elastic layer on a rigid base to which it sticks, instead of the half-space
    #[arg(long, value_name = "M", allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer_thickness: Option<f64>,
    /// Poisson's ratio of the layer [default: --poisson]
    #[arg(long, value_name = "NU", allow_hyphen_values = true)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layer_poisson: Option<f64>,
    /// How the problem is solved [default: adaptive, or uniform where that is cheaper; the summary says which and why]
    #[arg(long, value_parser = methods())]
    pub method: Option<Method>,
    /// Halve elements at the edges of contacts this many times beyond --grid (adaptive method, generated surfaces)
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub border_level: Option<usize>,
    /// Certified relative error of the pressure in the energy norm, which pits, offsets and light loads do not loosen
    /// [default: 0.01]
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true)]
    pub energy_tolerance: Option<f64>,
    /// Instead: certified tolerance relative to the peak-to-valley height, as other programs have it; or auto, an
    /// energy error well below the error of the grid
    #[arg(long, allow_hyphen_values = true)]
    pub tolerance: Option<ToleranceSpec>,
    /// Choose the grid so that the relative error of the contact area is at most this, as 0.5% or 0.005, and no finer
    /// than needed; the tolerance is auto then, unless it is given (random surfaces, instead of --grid)
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true)]
    pub area_error: Option<Fraction>,
    /// Compute the flow of a thin film through the gap too: permeance, percolation, critical constriction
    #[arg(long)]
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub leakage: bool,
    /// Write pressure and gap averaged to this many elements per side
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub output_grid: Option<GridSpec>,
}

/// How the command runs, and where its results go.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[command(next_help_heading = "Run")]
pub struct RunKeys {
    /// Folder that receives the results; without it nothing is written
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Worker threads [default: all cores]; results do not depend on it
    #[arg(long, allow_hyphen_values = true)]
    pub threads: Option<usize>,
    /// Most memory, as 500MB, 2GB or bytes: what is estimated to need more is refused before any work
    #[arg(long, value_name = "SIZE", allow_hyphen_values = true)]
    pub memory_limit: Option<ByteSize>,
    /// Most time, in seconds or as 90s, 5min, 1h: a solve that takes longer ends with what there is, marked
    /// not_converged; a sweep begins no further row
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    pub time_limit: Option<TimeLimit>,
    /// Print nothing but errors and what --json asks for
    #[arg(long)]
    #[serde(default)]
    pub quiet: bool,
    /// Print the summary as JSON, whatever else is said
    #[arg(long)]
    #[serde(default)]
    pub json: bool,
}

/// Discretisation of the half-space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum KernelName {
    /// Pressure constant on each element, displacement at its centre (Eq. 5).
    Love,
    /// The symbol 2/(E* q), as FFT codes have it.
    Spectral,
    /// A symbol that a Python program gives; only that program can repeat the result.
    #[value(skip)]
    Own,
}

/// A scene: the three groups of keys.
#[derive(Args, Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The rough surface.
    #[command(flatten)]
    pub surface: SurfaceKeys,
    /// Half-space, load, method.
    #[command(flatten)]
    pub contact: ContactKeys,
    /// Run and output.
    #[command(flatten)]
    pub run: RunKeys,
}

/// Sets each key that `upper` does not have to the value in `lower`.
macro_rules! or_lower {
    ($upper:expr, $lower:expr, { $($key:ident),+ $(,)? }) => { $( if $upper.$key.is_none() { $upper.$key = $lower.$key; } )+ };
}

impl SurfaceKeys {
    /// These keys laid over `lower`.
    ///
    /// A key given here removes its alternatives in `lower`. A height map, a file of waves and the parameters of a
    /// random surface are alternatives. So are `rms`, `rms_slope` and `c0`. A `cell` removes the other side.
    #[must_use]
    pub fn over(mut self, mut lower: Self) -> Self {
        if self.heights.is_some() {
            lower = Self { cell: lower.cell, cell_y: lower.cell_y, ..Self::default() };
        } else if self.spectrum.is_some() {
            lower = Self { cell: lower.cell, ..Self::default() };
        } else if self.generates() {
            lower = Self { heights: None, spectrum: None, unit: None, height_scale: None, cell_y: None, ..lower };
            (lower.channel, lower.layout) = (None, None);
        }
        if self.cell.is_some() {
            lower.cell_y = None;
        }
        if self.rms.is_some() || self.rms_slope.is_some() || self.c0.is_some() {
            (lower.rms, lower.rms_slope, lower.c0) = (None, None, None);
        }
        or_lower!(self, lower, {
            cell, cell_y, heights, spectrum, unit, height_scale, channel, layout, waves, hurst, rms, rms_slope, c0, seed, truncation, roll_off,
            low_cut, amplitudes, grid
        });
        self
    }

    /// The file from which the surface is read, with its key.
    ///
    /// `None` for a random surface.
    #[must_use]
    pub fn file(&self) -> Option<(&'static str, &Path)> {
        let heights = self.heights.as_deref().map(|path| ("heights", path));
        heights.or_else(|| self.spectrum.as_deref().map(|path| ("spectrum", path)))
    }

    /// The known units of a height map or of coefficients.
    #[must_use]
    pub fn scales(&self) -> Scales {
        Scales { unit: self.unit, height_scale: self.height_scale }
    }

    /// The channel and the layout to read of a height map.
    #[must_use]
    pub fn read_params(&self) -> ReadParams {
        ReadParams { channel: self.channel.clone(), layout: self.layout }
    }

    /// Whether any parameter of a random surface is given.
    #[must_use]
    pub fn generates(&self) -> bool {
        let Self { waves, hurst, rms, rms_slope, c0, seed, truncation, roll_off, low_cut, amplitudes, .. } = self;
        let numbers = [hurst, rms, rms_slope, c0, roll_off, low_cut].iter().any(|key| key.is_some());
        numbers || waves.is_some() || seed.is_some() || truncation.is_some() || amplitudes.is_some()
    }
}

impl ContactKeys {
    /// These keys laid over `lower`.
    ///
    /// A key given here removes its alternatives in `lower`. These are `pressure` and `penetration`, `tolerance` and
    /// `energy_tolerance`, and `e_star` and the pair of `young` and `poisson`.
    #[must_use]
    pub fn over(mut self, mut lower: Self) -> Self {
        if self.pressure.is_some() || self.penetration.is_some() {
            (lower.pressure, lower.penetration) = (None, None);
        }
        if self.e_star.is_some() {
            (lower.young, lower.poisson) = (None, None);
        } else if self.young.is_some() || self.poisson.is_some() {
            lower.e_star = None;
        }
        if self.tolerance.is_some() || self.energy_tolerance.is_some() {
            (lower.tolerance, lower.energy_tolerance) = (None, None);
        }
        or_lower!(self, lower, {
            young, poisson, e_star, pressure, penetration, hardness, kernel, boundary, layer_thickness, layer_poisson, method, border_level,
            energy_tolerance, tolerance, area_error, output_grid
        });
        self.leakage |= lower.leakage;
        self
    }
}

impl RunKeys {
    /// These keys laid over `lower`. `quiet` and `json` are set if either sets them.
    #[must_use]
    pub fn over(mut self, lower: Self) -> Self {
        or_lower!(self, lower, { out, threads, memory_limit, time_limit });
        self.quiet |= lower.quiet;
        self.json |= lower.json;
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

    /// Whether the scene has no key at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The scene with its relative paths taken from `folder`.
    #[must_use]
    pub fn relative_to(mut self, folder: &Path) -> Self {
        for path in [&mut self.surface.heights, &mut self.surface.spectrum, &mut self.run.out].into_iter().flatten() {
            *path = folder.join(&*path);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_upper_key_removes_its_alternatives_below() {
        let lower = Scene {
            surface: SurfaceKeys { waves: Some(8), rms: Some(1.0), cell: Some(2.0), ..Default::default() },
            contact: ContactKeys { pressure: Some(1.0), e_star: Some(3.0), ..Default::default() },
            run: RunKeys::default(),
        };
        let upper = Scene {
            surface: SurfaceKeys { c0: Some(4.0), ..Default::default() },
            contact: ContactKeys { penetration: Some(5.0), young: Some(6.0), ..Default::default() },
            run: RunKeys { json: true, ..Default::default() },
        };
        let merged = upper.over(lower);
        assert_eq!((merged.surface.c0, merged.surface.rms, merged.surface.waves), (Some(4.0), None, Some(8)));
        assert_eq!((merged.contact.penetration, merged.contact.pressure), (Some(5.0), None));
        assert_eq!((merged.contact.young, merged.contact.e_star), (Some(6.0), None));
        assert!(merged.run.json);
    }

    #[test]
    fn a_height_map_replaces_a_random_surface_and_the_reverse() {
        let map = SurfaceKeys { heights: Some("h.npy".into()), ..Default::default() };
        let random =
            SurfaceKeys { waves: Some(8), grid: Some(GridSpec::square(64)), cell: Some(2.0), ..Default::default() };
        let merged = map.clone().over(random.clone());
        assert_eq!((merged.waves, merged.grid, merged.cell), (None, None, Some(2.0)));
        let rectangle = || SurfaceKeys { cell: Some(2.0), cell_y: Some(1.0), ..Default::default() };
        let other = SurfaceKeys { cell: Some(4.0), ..Default::default() }.over(rectangle());
        assert_eq!((other.cell, other.cell_y), (Some(4.0), None), "the other side was that of another cell");
        let same = SurfaceKeys { grid: Some(GridSpec::square(64)), ..Default::default() }.over(rectangle());
        assert_eq!((same.cell, same.cell_y), (Some(2.0), Some(1.0)));
        assert_eq!(random.clone().over(map.clone()).heights, None);
        let waves = SurfaceKeys { spectrum: Some("waves.txt".into()), ..Default::default() };
        for lower in [&random, &map] {
            let merged = waves.clone().over(lower.clone());
            assert_eq!((merged.waves, merged.heights, merged.cell), (None, None, lower.cell));
            assert_eq!(lower.clone().over(waves.clone()).spectrum, None);
        }
    }
}
