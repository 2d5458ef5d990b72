//! `cargo xtask accuracy`: how far the contact area, rms pressure and mean gap of usual meshes are from the limit of fine
//! ones, and how often the error bars hold that.

mod scenes;
mod tables;

use anyhow::{Context, Result};
use plotters::prelude::{DrawingBackend, RGBColor};
use rc_core::{EdgeBias, Kernel, Silent};
use rc_figures::{Figure, Preset, Table};
use rc_kernel::{Love, Spectral};
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines};
use rc_solver::{ContactProblem, Control, Method, Observables, SolveParams, StressDistribution};

use self::scenes::{Scene, Set};

/// Perimeter correction as published (Yastrebov, Anciaux, Molinari, *Tribol. Int.* 114 (2017) 161): (π - 1 + ln 2)/24.
const PUBLISHED: f64 = 0.118_114_159_756_238_73;

/// Text, in pixels.
const TEXT: f64 = 24.0;

/// What is solved.
#[derive(Clone, Debug)]
pub struct Params {
    n_scenes: usize,
    waves: Vec<usize>,
    /// Elements per shortest wave.
    meshes: Vec<usize>,
    /// Elements per side of the reference.
    reference: usize,
}

/// Observables in the limit of fine meshes.
#[derive(Clone, Copy, Debug)]
struct Limit {
    area: f64,
    rms_pressure: f64,
    mean_gap: f64,
}

/// How far a stress distribution is from the limit's.
#[derive(Clone, Copy, Debug)]
struct Distribution {
    /// Its first bin over its greatest.
    first_bin: f64,
    /// The same of the limit.
    first_bin_of_limit: f64,
    /// ∫ |P - P of the limit| dσ over the contact area.
    distance: f64,
}

impl Distribution {
    fn new(found: &StressDistribution, limit: &StressDistribution) -> Self {
        let width = BIN_OVER_RMS_SLOPE * scenes::RMS_SLOPE;
        let differences = found.density.iter().zip(&limit.density).map(|(p, limit)| (p - limit).abs());
        let first_bin = |of: &StressDistribution| of.density[0] / of.density.iter().copied().fold(0.0, f64::max);
        Self {
            first_bin: first_bin(found),
            first_bin_of_limit: first_bin(limit),
            distance: differences.sum::<f64>() * width / limit.area_fraction,
        }
    }
}

/// Bins of the stress distribution: their width over E* and rms slope, and their number.
const BIN_OVER_RMS_SLOPE: f64 = 0.02;
const N_BINS: usize = 150;

/// One mesh of one scene.
#[derive(Clone, Copy, Debug)]
struct Case {
    scene: Scene,
    kernel: &'static str,
    mesh: usize,
    limit: Limit,
    found: Observables,
    /// A/A0 of the level set of p² alone.
    area_of_pressure: f64,
    distribution: Distribution,
    side: usize,
    bias: EdgeBias,
}

/// Estimators of the contact area.
const ESTIMATORS: [(&str, RGBColor); 4] = [
    ("elements counted", RGBColor(200, 60, 30)),
    ("perimeter term as published", RGBColor(230, 159, 0)),
    ("edges from p² alone", RGBColor(90, 150, 210)),
    ("edges from p and gap (rc)", RGBColor(20, 20, 20)),
];

impl Case {
    /// A/A0, in the order of [`ESTIMATORS`].
    fn areas(&self) -> [f64; 4] {
        let area = &self.found.area;
        let published = area.cells - PUBLISHED * area.perimeter_edges as f64 / (self.side * self.side) as f64;
        [area.cells, published, self.area_of_pressure, area.fraction]
    }

    /// Their relative errors.
    fn area_errors(&self) -> [f64; 4] {
        self.areas().map(|area| area / self.limit.area - 1.0)
    }

    /// How much greater [`EdgeBias::per_square`] should be for the limit's rms pressure.
    fn more_per_square(&self) -> f64 {
        let squares = self.found.area.missing_square / self.bias.per_square;
        (self.limit.rms_pressure.powi(2) - self.found.rms_pressure_corrected.powi(2)) / squares
    }

    /// Errors over the bars of area, rms pressure and mean gap: at most 1 in size when the bar holds.
    fn over_bars(&self) -> [f64; 3] {
        let Observables { area, rms_pressure_corrected, rms_pressure_error, mean_gap, mean_gap_error, .. } = self.found;
        let over = |value: f64, limit: f64, bar: Option<f64>| bar.map_or(f64::NAN, |bar| (value - limit) / bar);
        [
            over(area.fraction, self.limit.area, Some(area.error)),
            over(rms_pressure_corrected, self.limit.rms_pressure, rms_pressure_error),
            over(mean_gap, self.limit.mean_gap, mean_gap_error),
        ]
    }
}

/// Errors of area, rms pressure and mean gap on usual meshes.
#[derive(Clone, Debug)]
pub struct Accuracy {
    meshes: Vec<usize>,
    cases: Vec<Case>,
}

