//! The start of a finer grid, on a solved wave.
//!
//! The edge function is linear across the edge of the contact; the pressure is not.

use anyhow::Result;
use plotters::prelude::{Circle, DashedLineSeries, DrawingBackend, LineSeries, PathElement};
use plotters::style::{BLACK, Color, RGBColor};
use rc_core::{Field, Grid};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{Control, Method, SolveParams, solve};
use rc_theory::westergaard::Westergaard;

use crate::chart::{Axes, BLUE, Chart, Drawn, GREY, RED, Side, write};
use crate::{Figure, Preset, Rule, Table, number};

/// Distance from the last element in contact to the edge, in elements.
///
/// It is a typical value, which the solver assumes too.
const EDGE_DISTANCE: f64 = 0.7;
/// Range of x in the drawing, in λ.
const SHOWN: (f64, f64) = (0.0, 0.5);

/// Parameters of the figure.
#[derive(Clone, Debug)]
pub struct Params {
    wave: Westergaard,
    /// Ratio of the mean pressure to that of full contact.
    load: f64,
    /// Elements along the wave. The number of points of the exact curve follows.
    grid: usize,
    n_points: usize,
}

/// A wave in contact along a line from its crest.
///
/// Units are λ and E*.
#[derive(Clone, Debug)]
pub struct Start {
    params: Params,
    /// Centres of the elements. Pressure, gap and edge function at the centres follow.
    x: Vec<f64>,
    pressure: Vec<f64>,
    gap: Vec<f64>,
    edge_function: Vec<f64>,
}

impl Figure for Start {
    const NAME: &'static str = "guide-start";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        let n_points = match preset {
            Preset::Full => 400,
            Preset::Quick => 100,
        };
        Ok(Params { wave: Westergaard { amplitude: 1e-3 }, load: 0.3, grid: 16, n_points })
    }

    fn compute(params: &Params) -> Result<Self> {
        let height = |x: f64| params.wave.amplitude * (std::f64::consts::TAU * x).cos();
        let heights = Field::from_fn(Grid::square(params.grid)?, |at| height(at.x));
        let how = SolveParams::to_tolerance(1e-10).by(Method::Uniform);
        let solution = solve(&heights, Control::MeanPressure(params.mean_pressure()), &how)?;
        let (pressure, gap) = (solution.pressure().row(0).to_vec(), solution.gap().row(0).to_vec());
        let spacing = (params.grid as f64).recip();
        let x = (0..params.grid).map(|i| (i as f64 + 0.5) * spacing).collect();
        let edge_function = (0..params.grid).map(|i| edge_function(&pressure, gap[i], i, spacing)).collect();
        Ok(Self { params: params.clone(), x, pressure, gap, edge_function })
    }

    fn tables(&self) -> Vec<Table> {
        let header = ["x", "pressure", "gap", "edge_function"];
        let rows = (0..self.x.len() / 2)
            .map(|i| [self.x[i], self.pressure[i], self.gap[i], self.edge_function[i]].map(number).into());
        let columns = Table::new("elements", &header, rows).rest(Rule::of_scale(1e-6));
        let header = ["edge", "by_edge_function", "by_pressure"];
        let edges = [self.exact_edge(), edge_of(&self.edge_function), edge_of(&self.pressure)];
        vec![columns, Table::new("edges", &header, [edges.map(number).into()])]
    }
}

impl Params {
    fn mean_pressure(&self) -> f64 {
        self.load * self.wave.full_contact_pressure()
    }
}

/// The edge function at element `i`.
///
/// It is p² in contact. Out of contact it is -c² (3g/4c)^(2/3), where c is from the neighbours in contact. It is zero
/// without such neighbours.
fn edge_function(pressure: &[f64], gap: f64, i: usize, spacing: f64) -> f64 {
    let n = pressure.len();
    let near = [pressure[(i + n - 1) % n], pressure[(i + 1) % n]];
    let near: Vec<f64> = near.into_iter().filter(|p| *p > 0.0).collect();
    if pressure[i] > 0.0 {
        return pressure[i] * pressure[i];
    }
    if near.is_empty() {
        return 0.0;
    }
    let c_squared = near.iter().map(|p| p * p).sum::<f64>() / (near.len() as f64 * EDGE_DISTANCE * spacing);
    -c_squared * (0.75 * gap / c_squared.sqrt()).powf(2.0 / 3.0)
}

/// `values` at `x` by linear interpolation between the centres of elements.
fn at(values: &[f64], x: f64) -> f64 {
    let n = values.len();
    let place = x * n as f64 - 0.5;
    let (below, part) = (place.floor(), place - place.floor());
    let value = |i: f64| values[(i as isize).rem_euclid(n as isize) as usize];
    value(below) + part * (value(below + 1.0) - value(below))
}

