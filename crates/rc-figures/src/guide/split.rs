//! The kernel split by scale.
//!
//! The displacement of one element is the sum of what each level of the operator adds.

use std::f64::consts::PI;

use anyhow::Result;
use plotters::prelude::{Circle, DrawingBackend, LineSeries, PathElement};
use plotters::style::{BLACK, Color, RGBColor};
use rc_core::DVec2;
use rc_kernel::{ScaleSplit, SplitParams, Stencil, love_displacement};
use rc_plot::{Area, Picture, PictureError};

use crate::chart::{Axes, BLUE, Chart, Drawn, GREEN, RED, Side, write};
use crate::{Figure, Preset, Rule, Table, number};

const COLOURS: [RGBColor; 3] = [BLUE, GREEN, RGBColor(200, 130, 0)];
/// Lowest power of ten in the drawings of displacements and of transforms.
const FLOOR: [f64; 2] = [-5.0, -7.0];

/// Parameters of the figure.
#[derive(Clone, Debug)]
pub struct Params {
    split: SplitParams,
    /// Number of levels above the base grid.
    n_levels: usize,
    /// Number of wavenumbers of the transforms.
    n_waves: usize,
}

/// The parts of the kernel, in units of the finest element's side and E*.
#[derive(Clone, Debug)]
pub struct Split {
    tables: ScaleSplit,
    params: Params,
    /// Angular wavenumbers. The transforms of the levels' parts at them follow, finest level first, remainder last.
    waves: Vec<f64>,
    transforms: Vec<Vec<f64>>,
}

impl Figure for Split {
    const NAME: &'static str = "guide-split";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        let n_waves = match preset {
            Preset::Full => 400,
            Preset::Quick => 40,
        };
        Ok(Params { split: SplitParams::certified(), n_levels: 3, n_waves })
    }

    fn compute(params: &Params) -> Result<Self> {
        let split = ScaleSplit::new(params.split);
        let step = |i: usize| 3.0 * i as f64 / (params.n_waves - 1) as f64;
        let waves: Vec<f64> = (0..params.n_waves).map(|i| 1e-3 * 4.0 * 10_f64.powf(step(i))).collect();
        let cutoff = |level: usize| params.split.cutoff as f64 * side(level);
        let short = |level: usize, q: f64| split.short_range_symbol(q, cutoff(level));
        let part = |level: usize| {
            let below = move |q: f64| if level == 0 { 0.0 } else { short(level - 1, q) };
            waves.iter().map(|&q| short(level, q) - below(q)).collect()
        };
        let last = cutoff(params.n_levels - 1);
        let remainder = waves.iter().map(|&q| split.remainder_symbol(q, last)).collect();
        let transforms = (0..params.n_levels).map(part).chain([remainder]).collect();
        Ok(Self { tables: split, params: params.clone(), waves, transforms })
    }

    fn tables(&self) -> Vec<Table> {
        vec![self.displacements(), self.symbols()]
    }
}

/// Side of an element of a level, in sides of the finest level's element (level 0).
fn side(level: usize) -> f64 {
    f64::from(1_u32 << level)
}

impl Split {
    fn stencil(&self, level: usize) -> Stencil {
        if level == 0 { self.tables.love_stencil() } else { self.tables.level_stencil() }
    }

    /// The part of a level in the displacement of the point at `r` along x.
    ///
    /// `None` where the level does not have a point, and zero beyond its stencil.
    fn part(&self, level: usize, r: usize) -> Option<f64> {
        let step = 1 << level;
        let stencil = self.stencil(level);
        let offset = r / step;
        let inside = offset <= stencil.radius();
        r.is_multiple_of(step).then(|| if inside { stencil.weight(offset as i32, 0) / side(level) } else { 0.0 })
    }

    /// The part of the base grid, which is the rest.
    fn rest(&self, r: usize) -> Option<f64> {
        let parts: Option<f64> = (0..self.params.n_levels).map(|level| self.part(level, r)).sum();
        parts.map(|parts| whole(r) - parts)
    }

