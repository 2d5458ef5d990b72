//! The distribution of heights, which the paper calls Gaussian.
//!
//! The paper says that waves of fixed amplitude and random phase add up to Gaussian heights. This holds unless few
//! waves have most of the variance. Over all phases, the height is a sum of independent cosines c_i cos φ_i. Its excess
//! kurtosis is -(3/2) Σ c_i⁴ / (Σ c_i²)², a number without sampling error.

use anyhow::Result;
use rc_core::Grid;
use rc_fractal::{SpectrumParams, Surface};

use super::params::Params;
use crate::fit::Sample;
use crate::table::Rows;
use crate::{Rule, Table};

/// Upper end of the bins, in rms heights. The width of a bin follows.
const END: f64 = 4.0;
const WIDTH: f64 = 0.25;
const N_BINS: usize = (2.0 * END / WIDTH) as usize;

/// The heights of all realisations, divided by their rms height.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// Middle of each bin, and the density in it. The scatter is that of realisations.
    pub(super) bins: Vec<(f64, Sample)>,
    /// Excess kurtosis of all realisations together. The exact value over all phases and the values of single
    /// realisations follow.
    pub(super) kurtosis: f64,
    pub(super) exact_kurtosis: f64,
    pub(super) one_kurtosis: Sample,
    pub(super) one_skewness: Sample,
    /// Fractions of the surface that are more than 2 and 3 rms heights from the mean plane.
    pub(super) beyond: [f64; 2],
}

/// Statistics of one realisation.
struct Realisation {
    density: Vec<f64>,
    skewness: f64,
    /// Mean of the fourth power of the heights.
    fourth: f64,
    beyond: [f64; 2],
}

impl Realisation {
    /// The statistics of heights that are divided by their rms height.
    fn of(heights: &[f64]) -> Self {
        let n = heights.len() as f64;
        let mut density = vec![0.0; N_BINS];
        for bin in heights.iter().map(|h| (h + END) / WIDTH).filter(|bin| (0.0..N_BINS as f64).contains(bin)) {
            density[bin as usize] += (n * WIDTH).recip();
        }
        let mean = |of: &dyn Fn(f64) -> f64| heights.iter().map(|&h| of(h)).sum::<f64>() / n;
        let beyond = [2.0, 3.0].map(|end| mean(&|h| f64::from(h.abs() > end)));
        Self { density, skewness: mean(&|h| h.powi(3)), fourth: mean(&|h| h.powi(4)), beyond }
    }
}

impl Heights {
    pub(super) fn of(params: &Params) -> Result<Self> {
        let waves = params.converged_waves;
        // Two elements per half wave are enough for heights.
        let grid = Grid::square(4 * waves)?;
        let mut all = Vec::new();
        let mut exact_kurtosis = 0.0;
        for seed in 1..=params.height_seeds {
            let surface = Surface::new(&SpectrumParams::paper(waves, seed))?;
            exact_kurtosis = kurtosis_of_all_phases(&surface);
            let field = surface.sample_on(grid)?;
            let rms = field.rms();
            all.push(Realisation::of(&field.values().iter().map(|h| h / rms).collect::<Vec<_>>()));
        }
        let sample = |of: &dyn Fn(&Realisation) -> f64| Sample::of(&all.iter().map(of).collect::<Vec<_>>());
        let middle = |bin: usize| (bin as f64 + 0.5) * WIDTH - END;
        Ok(Self {
            bins: (0..N_BINS).map(|bin| (middle(bin), sample(&|one| one.density[bin]))).collect(),
            // Amplitudes are fixed, so every realisation has the same rms height.
            kurtosis: sample(&|one| one.fourth).mean - 3.0,
            exact_kurtosis,
            one_kurtosis: sample(&|one| one.fourth - 3.0),
            one_skewness: sample(&|one| one.skewness),
            beyond: [0, 1].map(|i| sample(&|one| one.beyond[i]).mean),
        })
    }

    pub(super) fn table(&self) -> Table {
        // A height at the end of a bin may fall into either bin.
        let density = Rule::of_scale(1e-4);
        Rows::of(&self.bins)
            .column("height_over_rms", |(height, _)| *height)
            .within("density", density, |(_, sample)| sample.mean)
            .within("standard_deviation_of_one", density, |(_, sample)| sample.deviation)
            .column("gaussian", |(height, _)| gaussian(*height))
            .table("heights")
    }
}

pub(super) fn gaussian(height: f64) -> f64 {
    (-0.5 * height * height).exp() / std::f64::consts::TAU.sqrt()
}

fn kurtosis_of_all_phases(surface: &Surface) -> f64 {
    let n = surface.waves() as i64;
    // Of each pair ±k this takes the one with kx > 0, or with kx = 0 and ky > 0.
    let pairs = (0..=n).flat_map(|kx| (-n..=n).map(move |ky| (kx, ky))).filter(|&(kx, ky)| kx > 0 || ky > 0);
    let (squares, fourths) = pairs.fold((0.0, 0.0), |(squares, fourths), (kx, ky)| {
        let square = surface.amplitude(kx, ky).norm_sqr();
        (squares + square, fourths + square * square)
    });
    -1.5 * fourths / (squares * squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_two_heights() {
        let one = Realisation::of(&[1.0, -1.0, 1.0, -3.5]);
        assert!((one.fourth - (3.0 + 3.5_f64.powi(4)) / 4.0).abs() < 1e-12);
        assert!(one.beyond.iter().all(|part| (part - 0.25).abs() < 1e-12), "{:?}", one.beyond);
        assert!((one.density.iter().sum::<f64>() * WIDTH - 1.0).abs() < 1e-12);
        assert!((one.density[((1.0 + END) / WIDTH) as usize] * WIDTH - 0.5).abs() < 1e-12);
    }
}
