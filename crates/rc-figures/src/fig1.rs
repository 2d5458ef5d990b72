//! Fig. 1: a section of a solved contact.
//!
//! It shows the rigid rough surface, the deformed half-space, the penetration Δ and the mean planes. The paper's figure
//! is a sketch, while this one is a solution. The section is the row of elements through the highest peak. There the
//! displacement v has its largest value, which is Δ (Sec. 2).

use std::f64::consts::TAU;

use anyhow::Result;
use plotters::prelude::DrawingBackend;
use plotters::style::{BLACK, RGBColor};
use rc_core::{Field, Grid, HeightField as _};
use rc_fractal::{SpectrumParams, Surface};
use rc_plot::{Area, Picture, PictureError};
use rc_solver::{Control, Method, Solution, SolveParams, solve};

use crate::chart::{BLUE, GREY, Panel, Pen, RED, Side};
use crate::table::{Rows, quantity, summary};
use crate::{Figure, Preset, Rule, Table, paper};

/// Colour of the rigid body. The colour of the half-space follows.
const RIGID: RGBColor = RGBColor(214, 214, 214);
const SOFT: RGBColor = RGBColor(203, 223, 242);
/// Width of the enlarged part, in λ.
const WINDOW: f64 = 0.25;
/// Micrometres in a metre. Millimetres in a metre follow.
const MICRO: f64 = 1e6;
const MILLI: f64 = 1e3;

/// Parameters of Fig. 1.
#[derive(Clone, Debug)]
pub struct Params {
    /// Number of waves N.
    waves: usize,
    /// Elements per side.
    grid: usize,
    /// Mean pressure σ0/E*.
    mean_pressure: f64,
    /// Seed of the phases.
    seed: u64,
    /// Relative tolerance of the solve.
    tolerance: f64,
    /// Side λ of the cell (m).
    cell: f64,
}

/// One element of the section, with displacements (m) that are positive into the half-space.
#[derive(Clone, Copy, Debug)]
struct Point {
    /// Distance from the highest peak (m).
    x: f64,
    /// Displacement at which the half-space touches the rigid surface, h - h_max + Δ.
    rigid: f64,
    /// Displacement v of the half-space.
    deformed: f64,
    /// σ/E*.
    pressure: f64,
}

/// The section with its measured lengths, in SI units.
#[derive(Clone, Debug)]
pub struct Fig1 {
    cell: f64,
    mean_pressure: f64,
    /// Elements of the section, with the highest peak in the middle.
    points: Vec<Point>,
    /// Penetration Δ.
    penetration: f64,
    /// Height of the highest peak above the mean plane of the roughness.
    h_max: f64,
    /// Mean displacement over the whole cell. The maximum follows.
    mean_displacement: f64,
    max_displacement: f64,
    /// A/A0 of the whole cell.
    area: f64,
}

impl Figure for Fig1 {
    const NAME: &'static str = "fig1";
    type Params = Params;

    /// 64 waves of the paper's surface on 32 elements per shortest wave (full).
    ///
    /// The quick preset has 8 waves on 16 elements per shortest wave.
    fn params(preset: Preset) -> Result<Params> {
        let (waves, grid, tolerance) = match preset {
            Preset::Full => (paper::value("waves_a")? as usize, 2048, 1e-6),
            Preset::Quick => (8, 128, 1e-9),
        };
        let (mean_pressure, cell) = (paper::value("load")?, TAU / paper::value("q0")?);
        Ok(Params { waves, grid, mean_pressure, seed: 1, tolerance, cell })
    }

    fn compute(params: &Params) -> Result<Self> {
        let surface = Surface::new(&SpectrumParams::paper(params.waves, params.seed))?;
        let grid = Grid::square(params.grid)?;
        let solving = SolveParams::to_tolerance(params.tolerance).by(Method::Adaptive);
        let solution = solve(surface.on(grid), Control::MeanPressure(params.mean_pressure), &solving)?;
        Ok(Self::of(params, &surface.sample_on(grid)?, &solution))
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.summary(), self.section()]
    }
}

impl Picture for Fig1 {
    fn size(&self) -> (u32, u32) {
        (2100, 1560)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let (upper, lower) = area.split_vertically(880);
        self.whole(upper.dim_in_pixel()).draw(&upper)?;
        self.part(lower.dim_in_pixel()).draw(&lower)
    }
}

