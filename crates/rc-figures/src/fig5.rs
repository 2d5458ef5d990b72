//! Fig. 5: contact area against mean pressure for both surfaces.
//!
//! It has straight lines and Persson's curve. Averages are over realisations at the same load, and bars are standard
//! deviations of one realisation.

mod procedure;

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use plotters::style::BLACK;
use procedure::Pair;
use rc_plot::{Area, Picture, PictureError};
use rc_theory::persson::Persson;

use crate::chart::{GREY, Key, Mark, Panel, Pen, STYLES, Side, Style, draw_panels};
use crate::fit::{Line, Sample};
use crate::sweep::{self, Sweep};
use crate::table::{Quantity, Rows, quantity, sampled, summary};
use crate::{Figure, Preset, Rule, Table, paper};

/// Range of loads σ0/E* to which the straight line is fitted.
const FITTED: (f64, f64) = (1e-4, 1.5e-3);
/// Upper end of a longer range for comparison. Contact there is a quarter of the cell.
const LONGER: f64 = 4e-3;
/// κ of bearing-area theory at vanishing load, √(2π).
///
/// Source: Bush, Gibson, Thomas, Wear 35 (1975) 87.
const KAPPA_ASPERITIES: f64 = 2.506_628_274_631_000_2;
/// Name of the difference between the paper's procedure and the uniform method.
const BY_PROCEDURE: &str = "greatest relative difference of areas by the paper's procedure";
/// Factor from E* to the unit of the drawn loads, a thousandth of E*.
const MILLI: f64 = 1e3;

/// Parameters of Fig. 5.
#[derive(Clone, Debug)]
pub struct Params {
    sweep: sweep::Params,
    procedure: procedure::Params,
    printed: Printed,
}

/// The values that the paper prints.
#[derive(Clone, Copy, Debug)]
struct Printed {
    /// σ0/E* of the two printed areas.
    load: f64,
    areas: [f64; 2],
    r_squared: f64,
}

/// Contact areas of both surfaces with their fits.
#[derive(Clone, Debug)]
pub struct Fig5 {
    sweep: Sweep,
    curves: Vec<Curve>,
    /// Contacts of reduced size that the paper's procedure solves too.
    pairs: Vec<Pair>,
    procedure: procedure::Params,
    printed: Printed,
    /// Whether the surfaces are the paper's.
    full: bool,
}

/// One surface.
#[derive(Clone, Debug)]
struct Curve {
    waves: usize,
    rms_slope: f64,
    style: Style,
    points: Vec<Point>,
    /// Line through the mean areas of the fitted loads. The line of the longer range follows.
    line: Line,
    longer: Line,
}

/// Averages at one load.
#[derive(Clone, Copy, Debug)]
struct Point {
    load: f64,
    area: Sample,
    counted: Sample,
}

impl Figure for Fig5 {
    const NAME: &'static str = "fig5";
    type Params = Params;

    /// The parameters of `sweep::Params::of`.
    fn params(preset: Preset) -> Result<Params> {
        let printed = Printed {
            load: paper::value("load")?,
            areas: [paper::value("area_fraction_a")?, paper::value("area_fraction_b")?],
            r_squared: paper::value("fig5_r_squared")?,
        };
        let procedure = procedure::Params::reduced(printed.load);
        Ok(Params { sweep: sweep::Params::of(preset)?, procedure, printed })
    }

    fn compute(params: &Params) -> Result<Self> {
        Self::of(params, Sweep::solve(&params.sweep)?)
    }

    fn tables(&self) -> Vec<Table> {
        let procedure = procedure::table(&self.procedure, &self.pairs);
        vec![self.summary(), self.curves_table(), self.sweep.table(), procedure]
    }
}

impl Picture for Fig5 {
    fn size(&self) -> (u32, u32) {
        (2000, 880)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (1, 2), &[self.areas_panel(), self.kappa_panel()])
    }
}

impl Curve {
    fn of(sweep: &Sweep, loads: &[f64], surface: sweep::SurfaceOf, style: Style) -> Self {
        let waves = surface.waves;
        let points: Vec<Point> = loads
            .iter()
            .map(|&load| Point {
                load,
                area: sweep.sample(waves, load, |state| state.area),
                counted: sweep.sample(waves, load, |state| state.area_cells),
            })
            .collect();
        let line = |end: f64| {
            let fitted = points.iter().filter(|point| (FITTED.0..=end).contains(&point.load));
            Line::fit(&fitted.map(|point| (point.load, point.area.mean)).collect::<Vec<_>>())
        };
        let (line, longer) = (line(FITTED.1), line(LONGER));
        Self { waves, rms_slope: surface.rms_slope, style, points, line, longer }
    }

    /// κ of a contact area at a load.
    fn kappa(&self, area: f64, load: f64) -> f64 {
        area * self.rms_slope / load
    }

