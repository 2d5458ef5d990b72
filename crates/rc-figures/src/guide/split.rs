//! The kernel split by scale.
//!
//! The displacement of one element is the sum of what each level of the operator adds.

use std::f64::consts::PI;

use plotters::prelude::DrawingBackend;
use plotters::style::{BLACK, RGBColor};
use rc_core::DVec2;
use rc_kernel::{ScaleSplit, SplitParams, Stencil, love_displacement};
use rc_plot::{Area, Picture, PictureError};

use crate::Preset;
use crate::chart::{BLUE, GREEN, Mark, Panel, Pen, RED, Side, draw_panels};

/// Number of levels above the base grid.
const N_LEVELS: usize = 3;
/// Colour and name of each level's part, finest level first, base grid last.
const PARTS: [(RGBColor, &str); N_LEVELS + 1] = [
    (BLUE, "finest level"),
    (GREEN, "next level"),
    (RGBColor(200, 130, 0), "next level again"),
    (RED, "base grid (transform)"),
];
/// Lowest power of ten in the drawings of displacements and of transforms.
const FLOOR: [f64; 2] = [-5.0, -7.0];
/// Greatest distance that is drawn, in finest elements.
const FARTHEST: usize = 70;

/// The parts of the kernel, in units of the finest element's side and E*.
#[derive(Clone, Debug)]
pub(super) struct Split {
    tables: ScaleSplit,
    /// Angular wavenumbers. The transforms of the levels' parts at them follow, finest level first, remainder last.
    waves: Vec<f64>,
    transforms: Vec<Vec<f64>>,
}

impl Split {
    pub(super) fn compute(preset: Preset) -> Self {
        let n_waves = if preset == Preset::Full { 400 } else { 40 };
        let params = SplitParams::certified();
        let split = ScaleSplit::new(params);
        let step = |i: usize| 3.0 * i as f64 / (n_waves - 1) as f64;
        let waves: Vec<f64> = (0..n_waves).map(|i| 1e-3 * 4.0 * 10_f64.powf(step(i))).collect();
        let cutoff = |level: usize| params.cutoff as f64 * side(level);
        let short = |level: usize, q: f64| split.short_range_symbol(q, cutoff(level));
        let part = |level: usize| {
            let below = move |q: f64| if level == 0 { 0.0 } else { short(level - 1, q) };
            waves.iter().map(|&q| short(level, q) - below(q)).collect()
        };
        let remainder = waves.iter().map(|&q| split.remainder_symbol(q, cutoff(N_LEVELS - 1))).collect();
        let transforms = (0..N_LEVELS).map(part).chain([remainder]).collect();
        Self { waves, transforms, tables: split }
    }

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
        let parts: Option<f64> = (0..N_LEVELS).map(|level| self.part(level, r)).sum();
        parts.map(|parts| whole(r) - parts)
    }

    fn displacements_panel(&self) -> Panel {
        let y = ("log10 (v E* / (p h))", (FLOOR[0], 0.3));
        let mut panel = Panel::new(("log10 (r / h)", (0.0, 1.85)), y).ticks(10, 7);
        let line = |value: &dyn Fn(usize) -> Option<f64>| -> Vec<(f64, f64)> {
            let points = (1..=FARTHEST).filter_map(|r| Some((r as f64, value(r)?)));
            logarithms(points, FLOOR[0])
        };
        panel.line(line(&|r| Some(whole(r))), Pen::new(BLACK, 2));
        for (level, (colour, _)) in PARTS.into_iter().enumerate() {
            let (all, own) = if level < N_LEVELS {
                (line(&|r| self.part(level, r)), line(&|r| self.part(level, r)))
            } else {
                let is_point = |r: usize| r.is_multiple_of(1 << N_LEVELS);
                (line(&|r| self.rest(r)), line(&|r| self.rest(r).filter(|_| is_point(r))))
            };
            panel.line(all, Pen::new(colour, 2));
            panel.marks(own, Mark::dot(colour, 5));
        }
        panel.note((0.62, -0.75), "one element: the sum of all parts");
        panel.note((0.05, -4.7), "(a)");
        panel
    }

    fn transforms_panel(&self) -> Panel {
        let y = ("log10 (transform E* / h)", (FLOOR[1], 3.0));
        let mut panel = Panel::new(("log10 (q h)", (-2.4, 0.6)), y).ticks(8, 8);
        let half_space = self.waves.iter().map(|&q| (q, 2.0 / q));
        panel.line(logarithms(half_space, FLOOR[1]), Pen::new(BLACK, 2));
        for (level, (part, (colour, name))) in self.transforms.iter().zip(PARTS).enumerate() {
            let points = self.waves.iter().copied().zip(part.iter().copied());
            panel.line(logarithms(points, FLOOR[1]), Pen::new(colour, 3));
            let shortest = (PI / side(level)).log10();
            panel.line([FLOOR[1], FLOOR[1] + 0.6].map(|y| (shortest, y)), Pen::new(colour, 4));
            panel.text((-2.3, -2.2 - 0.75 * level as f64), Side::Right, name, colour);
        }
        panel.note((-1.0, 2.3), "half-space, 2/q");
        panel.note((-2.3, -6.6), "(b)");
        panel
    }
}

/// Side of an element of a level, in sides of the finest level's element (level 0).
fn side(level: usize) -> f64 {
    f64::from(1_u32 << level)
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

impl Picture for Split {
    fn size(&self) -> (u32, u32) {
        (1800, 760)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        draw_panels(area, (1, 2), &[self.displacements_panel(), self.transforms_panel()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_the_kernel_add_up_to_the_half_space() {
        let figure = Split::compute(Preset::Quick);
        for (i, q) in figure.waves.iter().enumerate() {
            let sum: f64 = figure.transforms.iter().map(|part| part[i]).sum();
            assert!((sum * q / 2.0 - 1.0).abs() < 1e-12, "{sum} at q = {q}");
        }
    }

    /// Far from the element only the part of the base grid remains.
    #[test]
    fn stencils_end_and_the_remainder_is_smooth() {
        let figure = Split::compute(Preset::Quick);
        let reach = SplitParams::certified().cutoff << (N_LEVELS - 1);
        assert_eq!(figure.rest(2 * reach), Some(whole(2 * reach)));
        let near = figure.rest(0).expect("a point of every level");
        assert!(near < 0.1 * whole(0), "the remainder is {near} at the element, which is displaced by {}", whole(0));
    }
}