impl Fig1 {
    /// The row through the highest peak, shifted so that the peak is in its middle.
    fn of(params: &Params, heights: &Field, solution: &Solution<'_>) -> Self {
        let (n, cell, penetration) = (params.grid, params.cell, solution.info().penetration);
        let (pressure, displacement) = (solution.pressure(), solution.displacement());
        let h_max = heights.max();
        let peak = heights.values().iter().position(|&h| h >= h_max).unwrap_or(0);
        let (peak_x, row) = (peak % n, peak / n);
        let points = (0..n).map(|i| {
            let ix = (peak_x + n / 2 + i) % n;
            Point {
                x: (i as f64 - (n / 2) as f64) * cell / n as f64,
                rigid: cell * (heights.at(ix, row) - h_max + penetration),
                deformed: cell * displacement.at(ix, row),
                pressure: pressure.at(ix, row),
            }
        });
        Self {
            cell,
            mean_pressure: params.mean_pressure,
            points: points.collect(),
            penetration: cell * penetration,
            h_max: cell * solution.info().penetration_full_contact,
            mean_displacement: cell * displacement.mean(),
            max_displacement: cell * displacement.max(),
            area: solution.area().fraction,
        }
    }

    fn summary(&self) -> Table {
        let in_contact = self.points.iter().filter(|point| point.pressure > 0.0).count();
        let quantities = [
            quantity("mean pressure", "E*", self.mean_pressure),
            quantity("contact area", "A0", self.area),
            quantity("contact along the section", "cell side", in_contact as f64 / self.points.len() as f64),
            quantity("penetration", "um", MICRO * self.penetration),
            quantity("greatest displacement", "um", MICRO * self.max_displacement),
            quantity("mean displacement", "um", MICRO * self.mean_displacement),
            quantity("h_max", "um", MICRO * self.h_max),
            quantity("mean gap", "um", MICRO * (self.h_max - self.penetration)),
        ];
        // The mean is of displacements up to 17 µm, from an operator that is exact to 1e-6 of them.
        summary(quantities, &[]).column("value", Rule::relative(1e-5)).row("mean displacement", Rule::absolute(5e-5))
    }

    fn section(&self) -> Table {
        let length = Rule::of_scale(1e-5);
        Rows::of(&self.points)
            .column("x_mm", |point| MILLI * point.x)
            .within("rigid_um", length, |point| MICRO * point.rigid)
            .within("displacement_um", length, |point| MICRO * point.deformed)
            .within("gap_um", length, |point| MICRO * (point.deformed - point.rigid))
            .within("pressure_over_e_star", Rule::of_scale(3e-4), |point| point.pressure)
            .table("section")
    }

    /// The profiles within `half_width` (m) of the peak.
    ///
    /// The last point of the cell is the image of its first point.
    fn profile(&self, half_width: f64) -> Vec<Heights> {
        let image = self.points.first().map(|point| Point { x: 0.5 * self.cell, ..*point });
        let inside = self.points.iter().copied().chain(image).filter(|point| point.x.abs() <= half_width);
        let heights = inside.map(|point| Heights {
            x: MILLI * point.x,
            rigid: -MICRO * point.rigid,
            soft: -MICRO * point.deformed,
            touching: point.pressure > 0.0,
        });
        heights.collect()
    }

    /// The whole section with planes and dimensions, on an area of `size` pixels.
    fn whole(&self, size: (u32, u32)) -> Panel {
        let profile = self.profile(0.5 * self.cell);
        let top = profile.iter().map(|at| at.rigid).fold(0.0, f64::max);
        let (depth, gap) = (-MICRO * self.penetration, MICRO * (self.h_max - self.penetration));
        let half = MILLI * 0.5 * self.cell;
        let mut panel = bodies(&profile, half, (1.8 * depth, 1.15 * top), size);
        for plane in [0.0, gap] {
            panel.line([(-half, plane), (half, plane)], Pen::new(BLACK, 2).dashed(12, 8));
        }
        let (delta_x, h_max_x, gap_x) = (-0.05 * half, 0.32 * half, -0.92 * half);
        panel.line([(delta_x - 0.04 * half, depth), (h_max_x + 0.04 * half, depth)], Pen::new(BLACK, 1));
        for (x, ends, side, name) in [
            (delta_x, (0.0, depth), Side::Left, "Δ"),
            (h_max_x, (gap, depth), Side::Right, "h_max"),
            (gap_x, (0.0, gap), Side::Right, "h_max − Δ"),
        ] {
            panel.dimension(x, ends);
            panel.text((x, 0.5 * (ends.0 + ends.1)), side, name, BLACK);
        }
        panel.text((-0.2 * half, gap), Side::Above, "mean plane of the roughness, h = 0", BLACK);
        panel.text((-0.75 * half, 0.0), Side::Below, "mean plane of the half-space, v = 0", BLACK);
        panel.text((0.72 * half, 1.05 * top), Side::Below, "rigid rough surface", GREY);
        panel.text((-0.72 * half, 1.4 * depth), Side::Below, "elastic half-space", BLUE);
        panel.text((0.42 * half, 0.75 * depth), Side::Below, "contact", RED);
        panel
    }

