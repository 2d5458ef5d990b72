//! Fig. 8: distribution of the interfacial stress for both surfaces.
//!
//! It has the fit of Eq. 7 and the approach to zero. At contact edges the distribution is resolved below the element
//! ([`StressDistribution`]). The histogram of the same elements is drawn beside it. Realisations are averaged bin by
//! bin.

use anyhow::Result;
use rc_core::{Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{Control, SolveParams, StressDistribution, solve};
use rc_theory::persson::Persson;

use plotters::prelude::DrawingBackend;

use crate::chart::{STYLES, Style};
use crate::fit::{Line, Sample};
use crate::sweep::ELEMENTS_PER_WAVE;
use crate::{Figure, Preset, Table, paper};

mod drawing;
mod tables;

/// Ranges of stress for the slope of log P against log σ.
///
/// Stresses are relative to the stress of the peak. Each range is a decade.
const DECADES: [(f64, f64); 2] = [(0.01, 0.1), (0.004, 0.04)];

/// Parameters of Fig. 8.
#[derive(Clone, Debug)]
pub struct Params {
    /// Numbers of waves N.
    waves: Vec<usize>,
    /// Elements per shortest wave.
    elements_per_wave: usize,
    /// Mean pressure σ0/E*.
    load: f64,
    /// Seeds of the realisations.
    seeds: Vec<u64>,
    /// Relative tolerance of the solves.
    tolerance: f64,
    /// Width of the bins, in E*. Their number follows.
    bin_width: f64,
    n_bins: usize,
    /// First edge of the bins for the approach to zero, in E*. Bins per decade and their number follow.
    first_edge: f64,
    per_decade: usize,
    n_small: usize,
    /// N of the realisation on finer and finer elements. Its elements per shortest wave follow.
    refined_waves: usize,
    refined: Vec<usize>,
}

/// The distributions of both surfaces with their fits.
#[derive(Clone, Debug)]
pub struct Fig8 {
    curves: Vec<Curve>,
    /// Elements per shortest wave, and the distribution of one realisation on them.
    refined: Vec<(usize, Curve)>,
    load: f64,
    /// Areas that the paper prints; `None` for surfaces other than the paper's.
    printed: Option<[f64; 2]>,
}

/// Averages over realisations of one surface, in units of E*.
#[derive(Clone, Debug)]
struct Curve {
    waves: usize,
    rms_slope: f64,
    style: Style,
    /// Bins of equal width. Bins with equal ratios of their ends, towards zero stress, follow.
    bins: Vec<Bin>,
    small: Vec<Bin>,
    /// A/A0 as the best estimate from counting. The integral of P follows.
    area: Sample,
    integral: Sample,
    /// ∫ σ P dσ over all bins.
    mean_stress: Sample,
    /// The fit of Eq. 7 to the averages. The Λ of each realisation follows.
    fit: Persson,
    lambda: Sample,
}

/// Averages in one bin.
#[derive(Clone, Copy, Debug)]
struct Bin {
    stress: f64,
    density: Sample,
    /// Number of elements in all realisations. The P that follows from it comes next.
    elements: usize,
    of_elements: f64,
}

/// Distributions of one realisation.
struct Realisation {
    area: f64,
    equal: StressDistribution,
    small: StressDistribution,
    /// Numbers of elements in the equal bins and in the small ones. The number of all elements follows.
    equal_elements: Vec<usize>,
    small_elements: Vec<usize>,
    n_elements: usize,
    lambda: f64,
}

impl Figure for Fig8 {
    const NAME: &'static str = "fig8";
    type Params = Params;

    /// The paper's surfaces, load and realisations (full).
    ///
    /// The quick preset has 8 and 16 waves and three realisations.
    fn params(preset: Preset) -> Result<Params> {
        let full = Params {
            waves: paper::both_waves()?.into(),
            elements_per_wave: ELEMENTS_PER_WAVE,
            load: paper::value("load")?,
            seeds: (1..=paper::value("realisations")? as u64).collect(),
            tolerance: 1e-6,
            bin_width: 2e-4,
            n_bins: 400,
            first_edge: 1e-5,
            per_decade: 10,
            n_small: 30,
            refined_waves: 32,
            refined: vec![32, 64, 128],
        };
        Ok(match preset {
            Preset::Full => full,
            Preset::Quick => Params {
                waves: vec![8, 16],
                // The tolerance is that of the full figure, so that other vector instructions make differences of the
                // same size.
                seeds: vec![1, 2, 3],
                bin_width: 1e-3,
                n_bins: 80,
                refined_waves: 8,
                refined: vec![32, 64],
                ..full
            },
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let curves = params.waves.iter().zip(STYLES).map(|(&waves, style)| Curve::solve(params, waves, style));
        let printed = [paper::value("area_fraction_a")?, paper::value("area_fraction_b")?];
        Ok(Self {
            curves: curves.collect::<Result<_>>()?,
            refined: params.refined.iter().map(|&side| Ok((side, refined(params, side)?))).collect::<Result<_>>()?,
            load: params.load,
            printed: (params.waves == paper::both_waves()?).then_some(printed),
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.bins_table(), self.small_table(), self.refined_table()]
    }
}

impl Picture for Fig8 {
    fn size(&self) -> (u32, u32) {
        (2000, 980)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        self.draw_panels(area)
    }
}

/// Number of elements whose pressure is in each bin.
fn histogram(pressure: &Field, edges: &[f64]) -> Vec<usize> {
    let mut counts = vec![0_usize; edges.len().saturating_sub(1)];
    for &p in pressure.values().iter().filter(|&&p| p > 0.0) {
        let above = edges.partition_point(|&edge| edge <= p);
        if let Some(count) = above.checked_sub(1).and_then(|bin| counts.get_mut(bin)) {
            *count += 1;
        }
    }
    counts
}

/// Middle stress and density of each bin.
fn points(distribution: &StressDistribution) -> Vec<(f64, f64)> {
    let middles = distribution.edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1]));
    middles.zip(distribution.density.iter().copied()).collect()
}

impl Realisation {
    fn solve(params: &Params, surface: &Surface, waves: usize) -> Result<Self> {
        let heights = surface.on(Grid::square(params.elements_per_wave * waves)?);
        let solution =
            solve(heights, Control::MeanPressure(params.load), &SolveParams::to_tolerance(params.tolerance))?;
        let pressure = solution.pressure();
        let equal: Vec<f64> = (0..=params.n_bins).map(|k| k as f64 * params.bin_width).collect();
        let ratio = 10_f64.powf((params.per_decade as f64).recip());
        let small: Vec<f64> = (0..=params.n_small).map(|k| params.first_edge * ratio.powi(k as i32)).collect();
        let area = solution.area().fraction;
        let distribution = StressDistribution::with_area(pressure, &equal, area);
        Ok(Self {
            area,
            lambda: Persson::fit(params.load, &points(&distribution)).lambda,
            equal: distribution,
            equal_elements: histogram(pressure, &equal),
            small: StressDistribution::with_area(pressure, &small, area),
            small_elements: histogram(pressure, &small),
            n_elements: pressure.grid().len(),
        })
    }
}

/// The distribution of one realisation on elements of another size.
fn refined(params: &Params, elements_per_wave: usize) -> Result<Curve> {
    let params = Params { elements_per_wave, seeds: vec![1], ..params.clone() };
    Curve::solve(&params, params.refined_waves, STYLES[0])
}

/// Averages of the distributions of realisations.
fn average(
    all: &[Realisation],
    of: impl Fn(&Realisation) -> &StressDistribution,
    elements: impl Fn(&Realisation) -> &Vec<usize>,
) -> Vec<Bin> {
    let Some(first) = all.first() else { return Vec::new() };
    let n_all: usize = all.iter().map(|one| one.n_elements).sum();
    let bin = |(i, edge): (usize, &[f64])| {
        let n = all.iter().map(|one| elements(one)[i]).sum();
        Bin {
            stress: 0.5 * (edge[0] + edge[1]),
            density: Sample::of(&all.iter().map(|one| of(one).density[i]).collect::<Vec<_>>()),
            elements: n,
            of_elements: n as f64 / (n_all as f64 * (edge[1] - edge[0])),
        }
    };
    of(first).edges.windows(2).enumerate().map(bin).collect()
}

impl Curve {
    fn solve(params: &Params, waves: usize, style: Style) -> Result<Self> {
        let mut all = Vec::new();
        let mut rms_slope = 0.0;
        for &seed in &params.seeds {
            let surface = Surface::new(&SpectrumParams::paper(waves, seed))?;
            rms_slope = surface.moments().rms_slope;
            all.push(Realisation::solve(params, &surface, waves)?);
        }
        let bins = average(&all, |one| &one.equal, |one| &one.equal_elements);
        let sample = |of: &dyn Fn(&Realisation) -> f64| Sample::of(&all.iter().map(of).collect::<Vec<_>>());
        let averages: Vec<(f64, f64)> = bins.iter().map(|bin| (bin.stress, bin.density.mean)).collect();
        Ok(Self {
            waves,
            rms_slope,
            style,
            small: average(&all, |one| &one.small, |one| &one.small_elements),
            bins,
            area: sample(&|one| one.area),
            integral: sample(&|one| one.equal.area_fraction),
            mean_stress: sample(&|one| {
                points(&one.equal).iter().map(|&(stress, density)| stress * density * params.bin_width).sum()
            }),
            fit: Persson::fit(params.load, &averages),
            lambda: sample(&|one| one.lambda),
        })
    }

    fn lambda_over_theory(&self) -> f64 {
        self.fit.lambda / Persson::from_rms_slope(self.fit.mean_pressure, self.rms_slope).lambda
    }

    /// Stress and density of the highest bin.
    fn peak(&self) -> (f64, f64) {
        let densities = self.bins.iter().map(|bin| (bin.stress, bin.density.mean));
        densities.fold((0.0, 0.0), |peak, at| if at.1 > peak.1 { at } else { peak })
    }

    /// Slope of log P against log σ in a decade of σ.
    ///
    /// σ is relative to the stress of the peak.
    fn small_slope(&self, decade: (f64, f64), density: impl Fn(&Bin) -> f64) -> f64 {
        let peak = self.peak().0;
        let inside = self.small.iter().filter(|bin| (decade.0..=decade.1).contains(&(bin.stress / peak)));
        Line::fit(&inside.map(|bin| (bin.stress.ln(), density(bin).ln())).collect::<Vec<_>>()).slope
    }
}

#[cfg(test)]
mod tests;
