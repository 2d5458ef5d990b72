//! Surfaces on which error bars are tested.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};

use anyhow::Result;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fractal::{Amplitudes, Complex64, Normalisation, SpectrumParams, Surface, Truncation, Wave};

use crate::accuracy::random::Random;

/// Rms slope of rough surfaces and textures. Contact depends only on the ratio of mean pressure to rms slope.
pub(super) const RMS_SLOPE: f64 = 0.03;

/// A self-affine surface with exactly the amplitudes of the spectrum.
pub(super) fn self_affine(waves: usize, hurst: f64, random: &mut Random) -> Result<Surface> {
    Ok(Surface::new(&spectrum(waves, hurst, random))?)
}

/// Random amplitudes with roll-off or in a square of wave vectors. It emulates a measured map without noise.
pub(super) fn random_amplitudes(waves: usize, hurst: f64, random: &mut Random) -> Result<Surface> {
    let roll_off = random.choose(&[1.0, 2.0]);
    let truncation = random.choose(&[Truncation::Disc, Truncation::Square]);
    let spectrum = spectrum(waves, hurst, random);
    Ok(Surface::new(&SpectrumParams { amplitudes: Amplitudes::Random, roll_off, truncation, ..spectrum })?)
}

fn spectrum(waves: usize, hurst: f64, random: &mut Random) -> SpectrumParams {
    let normalisation = Normalisation::RmsSlope(RMS_SLOPE);
    SpectrumParams { hurst, normalisation, ..SpectrumParams::paper(waves, random.number()) }
}

/// Waves that are `ratio` times longer along y.
pub(super) fn long_along_y(waves: usize, (hurst, ratio): (f64, f64), random: &mut Random) -> Result<Surface> {
    gaussian(waves, random, |k| {
        let k = (k * DVec2::new(1.0, ratio)).length();
        if k <= waves as f64 { k.powf(-1.0 - hurst) } else { 0.0 }
    })
}

/// White noise under a Gaussian filter.
pub(super) fn smoothed_noise(waves: usize, random: &mut Random) -> Result<Surface> {
    gaussian(waves, random, |k| (-0.5 * (2.5 * k.length() / waves as f64).powi(2)).exp())
}

/// Waves with Gaussian amplitudes, up to `limit` to the cell along each side.
///
/// `spectrum` gives the standard deviation of an amplitude, up to a common factor.
fn gaussian(limit: usize, random: &mut Random, spectrum: impl Fn(DVec2) -> f64) -> Result<Surface> {
    let numbers = -(limit as i64)..=limit as i64;
    let vectors = numbers.clone().flat_map(|ky| numbers.clone().map(move |kx| [kx, ky]));
    let half = vectors.filter(|&[kx, ky]| ky > 0 || (ky == 0 && kx > 0));
    let waves = half.map(|k| {
        let radius = (-2.0 * (1.0 - random.uniform()).ln()).sqrt();
        (k, spectrum(DVec2::new(k[0] as f64, k[1] as f64)) * radius, TAU * random.uniform())
    });
    of_waves(waves.filter(|wave| wave.1 > 0.0).collect())
}

/// Waves of equal slopes with these wave vectors, shifted by a random vector.
pub(super) fn shifted_waves(vectors: &[[i64; 2]], random: &mut Random) -> Result<Surface> {
    let shift = DVec2::new(random.uniform(), random.uniform());
    let vectors = vectors.iter().map(|&k| (k, DVec2::new(k[0] as f64, k[1] as f64)));
    of_waves(vectors.map(|(k, vector)| (k, vector.length().recip(), TAU * vector.dot(shift))).collect())
}

/// The surface of waves with these vectors, amplitudes and phases, scaled to [`RMS_SLOPE`].
fn of_waves(waves: Vec<([i64; 2], f64, f64)>) -> Result<Surface> {
    let wave = |(k, amplitude, phase): ([i64; 2], f64, f64)| Wave {
        kx: k[0],
        ky: k[1],
        amplitude: Complex64::from_polar(0.5 * amplitude, phase),
    };
    let surface = Surface::from_waves(waves.into_iter().map(wave).collect())?;
    let slope = surface.moments().rms_slope;
    Ok(surface.scaled(RMS_SLOPE / slope))
}

/// Paraboloids of equal radius λ, in a periodic cell.
pub(super) struct Balls(Vec<DVec2>);