impl Figure for Accuracy {
    const NAME: &'static str = "accuracy";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        Ok(match preset {
            Preset::Full => {
                Params { n_scenes: 100, waves: vec![8, 16, 32], meshes: vec![4, 8, 16, 32], reference: 1024 }
            }
            Preset::Quick => Params { n_scenes: 4, waves: vec![8], meshes: vec![4, 8], reference: 256 },
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let mut cases = Vec::new();
        for set in [Set::Test, Set::Calibration] {
            for scene in set.scenes(params.n_scenes, &params.waves) {
                cases.extend(cases_of(scene, params).with_context(|| format!("{scene:?}"))?);
            }
        }
        Ok(Self { meshes: params.meshes.clone(), cases })
    }

    fn tables(&self) -> Vec<Table> {
        vec![tables::summary(self), tables::cases(self), tables::calibration(self)]
    }
}

fn cases_of(scene: Scene, params: &Params) -> Result<Vec<Case>> {
    // The two kernels' errors have opposite signs; those of the pressure and the gap are four times smaller with `spectral`.
    let (love, fine) = solve(scene, &Love, params.reference)?;
    let (spectral, _) = solve(scene, &Spectral, params.reference)?;
    let limit = Limit {
        area: 0.5 * (love.area.fraction + spectral.area.fraction),
        rms_pressure: spectral.rms_pressure,
        mean_gap: spectral.mean_gap,
    };
    let mut cases = Vec::new();
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        for &mesh in params.meshes.iter().filter(|&mesh| mesh * scene.waves < params.reference) {
            let side = mesh * scene.waves;
            let (found, stress) = solve(scene, kernel, side)?;
            let distribution = Distribution::new(&stress, &fine);
            let (area_of_pressure, bias) = (stress.area_fraction, kernel.edge_bias());
            let kernel = kernel.name();
            cases.push(Case { scene, kernel, mesh, limit, found, area_of_pressure, distribution, side, bias });
        }
    }
    Ok(cases)
}

fn solve(scene: Scene, kernel: &dyn Kernel, side: usize) -> Result<(Observables, StressDistribution)> {
    let heights = scene.heights(side)?;
    let control = Control::MeanPressure(scene.mean_pressure);
    let params = SolveParams::default().by(Method::Uniform);
    let solution = ContactProblem::new(&heights, control).with_kernel(kernel).solve(&params, &Silent)?;
    let edges: Vec<f64> = (0..=N_BINS).map(|bin| bin as f64 * BIN_OVER_RMS_SLOPE * scenes::RMS_SLOPE).collect();
    Ok((solution.observables().clone(), StressDistribution::of(solution.pressure(), &edges)))
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        n += 1.0;
    }
    f64::sqrt(sum / n)
}

impl Accuracy {
    /// The cases of a set of scenes.
    fn of_set(&self, set: Set) -> impl Iterator<Item = &Case> {
        self.cases.iter().filter(move |case| case.scene.set == set)
    }

    /// Those of a kernel on a mesh.
    fn of<'a>(&'a self, set: Set, kernel: &'a str, mesh: usize) -> impl Iterator<Item = &'a Case> {
        self.of_set(set).filter(move |case| case.kernel == kernel && case.mesh == mesh)
    }

    fn plot(&self, kernel: &'static str) -> LinePlot<'static> {
        let series = ESTIMATORS.iter().enumerate().map(|(estimator, &(name, colour))| {
            let error = |&mesh: &usize| {
                let percent = 100.0 * rms(self.of(Set::Test, kernel, mesh).map(|case| case.area_errors()[estimator]));
                ((mesh as f64).log2(), percent.log10())
            };
            Series { name, points: self.meshes.iter().map(error).collect(), colour, style: LineStyle::Solid }
        });
        LinePlot {
            title: if kernel == "love" { "kernel love" } else { "kernel spectral" },
            x_label: "log2 of elements per shortest wave",
            y_label: "log10 of rms error of A/A0 (%)",
            x: (1.8, 5.2),
            y: (-2.5, 1.5),
            series: series.collect(),
        }
    }
}

impl Picture for Accuracy {
    fn size(&self) -> (u32, u32) {
        (1800, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (left, right) = area.split_horizontally(self.size().0 / 2);
        draw_lines(&left, &self.plot("love"), TEXT)?;
        draw_lines(&right, &self.plot("spectral"), TEXT)
    }
}

#[cfg(test)]
mod tests {
    use rc_figures::write;

    use super::*;

    #[test]
    fn edges_beat_counting_and_bars_hold_on_the_quick_set() {
        let params = Accuracy::params(Preset::Quick).expect("constants");
        let accuracy = Accuracy::compute(&params).expect("solvable scenes");
        assert_eq!(accuracy.of_set(Set::Test).count(), params.n_scenes * params.meshes.len() * 2);
        for kernel in ["love", "spectral"] {
            let error =
                |estimator: usize| rms(accuracy.of(Set::Test, kernel, 8).map(|case| case.area_errors()[estimator]));
            assert!(error(3) < 0.2 * error(0), "{kernel}: {:e} by edges, {:e} counted", error(3), error(0));
        }
        let held = accuracy.cases.iter().filter(|case| case.over_bars()[0].abs() <= 1.0).count();
        assert!(10 * held >= 8 * accuracy.cases.len(), "{held} of {} bars hold", accuracy.cases.len());
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert_eq!(write(&accuracy, folder.path()).expect("the figure is written").len(), 5);
    }
}
