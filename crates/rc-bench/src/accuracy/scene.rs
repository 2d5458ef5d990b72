//! Random scenes on which error bars are tested.

use anyhow::Result;
use rc_core::{DVec2, HeightField, Kernel};
use rc_kernel::{FreeLove, Layer, Love, LoveLayer, Spectral, SpectralLayer};
use rc_solver::Method;

use crate::accuracy::random::Random;
use crate::accuracy::surfaces::{
    Balls, Bump, Copies, Creases, Patch, RMS_SLOPE, long_along_y, random_amplitudes, self_affine, shifted_waves,
    smoothed_noise,
};

/// Families of scenes. Each tries one property that error bars may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// Periodic rough surfaces, from light to full contact.
    Rough,
    /// Waves longer along y, elements longer along x, ridges.
    Anisotropic,
    /// Elements halved at contact edges.
    BorderLevels,
    /// Patches with free borders.
    FreeBorder,
    /// Contacts with a hardness.
    Hardness,
    /// Layers on a rigid base.
    Layer,
    /// Copies of a bump or of a rough tile, and waves of a lattice.
    Texture,
    /// Balls whose contacts are an element or a few elements wide.
    Small,
    /// Heights whose slope jumps. The bars are not made for them.
    Creases,
}

impl Family {
    pub(super) const ALL: [Self; 9] = [
        Self::Rough,
        Self::Anisotropic,
        Self::BorderLevels,
        Self::FreeBorder,
        Self::Hardness,
        Self::Layer,
        Self::Texture,
        Self::Small,
        Self::Creases,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Rough => "rough",
            Self::Anisotropic => "anisotropic",
            Self::BorderLevels => "border levels",
            Self::FreeBorder => "free border",
            Self::Hardness => "hardness",
            Self::Layer => "layer",
            Self::Texture => "texture",
            Self::Small => "small contacts",
            Self::Creases => "creases",
        }
    }

    /// Kinds of heights within the family, which take turns.
    pub(super) fn kinds(self) -> &'static [&'static str] {
        match self {
            Self::Rough => &["self-affine", "random amplitudes", "smoothed noise"],
            Self::Anisotropic => &["long along y", "oblong elements", "ridges"],
            Self::BorderLevels => &["border levels"],
            Self::FreeBorder => &["rough patch", "round patch", "round and rough patch"],
            Self::Hardness => &["hardness"],
            Self::Layer => &["layer"],
            Self::Texture => &["copies of a bump", "copies of a rough tile", "hexagonal waves"],
            Self::Small => &["balls"],
            Self::Creases => &["creases"],
        }
    }

    /// Number of scenes, as a multiple of the least number in a stratum.
    pub(super) fn parts(self) -> usize {
        match self {
            Self::Rough => 12,
            Self::Hardness => 6,
            Self::Layer => 8,
            Self::FreeBorder => 4,
            Self::Small | Self::Anisotropic | Self::BorderLevels | Self::Texture => 3,
            Self::Creases => 1,
        }
    }
}

/// The solid, and how it is discretised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Solid {
    HalfSpace { spectral: bool },
    Free,
    Layer { layer: Layer, spectral: bool },
}

impl Solid {
    pub(super) fn kernel(self) -> Box<dyn Kernel> {
        match self {
            Self::HalfSpace { spectral: true } => Box::new(Spectral),
            Self::HalfSpace { spectral: false } => Box::new(Love),
            Self::Free => Box::new(FreeLove),
            Self::Layer { layer, spectral: true } => Box::new(SpectralLayer(layer)),
            Self::Layer { layer, spectral: false } => Box::new(LoveLayer(layer)),
        }
    }

    /// The same solid, discretised by waves or by elements. There are no waves with free borders.
    pub(super) fn by(self, spectral: bool) -> Self {
        match self {
            Self::HalfSpace { .. } => Self::HalfSpace { spectral },
            Self::Free => Self::Free,
            Self::Layer { layer, .. } => Self::Layer { layer, spectral },
        }
    }

