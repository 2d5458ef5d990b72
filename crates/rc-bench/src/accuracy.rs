//! `cargo xtask accuracy`: errors of usual meshes, and how often error bars hold.
//!
//! The errors are of contact area, rms pressure and mean gap, relative to the limit of fine meshes.

mod case;
mod coverage;
mod scenes;
mod surfaces;
mod tables;

use anyhow::{Context, Result};
use plotters::prelude::{DrawingBackend, RGBColor};
use rc_figures::{Figure, Preset, Table};
use rc_plot::{Area, LinePlot, LineStyle, Picture, PictureError, Series, draw_lines};

use self::case::{Case, cases_of, of_mesh, rms};
use self::coverage::Bars;
use self::scenes::Set;

/// Size of the text, in pixels.
const TEXT: f64 = 24.0;

/// Numbers of scenes and meshes.
#[derive(Clone, Debug)]
pub struct Params {
    n_scenes: usize,
    waves: Vec<usize>,
    /// Elements per shortest wave.
    meshes: Vec<usize>,
    /// Elements per side of the reference.
    reference: usize,
    /// Number of scenes of each stratum of the error bars, and whether only strata with few elements are solved.
    coverage: (usize, bool),
}

/// Estimators of the contact area, in the order of [`Case::areas`].
const ESTIMATORS: [(&str, RGBColor); 4] = [
    ("elements counted", RGBColor(200, 60, 30)),
    ("perimeter term as published", RGBColor(230, 159, 0)),
    ("edges from p² alone", RGBColor(90, 150, 210)),
    ("edges from p and gap (rc)", RGBColor(20, 20, 20)),
];

/// Errors of area, rms pressure and mean gap on usual meshes.
#[derive(Clone, Debug)]
pub struct Accuracy {
    meshes: Vec<usize>,
    cases: Vec<Case>,
    bars: Vec<Bars>,
}

impl Figure for Accuracy {
    const NAME: &'static str = "accuracy";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        Ok(match preset {
            Preset::Full => Params {
                n_scenes: 100,
                waves: vec![8, 16, 32],
                meshes: vec![4, 8, 16, 32],
                reference: 1024,
                coverage: (60, false),
            },
            Preset::Quick => {
                Params { n_scenes: 4, waves: vec![8], meshes: vec![4, 8], reference: 256, coverage: (4, true) }
            }
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        let mut cases = Vec::new();
        for set in [Set::Test, Set::Calibration] {
            for scene in set.scenes(params.n_scenes, &params.waves) {
                cases.extend(cases_of(scene, &params.meshes, params.reference).with_context(|| format!("{scene:?}"))?);
            }
        }
        let (n_scenes, is_quick) = params.coverage;
        let bars = coverage::measure(n_scenes, is_quick)?;
        Ok(Self { meshes: params.meshes.clone(), cases, bars })
    }

    fn tables(&self) -> Vec<Table> {
        vec![
            tables::summary(&self.cases, &self.meshes),
            coverage::table(&self.bars),
            tables::cases(&self.cases),
            tables::calibration(&self.cases),
        ]
    }
}

impl Accuracy {
    fn plot(&self, kernel: &'static str) -> LinePlot<'static> {
        let series = ESTIMATORS.iter().enumerate().map(|(estimator, &(name, colour))| {
            let error = |&mesh: &usize| {
                let percent = 100.0
                    * rms(of_mesh(&self.cases, Set::Test, kernel, mesh).map(|case| case.area_errors()[estimator]));
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
        assert_eq!(case::of_set(&accuracy.cases, Set::Test).count(), params.n_scenes * params.meshes.len() * 2);
        for kernel in ["love", "spectral"] {
            let error = |estimator: usize| {
                rms(of_mesh(&accuracy.cases, Set::Test, kernel, 8).map(|case| case.area_errors()[estimator]))
            };
            assert!(error(3) < 0.2 * error(0), "{kernel}: {:e} by edges, {:e} counted", error(3), error(0));
        }
        let bars: Vec<_> = accuracy.bars.iter().filter(|bars| bars.is_covered()).collect();
        // The number of bars that hold may differ from 95 % by four standard errors of independent scenes. Some scenes
        // share a surface, and are not independent.
        let four_errors = 4.0 * (0.05 * 0.95 * bars.len() as f64).sqrt();
        for quantity in 0..3 {
            let held = bars.iter().filter(|bars| bars.hold()[quantity]).count() as f64;
            let expected = 0.95 * bars.len() as f64;
            assert!((held - expected).abs() < four_errors, "{quantity}: {held} of {} bars hold", bars.len());
        }
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert_eq!(write(&accuracy, folder.path()).expect("the figure is written").len(), 6);
    }
}