    /// Twice the reach of the coarsest stencil, in finest elements.
    fn reach(&self) -> usize {
        (2 * self.params.split.cutoff) << (self.params.n_levels - 1)
    }

    /// Points of the tables and pictures.
    ///
    /// They are the points of the finest stencil, then the points that all levels have.
    fn distances(&self) -> Vec<usize> {
        let reach = self.reach();
        let last = 1 << (self.params.n_levels - 1);
        (0..=reach).filter(|r| *r <= self.params.split.cutoff || r % last == 0).collect()
    }

    fn displacements(&self) -> Table {
        let names = (0..self.params.n_levels).map(|level| format!("level_{level}"));
        let header: Vec<String> = ["r", "whole"].map(str::to_owned).into_iter().chain(names).collect();
        let header: Vec<&str> = header.iter().map(String::as_str).chain(["base"]).collect();
        let rows = self.distances().into_iter().map(|r| {
            let parts = (0..self.params.n_levels).map(|level| self.part(level, r)).chain([self.rest(r)]);
            let parts = parts.map(|part| part.map_or_else(String::new, number));
            [r.to_string(), number(whole(r))].into_iter().chain(parts).collect()
        });
        Table::new("displacements", &header, rows).rest(Rule::of_scale(1e-8))
    }

    fn symbols(&self) -> Table {
        let names = (0..self.params.n_levels).map(|level| format!("level_{level}"));
        let header: Vec<String> = ["q".to_owned()].into_iter().chain(names).collect();
        let header: Vec<&str> = header.iter().map(String::as_str).chain(["base"]).collect();
        let rows = self.waves.iter().enumerate().map(|(i, &q)| {
            let values = self.transforms.iter().map(|part| part[i]);
            [q].into_iter().chain(values).map(number).collect()
        });
        Table::new("symbols", &header, rows).rest(Rule::of_scale(1e-8))
    }

    fn name(&self, level: usize) -> String {
        match level {
            0 => "finest level".to_owned(),
            1 => "next level".to_owned(),
            level if level == self.params.n_levels => "base grid (transform)".to_owned(),
            _ => "next level again".to_owned(),
        }
    }

    fn draw_displacements<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let axes = Axes {
            x: (0.0, 1.85),
            y: (FLOOR[0], 0.3),
            x_label: "log10 (r / h)",
            y_label: "log10 (v E* / (p h))",
            n_labels: (10, 7),
        };
        let mut chart = axes.on(area)?;
        let line = |value: &dyn Fn(usize) -> Option<f64>| -> Vec<(f64, f64)> {
            let points = (1..=self.reach().min(70)).filter_map(|r| Some((r, value(r)?)));
            logarithms(points.map(|(r, v)| (r as f64, v)), FLOOR[0])
        };
        chart.draw_series(LineSeries::new(line(&|r| Some(whole(r))), BLACK.stroke_width(2)))?;
        for (level, colour) in (0..self.params.n_levels).zip(COLOURS) {
            dotted(&mut chart, &line(&|r| self.part(level, r)), colour)?;
        }
        let base = |r: usize| self.rest(r).filter(|_| r.is_multiple_of(1 << self.params.n_levels));
        chart.draw_series(LineSeries::new(line(&|r| self.rest(r)), RED.stroke_width(2)))?;
        chart.draw_series(line(&base).into_iter().map(|at| Circle::new(at, 5, RED.filled())))?;
        write(&mut chart, (0.62, -0.75), Side::Right, "one element: the sum of all parts", BLACK)?;
        write(&mut chart, (0.05, -4.7), Side::Right, "(a)", BLACK)
    }

    fn draw_symbols<B: DrawingBackend>(&self, area: &Area<B>) -> Drawn<(), B> {
        let axes = Axes {
            x: (-2.4, 0.6),
            y: (FLOOR[1], 3.0),
            x_label: "log10 (q h)",
            y_label: "log10 (transform E* / h)",
            n_labels: (8, 8),
        };
        let mut chart = axes.on(area)?;
        let half_space = self.waves.iter().map(|&q| (q, 2.0 / q));
        chart.draw_series(LineSeries::new(logarithms(half_space, FLOOR[1]), BLACK.stroke_width(2)))?;
        let colours = COLOURS.into_iter().take(self.params.n_levels).chain([RED]);
        for (level, (part, colour)) in self.transforms.iter().zip(colours).enumerate() {
            let line = logarithms(self.waves.iter().copied().zip(part.iter().copied()), FLOOR[1]);
            chart.draw_series(LineSeries::new(line, colour.stroke_width(3)))?;
            let shortest = (PI / side(level)).log10();
            chart.draw_series([PathElement::new(
                [(shortest, FLOOR[1]), (shortest, FLOOR[1] + 0.6)],
                colour.stroke_width(4),
            )])?;
            write(&mut chart, (-2.3, -2.2 - 0.75 * level as f64), Side::Right, &self.name(level), colour)?;
        }
        write(&mut chart, (-1.0, 2.3), Side::Right, "half-space, 2/q", BLACK)?;
        write(&mut chart, (-2.3, -6.6), Side::Right, "(b)", BLACK)
    }
}

