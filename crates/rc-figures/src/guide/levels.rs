//! One application of the multilevel operator, level by level.
//!
//! Pressures are restricted down to the base grid, then displacements are prolonged up again.

use anyhow::{Context, Result};
use plotters::prelude::{DrawingBackend, PathElement, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{BLACK, Color};
use rc_core::{Field, Grid, HeightField as _, Kernel, Operator as _, Symbol};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{ScaleSplit, SplitParams};
use rc_plot::{Area, Palette, Picture, PictureError, Raster};
use rc_solver::{Control, Method, SolveParams, UniformOperator, solve};

use super::transfer::{displaced, prolonged, restricted};
use crate::chart::{BLUE, GREY, words};
use crate::{Preset, paper};

/// Side of a map, in pixels. The following sizes are also in pixels.
const PANEL: i32 = 224;
const ROW: i32 = 290;
const INDENT: i32 = 120;
const TEXT: i32 = 24;
const WIDTH: i32 = 1380;
/// Elements along the side of a tile.
const TILE: usize = 8;

/// Parameters of the figure.
#[derive(Clone, Debug)]
pub(super) struct Params {
    /// Number of waves N.
    waves: usize,
    /// Elements per side of the finest grid and of the base grid.
    grids: (usize, usize),
    /// Mean pressure σ0/E*.
    mean_pressure: f64,
    split: SplitParams,
}

/// Fields and tiles of one level.
#[derive(Clone, Debug)]
struct Level {
    pressure: Field,
    displacement: Field,
    /// Whether the solver would keep a tile, row by row.
    tiles: Vec<bool>,
}

/// All levels in units of λ and E*, the finest first.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    levels: Vec<Level>,
}

/// The part of the kernel that the stencils leave to the base grid.
struct Remainder<'a> {
    split: &'a ScaleSplit,
    cutoff: f64,
    /// Displacement that the stencils cause under a uniform pressure of 1.
    ///
    /// The base grid subtracts it, since a constant pressure displaces nothing (Eq. 3).
    of_constant: f64,
}

impl Kernel for Remainder<'_> {
    fn name(&self) -> &'static str {
        "remainder"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        Box::new(move |kx, ky| {
            let q = std::f64::consts::TAU * grid.waves(kx, ky);
            if q == 0.0 { -self.of_constant } else { self.split.remainder_symbol(q, self.cutoff) }
        })
    }
}

impl Params {
    /// Four waves on 128², 64², 32² and 16² elements (full), or on two levels less (quick).
    pub(super) fn of(preset: Preset) -> Result<Self> {
        let grids = match preset {
            Preset::Full => (128, 16),
            Preset::Quick => (64, 16),
        };
        Ok(Self { waves: 4, grids, mean_pressure: 0.4 * paper::value("load")?, split: SplitParams::quick() })
    }
}

/// Weights of the filter between level `depth` and the next coarser level. The finest level is 0.
fn taps(split: &ScaleSplit, depth: usize) -> Vec<f64> {
    let filter = if depth == 0 { split.love_filter() } else { split.level_filter() };
    filter.taps().to_vec()
}

/// The pressure on every level, down to the base grid.
fn pressures(finest: &Field, split: &ScaleSplit, base: usize) -> Result<Vec<Field>> {
    let mut levels = vec![finest.clone()];
    while let Some(last) = levels.last().filter(|level| level.grid().nx() > base) {
        let next = restricted(last, &taps(split, levels.len() - 1))?;
        levels.push(next);
    }
    Ok(levels)
}

/// The displacement on every level, from the base grid up.
fn displacements(pressures: &[Field], split: &ScaleSplit) -> Result<Vec<Field>> {
    let (base, above) = pressures.split_last().context("a level")?;
    let stencil = |depth: usize| if depth == 0 { split.love_stencil() } else { split.level_stencil() };
    let of_constant = |(depth, level): (usize, &Field)| level.grid().spacing().x * stencil(depth).sum();
    let remainder = Remainder {
        split,
        cutoff: 0.5 * split.params().cutoff as f64 * base.grid().spacing().x,
        of_constant: above.iter().enumerate().map(of_constant).sum(),
    };
    let mut levels = vec![applied(&UniformOperator::new(base.grid(), &remainder), base)];
    for (depth, pressure) in above.iter().enumerate().rev() {
        let mut displacement = prolonged(levels.last().context("the level below")?, &taps(split, depth))?;
        let added = displaced(pressure, &stencil(depth));
        displacement.values_mut().iter_mut().zip(added.values()).for_each(|(value, added)| *value += added);
        levels.push(displacement);
    }
    levels.reverse();
    Ok(levels)
}

