//! Statements of the paper that have no figure.
//!
//! They are energy and area against the number of waves, convergence, and Gaussian heights.

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use rc_plot::{Area, Picture, PictureError};

use crate::chart::{GREY, Key, Panel, Pen, STYLES, draw_panels};
use crate::table::Rows;
use crate::{Figure, Preset, Table, paper};

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
        vec![cutoff::table(&self.cutoffs), convergence::table(&self.meshes), self.moments(), self.heights.table()]
    }
}

impl Picture for Statements {
    fn size(&self) -> (u32, u32) {
        (2400, 800)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (1, 3), &[self.cutoffs_panel(), self.convergence_panel(), self.heights_panel()])
    }
}

impl Statements {
    fn moments(&self) -> Table {
        let Heights { kurtosis, exact_kurtosis, one_kurtosis, one_skewness, beyond, .. } = &self.heights;
        let rows = [
            ("excess kurtosis", *kurtosis, Some(one_kurtosis.deviation), 0.0),
            ("excess kurtosis of all phases", *exact_kurtosis, None, 0.0),
            ("skewness", one_skewness.mean, Some(one_skewness.deviation), 0.0),
            ("part beyond 2 rms heights", beyond[0], None, 0.0455003),
            ("part beyond 3 rms heights", beyond[1], None, 0.0026998),
        ];
        Rows::of(rows)
            .column("quantity", |row| row.0.to_owned())
            .column("waves", |_| self.converged_waves)
            .column("value", |row| row.1)
            .column("standard_deviation_of_one", |row| row.2)
            .column("gaussian", |row| row.3)
            .table("moments")
    }

    fn cutoffs_panel(&self) -> Panel {
        let x = |cutoff: &Cutoff| (cutoff.waves as f64).log2();
        let ends = (self.cutoffs.first().map_or(0.0, x), self.cutoffs.last().map_or(1.0, x));
        let range = ("log2 N", (ends.0 - 0.3, ends.1 + 0.3));
        let mut panel = Panel::new(range, ("over those of the fewest waves", (0.0, 1.3))).ticks(6, 7);
        let first = self.cutoffs.first().map_or(f64::NAN, |first| first.rms_slope);
        let thin = Pen::new(GREY, 2);
        panel.line(self.cutoffs.iter().map(|cutoff| (x(cutoff), first / cutoff.rms_slope)), thin);
        panel.marks(self.cutoffs.iter().map(|cutoff| (x(cutoff), cutoff.area_ratio.mean)), STYLES[0].mark);
        panel.marks(self.cutoffs.iter().map(|cutoff| (x(cutoff), cutoff.energy_ratio.mean)), STYLES[1].mark);
        let keys = [
            (Key::Mark(STYLES[1].mark), "elastic energy".to_owned()),
            (Key::Mark(STYLES[0].mark), "contact area".to_owned()),
            (Key::Line(thin), "1 / rms slope".to_owned()),
        ];
        panel.legend((ends.0 - 0.2, 0.32), 0.1, keys);
        panel.note((ends.0 - 0.3, 1.24), "(a)");
        panel
    }

    fn convergence_panel(&self) -> Panel {
        let (x, y) = (("log2 of elements per shortest wave", (1.5, 6.5)), (-6.0, 0.0));
        let mut panel = Panel::new(x, ("log10 of the relative error of A", y)).ticks(6, 7);
        let x = |mesh: &Mesh| (mesh.elements_per_wave as f64).log2();
        let log = |error: f64| error.abs().log10().clamp(y.0, y.1);
        if let Some((finest, coarser)) = self.meshes.split_last() {
            let counting = self.meshes.iter().map(|mesh| (x(mesh), log(mesh.errors(finest).counting)));
            panel.marks(counting, STYLES[0].mark);
            panel.marks(coarser.iter().map(|mesh| (x(mesh), log(mesh.errors(finest).located))), STYLES[1].mark);
        }
        let keys = [
            (Key::Mark(STYLES[0].mark), "by counting".to_owned()),
            (Key::Mark(STYLES[1].mark), "edges located".to_owned()),
        ];
        panel.legend((3.8, -0.3), 0.45, keys);
        panel.note((1.5, -0.25), "(b)");
        panel
    }

    fn heights_panel(&self) -> Panel {
        let y = ("probability density", (0.0, 0.55));
        let mut panel = Panel::new(("h / rms height", (-4.0, 4.0)), y).ticks(9, 6);
        let line = (0..=160).map(|i| -4.0 + 0.05 * f64::from(i)).map(|height| (height, gaussian(height)));
        panel.line(line, Pen::new(GREY, 2));
        let bins = || self.heights.bins.iter().map(|&(height, density)| ((height, density.mean), density.deviation));
        panel.bars(bins().map(|((x, y), bar)| ((x, y), bar.min(y))), STYLES[0].colour);
        panel.marks(bins().map(|bin| bin.0), STYLES[0].mark.sized(5));
        panel.note((-4.0, 0.528), "(c)");
        panel
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
