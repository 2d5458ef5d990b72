//! Fig. 5: contact area against mean pressure for both surfaces.
//!
//! It has straight lines and Persson's curve. Averages are over realisations at the same load, and bars are standard
//! deviations of one realisation.

mod procedure;

use anyhow::Result;
use plotters::prelude::{DashedLineSeries, DrawingBackend, LineSeries};
use plotters::style::{BLACK, Color};
use procedure::Pair;
use rc_plot::{Area, Picture, PictureError};
use rc_theory::persson::Persson;

use crate::chart::{Axes, Chart, Drawn, GREY, Side, write};
use crate::fit::{Line, Sample};
use crate::marks::{self, STYLES, Style, error_bars, legend, square};
use crate::sweep::{self, Sweep};
use crate::{Figure, Preset, Rule, Table, number, paper};

/// Range of loads σ0/E* to which the straight line is fitted.
const FITTED: (f64, f64) = (1e-4, 1.5e-3);
/// Upper end of a longer range for comparison. Contact there is a quarter of the cell.
const LONGER: f64 = 4e-3;
/// κ of bearing-area theory at vanishing load, √(2π).
///
/// Source: Bush, Gibson, Thomas, Wear 35 (1975) 87.
const KAPPA_ASPERITIES: f64 = 2.506_628_274_631_000_2;
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

    fn caption(&self) -> Option<String> {
        let n = self.sweep.realisations(self.curves.first()?.waves).count();
        let lines: Vec<String> = self.curves.iter().map(Curve::description).collect();
        Some(format!(
            "**Fig. 5.** (a) Contact area against mean pressure, averages of {n} realisations. Bars are the standard deviation \
             of one realisation, where they are larger than the mark. Straight lines are fitted to the averages for σ0/E* \
             from {:.0e} to {:.1e}: {}. Thin lines: Persson's theory, erf(√2 σ0/(E* g)) with the rms slope g, without a fit. \
             Squares: the areas of the paper's two maps. (b) κ = (A/A0) g E*/σ0 against the load. The rms slope explains \
             the difference between the surfaces. κ falls slowly, which a straight line hides.\n",
            FITTED.0,
            FITTED.1,
            lines.join("; "),
        ))
    }
}