    pub(super) fn is_spectral(self) -> bool {
        matches!(self, Self::HalfSpace { spectral: true } | Self::Layer { spectral: true, .. })
    }
}

type Heights = Box<dyn HeightField + Send + Sync>;

/// One scene: heights, solid, load and mesh.
pub(super) struct Scene {
    pub(super) family: Family,
    pub(super) heights: Heights,
    /// The kind of the heights within the family.
    pub(super) kind: &'static str,
    pub(super) solid: Solid,
    pub(super) method: Method,
    pub(super) border_level: usize,
    pub(super) grid: [usize; 2],
    /// Ratio of the elements of the scene to those of its reference, by side.
    pub(super) finer: usize,
    pub(super) mean_pressure: f64,
    pub(super) hardness: f64,
    /// The shortest wave: waves to the cell, and elements to the wave.
    pub(super) waves: usize,
    pub(super) elements_per_wave: usize,
    pub(super) hurst: f64,
    /// Radius of small contacts, thickness of a layer, in elements.
    pub(super) size: f64,
}

impl Scene {
    /// Scene number `index` of a family, under a seed.
    pub(super) fn new(family: Family, seed: u64, index: usize) -> Result<Self> {
        let random = &mut Random::new(seed, 16 * index + family as usize);
        let kinds = family.kinds();
        let kind = kinds[index % kinds.len()];
        let turn = index / kinds.len();
        match family {
            Family::Rough => Self::rough(kind, turn, random),
            Family::Anisotropic => Self::anisotropic(kind, random),
            Family::BorderLevels => Self::border_levels(kind, turn, random),
            Family::FreeBorder => Self::free_border(kind, random),
            Family::Hardness => Self::hard(kind, random),
            Family::Layer => Self::layer(kind, turn, random),
            Family::Texture => Self::texture(kind, random),
            Family::Small => Ok(Self::small(kind, turn, random)),
            Family::Creases => Self::creases(kind, random),
        }
    }

