//! The start of a finer grid, on a solved wave.
//!
//! The edge function is linear across the edge of the contact; the pressure is not.

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use plotters::style::{BLACK, RGBColor};
use rc_core::{Field, Grid};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{Control, Method, SolveParams, solve};
use rc_theory::westergaard::Westergaard;

use crate::chart::{BLUE, GREY, Mark, Panel, Pen, RED, Side, draw_panels};

/// Distance from the last element in contact to the edge, in elements.
///
/// It is a typical value, which the solver assumes too.
const EDGE_DISTANCE: f64 = 0.7;
/// Range of x in the drawing, in λ.
const SHOWN: (f64, f64) = (0.0, 0.5);
const WAVE: Westergaard = Westergaard { amplitude: 1e-3 };
/// Ratio of the mean pressure to that of full contact.
const LOAD: f64 = 0.3;
/// Elements along the wave. The number of points of a drawn curve follows.
const N: usize = 16;
const N_POINTS: usize = 400;

/// A wave in contact along a line from its crest.
///
/// Units are λ and E*.
#[derive(Clone, Debug)]
pub(super) struct Start {
    /// Pressure at the centres of the elements. The edge function there follows.
    pressure: Vec<f64>,
    edge_function: Vec<f64>,
}

impl Start {
    pub(super) fn compute() -> Result<Self> {
        let height = |x: f64| WAVE.amplitude * (std::f64::consts::TAU * x).cos();
        let heights = Field::from_fn(Grid::square(N)?, |at| height(at.x));
        let how = SolveParams::to_tolerance(1e-10).by(Method::Uniform);
        let solution = solve(&heights, Control::MeanPressure(mean_pressure()), &how)?;
        let pressure = solution.pressure().row(0).to_vec();
        let gaps = solution.gap().row(0).iter().enumerate();
        let edge_function = gaps.map(|(i, gap)| edge_function(&pressure, *gap, i)).collect();
        Ok(Self { pressure, edge_function })
    }

    fn pressure_panel(&self) -> Panel {
        let unit = WAVE.full_contact_pressure();
        let mut panel = panel("p / p of full contact", (0.0, 1.4));
        panel.line(points(|x| at(&self.pressure, x) / unit), Pen::new(RED, 3));
        panel.line(points(|x| at(&self.edge_function, x).max(0.0).sqrt() / unit), Pen::new(BLUE, 3));
        panel.line(points(|x| WAVE.pressure(x, mean_pressure()) / unit), Pen::new(BLACK, 2).dashed(8, 6));
        draw_dots(&mut panel, &self.pressure, unit);
        let lines: [(&str, RGBColor); 4] = [
            ("dots: coarse grid", BLACK),
            ("dashed: exact", BLACK),
            ("p interpolated", RED),
            ("√φ, φ interpolated", BLUE),
        ];
        for (i, (line, colour)) in lines.into_iter().enumerate() {
            panel.text((0.26, 1.2 - 0.12 * i as f64), Side::Right, line, colour);
        }
        panel.note((0.01, 0.08), "(a)");
        panel
    }

    fn edge_function_panel(&self) -> Panel {
        let unit = WAVE.full_contact_pressure().powi(2);
        let mut panel = panel("φ / p² of full contact", (-0.8, 1.6));
        panel.line([(SHOWN.0, 0.0), (SHOWN.1, 0.0)], Pen::new(GREY, 1));
        panel.line([-0.8, 1.6].map(|y| (exact_edge(), y)), Pen::new(BLACK, 2).dashed(8, 6));
        panel.line(points(|x| at(&self.edge_function, x) / unit), Pen::new(BLUE, 3));
        draw_dots(&mut panel, &self.edge_function, unit);
        panel.note((exact_edge(), 1.3), "exact edge");
        panel.note((0.01, -0.66), "(b)");
        panel
    }
}

fn mean_pressure() -> f64 {
    LOAD * WAVE.full_contact_pressure()
}

fn exact_edge() -> f64 {
    WAVE.half_width(mean_pressure())
}

/// The edge function at element `i`.
///
/// It is p² in contact. Out of contact it is -c² (3g/4c)^(2/3), where c is from the neighbours in contact. It is zero
/// without such neighbours.
fn edge_function(pressure: &[f64], gap: f64, i: usize) -> f64 {
    let n = pressure.len();
    let near = [pressure[(i + n - 1) % n], pressure[(i + 1) % n]];
    let near: Vec<f64> = near.into_iter().filter(|p| *p > 0.0).collect();
    if pressure[i] > 0.0 {
        return pressure[i] * pressure[i];
    }
    if near.is_empty() {
        return 0.0;
    }
    let c_squared = near.iter().map(|p| p * p).sum::<f64>() * n as f64 / (near.len() as f64 * EDGE_DISTANCE);
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

/// Points of a curve from the crest to the trough.
fn points(at: impl Fn(f64) -> f64) -> impl Iterator<Item = (f64, f64)> {
    (0..=N_POINTS).map(|i| SHOWN.1 * i as f64 / N_POINTS as f64).map(move |x| (x, at(x)))
}

fn draw_dots(panel: &mut Panel, values: &[f64], unit: f64) {
    let dots = values.iter().enumerate().map(|(i, value)| ((i as f64 + 0.5) / N as f64, value / unit));
    panel.marks(dots.filter(|dot| dot.0 < SHOWN.1), Mark::dot(BLACK, 7));
}

/// A panel from the crest to the trough.
fn panel(y_label: &'static str, y: (f64, f64)) -> Panel {
    Panel::new(("x / λ", SHOWN), (y_label, y)).ticks(6, 7)
}

impl Picture for Start {
    fn size(&self) -> (u32, u32) {
        (1800, 720)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (1, 2), &[self.pressure_panel(), self.edge_function_panel()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Position where the linear interpolation of `values` stops being positive.
    fn edge_of(values: &[f64]) -> f64 {
        let points = (0..=50_000).map(|i| 1e-5 * f64::from(i));
        points.take_while(|x| at(values, *x) > 0.0).last().unwrap_or(0.0)
    }

    #[test]
    fn the_edge_function_finds_the_edge_and_the_pressure_does_not() {
        let figure = Start::compute().expect("the wave is solved");
        let elements = |edge: f64| (edge - exact_edge()) * N as f64;
        let (good, bad) = (elements(edge_of(&figure.edge_function)), elements(edge_of(&figure.pressure)));
        assert!(good.abs() < 0.2 && bad > 0.4, "off by {good} and {bad} elements");
    }
}