impl Picture for Fig5 {
    fn size(&self) -> (u32, u32) {
        (2000, 880)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, 2));
        self.draw_areas(&panels[0]).map_err(PictureError::new)?;
        self.draw_kappa(&panels[1]).map_err(PictureError::new)
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

    fn description(&self) -> String {
        format!(
            "N = {}: slope {:.2}, that is κ = {:.3} over the rms slope {:.5}, R² = {:.5}",
            self.waves,
            self.line.slope,
            self.line.slope * self.rms_slope,
            self.rms_slope,
            self.line.r_squared
        )
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
        let header = ["quantity", "unit", "waves", "value", "standard_error", "paper"];
        let rows = self.curves.iter().zip(self.printed.areas).flat_map(|(curve, printed)| {
            let row = |quantity: &str, unit: &str, value: f64, error: Option<f64>, paper: Option<f64>| {
                let [error, paper] = [error, paper].map(|value| value.map_or_else(String::new, number));
                vec![quantity.to_owned(), unit.to_owned(), curve.waves.to_string(), number(value), error, paper]
            };
            let printed = self.full.then_some(printed);
            let r_squared = self.full.then_some(self.printed.r_squared);
            let load = self.printed.load;
            let at = curve.points.iter().find(|point| point.load.total_cmp(&load).is_eq());
            let at_load = at.into_iter().flat_map(|point| {
                let (area, counted) = (point.area, point.counted);
                let larger = self.sweep.larger_sample(curve.waves, load, |state| state.area);
                let persson = Persson::from_rms_slope(load, curve.rms_slope).area_fraction();
                [
                    row("area fraction", "A0", area.mean, Some(area.error()), printed),
                    row("area fraction by counting", "A0", counted.mean, Some(counted.error()), printed),
                    row("area fraction of all realisations", "A0", larger.mean, Some(larger.error()), printed),
                    row("scatter of the area fraction", "A0", larger.deviation, None, None),
                    row("Persson's area fraction", "A0", persson, None, None),
                    row(
                        "kappa at the load of the printed areas",
                        "1",
                        curve.kappa(area.mean, load),
                        Some(curve.kappa(area.error(), load)),
                        printed.map(|area| curve.kappa(area, load)),
                    ),
                ]
            });
            let fits = [
                row("rms slope", "1", curve.rms_slope, None, None),
                row("slope of the line", "1", curve.line.slope, None, None),
                row("intercept of the line", "A0", curve.line.intercept, None, None),
                row("kappa of the line", "1", curve.line.slope * curve.rms_slope, None, None),
                row("R squared", "1", curve.line.r_squared, None, r_squared),
                row("R squared up to 4e-3", "1", curve.longer.r_squared, None, None),
            ];
            at_load.chain(fits).collect::<Vec<_>>()
        });
        Table::new("summary", &header, rows.chain(self.ratio_rows()))
            .column("value", Rule::relative(1e-4))
            .column("standard_error", Rule::of_value(1e-4))
            .row("greatest relative difference of areas by the paper's procedure", Rule::absolute(2e-4))
            .row("R squared", Rule::absolute(1e-5))
            .row("R squared up to 4e-3", Rule::absolute(1e-5))
    }

    /// Rows that compare areas realisation by realisation.
    ///
    /// They are the ratio of the areas of both surfaces, and the largest difference that the paper's procedure makes.
    fn ratio_rows(&self) -> Vec<Vec<String>> {
        let [first, second] = &self.curves[..] else { return Vec::new() };
        let ratio = self.sweep.area_ratio(second.waves, first.waves, self.printed.load);
        let [a, b] = self.printed.areas;
        let printed = if self.full { number(b / a) } else { String::new() };
        let row = |quantity: &str, value: f64, error: String, paper: String| {
            vec![quantity.to_owned(), "1".to_owned(), String::new(), number(value), error, paper]
        };
        let procedure = self.pairs.iter().map(|pair| pair.difference().abs()).fold(0.0, f64::max);
        vec![
            row("ratio of areas", ratio.mean, number(ratio.error()), printed),
            row("scatter of the ratio of areas", ratio.deviation, String::new(), String::new()),
            row(
                "greatest relative difference of areas by the paper's procedure",
                procedure,
                String::new(),
                String::new(),
            ),
        ]
    }

    fn curves_table(&self) -> Table {
        let header = [
            "waves",
            "mean_pressure_over_e_star",
            "area_fraction",
            "standard_deviation",
            "area_fraction_by_counting",
            "kappa",
            "line",
            "persson",
        ];
        let rows = self.curves.iter().flat_map(|curve| {
            curve.points.iter().map(|point| {
                let Point { load, area, counted } = *point;
                let persson = Persson::from_rms_slope(load, curve.rms_slope).area_fraction();
                let kappa = curve.kappa(area.mean, load);
                let numbers = [load, area.mean, area.deviation, counted.mean, kappa, curve.line.at(load), persson];
                [curve.waves.to_string()].into_iter().chain(numbers.map(number)).collect()
            })
        });
        Table::new("curves", &header, rows)
            .column("area_fraction", Rule::relative(2e-4))
            .column("standard_deviation", Rule::of_scale(5e-4))
            .column("area_fraction_by_counting", Rule::relative(5e-4))
            .column("kappa", Rule::relative(2e-4))
            .column("line", Rule::of_scale(1e-4))
    }

    fn draw_areas<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let top = self.curves.iter().map(|curve| curve.line.at(1.15 * FITTED.1)).fold(0.0, f64::max);
        let x = (0.0, 1.1 * MILLI * FITTED.1);
        let axes = Axes { x, y: (0.0, 1.05 * top), x_label: "σ0 / E* (10⁻³)", y_label: "A / A0", n_labels: (9, 7) };
        let mut chart = axes.on(area)?;
        let ends = [0.0, 1.1 * FITTED.1];
        for curve in &self.curves {
            let theory = (0..=40).map(|i| 1.1 * FITTED.1 * f64::from(i) / 40.0);
            let theory = theory.map(|p| (MILLI * p, Persson::from_rms_slope(p, curve.rms_slope).area_fraction()));
            chart.draw_series(LineSeries::new(theory, curve.style.colour.stroke_width(1)))?;
            curve.style.line(&mut chart, ends.map(|load| (MILLI * load, curve.line.at(load))))?;
            let shown = || curve.points.iter().filter(|point| point.load <= 1.1 * FITTED.1);
            let at = |point: &Point| (MILLI * point.load, point.area.mean);
            let bars = shown().map(|point| (at(point), point.area.deviation));
            error_bars(&mut chart, bars, false, curve.style.colour)?;
            curve.style.marks(&mut chart, shown().map(at))?;
        }
        if self.full {
            for printed in self.printed.areas {
                square(&mut chart, (MILLI * self.printed.load, printed), 0, BLACK)?;
            }
        }
        write(&mut chart, (0.0, 1.0 * top), Side::Right, "(a)", BLACK)?;
        self.draw_legend(&mut chart, (0.12 * x.1, 0.99 * top), 0.07 * top)
    }

    fn draw_legend<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>, corner: (f64, f64), step: f64) -> Drawn<(), B> {
        let mut lines = Vec::new();
        for curve in &self.curves {
            lines.push((marks::Sample::Mark(curve.style), format!("N = {}", curve.waves)));
            let text = format!("κ = {:.3}, R² = {:.5}", curve.line.slope * curve.rms_slope, curve.line.r_squared);
            lines.push((marks::Sample::Line(curve.style), text));
        }
        lines.push((marks::Sample::Thin(GREY), "Persson, κ = 1.596".to_owned()));
        if self.full {
            lines.push((marks::Sample::Square(BLACK), "the paper".to_owned()));
        }
        legend(chart, corner, step, &lines)
    }

    fn draw_kappa<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let ends = self.curves.iter().flat_map(|curve| {
            let kappa =
                |point: &Point, sign: f64| curve.kappa(point.area.mean + sign * point.area.deviation, point.load);
            curve.points.iter().flat_map(move |point| [kappa(point, -1.0), kappa(point, 1.0)])
        });
        let (low, high) = ends.fold((1.5, 2.6), |(low, high): (f64, f64), end| (low.min(end), high.max(end)));
        let y = (low - 0.1, high + 0.1);
        let axes = Axes {
            x: (-5.2, -1.8),
            y,
            x_label: "log10 (σ0 / E*)",
            y_label: "κ = (A / A0) g E* / σ0",
            n_labels: (8, 8),
        };
        let mut chart = axes.on(area)?;
        let asperities = "asperities, vanishing load";
        for (kappa, name, x) in [(Persson::KAPPA, "Persson, low load", -5.2), (KAPPA_ASPERITIES, asperities, -3.3)] {
            chart.draw_series(DashedLineSeries::new([(-5.2, kappa), (-1.8, kappa)], 4, 6, GREY.stroke_width(2)))?;
            write(&mut chart, (x, kappa), Side::RightAbove, name, GREY)?;
        }
        for curve in &self.curves {
            let at = |point: &Point| (point.load.log10(), curve.kappa(point.area.mean, point.load));
            let bars = curve.points.iter().map(|point| (at(point), curve.kappa(point.area.deviation, point.load)));
            error_bars(&mut chart, bars, false, curve.style.colour)?;
            curve.style.line(&mut chart, curve.points.iter().map(at))?;
            curve.style.marks(&mut chart, curve.points.iter().map(at))?;
        }
        write(&mut chart, (-5.2, y.1 - 0.04 * (y.1 - y.0)), Side::Right, "(b)", BLACK)
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
