//! Sets of scenes: seeds, exponents, numbers of waves and loads.

use anyhow::Result;
use rc_core::{Field, Grid};
use rc_fractal::{Normalisation, SpectrumParams, Surface};

/// Rms slope of all scenes. Contact depends only on the ratio of mean pressure to rms slope.
pub(super) const RMS_SLOPE: f64 = 0.03;

/// Range of mean pressures, divided by E* and the rms slope.
///
/// Contact is from half a percent to nearly full.
const LOADS: (f64, f64) = (3e-3, 0.6);

/// Hurst exponents that the scenes take in turns.
pub(super) const HURST: [f64; 5] = [0.8, 0.3, 0.5, 1.0, 0.65];

/// σ0/E* of scene number `i`.
///
/// The order follows the golden ratio, so that it is not in step with the cycles of the other parameters.
pub(super) fn mean_pressure(i: usize) -> f64 {
    let (lightest, heaviest) = LOADS;
    RMS_SLOPE * lightest * (heaviest / lightest).powf(golden(i))
}

/// Number `i` of a sequence that fills [0, 1) evenly (multiples of the golden ratio).
pub(super) fn golden(i: usize) -> f64 {
    (i as f64 * 0.618_033_988_749_895).fract()
}

/// The purpose of a set of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Set {
    /// Scenes to which no constant was fitted.
    Test,
    /// Scenes to which constants were fitted.
    Calibration,
}

impl Set {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Test => "test",
            Self::Calibration => "calibration",
        }
    }

    fn first_seed(self) -> u64 {
        match self {
            Self::Test => 1000,
            Self::Calibration => 2000,
        }
    }
}

/// A surface and a load.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene {
    pub(super) set: Set,
    pub(super) waves: usize,
    pub(super) hurst: f64,
    pub(super) seed: u64,
    /// σ0/E*.
    pub(super) mean_pressure: f64,
}

impl Set {
    /// The first `n` scenes of the set that have a number of waves in `waves`.
    ///
    /// A number of waves is the cell's side over the shortest wavelength.
    pub(super) fn scenes(self, n: usize, waves: &[usize]) -> Vec<Scene> {
        let scene = |i: usize| Scene {
            set: self,
            waves: waves[i % waves.len()],
            hurst: HURST[i % HURST.len()],
            seed: self.first_seed() + i as u64,
            mean_pressure: mean_pressure(i),
        };
        (0..n).map(scene).collect()
    }
}

impl Scene {
    /// Heights on a grid of `side` elements per side.
    pub(super) fn heights(&self, side: usize) -> Result<Field> {
        let spectrum = SpectrumParams {
            hurst: self.hurst,
            normalisation: Normalisation::RmsSlope(RMS_SLOPE),
            ..SpectrumParams::paper(self.waves, self.seed)
        };
        Ok(Surface::new(&spectrum)?.sample_on(Grid::square(side)?)?)
    }
}
