//! The adaptive mesh of a solved contact.
//!
//! Elements are halved at the edges of contacts, and coarser inside.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use anyhow::{Context, Result};
use plotters::prelude::{DrawingBackend, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color};
use rc_core::{DVec2, Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Map, Palette, Picture, PictureError, Shade, draw_map};
use rc_solver::{ContactElement, Control, Method, SolveParams, solve};

use crate::chart::{GREY, RED, words};
use crate::{Preset, paper};

/// Side of a map, in pixels. The space around it and the size of the text follow.
const PANEL: u32 = 768;
const MARGIN: u32 = 24;
const TEXT: u32 = 24;

/// Parameters of the figure.
#[derive(Clone, Debug)]
pub(super) struct Params {
    /// Number of waves N.
    waves: usize,
    /// Elements per side of the grid.
    grid: usize,
    /// Number of times that elements at edges are halved.
    border_level: usize,
    /// Mean pressure σ0/E*.
    mean_pressure: f64,
    /// Relative tolerance of the solve.
    tolerance: f64,
    /// Side of the enlarged part, in λ.
    window: f64,
}

/// The elements of a solved contact, in units of λ and E*.
#[derive(Clone, Debug)]
pub(super) struct Mesh {
    params: Params,
    pressure: Field,
    elements: Vec<ContactElement>,
    /// Lower left corner of the enlarged part.
    corner: DVec2,
    /// Side of the cell (m), for the scale bar.
    cell: f64,
}

impl Params {
    /// Four waves on 256² elements with two border levels (full), or on 128² with one (quick).
    pub(super) fn of(preset: Preset) -> Result<Self> {
        let (grid, border_level) = match preset {
            Preset::Full => (256, 2),
            Preset::Quick => (128, 1),
        };
        Ok(Self { waves: 4, grid, border_level, mean_pressure: paper::value("load")?, tolerance: 1e-8, window: 0.1875 })
    }
}

impl Mesh {
    pub(super) fn compute(params: &Params) -> Result<Self> {
        let surface = Surface::new(&SpectrumParams::paper(params.waves, 1))?;
        let heights = surface.on(Grid::square(params.grid)?);
        let method = SolveParams::to_tolerance(params.tolerance).by(Method::Adaptive);
        let how = SolveParams { border_level: params.border_level, ..method };
        let solution = solve(heights, Control::MeanPressure(params.mean_pressure), &how)?;
        let elements: Vec<_> = solution.elements().context("the adaptive method has elements")?.collect();
        let peak = elements.iter().max_by(|a, b| a.pressure.total_cmp(&b.pressure)).context("nothing touches")?;
        let corner = peak.centre - 0.5 * params.window;
        let corner = corner.clamp(DVec2::ZERO, DVec2::splat(1.0 - params.window));
        let cell = TAU / paper::value("q0")?;
        Ok(Self { params: params.clone(), pressure: solution.pressure().clone(), elements, corner, cell })
    }

    /// Numbers of elements along the cell that the sizes of elements stand for.
    fn sizes(&self) -> BTreeSet<usize> {
        self.elements.iter().map(|element| (1.0 / element.side).round() as usize).collect()
    }

    fn maximum(&self) -> f64 {
        self.elements.iter().map(|element| element.pressure).fold(0.0, f64::max)
    }

    fn draw_cell<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let count = self.elements.len();
        let title = format!("{count} elements in contact");
        let map = Map { title: &title, field: &self.pressure, shade: Shade::Contact, side: self.cell };
        draw_map(area, &map, f64::from(TEXT))?;
        let top = (1.9 * f64::from(TEXT)) as i32;
        let pixel = |at: DVec2| {
            let at = f64::from(PANEL) * at;
            (at.x.round() as i32, top + PANEL as i32 - at.y.round() as i32)
        };
        let frame = [pixel(self.corner), pixel(self.corner + self.params.window)];
        area.draw(&Rectangle::new(frame, RED.stroke_width(3))).map_err(PictureError::new)
    }

    fn draw_window<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let scale = f64::from(PANEL) / self.params.window;
        let top = (1.9 * f64::from(TEXT)) as i32;
        let pixel = |at: DVec2| {
            let at = (scale * (at - self.corner)).clamp(DVec2::ZERO, DVec2::splat(f64::from(PANEL)));
            (at.x.round() as i32, top + PANEL as i32 - at.y.round() as i32)
        };
        let maximum = self.maximum();
        for element in self.elements.iter().filter(|element| self.is_drawn(element)) {
            let half = 0.5 * element.side;
            let square = [pixel(element.centre - half), pixel(element.centre + half)];
            let colour = Palette::Heat.colour(0.8 * element.pressure / maximum);
            area.draw(&Rectangle::new(square, colour.filled())).map_err(PictureError::new)?;
            area.draw(&Rectangle::new(square, GREY.stroke_width(1))).map_err(PictureError::new)?;
        }
        let frame = [(0, top), (PANEL as i32, top + PANEL as i32)];
        area.draw(&Rectangle::new(frame, RED.stroke_width(3))).map_err(PictureError::new)?;
        let sides: Vec<String> = self.sizes().iter().map(|n| format!("λ/{n}")).collect();
        let text = format!("sides {}", sides.join(", "));
        let style = words(f64::from(TEXT), BLACK).pos(Pos::new(HPos::Center, VPos::Center));
        area.draw(&Text::new(text, (PANEL as i32 / 2, (1.1 * f64::from(TEXT)) as i32), style))
            .map_err(PictureError::new)
    }

    /// Whether a part of the element is in the enlarged part.
    fn is_drawn(&self, element: &ContactElement) -> bool {
        let from_middle = (element.centre - self.corner - 0.5 * self.params.window).abs();
        from_middle.max_element() < 0.5 * (self.params.window + element.side)
    }
}

impl Picture for Mesh {
    fn size(&self) -> (u32, u32) {
        (2 * PANEL + 3 * MARGIN, PANEL + 4 * TEXT)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panel = |i: u32| {
            let left = (MARGIN + i * (PANEL + MARGIN)) as i32;
            area.clone().shrink((left, 0), (PANEL + 2, PANEL + 4 * TEXT))
        };
        self.draw_cell(&panel(0))?;
        self.draw_window(&panel(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_elements_carry_the_load_and_are_halved_at_edges() {
        let params = Params::of(Preset::Quick).expect("paper values");
        let figure = Mesh::compute(&params).expect("the contact is solved");
        let load: f64 = figure.elements.iter().map(|one| one.side * one.side * one.pressure).sum();
        assert!((load / params.mean_pressure - 1.0).abs() < 1e-9, "the elements carry {load}");
        assert_eq!(figure.sizes().len(), 2, "elements of the grid and halved ones: {:?}", figure.sizes());
    }
}