    /// The surroundings of the peak, on an area of `size` pixels.
    fn part(&self, size: (u32, u32)) -> Panel {
        let half = 0.5 * WINDOW * self.cell;
        let profile = self.profile(half);
        let soft = || profile.iter().map(|at| at.soft);
        let (low, high) = (soft().fold(f64::INFINITY, f64::min), soft().fold(f64::NEG_INFINITY, f64::max));
        bodies(&profile, MILLI * half, (low - 0.3 * (high - low), high + 0.45 * (high - low)), size)
    }
}

/// Heights for the drawing, above the mean plane of the half-space: -v.
#[derive(Clone, Copy, Debug)]
struct Heights {
    /// Distance from the peak (mm).
    x: f64,
    /// Rigid surface (µm).
    rigid: f64,
    /// Surface of the half-space (µm).
    soft: f64,
    touching: bool,
}

/// Both bodies and their contact, with the exaggeration of heights on an area of `size` pixels.
fn bodies(profile: &[Heights], half_width: f64, y: (f64, f64), size: (u32, u32)) -> Panel {
    let mut panel = Panel::new(("x (mm)", (-half_width, half_width)), ("height −v (µm)", y)).ticks(10, 8);
    let line = |height: fn(&Heights) -> f64| -> Vec<(f64, f64)> {
        profile.iter().map(|at| (at.x, height(at).clamp(y.0, y.1))).collect()
    };
    for (height, edge, fill, stroke) in [(line(|at| at.rigid), y.1, RIGID, GREY), (line(|at| at.soft), y.0, SOFT, BLUE)]
    {
        panel.body(height.iter().copied().chain([half_width, -half_width].map(|x| (x, edge))), fill);
        panel.line(height, Pen::new(stroke, 2));
    }
    for run in profile.chunk_by(|a, b| a.touching == b.touching).filter(|run| run[0].touching) {
        panel.line(run.iter().map(|at| (at.x, at.soft)), Pen::new(RED, 6));
    }
    // Ratio of µm per pixel along y to mm per pixel along x.
    let (width, height) = Panel::plotting_size(size);
    let exaggeration = MICRO / MILLI * (height / (y.1 - y.0)) / (width / (2.0 * half_width));
    let corner = (half_width, y.0 + 0.05 * (y.1 - y.0));
    panel.text(corner, Side::Left, format!("heights × {exaggeration:.0}"), BLACK);
    panel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    /// Allowed difference of displacements relative to h_max.
    ///
    /// The operator is exact to 1e-6 of their rms, which is below h_max. Single points have errors of a few times that.
    const DISPLACEMENT_ERROR: f64 = 5e-6;

    fn quick() -> (Params, Fig1) {
        let params = Fig1::params(Preset::Quick).expect("paper values");
        let figure = Fig1::compute(&params).expect("the quick figure is solved");
        (params, figure)
    }

    #[test]
    fn the_greatest_displacement_is_the_penetration_and_the_mean_is_zero() {
        let (_, figure) = quick();
        let bound = DISPLACEMENT_ERROR * figure.h_max;
        let Fig1 { max_displacement, penetration, mean_displacement, .. } = figure;
        let difference = max_displacement - penetration;
        assert!(difference.abs() < bound, "{max_displacement:e} against {penetration:e}, difference {difference:e}");
        assert!(mean_displacement.abs() < bound, "mean displacement {mean_displacement:e} above {bound:e}");
    }

    #[test]
    fn no_body_is_inside_the_other_and_pressure_is_only_where_they_touch() {
        let (_, figure) = quick();
        let bound = DISPLACEMENT_ERROR * figure.h_max;
        for point in &figure.points {
            let gap = point.deformed - point.rigid;
            assert!(gap > -bound, "penetration at {point:?}");
            assert!(point.pressure == 0.0 || gap < 10.0 * bound, "pressure across a gap of {gap:e} at {point:?}");
        }
    }

    #[test]
    fn quick_figure_1_is_as_reviewed_and_can_be_drawn() {
        let (params, figure) = quick();
        assert_reviewed(&figure, &params, &["fig1-summary", "fig1-section"]);
        assert_written(&figure);
    }
}