fn applied(operator: &UniformOperator, pressure: &Field) -> Field {
    let mut displacement = Field::zeros(pressure.grid());
    operator.apply(pressure.values(), displacement.values_mut(), &mut []);
    displacement
}

/// The tiles of each level.
///
/// On the finest level they are the tiles that the contact touches. On coarser levels they are the tiles that the
/// filters reach from the finer level.
fn tiles(pressures: &[Field], split: &ScaleSplit) -> Result<Vec<Vec<bool>>> {
    let mut marks = pressures[0].clone();
    let mut levels = Vec::new();
    for (depth, pressure) in pressures.iter().enumerate() {
        let grid = pressure.grid();
        let columns = grid.nx() / TILE;
        let tile = |i: usize| (i / grid.nx() / TILE) * columns + (i % grid.nx()) / TILE;
        let mut tiles = vec![false; columns * (grid.ny() / TILE)];
        (0..grid.len()).filter(|&i| marks.values()[i] > 0.0).for_each(|i| tiles[tile(i)] = true);
        for (i, mark) in marks.values_mut().iter_mut().enumerate() {
            *mark = f64::from(u8::from(tiles[tile(i)]));
        }
        if depth + 1 < pressures.len() {
            let taps: Vec<f64> = taps(split, depth).iter().map(|tap| tap.abs()).collect();
            marks = restricted(&marks, &taps)?;
        }
        levels.push(tiles);
    }
    Ok(levels)
}

/// Upper left corners of the two maps of a level.
fn corners(depth: usize) -> [(i32, i32); 2] {
    let (indent, top) = (20 + INDENT * depth as i32, 56 + ROW * depth as i32);
    [(indent, top), (WIDTH - indent - PANEL, top)]
}

impl Levels {
    pub(super) fn compute(params: &Params) -> Result<Self> {
        let (split, finest) = (ScaleSplit::new(params.split), Grid::square(params.grids.0)?);
        let surface = Surface::new(&SpectrumParams::paper(params.waves, 1))?;
        let how = SolveParams::to_tolerance(1e-10).by(Method::Uniform);
        let solution = solve(surface.on(finest), Control::MeanPressure(params.mean_pressure), &how)?;
        let pressures = pressures(solution.pressure(), &split, params.grids.1)?;
        let displacements = displacements(&pressures, &split)?;
        let tiles = tiles(&pressures, &split)?;
        let levels = pressures.into_iter().zip(displacements).zip(tiles);
        let level = |((pressure, displacement), tiles)| Level { pressure, displacement, tiles };
        Ok(Self { levels: levels.map(level).collect() })
    }

    fn draw_level<B: DrawingBackend>(&self, area: &Area<B>, depth: usize) -> Result<(), PictureError> {
        let level = &self.levels[depth];
        let [left, right] = corners(depth);
        let is_base = depth + 1 == self.levels.len();
        let whole = vec![true; level.tiles.len()];
        let displaced_tiles = if is_base { &whole } else { &level.tiles };
        draw_field(area, left, &level.pressure, &level.tiles)?;
        draw_field(area, right, &level.displacement, displaced_tiles)?;
        let n = level.pressure.grid().nx();
        let name = if depth == 0 { "p" } else { "ρ" };
        let middle = |corner: (i32, i32)| (corner.0 + PANEL / 2, corner.1 - TEXT / 2 - 2);
        label(area, middle(left), &format!("{name}, {n}²"))?;
        label(area, middle(right), &format!("{}, {n}²", if depth == 0 { "v" } else { "u" }))?;
        let level_y = left.1 + PANEL / 2;
        arrow(area, (left.0 + PANEL + 12, level_y), (right.0 - 12, level_y))?;
        let what = if is_base { "transform" } else { "stencil" };
        label(area, (WIDTH / 2, level_y - TEXT), what)?;
        if !is_base {
            let [below_left, below_right] = corners(depth + 1);
            let (x, y) = (below_left.0 - 20, left.1 + PANEL + 8);
            arrow(area, (x, y), (x, y + ROW - PANEL / 2 - 40))?;
            label(area, (x - 58, y + 50), "restrict")?;
            let x = below_right.0 + PANEL + 20;
            arrow(area, (x, y + ROW - PANEL / 2 - 40), (x, y))?;
            label(area, (x + 58, y + 50), "prolong")?;
        }
        Ok(())
    }
}

