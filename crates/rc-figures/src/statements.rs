//! Statements of the paper that have no figure.
//!
//! They are energy and area against the number of waves, convergence, and Gaussian heights.

use anyhow::Result;
use plotters::prelude::{DrawingBackend, LineSeries};
use plotters::style::{BLACK, Color};
use rc_plot::{Area, Picture, PictureError};

use crate::chart::{Axes, Drawn, GREY, Side, write};
use crate::marks::{STYLES, Sample, error_bars, legend};
use crate::{Figure, Preset, Table, number, paper};

mod convergence;
mod cutoff;
mod heights;
mod params;

use convergence::Mesh;
use cutoff::Cutoff;
use heights::{Heights, gaussian};
use params::Params;

/// Results for all statements.
#[derive(Clone, Debug)]
pub struct Statements {
    cutoffs: Vec<Cutoff>,
    meshes: Vec<Mesh>,
    converged_waves: usize,
    heights: Heights,
}

impl Figure for Statements {
    const NAME: &'static str = "statements";
    type Params = Params;

    /// N from 8 to 256 (full) and from 4 to 16 (quick).
    fn params(preset: Preset) -> Result<Params> {
        let load = paper::value("load")?;
        let realisations = paper::value("realisations")? as u64;
        Ok(match preset {
            Preset::Full => Params {
                load,
                tolerance: 1e-6,
                waves: vec![8, 16, 32, 64, 128, 256],
                elements_per_wave: 8,
                seeds: (1..=realisations).collect(),
                converged_waves: paper::value("waves_a")? as usize,
                meshes: vec![4, 8, 16, 32, 64],
                height_seeds: 100,
            },
            Preset::Quick => Params {
                load,
                tolerance: 1e-8,
                waves: vec![4, 8, 16],
                elements_per_wave: 8,
                seeds: vec![1, 2, 3],
                converged_waves: 8,
                meshes: vec![4, 8, 16, 32],
                height_seeds: 10,
            },
        })
    }

    fn compute(params: &Params) -> Result<Self> {
        Ok(Self {
            cutoffs: cutoff::solve_all(params)?,
            meshes: convergence::solve_all(params)?,
            converged_waves: params.converged_waves,
            heights: Heights::of(params)?,
        })
    }

    fn tables(&self) -> Vec<Table> {
        vec![
            cutoff::table(&self.cutoffs),
            convergence::table(&self.meshes),
            self.heights_summary(),
            self.heights.table(),
        ]
    }

    fn caption(&self) -> Option<String> {
        let (first, last) = (self.cutoffs.first()?, self.cutoffs.last()?);
        Some(format!(
            "**Statements without a figure.** (a) Contact area (dots) and elastic energy (triangles) at the paper's load against \
             the number of waves N. They are relative to their values at N = {}, with the same long waves. Line: the rms \
             slope to the power −1. (b) Error of the area against the elements per shortest wave, N = {}, by counting (dots) \
             and with located edges (triangles). (c) Distribution of heights, relative to the rms height, for {} waves. Dots: \
             all realisations. Bars: the standard deviation of one realisation. Line: Gaussian.\n\nFrom N = {} to {} the area \
             falls by {:.0} % and the energy changes by {:+.2} %.\n",
            first.waves,
            self.converged_waves,
            self.converged_waves,
            first.waves,
            last.waves,
            100.0 * (1.0 - last.area_ratio.mean),
            100.0 * (last.energy_ratio.mean - 1.0),
        ))
    }
}

impl Picture for Statements {
    fn size(&self) -> (u32, u32) {
        (2400, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, 3));
        self.draw_cutoffs(&panels[0]).map_err(PictureError::new)?;
        self.draw_convergence(&panels[1]).map_err(PictureError::new)?;
        self.draw_heights(&panels[2]).map_err(PictureError::new)
    }
}

impl Statements {
    fn heights_summary(&self) -> Table {
        let row = |quantity: &str, value: f64, deviation: Option<f64>, gaussian: f64| {
            let deviation = deviation.map_or_else(String::new, number);
            vec![quantity.to_owned(), self.converged_waves.to_string(), number(value), deviation, number(gaussian)]
        };
        let Heights { kurtosis, exact_kurtosis, one_kurtosis, one_skewness, beyond, .. } = &self.heights;
        let rows = [
            row("excess kurtosis", *kurtosis, Some(one_kurtosis.deviation), 0.0),
            row("excess kurtosis of all phases", *exact_kurtosis, None, 0.0),
            row("skewness", one_skewness.mean, Some(one_skewness.deviation), 0.0),
            row("part beyond 2 rms heights", beyond[0], None, 0.0455003),
            row("part beyond 3 rms heights", beyond[1], None, 0.0026998),
        ];
        let header = ["quantity", "waves", "value", "standard_deviation_of_one", "gaussian"];
        Table::new("moments", &header, rows)
    }

