//! The adaptive mesh of a solved contact.
//!
//! Elements are halved at the edges of contacts, and coarser inside.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use anyhow::{Context, Result};
use plotters::prelude::{DrawingBackend, IntoFont, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color, TextStyle};
use rc_core::{DVec2, Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, FONT, Map, Palette, Picture, PictureError, Shade, draw_map};
use rc_solver::{ContactElement, Control, Method, SolveParams, solve};

use crate::chart::{GREY, RED};
use crate::{Figure, Preset, Rule, Table, number, paper};

/// Side of a map, in pixels. The space around it and the size of the text follow.
const PANEL: u32 = 768;
const MARGIN: u32 = 24;
const TEXT: u32 = 24;

/// Parameters of the figure.
#[derive(Clone, Debug)]
pub struct Params {
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

/// Elements of one size.
#[derive(Clone, Copy, Debug, Default)]
struct Size {
    count: usize,
    /// Fraction of the cell that they cover.
    area: f64,
    load: f64,
}

/// The elements of a solved contact, in units of λ and E*.
#[derive(Clone, Debug)]
pub struct Mesh {
    params: Params,
    pressure: Field,
    elements: Vec<ContactElement>,
    /// Lower left corner of the enlarged part.
    corner: DVec2,
    /// Side of the cell (m), for the scale bar.
    cell: f64,
}

impl Figure for Mesh {
    const NAME: &'static str = "guide-mesh";
    type Params = Params;

    /// Four waves on 256² elements with two border levels (full).
    ///
    /// The quick preset has 128² elements and one border level.
    fn params(preset: Preset) -> Result<Params> {
        let (grid, border_level) = match preset {
            Preset::Full => (256, 2),
            Preset::Quick => (128, 1),
        };
        let mean_pressure = paper::value("load")?;
        Ok(Params { waves: 4, grid, border_level, mean_pressure, tolerance: 1e-8, window: 0.1875 })
    }

    fn compute(params: &Params) -> Result<Self> {
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

    fn tables(&self) -> Vec<Table> {
        let header = ["elements_per_side", "count", "area", "load"];
        let rows = self.sizes().into_iter().map(|(per_side, size)| {
            vec![per_side.to_string(), size.count.to_string(), number(size.area), number(size.load)]
        });
        // A tile of 64 elements at the edge of a contact may or may not be divided.
        let table = Table::new("sizes", &header, rows).column("count", Rule::count(1.0));
        vec![table.column("area", Rule::of_count("count", 1.0)).column("load", Rule::of_count("count", 1.0))]
    }
}

impl Mesh {
    /// Sizes of elements by their number along the cell, coarsest first.
    fn sizes(&self) -> BTreeMap<usize, Size> {
        let mut sizes = BTreeMap::<usize, Size>::new();
        for element in &self.elements {
            let size = sizes.entry((1.0 / element.side).round() as usize).or_default();
            let area = element.side * element.side;
            size.count += 1;
            size.area += area;
            size.load += area * element.pressure;
        }
        sizes
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
        let sides: Vec<String> = self.sizes().keys().map(|n| format!("λ/{n}")).collect();
        let text = format!("sides {}", sides.join(", "));
        let style: TextStyle<'_> = (FONT, f64::from(TEXT)).into_font().color(&BLACK);
        let style = style.pos(Pos::new(HPos::Center, VPos::Center));
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
    use crate::figure::tests::{assert_reviewed, assert_written};

    #[test]
    fn the_quick_mesh_of_the_guide_is_as_reviewed_and_can_be_drawn() {
        let params = Mesh::params(Preset::Quick).expect("paper values");
        let figure = Mesh::compute(&params).expect("the contact is solved");
        let sizes = figure.sizes();
        let load: f64 = sizes.values().map(|size| size.load).sum();
        assert!((load / params.mean_pressure - 1.0).abs() < 1e-9, "the elements carry {load}");
        assert_eq!(sizes.len(), 2, "elements of the grid and halved ones: {sizes:?}");
        assert_reviewed(&figure, &params, &["guide-mesh-sizes"]);
        assert_written(&figure);
    }
}