/// Draws a field in the kept tiles, with the outlines of these tiles.
///
/// Each element is one square.
fn draw_field<B: DrawingBackend>(
    area: &Area<B>,
    (left, top): (i32, i32),
    field: &Field,
    tiles: &[bool],
) -> Result<(), PictureError> {
    let grid = field.grid();
    let columns = grid.nx() / TILE;
    let (low, high) = (field.min(), field.max());
    let is_kept = |ix: usize, iy: usize| tiles[(iy / TILE) * columns + ix / TILE];
    let mut shaded = Field::zeros(grid);
    for (i, shade) in shaded.values_mut().iter_mut().enumerate() {
        let part = 0.04 + 0.76 * (field.values()[i] - low) / (high - low);
        *shade = if is_kept(i % grid.nx(), i / grid.nx()) { part } else { 0.0 };
    }
    let raster = Raster::of(&shaded, (PANEL as u32, PANEL as u32), |part| part, |part| Palette::Heat.colour(part));
    let bitmap =
        plotters::element::BitMapElement::with_owned_buffer((left, top), (PANEL as u32, PANEL as u32), raster.rgb);
    let bitmap = bitmap.ok_or_else(|| PictureError::new("the bitmap has another size than its area"))?;
    area.draw(&bitmap).map_err(PictureError::new)?;
    let side = PANEL / columns as i32;
    for i in (0..tiles.len()).filter(|&i| tiles[i]) {
        let (column, row) = ((i % columns) as i32, (i / columns) as i32);
        let at = (left + column * side, top + PANEL - (row + 1) * side);
        let square = Rectangle::new([at, (at.0 + side, at.1 + side)], GREY.mix(0.5).stroke_width(1));
        area.draw(&square).map_err(PictureError::new)?;
    }
    let frame = Rectangle::new([(left, top), (left + PANEL, top + PANEL)], GREY.stroke_width(1));
    area.draw(&frame).map_err(PictureError::new)
}

fn arrow<B: DrawingBackend>(area: &Area<B>, from: (i32, i32), to: (i32, i32)) -> Result<(), PictureError> {
    area.draw(&PathElement::new([from, to], BLUE.stroke_width(3))).map_err(PictureError::new)?;
    let (dx, dy) = ((to.0 - from.0).signum(), (to.1 - from.1).signum());
    let back = (to.0 - 16 * dx, to.1 - 16 * dy);
    let head = [to, (back.0 - 7 * dy, back.1 - 7 * dx), (back.0 + 7 * dy, back.1 + 7 * dx)];
    area.draw(&Polygon::new(head, BLUE.filled())).map_err(PictureError::new)
}

fn label<B: DrawingBackend>(area: &Area<B>, at: (i32, i32), text: &str) -> Result<(), PictureError> {
    let style = words(f64::from(TEXT), BLACK).pos(Pos::new(HPos::Center, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).map_err(PictureError::new)
}

impl Picture for Levels {
    fn size(&self) -> (u32, u32) {
        let height = 56 + ROW * (self.levels.len() as i32 - 1) + PANEL + 20;
        (WIDTH as u32, height as u32)
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        (0..self.levels.len()).try_for_each(|depth| self.draw_level(area, depth))
    }
}

#[cfg(test)]
mod tests {
    use rc_kernel::Love;

    use super::*;

    /// The sums over levels give L, with the error that the split promises.
    #[test]
    fn one_v_of_levels_is_the_operator() {
        for (split, bound) in [(SplitParams::quick(), 2e-2), (SplitParams::certified(), 5e-6)] {
            let params = Params { split, ..Params::of(Preset::Quick).expect("paper values") };
            let figure = Levels::compute(&params).expect("the contact is solved");
            let [pressure, displacement] = [&figure.levels[0].pressure, &figure.levels[0].displacement];
            let exact = applied(&UniformOperator::new(pressure.grid(), &Love), pressure);
            let error = relative_error(displacement, &exact, pressure);
            assert!(error < bound, "{split:?}: {error:e} above {bound:e}");
        }
    }

    /// Relative rms error of the displacement over the contact.
    fn relative_error(test: &Field, exact: &Field, pressure: &Field) -> f64 {
        let contact = || (0..pressure.values().len()).filter(|&i| pressure.values()[i] > 0.0);
        let sum = |term: &dyn Fn(usize) -> f64| contact().map(|i| term(i).powi(2)).sum::<f64>();
        let difference = sum(&|i| test.values()[i] - exact.values()[i]);
        (difference / sum(&|i| exact.values()[i])).sqrt()
    }
}
