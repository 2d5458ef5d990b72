//! Surfaces on which error bars are tested.

use std::f64::consts::{PI, TAU};

use anyhow::Result;
use rc_core::{DVec2, Field, Grid, HeightField};
use rc_fractal::{Amplitudes, Normalisation, SpectrumParams, Surface, Truncation};

/// Rms slope of all surfaces but the ball. Contact depends only on the ratio of mean pressure to rms slope.
pub(super) const RMS_SLOPE: f64 = 0.03;

/// Hurst exponents that the surfaces take in turns.
const HURST: [f64; 5] = [0.8, 0.3, 0.5, 1.0, 0.65];

/// Kinds of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Self-affine, with exactly the amplitudes of the spectrum.
    SelfAffine,
    /// Random amplitudes with roll-off or in a square of wave vectors. They emulate a measured map without noise.
    RandomAmplitudes,
    /// As `RandomAmplitudes`, with waves two or four times longer along y.
    OneDirection,
    /// White noise under a Gaussian filter.
    SmoothedNoise,
    /// A single ball in the cell.
    Ball,
    /// One wave, along x or along y. The edges of contact are straight and parallel to the elements.
    Strips,
    /// A map with linear interpolation between its points. The slope jumps at the points.
    Creases,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::SelfAffine => "self-affine",
            Self::RandomAmplitudes => "random amplitudes",
            Self::OneDirection => "long along y",
            Self::SmoothedNoise => "smoothed noise",
            Self::Ball => "ball",
            Self::Strips => "strips",
            Self::Creases => "creases",
        }
    }

    /// Surface number `i`, with `waves` to the cell.
    ///
    /// The rms slope is [`RMS_SLOPE`], except for the ball.
    pub(super) fn surface(self, i: usize, waves: usize) -> Result<Box<dyn HeightField>> {
        let seed = 3000 + i as u64;
        let mut random = Random(seed);
        let spectrum = SpectrumParams {
            hurst: HURST[i % HURST.len()],
            normalisation: Normalisation::RmsSlope(RMS_SLOPE),
            ..SpectrumParams::paper(waves, seed)
        };
        Ok(match self {
            Self::SelfAffine => Box::new(Surface::new(&spectrum)?),
            Self::RandomAmplitudes => Box::new(Surface::new(&SpectrumParams {
                amplitudes: Amplitudes::Random,
                roll_off: if i.is_multiple_of(2) { 2.0 } else { 1.0 },
                truncation: if i.is_multiple_of(3) { Truncation::Square } else { Truncation::Disc },
                ..spectrum
            })?),
            Self::OneDirection => {
                let ratio = if i.is_multiple_of(2) { 2.0 } else { 4.0 };
                Box::new(Waves::new(waves, &mut random, |k| {
                    let k = (k * DVec2::new(1.0, ratio)).length();
                    if k <= waves as f64 { k.powf(-1.0 - spectrum.hurst) } else { 0.0 }
                }))
            }
            Self::SmoothedNoise => {
                Box::new(Waves::new(waves, &mut random, |k| (-0.5 * (2.5 * k.length() / waves as f64).powi(2)).exp()))
            }
            Self::Ball => Box::new(Ball { centre: DVec2::new(random.uniform(), random.uniform()) }),
            Self::Strips => Box::new(Strips {
                waves: (1 + i % 3) as f64,
                phase: TAU * random.uniform(),
                along_y: i.is_multiple_of(2),
            }),
            Self::Creases => {
                let map = Waves::new(waves, &mut random, |k| k.length().powf(-1.5));
                Box::new(Creases { map: map.sample(Grid::square(2 * waves)?) })
            }
        })
    }
}

/// Pseudo-random numbers (SplitMix64).
struct Random(u64);

impl Random {
    /// A number uniform in [0, 1).
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Waves with Gaussian amplitudes.
struct Waves {
    /// Wave vector, amplitude and phase of each wave.
    waves: Vec<(DVec2, f64, f64)>,
    limit: usize,
}

impl Waves {
    /// Waves up to `limit` to the cell along each side.
    ///
    /// `spectrum` gives the standard deviation of an amplitude, up to a common factor.
    fn new(limit: usize, random: &mut Random, spectrum: impl Fn(DVec2) -> f64) -> Self {
        let numbers = -(limit as i32)..=limit as i32;
        let vectors = numbers.clone().flat_map(|ky| numbers.clone().map(move |kx| [kx, ky]));
        let half = vectors.filter(|&[kx, ky]| ky > 0 || (ky == 0 && kx > 0));
        let vectors = half.map(|k| DVec2::new(k[0].into(), k[1].into()));
        let mut waves: Vec<(DVec2, f64, f64)> = vectors
            .map(|k| {
                let radius = (-2.0 * (1.0 - random.uniform()).ln()).sqrt();
                (k, spectrum(k) * radius, TAU * random.uniform())
            })
            .filter(|wave| wave.1 > 0.0)
            .collect();
        let slope =
            waves.iter().map(|(k, amplitude, _)| 0.5 * (TAU * amplitude * k.length()).powi(2)).sum::<f64>().sqrt();
        for wave in &mut waves {
            wave.1 *= RMS_SLOPE / slope;
        }
        Self { waves, limit }
    }
}

impl HeightField for Waves {
    fn height(&self, at: DVec2) -> f64 {
        self.waves.iter().map(|&(k, amplitude, phase)| amplitude * (TAU * k.dot(at) + phase).cos()).sum()
    }

    fn band_limit(&self) -> Option<usize> {
        Some(self.limit)
    }
}

/// A ball of radius λ.
struct Ball {
    centre: DVec2,
}

impl HeightField for Ball {
    fn height(&self, at: DVec2) -> f64 {
        let from_centre = at - self.centre;
        -0.5 * (from_centre - from_centre.round()).length_squared()
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

struct Strips {
    waves: f64,
    phase: f64,
    along_y: bool,
}

impl HeightField for Strips {
    fn height(&self, at: DVec2) -> f64 {
        let across = if self.along_y { at.x } else { at.y };
        RMS_SLOPE / (2.0_f64.sqrt() * PI * self.waves) * (TAU * self.waves * across + self.phase).cos()
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

/// Bilinear interpolation between the points of a map.
struct Creases {
    map: Field,
}

impl HeightField for Creases {
    fn height(&self, at: DVec2) -> f64 {
        let n = self.map.grid().nx();
        let place = at * n as f64;
        let (corner, inside) = (place.floor(), place - place.floor());
        let value = |x: f64, y: f64| {
            let [x, y] = [corner.x + x, corner.y + y].map(|i| i.rem_euclid(n as f64) as usize);
            self.map.values()[y * n + x]
        };
        let along_x = |y: f64| (1.0 - inside.x) * value(0.0, y) + inside.x * value(1.0, y);
        (1.0 - inside.y) * along_x(0.0) + inside.y * along_x(1.0)
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}
