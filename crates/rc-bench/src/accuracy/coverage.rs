//! How often error bars hold.
//!
//! No constant was fitted to these scenes. Their limits are from elements at least four times smaller and from the
//! other kernel.

use anyhow::{Context, Result};
use rayon::prelude::*;
use rc_core::{Grid, HeightField, Kernel, Silent};
use rc_figures::numeric::median;
use rc_figures::{Table, number};
use rc_kernel::{Love, Spectral};
use rc_solver::{ContactProblem, Control, Method, Observables, SolveParams};

use super::case::FINER;
use super::scenes::{RMS_SLOPE, golden, mean_pressure};
use super::surfaces::Kind;

/// Tolerance of the limits, relative to the height range.
///
/// The solves under test have the default tolerance.
const LIMIT_TOLERANCE: f64 = 1e-8;

/// One discretisation of surfaces of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stratum {
    kind: Kind,
    method: Method,
    kernel: &'static str,
    border_level: usize,
    waves: usize,
    elements_per_wave: usize,
    /// Ratio of the sides of an element, x to y.
    ratio: usize,
}

/// Relative errors and error bars of one scene of a stratum.
///
/// Both are of area, rms pressure and mean gap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bars {
    stratum: Stratum,
    errors: [f64; 3],
    limits_of_errors: [f64; 3],
}

impl Bars {
    /// Whether each of the three bars holds.
    pub(super) fn hold(&self) -> [bool; 3] {
        std::array::from_fn(|i| self.errors[i].abs() <= self.limits_of_errors[i])
    }

    /// Whether the bars are made for such a surface.
    pub(super) fn is_covered(&self) -> bool {
        !matches!(self.stratum.kind, Kind::Strips | Kind::Creases)
    }
}

fn uniform(kind: Kind, kernel: &'static str, waves: usize, elements_per_wave: usize) -> Stratum {
    Stratum { kind, method: Method::Uniform, kernel, border_level: 0, waves, elements_per_wave, ratio: 1 }
}

fn adaptive(waves: usize, elements_per_wave: usize, border_level: usize) -> Stratum {
    let stratum = uniform(Kind::SelfAffine, "love", waves, elements_per_wave);
    Stratum { method: Method::Adaptive, border_level, ..stratum }
}

fn strata() -> Vec<Stratum> {
    let mut strata = vec![adaptive(12, 16, 0), adaptive(12, 8, 1), adaptive(6, 8, 2), adaptive(6, 8, 3)];
    for kernel in ["love", "spectral"] {
        for (waves, elements_per_wave) in [(24, 4), (12, 8), (12, 16), (6, 32)] {
            strata.push(uniform(Kind::SelfAffine, kernel, waves, elements_per_wave));
        }
        for elements_per_wave in [8, 16] {
            strata.push(Stratum { ratio: 2, ..uniform(Kind::SelfAffine, kernel, 12, elements_per_wave) });
        }
        for kind in [Kind::RandomAmplitudes, Kind::OneDirection, Kind::SmoothedNoise, Kind::Ball] {
            strata.extend([4, 16].map(|elements_per_wave| uniform(kind, kernel, 8, elements_per_wave)));
        }
        strata.extend([Kind::Strips, Kind::Creases].map(|kind| uniform(kind, kernel, 8, 8)));
    }
    strata
}

/// Solves `n` scenes of each stratum; `is_quick` selects only strata with few elements.
pub(super) fn measure(n: usize, is_quick: bool) -> Result<Vec<Bars>> {
    let strata = strata().into_iter().filter(|stratum| !is_quick || stratum.reference_side() < 512);
    let scenes: Vec<(Stratum, usize)> = strata.flat_map(|stratum| (0..n).map(move |i| (stratum, i))).collect();
    let bars = scenes.into_par_iter().map(|(stratum, i)| stratum.bars(i).with_context(|| format!("{stratum:?}, {i}")));
    bars.collect()
}

impl Stratum {
    fn side(&self) -> usize {
        self.waves * self.elements_per_wave
    }

    fn reference_side(&self) -> usize {
        (FINER * self.side()) << self.border_level
    }

    fn mean_pressure(&self, i: usize) -> f64 {
        match self.kind {
            // Loads of Hertz's theory for contact radii of 0.02 to 0.2 of the cell.
            Kind::Ball => 4.0 / 3.0 * (0.02 * 10.0_f64.powf(golden(i))).powi(3),
            // Contact is full from a mean pressure of √2 rms slope / 2 on.
            Kind::Strips => RMS_SLOPE * (0.01 + 0.6 * golden(i)),
            _ => mean_pressure(i),
        }
    }

