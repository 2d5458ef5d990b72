//! The panels of the comparison with the published reference.

use plotters::prelude::{DrawingBackend, LineSeries, PathElement};
use plotters::style::{BLACK, Color};
use rc_plot::Area;

use super::{Gfmd, Point};
use crate::chart::{Axes, BLUE, Drawn, GREEN, GREY, RED, Side, write};
use crate::marks::{Sample, Style, error_bars, legend};

/// Style of located areas and of all other results of ours. The style of counted areas follows.
const LOCATED: Style = Style { colour: RED, dot: true };
const COUNTED: Style = Style { colour: BLUE, dot: false };
/// Shift of the published sets to the right, in decades. It keeps bars from hiding each other.
const ASIDE: f64 = 0.035;

impl Gfmd {
    pub(super) fn draw_panels<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let panels = area.split_evenly((2, 2));
        self.draw_kappa(&panels[0])?;
        self.draw_differences(&panels[1])?;
        self.draw_stress(&panels[2])?;
        self.draw_gap_and_energy(&panels[3])
    }

    /// Range of the decimal logarithm of the loads.
    fn decades(&self) -> (f64, f64) {
        let first = self.points.first().map_or(-4.0, |point| point.load.log10());
        let last = self.points.last().map_or(0.0, |point| point.load.log10());
        (first - 0.2, last + 0.2)
    }

    fn draw_kappa<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (x, top) = (self.decades(), 2.8);
        let axes =
            Axes {
                x, y: (0.8, top), x_label: "log10 (σ0 / E*)", y_label: "κ = (A / A0) g E* / σ0", n_labels: (6, 8)
            };
        let mut chart = axes.on(area)?;
        let slope = self.rms_slope;
        let kappa = move |load: f64, area: f64| (load.log10(), area * slope / load);
        let theory = (0..=200).map(|i| {
            let load = 10_f64.powf(x.0 + (x.1 - x.0) * f64::from(i) / 200.0);
            kappa(load, self.theory(load))
        });
        chart.draw_series(LineSeries::new(theory, GREY.stroke_width(2)))?;
        let points = || self.points.iter();
        let bar = |point: &Point| (kappa(point.load, point.area.fraction), point.area.error * slope / point.load);
        error_bars(&mut chart, points().map(bar), false, LOCATED.colour)?;
        LOCATED.marks(&mut chart, points().map(|point| bar(point).0))?;
        COUNTED.marks(&mut chart, points().map(|point| kappa(point.load, point.area.cells)))?;
        let published = || points().filter_map(|point| point.published);
        let aside = |(x, y): (f64, f64)| (x + ASIDE, y);
        let first = published().map(|one| (aside(kappa(one.load, one.first)), one.deviation * slope / one.load));
        error_bars(&mut chart, first, false, BLACK)?;
        let dashes = |(x, y): (f64, f64)| PathElement::new([(x - 0.05, y), (x + 0.05, y)], GREEN.stroke_width(4));
        let second = published().filter_map(|one| Some(aside(kappa(one.load, one.second?))));
        chart.draw_series(second.map(dashes))?;
        write(&mut chart, (x.0, 0.97 * top), Side::Right, "(a)", BLACK)?;
        let lines = [
            (Sample::Mark(LOCATED), "located, with error bar".to_owned()),
            (Sample::Mark(COUNTED), "counted".to_owned()),
            (Sample::Thin(BLACK), "published, first set (bar: s.d.)".to_owned()),
            (Sample::Thin(GREEN), "published, second set".to_owned()),
            (Sample::Thin(GREY), "Persson's theory".to_owned()),
        ];
        legend(&mut chart, (x.0 + 0.1, 1.35), 0.11, &lines)
    }

    fn draw_differences<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (x, top) = (self.decades(), 6.0);
        let axes = Axes {
            x,
            y: (-top, top),
            x_label: "log10 (σ0 / E*)",
            y_label: "ours over published − 1 (%)",
            n_labels: (6, 9),
        };
        let mut chart = axes.on(area)?;
        for level in [-1.0, 0.0, 1.0] {
            let width = if level == 0.0 { 2 } else { 1 };
            chart.draw_series(LineSeries::new([(x.0, level), (x.1, level)], GREY.stroke_width(width)))?;
        }
        let pairs = self.points.iter().filter_map(|point| Some((point, point.published?)));
        let located = pairs.clone().filter_map(|(point, published)| {
            let second = published.second?;
            let error = point.area.error.hypot(published.deviation) / second;
            Some(((point.load.log10(), 100.0 * (point.area.fraction / second - 1.0)), 100.0 * error))
        });
        let counted = pairs.map(|(point, published)| {
            let at = (point.load.log10() + ASIDE, 100.0 * (point.area.cells / published.first - 1.0));
            (at, 100.0 * published.deviation / published.first)
        });
        let inside = |((_, y), half): &((f64, f64), f64)| y.abs() + half < top;
        error_bars(&mut chart, located.clone().filter(inside), false, LOCATED.colour)?;
        LOCATED.marks(&mut chart, located.map(|one| one.0).filter(|at| at.1.abs() < top))?;
        error_bars(&mut chart, counted.clone().filter(inside), false, COUNTED.colour)?;
        COUNTED.marks(&mut chart, counted.map(|one| one.0).filter(|at| at.1.abs() < top))?;
        write(&mut chart, (x.0, 0.92 * top), Side::Right, "(b)", BLACK)?;
        let lines = [
            (Sample::Mark(LOCATED), "located, against the second set".to_owned()),
            (Sample::Mark(COUNTED), "counted, against the first set".to_owned()),
        ];
        legend(&mut chart, (x.0 + 0.9, 0.92 * top), 0.12 * top, &lines)
    }

    fn draw_stress<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (low, high) = (-4.0, 1.0);
        let end = self.distributions.iter().filter_map(|one| one.stress.edges.last()).fold(0.0_f64, |a, b| a.max(*b));
        let axes =
            Axes { x: (0.0, end), y: (low, high), x_label: "σ / E*", y_label: "log10 P(σ / E*)", n_labels: (6, 6) };
        let mut chart = axes.on(area)?;
        let mut lines = Vec::new();
        let styles = [LOCATED, COUNTED, Style { colour: GREEN, dot: true }];
        for (one, style) in self.distributions.iter().zip(styles) {
            let middles = one.stress.edges.windows(2).map(|edge| 0.5 * (edge[0] + edge[1]));
            let points = middles.zip(&one.stress.density).map(|(stress, density)| (stress, density.log10()));
            style.marks_of(&mut chart, points.filter(|at| at.1 > low), 5)?;
            let theory = (1..=300).map(|i| end * f64::from(i) / 300.0);
            let theory = theory.map(|stress| (stress, one.theory.density(stress).log10())).filter(|at| at.1 > low);
            chart.draw_series(LineSeries::new(theory, style.colour.stroke_width(2)))?;
            lines.push((Sample::Mark(style), format!("σ0 = {} E*", one.load)));
        }
        lines.push((Sample::Thin(GREY), "Persson's theory, without a fit".to_owned()));
        write(&mut chart, (0.0, 0.94 * high), Side::Right, "(c)", BLACK)?;
        legend(&mut chart, (0.45 * end, 0.85 * high), 0.32, &lines)
    }

    fn draw_gap_and_energy<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (x, low) = (self.decades(), -3.5);
        let axes = Axes {
            x,
            y: (low, 1.0),
            x_label: "log10 (σ0 / E*)",
            y_label: "log10 (gap / h_rms), log10 (U / U_full)",
            n_labels: (6, 9),
        };
        let mut chart = axes.on(area)?;
        let gaps = self.points.iter().map(|point| (point.load.log10(), point.mean_gap.0.log10()));
        let gaps: Vec<(f64, f64)> = gaps.filter(|at| at.1 > low).collect();
        LOCATED.line(&mut chart, gaps.iter().copied())?;
        LOCATED.marks(&mut chart, gaps)?;
        let energies = || self.points.iter().map(|point| (point.load.log10(), point.energy.log10()));
        COUNTED.line(&mut chart, energies())?;
        COUNTED.marks(&mut chart, energies())?;
        write(&mut chart, (x.0, 0.85), Side::Right, "(d)", BLACK)?;
        let lines = [
            (Sample::Mark(LOCATED), "mean gap over rms height".to_owned()),
            (Sample::Mark(COUNTED), "energy over that of full contact".to_owned()),
        ];
        legend(&mut chart, (x.0 + 1.0, low + 0.75), 0.3, &lines)
    }
}
