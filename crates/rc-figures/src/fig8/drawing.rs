//! The panels of Fig. 8.

use plotters::prelude::{DashedLineSeries, DrawingBackend, LineSeries, Rectangle};
use plotters::style::{BLACK, Color, WHITE};
use rc_plot::Area;

use super::{Bin, Curve, Fig8};
use crate::chart::{Axes, Drawn, GREY, Side, write};
use crate::marks::{Sample, error_bars, legend};

/// Upper end of the drawn stresses, in hundredths of E*.
const GREATEST_STRESS: f64 = 5.0;
const HUNDREDTH: f64 = 1e2;
/// Lower end of log P in the panel where P goes to zero.
const LOWEST: f64 = -2.5;
/// Half-size of small marks, in pixels. The half-size of large marks follows.
const SMALL_MARK: i32 = 5;
const TINY_MARK: i32 = 3;

impl Fig8 {
    pub(super) fn draw_panels<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (left, right) = area.split_horizontally(1080);
        self.draw_distribution(&left)?;
        // The inset is over the empty upper right of the first panel.
        let (corner, size) = ((600, 40), (450, 440));
        left.draw(&Rectangle::new(
            [(corner.0 + 40, corner.1), (corner.0 + size.0, corner.1 + size.1)],
            WHITE.filled(),
        ))?;
        self.draw_tail(&left.clone().shrink(corner, (size.0 as u32, size.1 as u32)))?;
        self.draw_start(&right)
    }

    /// Maximum of the density P.
    fn peak(&self) -> f64 {
        self.curves.iter().map(|curve| curve.peak().1).fold(0.0, f64::max)
    }

    /// Upper end of the logarithmic axes.
    fn top_decade(&self) -> f64 {
        self.peak().log10() + 0.25
    }

    fn draw_distribution<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let top = 1.75 * self.peak();
        let axes = Axes {
            x: (0.0, GREATEST_STRESS),
            y: (0.0, top),
            x_label: "σ / E* (10⁻²)",
            y_label: "P(σ / E*)",
            n_labels: (6, 7),
        };
        let mut chart = axes.on(area)?;
        let mut lines = Vec::new();
        for curve in &self.curves {
            let stride = curve.stride();
            let bins = || curve.bins.iter().step_by(stride).filter(|bin| HUNDREDTH * bin.stress < GREATEST_STRESS);
            let at = |bin: &Bin| (HUNDREDTH * bin.stress, bin.density.mean);
            error_bars(&mut chart, bins().map(|bin| (at(bin), bin.density.deviation)), false, curve.style.colour)?;
            curve.style.marks_of(&mut chart, bins().map(at), SMALL_MARK)?;
            curve.style.line(&mut chart, curve.fitted(GREATEST_STRESS / HUNDREDTH))?;
            lines.push((Sample::Mark(curve.style), format!("N = {}", curve.waves)));
            let lambda = curve.fit.lambda * 1e5;
            lines.push((Sample::Line(curve.style), format!("Eq. 7, Λ = {lambda:.2}·10⁻⁵")));
        }
        write(&mut chart, (0.02 * GREATEST_STRESS, 0.965 * top), Side::Right, "(a)", BLACK)?;
        legend(&mut chart, (0.08 * GREATEST_STRESS, 0.965 * top), 0.055 * top, &lines)
    }

    /// Draws the tail with a logarithmic axis for P.
    fn draw_tail<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let (low, high) = (-3.0, self.top_decade());
        let axes =
            Axes { x: (0.0, 6.0), y: (low, high), x_label: "σ / E* (10⁻²)", y_label: "log10 P", n_labels: (4, 5) };
        let mut chart = axes.on(area)?;
        for curve in &self.curves {
            let inside = |at: &(f64, f64)| at.1 > low && at.0 < 6.0;
            let bins = curve.bins.iter().step_by(curve.stride());
            let points = bins.map(|bin| (HUNDREDTH * bin.stress, bin.density.mean.log10())).filter(inside);
            curve.style.marks_of(&mut chart, points, TINY_MARK)?;
            let line = curve.fitted(0.06).into_iter().map(|(stress, density)| (stress, density.log10())).filter(inside);
            chart.draw_series(LineSeries::new(line, curve.style.colour.stroke_width(2)))?;
        }
        Ok(())
    }

    /// Draws the approach to zero with two logarithmic axes.
    fn draw_start<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let axes = Axes {
            x: (-5.0, -1.9),
            y: (LOWEST, self.top_decade()),
            x_label: "log10 (σ / E*)",
            y_label: "log10 P(σ / E*)",
            n_labels: (7, 8),
        };
        let mut chart = axes.on(area)?;
        let mut lines = Vec::new();
        for curve in &self.curves {
            let line = |of: fn(&Bin) -> f64| -> Vec<(f64, f64)> {
                let points = curve.small.iter().map(|bin| (bin.stress.log10(), of(bin).log10()));
                points.filter(|at| at.1 > LOWEST).collect()
            };
            curve.style.marks(&mut chart, line(|bin| bin.density.mean))?;
            chart.draw_series(LineSeries::new(line(|bin| bin.of_elements), curve.style.colour.stroke_width(2)))?;
            lines.push((Sample::Mark(curve.style), format!("N = {}, p² linear at edges", curve.waves)));
            lines.push((Sample::Thin(curve.style.colour), format!("N = {}, elements counted", curve.waves)));
        }
        if let Some(curve) = self.curves.first() {
            // The line is slightly above the marks.
            let first = curve.small.first().map_or(0.0, |bin| (bin.density.mean / bin.stress).log10());
            let line = [-4.9, -2.9].map(|x| (x, x + first + 0.15));
            chart.draw_series(DashedLineSeries::new(line, 4, 6, GREY.stroke_width(3)))?;
            lines.push((Sample::Dotted(GREY), "slope 1".to_owned()));
        }
        write(&mut chart, (-5.0, self.top_decade() - 0.12), Side::Right, "(b)", BLACK)?;
        legend(&mut chart, (-3.45, -1.45), 0.2, &lines)
    }
}

impl Curve {
    /// Step between drawn bins, so that marks do not hide each other.
    fn stride(&self) -> usize {
        (self.bins.len() / 80).max(1)
    }

    /// Points of Eq. 7 up to the stress `end`, in the units of the axes.
    fn fitted(&self, end: f64) -> Vec<(f64, f64)> {
        let stresses = (1..=300).map(|i| end * f64::from(i) / 300.0);
        stresses.map(|stress| (HUNDREDTH * stress, self.fit.density(stress))).collect()
    }
}