    fn bars(&self, i: usize) -> Result<Bars> {
        let surface = self.kind.surface(i, self.waves)?;
        let solve = |kernel: &dyn Kernel, grid: Grid, params: &SolveParams| -> Result<Observables> {
            let heights;
            let control = Control::MeanPressure(self.mean_pressure(i));
            // The adaptive method evaluates heights where it needs them. The other methods get a map, like a measured
            // one.
            let problem = if params.method == Some(Method::Adaptive) {
                let surface: &dyn HeightField = surface.as_ref();
                ContactProblem::new(rc_core::HeightSource::Surface { surface, grid }, control)
            } else {
                heights = surface.sample(grid);
                ContactProblem::new(&heights, control)
            };
            Ok(*problem.with_kernel(kernel).solve(params, &Silent)?.observables())
        };
        let fine = SolveParams::to_tolerance(LIMIT_TOLERANCE).by(Method::Uniform);
        let reference = Grid::square(self.reference_side())?;
        let (kernel, other): (&dyn Kernel, &dyn Kernel) = match self.kernel {
            "love" => (&Love, &Spectral),
            _ => (&Spectral, &Love),
        };
        let limit = solve(other, reference, &fine)?;
        // The rms pressure and the mean gap are less accurate with `love` on the fine grid than with `spectral` on the
        // coarse one.
        let smooth = if self.kernel == "love" { limit } else { solve(&Spectral, reference, &fine)? };
        let params = SolveParams { border_level: self.border_level, ..SolveParams::default().by(self.method) };
        let found = solve(kernel, Grid::new(self.side() / self.ratio, self.side())?, &params)?;
        let limits = [limit.area.fraction, smooth.rms_pressure_corrected, smooth.mean_gap];
        let values = [found.area.fraction, found.rms_pressure_corrected, found.mean_gap];
        let bars = [Some(found.area.error), found.rms_pressure_error, Some(found.mean_gap_error)];
        Ok(Bars {
            stratum: *self,
            errors: std::array::from_fn(|i| values[i] / limits[i] - 1.0),
            limits_of_errors: std::array::from_fn(|i| bars[i].map_or(f64::NAN, |bar| bar / limits[i])),
        })
    }
}

/// One line for each stratum: median errors and error bars, and how many hold.
///
/// Errors and bars are of the three quantities. The last columns are the fraction of the scenes whose bars hold, and
/// the standard error of a fraction of 95 %.
pub(super) fn table(bars: &[Bars]) -> Table {
    let header = [
        "surface",
        "method",
        "kernel",
        "border_level",
        "waves",
        "elements_per_wave",
        "element_ratio",
        "scenes",
        "standard_error_percent",
        "area_covered_percent",
        "rms_pressure_covered_percent",
        "mean_gap_covered_percent",
        "area_median_error_percent",
        "area_median_bar_percent",
        "rms_pressure_median_error_percent",
        "rms_pressure_median_bar_percent",
        "mean_gap_median_error_percent",
        "mean_gap_median_bar_percent",
    ];
    let mut strata: Vec<Stratum> = Vec::new();
    for bars in bars {
        if !strata.contains(&bars.stratum) {
            strata.push(bars.stratum);
        }
    }
    let of_stratum = |stratum: Stratum| {
        let names = [stratum.kind.name(), stratum.method.name(), stratum.kernel].map(str::to_owned);
        let numbers = [stratum.border_level, stratum.waves, stratum.elements_per_wave, stratum.ratio];
        let first = names.into_iter().chain(numbers.map(|number| number.to_string()));
        let scenes: Vec<&Bars> = bars.iter().filter(|bars| bars.stratum == stratum).collect();
        first.chain(statistics(&scenes)).collect::<Vec<String>>()
    };
    let pooled: Vec<&Bars> = bars.iter().filter(|bars| bars.is_covered()).collect();
    let first = ["all but strips and creases", "", "", "", "", "", ""].map(str::to_owned);
    let pooled: Vec<String> = first.into_iter().chain(statistics(&pooled)).collect();
    let rows: Vec<Vec<String>> = strata.into_iter().map(of_stratum).chain([pooled]).collect();
    Table::new("coverage", &header, rows)
}

/// The columns of one line of [`table`], without those that name the stratum.
fn statistics(scenes: &[&Bars]) -> Vec<String> {
    let n = scenes.len() as f64;
    let covered = |i: usize| 100.0 * scenes.iter().filter(|bars| bars.hold()[i]).count() as f64 / n;
    let of_errors = |i: usize| 100.0 * median(scenes.iter().map(|bars| bars.errors[i].abs()).collect());
    let of_bars = |i: usize| 100.0 * median(scenes.iter().map(|bars| bars.limits_of_errors[i]).collect());
    let mut values = vec![100.0 * (0.95 * 0.05 / n).sqrt()];
    values.extend((0..3).map(covered));
    values.extend((0..3).flat_map(|i| [of_errors(i), of_bars(i)]));
    [scenes.len().to_string()].into_iter().chain(values.into_iter().map(number)).collect()
}
