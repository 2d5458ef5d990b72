//! The panels of the Challenge's surface.

use plotters::prelude::{DrawingBackend, LineSeries};
use plotters::style::{BLACK, Color};
use rc_plot::Area;
use rc_theory::persson::Persson;

use super::{CELL_UM, Challenge, E_STAR_MPA, Point, REFERENCE_LOAD};
use crate::chart::{Axes, BLUE, Drawn, GREEN, GREY, RED, Side, write};
use crate::marks::{Sample, Style, error_bars, legend};

const OURS: Style = Style { colour: RED, dot: true };

impl Challenge {
    pub(super) fn draw_panels<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let panels = area.split_evenly((2, 2));
        self.draw_area(&panels[0])?;
        self.draw_gap(&panels[1])?;
        self.draw_stiffness(&panels[2])?;
        self.draw_patches(&panels[3])
    }

    /// Range of the decimal logarithm of the mean pressures (MPa).
    fn decades(&self) -> (f64, f64) {
        let log = |point: Option<&Point>| point.map_or(0.0, |point| (point.load * E_STAR_MPA).log10());
        (log(self.points.first()) - 0.2, log(self.points.last()) + 0.2)
    }

    fn draw_area<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let end = 1.1 * self.points.last().map_or(1.0, |point| point.load);
        let top = 120.0 * self.points.last().map_or(1.0, |point| point.solved.area.fraction);
        let axes = Axes {
            x: (0.0, end * E_STAR_MPA),
            y: (0.0, top),
            x_label: "σ0 (MPa)",
            y_label: "A / A0 (%)",
            n_labels: (6, 7),
        };
        let mut chart = axes.on(area)?;
        let theory = (0..=100).map(|i| {
            let load = end * f64::from(i) / 100.0;
            (load * E_STAR_MPA, 100.0 * Persson::from_rms_slope(load, self.rms_slope).area_fraction())
        });
        chart.draw_series(LineSeries::new(theory, GREY.stroke_width(2)))?;
        let points = || {
            let at = |point: &Point| (point.load * E_STAR_MPA, 100.0 * point.solved.area.fraction);
            self.points.iter().map(move |point| (at(point), 100.0 * point.solved.area.error))
        };
        OURS.line(&mut chart, points().map(|one| one.0))?;
        error_bars(&mut chart, points(), false, OURS.colour)?;
        OURS.marks(&mut chart, points().map(|one| one.0))?;
        write(&mut chart, (0.0, 0.95 * top), Side::Right, "(a)", BLACK)?;
        let lines = [
            (Sample::Mark(OURS), "located, with error bar".to_owned()),
            (Sample::Thin(GREY), "Persson's theory".to_owned()),
        ];
        legend(&mut chart, (0.1 * end * E_STAR_MPA, 0.95 * top), 0.07 * top, &lines)
    }

    fn draw_gap<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let x = self.decades();
        let gap = |point: &Point| point.solved.observables.mean_gap * CELL_UM;
        let top = 1.15 * self.points.iter().map(gap).fold(0.0, f64::max);
        let axes = Axes { x, y: (0.0, top), x_label: "log10 (σ0 / MPa)", y_label: "mean gap (µm)", n_labels: (6, 7) };
        let mut chart = axes.on(area)?;
        let at = |point: &Point| ((point.load * E_STAR_MPA).log10(), gap(point));
        OURS.line(&mut chart, self.points.iter().map(at))?;
        let bars = self.points.iter().map(|point| (at(point), point.solved.observables.mean_gap_error * CELL_UM));
        error_bars(&mut chart, bars, false, OURS.colour)?;
        OURS.marks(&mut chart, self.points.iter().map(at))?;
        write(&mut chart, (x.0, 0.95 * top), Side::Right, "(b)", BLACK)
    }

    fn draw_stiffness<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let x = self.decades();
        let at = |point: &Point| {
            let stiffness = point.solved.stiffness * E_STAR_MPA / CELL_UM;
            ((point.load * E_STAR_MPA).log10(), stiffness.log10())
        };
        let heights = || self.points.iter().map(|point| at(point).1);
        let y = (heights().fold(f64::INFINITY, f64::min) - 0.2, heights().fold(f64::NEG_INFINITY, f64::max) + 0.2);
        let axes =
            Axes { x, y, x_label: "log10 (σ0 / MPa)", y_label: "log10 (stiffness / (MPa/µm))", n_labels: (6, 7) };
        let mut chart = axes.on(area)?;
        OURS.line(&mut chart, self.points.iter().map(at))?;
        OURS.marks(&mut chart, self.points.iter().map(at))?;
        write(&mut chart, (x.0, y.1 - 0.05 * (y.1 - y.0)), Side::Right, "(c)", BLACK)
    }

    /// Draws the number of patches above an area for three loads.
    ///
    /// The loads are the lightest, the reference's and the heaviest.
    fn draw_patches<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let reference = self.points.iter().find(|point| point.load.total_cmp(&REFERENCE_LOAD).is_eq());
        let curves = [self.points.first(), reference, self.points.last()];
        let log_area = |area: f64| (area * CELL_UM * CELL_UM).log10();
        let most = self.points.iter().map(|point| point.patches.len()).max().unwrap_or(1);
        let largest = self.points.iter().filter_map(|point| point.patches.first()).fold(0.0_f64, |a, b| a.max(*b));
        let (x, top) = ((-4.5, log_area(largest) + 0.3), (most as f64).log10() + 0.8);
        let axes = Axes {
            x,
            y: (0.0, top),
            x_label: "log10 (a / µm²)",
            y_label: "log10 (number of patches larger than a)",
            n_labels: (6, 7),
        };
        let mut chart = axes.on(area)?;
        let mut lines = Vec::new();
        for (point, colour) in curves.into_iter().zip([GREEN, RED, BLUE]) {
            let Some(Point { load, patches, .. }) = point else { continue };
            let ranked = patches.iter().enumerate().map(|(rank, area)| (log_area(*area), ((rank + 1) as f64).log10()));
            // A few hundred points are enough to draw the line.
            let stride = (patches.len() / 500).max(1);
            let few = ranked.enumerate().filter(|(i, at)| (i % stride == 0 || *i < 100) && at.0 > x.0);
            chart.draw_series(LineSeries::new(few.map(|one| one.1), colour.stroke_width(3)))?;
            lines.push((Sample::Thin(colour), format!("σ0 = {} MPa", rc_core::quantity::digits(load * E_STAR_MPA, 3))));
        }
        write(&mut chart, (x.0, 0.95 * top), Side::Right, "(d)", BLACK)?;
        legend(&mut chart, (x.0 + 0.55 * (x.1 - x.0), 0.95 * top), 0.07 * top, &lines)
    }
}