    /// The numbers of one surface beside the paper's, if these are for it.
    fn quantities(&self, sweep: &Sweep, printed: &Printed, area: Option<f64>) -> Vec<Quantity> {
        let load = printed.load;
        let at = self.points.iter().find(|point| point.load.total_cmp(&load).is_eq());
        let at_load = at.map(|point| {
            let larger = sweep.larger_sample(self.waves, load, |state| state.area);
            let persson = Persson::from_rms_slope(load, self.rms_slope).area_fraction();
            let kappa = self.kappa(point.area.mean, load);
            [
                sampled("area fraction", "A0", point.area).paper(area),
                sampled("area fraction by counting", "A0", point.counted).paper(area),
                sampled("area fraction of all realisations", "A0", larger).paper(area),
                quantity("scatter of the area fraction", "A0", larger.deviation),
                quantity("Persson's area fraction", "A0", persson),
                quantity("kappa at the load of the printed areas", "1", kappa)
                    .error(self.kappa(point.area.error(), load))
                    .paper(area.map(|area| self.kappa(area, load))),
            ]
        });
        let fits = [
            quantity("rms slope", "1", self.rms_slope),
            quantity("slope of the line", "1", self.line.slope),
            quantity("intercept of the line", "A0", self.line.intercept),
            quantity("kappa of the line", "1", self.line.slope * self.rms_slope),
            quantity("R squared", "1", self.line.r_squared).paper(area.map(|_| printed.r_squared)),
            quantity("R squared up to 4e-3", "1", self.longer.r_squared),
        ];
        at_load.into_iter().flatten().chain(fits).map(|one| one.waves(self.waves)).collect()
    }
}

impl Fig5 {
    /// The figure of a solved sweep.
    pub(crate) fn of(params: &Params, sweep: Sweep) -> Result<Self> {
        let curve = |(&surface, style)| Curve::of(&sweep, &params.sweep.loads, surface, style);
        let curves = sweep.surfaces.iter().zip(STYLES).map(curve).collect();
        let full = params.sweep.waves == paper::both_waves()?;
        let (pairs, procedure) = (procedure::solve_all(&params.procedure)?, params.procedure.clone());
        Ok(Self { curves, sweep, pairs, procedure, printed: params.printed, full })
    }

    /// The sweep of this figure.
    pub(crate) fn into_sweep(self) -> Sweep {
        self.sweep
    }

    fn summary(&self) -> Table {
        let of_curves = self
            .curves
            .iter()
            .zip(self.printed.areas)
            .flat_map(|(curve, area)| curve.quantities(&self.sweep, &self.printed, self.full.then_some(area)));
        summary(of_curves.chain(self.ratios()), &["waves", "standard_error", "paper"])
            .column("value", Rule::relative(1e-4))
            .column("standard_error", Rule::of_value(1e-4))
            .row(BY_PROCEDURE, Rule::absolute(2e-4))
            .row("R squared", Rule::absolute(1e-5))
            .row("R squared up to 4e-3", Rule::absolute(1e-5))
    }

    /// Comparisons of areas realisation by realisation.
    ///
    /// They are the ratio of the areas of both surfaces, and the largest difference that the paper's procedure makes.
    fn ratios(&self) -> Vec<Quantity> {
        let [first, second] = &self.curves[..] else { return Vec::new() };
        let ratio = self.sweep.area_ratio(second.waves, first.waves, self.printed.load);
        let [a, b] = self.printed.areas;
        let procedure = self.pairs.iter().map(|pair| pair.difference().abs()).fold(0.0, f64::max);
        vec![
            sampled("ratio of areas", "1", ratio).paper(self.full.then_some(b / a)),
            quantity("scatter of the ratio of areas", "1", ratio.deviation),
            quantity(BY_PROCEDURE, "1", procedure),
        ]
    }

    fn curves_table(&self) -> Table {
        let points = self.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
        Rows::of(points)
            .column("waves", |(curve, _)| curve.waves)
            .column("mean_pressure_over_e_star", |(_, point)| point.load)
            .within("area_fraction", Rule::relative(2e-4), |(_, point)| point.area.mean)
            .within("standard_deviation", Rule::of_scale(5e-4), |(_, point)| point.area.deviation)
            .within("area_fraction_by_counting", Rule::relative(5e-4), |(_, point)| point.counted.mean)
            .within("kappa", Rule::relative(2e-4), |(curve, point)| curve.kappa(point.area.mean, point.load))
            .within("line", Rule::of_scale(1e-4), |(curve, point)| curve.line.at(point.load))
            .column("persson", |(curve, point)| Persson::from_rms_slope(point.load, curve.rms_slope).area_fraction())
            .table("curves")
    }