    fn draw_cutoffs<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let Some(first) = self.cutoffs.first() else { return Ok(()) };
        let x = |cutoff: &Cutoff| (cutoff.waves as f64).log2();
        let ends = (x(first), self.cutoffs.last().map_or(1.0, x));
        let axes = Axes {
            x: (ends.0 - 0.3, ends.1 + 0.3),
            y: (0.0, 1.3),
            x_label: "log2 N",
            y_label: "over those of the fewest waves",
            n_labels: (6, 7),
        };
        let mut chart = axes.on(area)?;
        let slope = self.cutoffs.iter().map(|cutoff| (x(cutoff), first.rms_slope / cutoff.rms_slope));
        chart.draw_series(LineSeries::new(slope, GREY.stroke_width(2)))?;
        STYLES[0].marks(&mut chart, self.cutoffs.iter().map(|cutoff| (x(cutoff), cutoff.area_ratio.mean)))?;
        STYLES[1].marks(&mut chart, self.cutoffs.iter().map(|cutoff| (x(cutoff), cutoff.energy_ratio.mean)))?;
        let lines = [
            (Sample::Mark(STYLES[1]), "elastic energy".to_owned()),
            (Sample::Mark(STYLES[0]), "contact area".to_owned()),
            (Sample::Thin(GREY), "1 / rms slope".to_owned()),
        ];
        legend(&mut chart, (ends.0 - 0.2, 0.32), 0.1, &lines)?;
        write(&mut chart, (ends.0 - 0.3, 1.24), Side::Right, "(a)", BLACK)
    }

    fn draw_convergence<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let Some((finest, coarser)) = self.meshes.split_last() else { return Ok(()) };
        let y = (-6.0, 0.0);
        let axes = Axes {
            x: (1.5, 6.5),
            y,
            x_label: "log2 of elements per shortest wave",
            y_label: "log10 of the relative error of A",
            n_labels: (6, 7),
        };
        let mut chart = axes.on(area)?;
        let x = |mesh: &Mesh| (mesh.elements_per_wave as f64).log2();
        let log = |error: f64| error.abs().log10().clamp(y.0, y.1);
        STYLES[0].marks(&mut chart, self.meshes.iter().map(|mesh| (x(mesh), log(mesh.errors(finest).counting))))?;
        STYLES[1].marks(&mut chart, coarser.iter().map(|mesh| (x(mesh), log(mesh.errors(finest).located))))?;
        let lines = [
            (Sample::Mark(STYLES[0]), "by counting".to_owned()),
            (Sample::Mark(STYLES[1]), "edges located".to_owned()),
        ];
        legend(&mut chart, (3.8, -0.3), 0.45, &lines)?;
        write(&mut chart, (1.5, -0.25), Side::Right, "(b)", BLACK)
    }

    fn draw_heights<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let y = (0.0, 0.55);
        let axes =
            Axes { x: (-4.0, 4.0), y, x_label: "h / rms height", y_label: "probability density", n_labels: (9, 6) };
        let mut chart = axes.on(area)?;
        let line = (0..=160).map(|i| -4.0 + 0.05 * f64::from(i)).map(|height| (height, gaussian(height)));
        chart.draw_series(LineSeries::new(line, GREY.stroke_width(2)))?;
        let bins = || self.heights.bins.iter().map(|&(height, density)| ((height, density.mean), density.deviation));
        error_bars(&mut chart, bins().map(|((x, y), bar)| ((x, y), bar.min(y))), false, STYLES[0].colour)?;
        STYLES[0].marks_of(&mut chart, bins().map(|bin| bin.0), 5)?;
        write(&mut chart, (-4.0, 0.96 * y.1), Side::Right, "(c)", BLACK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn quick_statements_are_as_reviewed_and_can_be_drawn() {
        let params = Statements::params(Preset::Quick).expect("paper values");
        let figure = Statements::compute(&params).expect("the quick contacts are solved");
        for pair in figure.cutoffs.windows(2) {
            assert!(pair[1].area.mean < pair[0].area.mean, "area grows with N: {pair:?}");
        }
        let (finest, coarser) = figure.meshes.split_last().expect("meshes");
        for mesh in coarser {
            let errors = mesh.errors(finest);
            assert!(errors.located.abs() < errors.counting.abs(), "{mesh:?}: {errors:?}");
        }
        // Ten realisations of few waves scatter around the sum over all phases.
        let heights = &figure.heights;
        let bound = 4.0 * heights.one_kurtosis.error();
        assert!((heights.kurtosis - heights.exact_kurtosis).abs() < bound, "{heights:?}");
        assert_reviewed(
            &figure,
            &params,
            &["statements-cutoff", "statements-convergence", "statements-moments", "statements-heights"],
        );
        assert_written(&figure);
    }
}