impl Balls {
    /// `n` balls at random places that are at least `distance` apart, as far as there is room.
    pub(super) fn new(n: usize, distance: f64, random: &mut Random) -> Self {
        let mut centres: Vec<DVec2> = Vec::new();
        for _ in 0..100 * n {
            let place = DVec2::new(random.uniform(), random.uniform());
            let is_free = centres.iter().all(|centre| wrapped(place - *centre).length() >= distance);
            if is_free && centres.len() < n {
                centres.push(place);
            }
        }
        Self(centres)
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }
}

fn wrapped(vector: DVec2) -> DVec2 {
    vector - vector.round()
}

impl HeightField for Balls {
    fn height(&self, at: DVec2) -> f64 {
        let depths = self.0.iter().map(|centre| -0.5 * wrapped(at - *centre).length_squared());
        depths.fold(f64::NEG_INFINITY, f64::max)
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

/// A patch that is not periodic: a quarter of a rough cell, a paraboloid and a slope.
pub(super) struct Patch {
    /// The rough cell, twice as long as the patch.
    pub(super) rough: Option<Surface>,
    /// Centre of a paraboloid, in λ, and its curvature.
    pub(super) paraboloid: (DVec2, f64),
    /// Slope of the whole patch.
    pub(super) tilt: DVec2,
}

impl Patch {
    fn smooth(&self, at: DVec2) -> f64 {
        let (centre, curvature) = self.paraboloid;
        self.tilt.dot(at) - 0.5 * curvature * (at - centre).length_squared()
    }
}

impl HeightField for Patch {
    fn height(&self, at: DVec2) -> f64 {
        self.rough.as_ref().map_or(0.0, |rough| 2.0 * rough.height(0.5 * at)) + self.smooth(at)
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }

    fn sample(&self, grid: Grid) -> Field {
        let Some(rough) = &self.rough else { return Field::from_fn(grid, |at| self.smooth(at)) };
        let whole = Grid::new(2 * grid.nx(), 2 * grid.ny()).expect("a grid of four times the elements");
        let whole = rough.sample(whole);
        let mut heights = Field::from_fn(grid, |at| self.smooth(at));
        for (row, values) in heights.values_mut().chunks_mut(grid.nx()).enumerate() {
            values.iter_mut().zip(whole.row(row)).for_each(|(height, rough)| *height += 2.0 * rough);
        }
        heights
    }
}

/// Copies of a tile, side by side along both axes.
pub(super) struct Copies {
    pub(super) n: usize,
    pub(super) tile: Box<dyn HeightField + Send + Sync>,
}

impl HeightField for Copies {
    fn height(&self, at: DVec2) -> f64 {
        let n = self.n as f64;
        self.tile.height(n * at - (n * at).floor()) / n
    }

    fn band_limit(&self) -> Option<usize> {
        Some(self.n * self.tile.band_limit()?)
    }
}

/// A dimple or a bump in each cell: the product of two cosines, with peaks of this sharpness.
pub(super) struct Bump {
    pub(super) centre: DVec2,
    /// 1 for cosines. Larger numbers make narrower bumps.
    pub(super) sharpness: f64,
}

impl HeightField for Bump {
    fn height(&self, at: DVec2) -> f64 {
        let phase = TAU * (at - self.centre);
        let depth = self.sharpness * (phase.x.cos() + phase.y.cos() - 2.0);
        RMS_SLOPE * FRAC_1_SQRT_2 * depth.exp() / (TAU * self.sharpness.sqrt())
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

/// Bilinear interpolation between the points of a map.
pub(super) struct Creases(Field);

impl Creases {
    /// Creases between random points, `2 waves` to each side.
    pub(super) fn new(waves: usize, random: &mut Random) -> Result<Self> {
        let map = gaussian(waves, random, |k| k.length().powf(-1.5))?;
        Ok(Self(map.sample(Grid::square(2 * waves)?)))
    }
}

impl HeightField for Creases {
    fn height(&self, at: DVec2) -> f64 {
        let n = self.0.grid().nx();
        let place = at * n as f64;
        let (corner, inside) = (place.floor(), place - place.floor());
        let value = |x: f64, y: f64| {
            let [x, y] = [corner.x + x, corner.y + y].map(|i| i.rem_euclid(n as f64) as usize);
            self.0.values()[y * n + x]
        };
        let along_x = |y: f64| (1.0 - inside.x) * value(0.0, y) + inside.x * value(1.0, y);
        (1.0 - inside.y) * along_x(0.0) + inside.y * along_x(1.0)
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}