    fn areas_panel(&self) -> Panel {
        let top = self.curves.iter().map(|curve| curve.line.at(1.15 * FITTED.1)).fold(0.0, f64::max);
        let end = 1.1 * FITTED.1;
        let mut panel = Panel::new(("σ0 / E* (10⁻³)", (0.0, MILLI * end)), ("A / A0", (0.0, 1.05 * top))).ticks(9, 7);
        for curve in &self.curves {
            let theory = (0..=40).map(|i| end * f64::from(i) / 40.0);
            let theory = theory.map(|p| (MILLI * p, Persson::from_rms_slope(p, curve.rms_slope).area_fraction()));
            panel.line(theory, Pen::new(curve.style.colour, 1));
            panel.line([0.0, end].map(|load| (MILLI * load, curve.line.at(load))), curve.style.pen);
            let shown = || curve.points.iter().filter(|point| point.load <= end);
            let at = |point: &Point| (MILLI * point.load, point.area.mean);
            panel.bars(shown().map(|point| (at(point), point.area.deviation)), curve.style.colour);
            panel.marks(shown().map(at), curve.style.mark);
        }
        if self.full {
            panel.marks(self.printed.areas.map(|area| (MILLI * self.printed.load, area)), Mark::square(BLACK));
        }
        panel.note((0.0, top), "(a)");
        panel.legend((0.12 * MILLI * end, 0.99 * top), 0.07 * top, self.keys());
        panel
    }

    /// The lines of the legend.
    fn keys(&self) -> Vec<(Key, String)> {
        let mut keys = Vec::new();
        for curve in &self.curves {
            keys.push((Key::Mark(curve.style.mark), format!("N = {}", curve.waves)));
            let text = format!("κ = {:.3}, R² = {:.5}", curve.line.slope * curve.rms_slope, curve.line.r_squared);
            keys.push((Key::Line(curve.style.pen), text));
        }
        keys.push((Key::Line(Pen::new(GREY, 2)), "Persson, κ = 1.596".to_owned()));
        if self.full {
            keys.push((Key::Mark(Mark::square(BLACK)), "the paper".to_owned()));
        }
        keys
    }

    fn kappa_panel(&self) -> Panel {
        let at = |curve: &Curve, point: &Point| (point.load.log10(), curve.kappa(point.area.mean, point.load));
        let bar = |curve: &Curve, point: &Point| curve.kappa(point.area.deviation, point.load);
        let points = self.curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
        let (low, high) = points.fold((1.5, 2.6), |(low, high): (f64, f64), (curve, point)| {
            let ((_, kappa), bar) = (at(curve, point), bar(curve, point));
            (low.min(kappa - bar), high.max(kappa + bar))
        });
        let (x, y) = ((-5.2, -1.8), (low - 0.1, high + 0.1));
        let mut panel = Panel::new(("log10 (σ0 / E*)", x), ("κ = (A / A0) g E* / σ0", y)).ticks(8, 8);
        let asperities = "asperities, vanishing load";
        for (kappa, name, left) in [(Persson::KAPPA, "Persson, low load", x.0), (KAPPA_ASPERITIES, asperities, -3.3)] {
            panel.line([(x.0, kappa), (x.1, kappa)], Pen::new(GREY, 2).dashed(4, 6));
            panel.text((left, kappa), Side::RightAbove, name, GREY);
        }
        for curve in &self.curves {
            let points = || curve.points.iter().map(|point| at(curve, point));
            panel.bars(points().zip(curve.points.iter().map(|point| bar(curve, point))), curve.style.colour);
            panel.line(points(), curve.style.pen);
            panel.marks(points(), curve.style.mark);
        }
        panel.note((x.0, y.1 - 0.04 * (y.1 - y.0)), "(b)");
        panel
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn quick_figure_5_is_as_reviewed_and_can_be_drawn() {
        let params = Fig5::params(Preset::Quick).expect("paper values");
        let figure = Fig5::compute(&params).expect("the quick figure is solved");
        for curve in &figure.curves {
            for pair in curve.points.windows(2) {
                assert!(pair[1].area.mean > pair[0].area.mean, "area falls with load: {pair:?}");
            }
            // All simulations give values between the two theories; the literature has 1.9 to 2.3 at these loads.
            let kappa = curve.line.slope * curve.rms_slope;
            assert!((Persson::KAPPA..KAPPA_ASPERITIES).contains(&kappa), "N = {}: κ = {kappa}", curve.waves);
        }
        // Inside a contact, the paper's mesh has one pressure for many of the smallest elements. The edges are the
        // same.
        for pair in &figure.pairs {
            assert!(pair.difference().abs() < 2e-2, "{pair:?}");
            assert!(pair.difference_of_penetration().abs() < 5e-3, "{pair:?}");
        }
        assert_reviewed(&figure, &params, &["fig5-summary", "fig5-curves", "fig5-realisations", "fig5-procedure"]);
        assert_written(&figure);
    }
}