    /// A scene on a square grid of this many waves and elements.
    fn on(
        family: Family,
        (kind, heights): (&'static str, Heights),
        (waves, elements_per_wave): (usize, usize),
        random: &mut Random,
    ) -> Self {
        let side = waves * elements_per_wave;
        Self {
            family,
            heights,
            kind,
            solid: Solid::HalfSpace { spectral: random.uniform() < 0.5 },
            method: Method::Uniform,
            border_level: 0,
            grid: [side; 2],
            finer: 4,
            mean_pressure: load(random),
            hardness: f64::INFINITY,
            waves,
            elements_per_wave,
            hurst: f64::NAN,
            size: f64::NAN,
        }
    }

    fn rough(kind: &'static str, turn: usize, random: &mut Random) -> Result<Self> {
        let mesh @ (waves, _) = mesh(random, [4, 6, 8, 12, 16, 32][turn % 6], 128);
        let hurst = random.between(0.3, 1.0);
        let heights: Heights = match kind {
            "self-affine" => Box::new(self_affine(waves, hurst, random)?),
            "random amplitudes" => Box::new(random_amplitudes(waves, hurst, random)?),
            _ => Box::new(smoothed_noise(waves, random)?),
        };
        let scene = Self::on(Family::Rough, (kind, heights), mesh, random);
        let solid = Solid::HalfSpace { spectral: (turn / 6).is_multiple_of(2) };
        Ok(Self { solid, hurst, ..scene })
    }

    fn anisotropic(kind: &'static str, random: &mut Random) -> Result<Self> {
        // Oblong elements are twice as long along x.
        let elements = random.choose(if kind == "oblong elements" { &[8, 16] } else { &[4, 8, 16] });
        let mesh @ (waves, elements) = mesh(random, elements, 96);
        let hurst = random.between(0.3, 1.0);
        let heights: Heights = match kind {
            "long along y" => Box::new(long_along_y(waves, (hurst, random.choose(&[2.0, 4.0])), random)?),
            "ridges" => {
                let across = random.choose(&[[1, 0], [2, 0], [3, 0], [0, 1], [1, 1], [2, 1], [4, 1], [1, 3]]);
                Box::new(shifted_waves(&[across], random)?)
            }
            _ => Box::new(self_affine(waves, hurst, random)?),
        };
        let scene = Self::on(Family::Anisotropic, (kind, heights), mesh, random);
        let oblong = if kind == "oblong elements" { 2 } else { 1 };
        Ok(Self { grid: [waves * elements / oblong, waves * elements], hurst, ..scene })
    }

    fn border_levels(kind: &'static str, turn: usize, random: &mut Random) -> Result<Self> {
        let border_level = 1 + turn % 3;
        // The adaptive method has base grids for multiples of 16.
        let elements = random.choose(&[6, 8, 12]);
        let waves = if border_level < 2 { random.choose(&[48, 96]) / elements } else { 48 / elements };
        let hurst = random.between(0.3, 1.0);
        let heights = (kind, Box::new(self_affine(waves, hurst, random)?) as _);
        let scene = Self::on(Family::BorderLevels, heights, (waves, elements), random);
        let solid = Solid::HalfSpace { spectral: false };
        let finer = if border_level == 3 { 3 } else { 4 };
        Ok(Self { solid, method: Method::Adaptive, border_level, finer, hurst, ..scene })
    }

    fn free_border(kind: &'static str, random: &mut Random) -> Result<Self> {
        let mesh = (random.choose(&[2, 3, 4]), random.choose(&[8, 12, 16]));
        let hurst = random.between(0.5, 1.0);
        let tilt = random.choose(&[0.0, 0.3]) * RMS_SLOPE;
        let angle = random.between(0.0, std::f64::consts::TAU);
        let tilt = tilt * DVec2::new(angle.cos(), angle.sin());
        let centre = DVec2::new(random.between(-0.1, 1.1), random.between(-0.1, 1.1));
        let rough = if kind == "round patch" { None } else { Some(self_affine(2 * mesh.0, hurst, random)?) };
        let curvature = match kind {
            "rough patch" => 0.0,
            "round patch" => 3.0 * RMS_SLOPE,
            _ => random.between(1.0, 4.0) * RMS_SLOPE,
        };
        let patch = Patch { rough, paraboloid: (centre, curvature), tilt };
        let scene = Self::on(Family::FreeBorder, (kind, Box::new(patch)), mesh, random);
        let mean_pressure = RMS_SLOPE * random.log_between(3e-3, 1.0);
        Ok(Self { solid: Solid::Free, mean_pressure, hurst, ..scene })
    }

    fn hard(kind: &'static str, random: &mut Random) -> Result<Self> {
        let elements = random.choose(&[4, 8, 16]);
        let mesh @ (waves, _) = mesh(random, elements, 96);
        let hurst = random.between(0.3, 1.0);
        let heights = (kind, Box::new(self_affine(waves, hurst, random)?) as _);
        let scene = Self::on(Family::Hardness, heights, mesh, random);
        let hardness = RMS_SLOPE * random.log_between(0.04, 3.0);
        let mean_pressure = (0.95 * hardness).min(RMS_SLOPE) * random.log_between(3e-3, 1.0);
        Ok(Self { mean_pressure, hardness, hurst, ..scene })
    }

    fn layer(kind: &'static str, turn: usize, random: &mut Random) -> Result<Self> {
        let elements = random.choose(&[4, 8, 16]);
        let mesh @ (waves, elements) = mesh(random, elements, 96);
        let hurst = random.between(0.3, 1.0);
        let heights = (kind, Box::new(self_affine(waves, hurst, random)?) as _);
        let scene = Self::on(Family::Layer, heights, mesh, random);
        let [low, high] = [[0.3, 0.7], [0.7, 1.5], [1.5, 4.0], [4.0, 30.0]][turn % 4];
        let size = random.log_between(low, high);
        let poisson = random.choose(&[0.0, 0.2, 0.3, 0.4, 0.45]);
        let layer = Layer::on_rigid_base(size / (waves * elements) as f64, poisson);
        // A thin layer is stiffer.
        let stiffer = (1.0 + elements as f64 / (3.0 * size)).min(10.0);
        let solid = Solid::Layer { layer, spectral: (turn / 4).is_multiple_of(2) };
        Ok(Self { solid, mean_pressure: stiffer * scene.mean_pressure, hurst, size, ..scene })
    }

    fn texture(kind: &'static str, random: &mut Random) -> Result<Self> {
        let n = random.choose(&[2, 4, 8]);
        let pitch = random.choose(if n == 8 { &[8, 12, 16] } else { &[8, 16, 24, 32] });
        let (heights, mesh): (Heights, _) = match kind {
            "copies of a bump" => {
                let centre = DVec2::new(random.uniform(), random.uniform());
                let sharpness = if pitch < 16 { 0.2 } else { random.choose(&[0.2, 1.0, 3.0]) };
                let tile = Box::new(Bump { centre, sharpness });
                (Box::new(Copies { n, tile }), (n, pitch))
            }
            "copies of a rough tile" => {
                let tile = Box::new(self_affine(pitch / random.choose(&[4, 8]), 0.8, random)?);
                (Box::new(Copies { n, tile }), (n, pitch))
            }
            _ => {
                let [a, b] = random.choose(&[[4, 7], [3, 5], [7, 12], [2, 3]]);
                let waves = shifted_waves(&[[a, b], [a, -b], [-2 * a, 0]], random)?;
                (Box::new(waves), (2 * a as usize, random.choose(&[6, 8, 12])))
            }
        };
        Ok(Self::on(Family::Texture, (kind, heights), mesh, random))
    }

    fn small(kind: &'static str, turn: usize, random: &mut Random) -> Self {
        let side = random.choose(&[24, 32, 48]);
        let [low, high] = [[0.3, 0.5], [0.5, 0.8], [0.8, 3.0]][turn % 3];
        let size = random.log_between(low, high);
        let radius = size / side as f64;
        let balls = Balls::new(random.choose(&[1, 2, 4, 8, 12]), 3.0 * radius + 2.0 / side as f64, random);
        // Hertz's load of contacts of this radius.
        let mean_pressure = balls.len() as f64 * 4.0 / 3.0 * radius.powi(3);
        let scene = Self::on(Family::Small, (kind, Box::new(balls)), (1, side), random);
        let finer = if size < 0.8 { 16 } else { 8 };
        Self { finer, mean_pressure, size, ..scene }
    }

    fn creases(kind: &'static str, random: &mut Random) -> Result<Self> {
        let mesh = (8, 8);
        let heights = (kind, Box::new(Creases::new(mesh.0, random)?) as _);
        Ok(Self::on(Family::Creases, heights, mesh, random))
    }
}

/// Waves to the cell, for this many elements to the wave, and at most `longest` elements to the cell.
fn mesh(random: &mut Random, elements_per_wave: usize, longest: usize) -> (usize, usize) {
    let most = if elements_per_wave == 4 { 3 * longest / 8 } else { longest / elements_per_wave };
    ((random.log_between(3.0, most as f64 + 1.0) as usize).clamp(3, most), elements_per_wave)
}

/// Mean pressures from half a percent of contact to full contact.
fn load(random: &mut Random) -> f64 {
    let of_slope = if random.uniform() < 0.5 { random.log_between(3e-3, 0.3) } else { random.between(0.3, 1.8) };
    RMS_SLOPE * of_slope
}