/// The displacement at `r` by one element under unit pressure.
fn whole(r: usize) -> f64 {
    love_displacement(DVec2::new(r as f64, 0.0), 0.5)
}

/// Decimal logarithms of both coordinates, up to the first point below the floor.
///
/// Points whose second coordinate is not positive are left out.
fn logarithms(points: impl Iterator<Item = (f64, f64)>, floor: f64) -> Vec<(f64, f64)> {
    let points = points.filter(|(_, value)| *value > 0.0).map(|(at, value)| (at.log10(), value.log10()));
    points.take_while(|(_, value)| *value > floor).collect()
}

/// Draws a thin line with a dot at each weight of a stencil.
fn dotted<B: DrawingBackend>(chart: &mut Chart<'_, B>, points: &[(f64, f64)], colour: RGBColor) -> Drawn<(), B> {
    chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
    chart.draw_series(points.iter().map(|&at| Circle::new(at, 5, colour.filled())))?;
    Ok(())
}

impl Picture for Split {
    fn size(&self) -> (u32, u32) {
        (1800, 760)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let panels = area.split_evenly((1, 2));
        self.draw_displacements(&panels[0]).map_err(PictureError::new)?;
        self.draw_symbols(&panels[1]).map_err(PictureError::new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::tests::{assert_reviewed, assert_written};

    fn quick() -> (Split, Params) {
        let params = Split::params(Preset::Quick).expect("plain values");
        (Split::compute(&params).expect("tables cannot fail"), params)
    }

    #[test]
    fn the_parts_of_the_kernel_add_up_to_the_half_space() {
        let (figure, _) = quick();
        for (i, q) in figure.waves.iter().enumerate() {
            let sum: f64 = figure.transforms.iter().map(|part| part[i]).sum();
            assert!((sum * q / 2.0 - 1.0).abs() < 1e-12, "{sum} at q = {q}");
        }
    }

    /// Far from the element only the part of the base grid remains.
    #[test]
    fn stencils_end_and_the_remainder_is_smooth() {
        let (figure, params) = quick();
        let reach = params.split.cutoff << (params.n_levels - 1);
        assert_eq!(figure.rest(2 * reach), Some(whole(2 * reach)));
        let near = figure.rest(0).expect("a point of every level");
        assert!(near < 0.1 * whole(0), "the remainder is {near} at the element, which is displaced by {}", whole(0));
    }

    #[test]
    fn the_quick_split_of_the_guide_is_as_reviewed_and_can_be_drawn() {
        let (figure, params) = quick();
        assert_reviewed(&figure, &params, &["guide-split-displacements", "guide-split-symbols"]);
        assert_written(&figure);
    }
}