/// Position where the linear interpolation of `values` stops being positive.
fn edge_of(values: &[f64]) -> f64 {
    let points = (0..=50_000).map(|i| 1e-5 * f64::from(i));
    points.take_while(|x| at(values, *x) > 0.0).last().unwrap_or(0.0)
}

impl Start {
    fn exact_edge(&self) -> f64 {
        self.params.wave.half_width(self.params.mean_pressure())
    }

    fn draw_pressure<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let unit = self.params.wave.full_contact_pressure();
        let mut chart = axes("p / p of full contact", (0.0, 1.4)).on(area)?;
        let (wave, mean) = (self.params.wave, self.params.mean_pressure());
        self.line(&mut chart, &|x| at(&self.pressure, x) / unit, RED)?;
        self.line(&mut chart, &|x| at(&self.edge_function, x).max(0.0).sqrt() / unit, BLUE)?;
        let exact = self.points().map(|x| (x, wave.pressure(x, mean) / unit));
        chart.draw_series(DashedLineSeries::new(exact, 8, 6, BLACK.stroke_width(2)))?;
        self.dots(&mut chart, &self.pressure, unit)?;
        write(&mut chart, (0.26, 1.2), Side::Right, "dots: coarse grid", BLACK)?;
        write(&mut chart, (0.26, 1.08), Side::Right, "dashed: exact", BLACK)?;
        write(&mut chart, (0.26, 0.96), Side::Right, "p interpolated", RED)?;
        write(&mut chart, (0.26, 0.84), Side::Right, "√φ, φ interpolated", BLUE)?;
        write(&mut chart, (0.01, 0.08), Side::Right, "(a)", BLACK)
    }

    fn draw_edge_function<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let unit = self.params.wave.full_contact_pressure().powi(2);
        let mut chart = axes("φ / p² of full contact", (-0.8, 1.6)).on(area)?;
        chart.draw_series([PathElement::new([(SHOWN.0, 0.0), (SHOWN.1, 0.0)], GREY.stroke_width(1))])?;
        let edge = self.exact_edge();
        chart.draw_series(DashedLineSeries::new([(edge, -0.8), (edge, 1.6)], 8, 6, BLACK.stroke_width(2)))?;
        self.line(&mut chart, &|x| at(&self.edge_function, x) / unit, BLUE)?;
        self.dots(&mut chart, &self.edge_function, unit)?;
        write(&mut chart, (edge, 1.3), Side::Right, "exact edge", BLACK)?;
        write(&mut chart, (0.01, -0.66), Side::Right, "(b)", BLACK)
    }

    fn points(&self) -> impl Iterator<Item = f64> + Clone + use<> {
        let n = self.params.n_points;
        (0..=n).map(move |i| SHOWN.1 * i as f64 / n as f64)
    }

    fn line<B: DrawingBackend>(
        &self,
        chart: &mut Chart<'_, B>,
        at: &dyn Fn(f64) -> f64,
        colour: RGBColor,
    ) -> Drawn<(), B> {
        chart.draw_series(LineSeries::new(self.points().map(|x| (x, at(x))), colour.stroke_width(3)))?;
        Ok(())
    }

    fn dots<B: DrawingBackend>(&self, chart: &mut Chart<'_, B>, values: &[f64], unit: f64) -> Drawn<(), B> {
        let dots = self.x.iter().zip(values).filter(|(x, _)| **x < SHOWN.1);
        chart.draw_series(dots.map(|(&x, value)| Circle::new((x, value / unit), 7, BLACK.filled())))?;
        Ok(())
    }
}

/// Axes from the crest to the trough.
fn axes(y_label: &str, y: (f64, f64)) -> Axes<'_> {
    Axes { x: SHOWN, y, x_label: "x / λ", y_label, n_labels: (6, 7) }
}

impl Picture for Start {
    fn size(&self) -> (u32, u32) {
        (1800, 720)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, 2));
        self.draw_pressure(&panels[0]).map_err(PictureError::new)?;
        self.draw_edge_function(&panels[1]).map_err(PictureError::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    fn quick() -> (Start, Params) {
        let params = Start::params(Preset::Quick).expect("plain values");
        (Start::compute(&params).expect("the wave is solved"), params)
    }

    #[test]
    fn the_edge_function_finds_the_edge_and_the_pressure_does_not() {
        let (figure, params) = quick();
        let elements = |edge: f64| (edge - figure.exact_edge()) * params.grid as f64;
        let (good, bad) = (elements(edge_of(&figure.edge_function)), elements(edge_of(&figure.pressure)));
        assert!(good.abs() < 0.2 && bad > 0.4, "off by {good} and {bad} elements");
    }

    #[test]
    fn the_quick_start_of_the_guide_is_as_reviewed_and_can_be_drawn() {
        let (figure, params) = quick();
        assert_reviewed(&figure, &params, &["guide-start-elements", "guide-start-edges"]);
        assert_written(&figure);
    }
}
