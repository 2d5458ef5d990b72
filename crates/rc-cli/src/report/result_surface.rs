//! The surface of a result, and sections through both bodies.

use std::path::Path;

use rc_core::{Field, Grid};
use rc_fractal::moments_of_grid;
use rc_sweep::memory::Budget;
use serde::Serialize;

use super::surface::SurfaceBody;
use crate::error::CliError;
use crate::files::coarsen::{BlockMean, check_factor};
use crate::files::names::RESIDUAL_FILE;
use crate::files::result::{ResultFolder, in_cell};
use crate::inspect::record::SurfaceRecord;
use crate::scene::heights::check_finite;
use crate::scene::keys::Scene;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve;
use crate::scene::values::GridSpec;

/// Number of elements per side from which a generated surface is sampled on fewer, for its statistics.
const MOST_SAMPLES: usize = 1024;

/// Maximum number of points of a section.
const POINTS: usize = 1000;

/// The surface of a result.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ResultSurface {
    #[serde(flatten)]
    body: SurfaceBody,
    /// Whether it is the surface that plastic flow has left.
    is_left: bool,
    /// What has to be added to a height (m), so that it is counted from the undeformed elastic surface.
    shift: f64,
    /// Sections along x and y through the maximum pressure; empty if the heights on the grid of the fields are not known.
    sections: Vec<BodySection>,
    /// Whether the points of the sections are means over blocks.
    of_blocks: bool,
    #[serde(skip)]
    nayak: Option<f64>,
}

/// A section through both bodies, in heights (m) over the undeformed elastic surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct BodySection {
    /// `x` or `y`.
    axis: &'static str,
    /// The other coordinate (m).
    at: f64,
    /// Coordinate (m), rigid surface, elastic surface.
    points: Vec<[f64; 3]>,
    /// Whether each point is in contact.
    contact: Vec<bool>,
}

impl ResultSurface {
    /// The surface of the scene at `path`, of which `result` is the result. After a history of loads, it is the surface
    /// that plastic flow has left.
    ///
    /// # Errors
    /// [`CliError::Input`] when the surface cannot be read or is flat, and when its heights do not fit the memory.
    pub(super) fn of(path: &Path, result: &ResultFolder) -> Result<Self, CliError> {
        let scene = resolve::layers(Some(path), Scene::default())?;
        let setup = resolve::surface(scene.surface)?.bounded(scene.contact.boundary.unwrap_or_default())?;
        let mut surface = setup.load()?;
        let side = setup.cell.side();
        let stored = result.pressure.grid();
        let has_elements = result.is_of_elements() && same_elements(surface.grid, stored);
        let budget = Budget::new(scene.run.memory_limit);
        let left = left_by_flow(path, surface.grid, side)?;
        let full = has_elements
            .then(|| {
                budget.check_grid("the surface", surface.grid)?;
                left.clone().map_or_else(|| surface.heights().map(std::borrow::Cow::into_owned), Ok)
            })
            .transpose()?;
        let blocks = if result.is_of_elements() { None } else { means_over_blocks((&surface, &left), stored, budget) };
        let is_left = left.is_some();
        let coarse = left.map_or_else(|| sampled(&mut surface), Ok)?;
        let heights = full.as_ref().unwrap_or(&coarse);
        if heights.max() <= heights.min() {
            return Err(CliError::input("the surface is flat"));
        }
        let summary = &result.summary;
        let source = summary.source.clone().or_else(|| surface.origin.clone());
        let record = if is_left {
            SurfaceRecord::of_source(&coarse, side, moments_of_grid(&coarse), source)
        } else {
            SurfaceRecord {
                rms_height: summary.rms_height,
                rms_slope: summary.rms_slope,
                ..SurfaceRecord::of_source(&coarse, side, surface.moments(&coarse), source)
            }
        };
        let shift = summary.penetration - summary.h_max;
        let of_sections = full.as_ref().or(blocks.as_ref());
        let sections = of_sections.map_or_else(Vec::new, |heights| sections(heights, result, shift));
        let (body, of_blocks) = (SurfaceBody::of(heights, &record), blocks.is_some());
        Ok(Self { body, is_left, shift, sections, of_blocks, nayak: record.nayak })
    }

    /// Nayak's parameter of the surface.
    pub(super) fn nayak(&self) -> Option<f64> {
        self.nayak
    }
}

/// The heights (in λ) that plastic flow has left after a history of loads; `None` without one.
fn left_by_flow(scene: &Path, grid: Grid, side: f64) -> Result<Option<Field>, CliError> {
    let path = scene.with_file_name(RESIDUAL_FILE);
    if !path.is_file() {
        return Ok(None);
    }
    let mut heights = in_cell(&path, grid.cell_ratio())?;
    check_finite(&path, &heights)?;
    heights.values_mut().iter_mut().for_each(|height| *height /= side);
    Ok(Some(heights).filter(|heights| same_elements(heights.grid(), grid)))
}

/// The heights (in λ) of a surface, or those that flow has left, as means over the blocks of the `stored` fields.
///
/// `None` if the surface does not have such blocks, or does not fit the memory.
fn means_over_blocks((surface, left): (&LoadedSurface, &Option<Field>), stored: Grid, budget: Budget) -> Option<Field> {
    let spec = GridSpec { nx: stored.nx(), ny: stored.ny() };
    check_factor(surface.grid, spec).ok()?;
    budget.check_grid("the surface", surface.grid).ok()?;
    let mut means = BlockMean::new(surface.grid, spec);
    match left {
        Some(left) => means.take(left.values()),
        None => means.take(surface.heights().ok()?.values()),
    }
    Some(means.finish())
}

fn same_elements(a: Grid, b: Grid) -> bool {
    (a.nx(), a.ny()) == (b.nx(), b.ny())
}

/// The heights (in λ) of a map, or of a generated surface on the grid of its statistics.
///
/// A surface whose shortest waves need a finer grid is sampled on its own.
fn sampled(surface: &mut LoadedSurface) -> Result<Field, CliError> {
    let own = surface.grid;
    if surface.map().is_none() && own.nx().max(own.ny()) > MOST_SAMPLES {
        let every = own.nx().max(own.ny()).div_ceil(MOST_SAMPLES);
        surface.grid = own.with_elements(own.nx().div_ceil(every), own.ny().div_ceil(every)).unwrap_or(own);
        if let Ok(heights) = surface.heights().map(std::borrow::Cow::into_owned) {
            return Ok(heights);
        }
        surface.grid = own;
    }
    surface.heights().map(std::borrow::Cow::into_owned)
}

/// Index of the maximum pressure.
pub(super) fn peak(pressure: &Field) -> usize {
    let values = pressure.values();
    (0..values.len()).max_by(|a, b| values[*a].total_cmp(&values[*b])).unwrap_or(0)
}

/// The sections along x and y through the maximum pressure, with `heights` in λ.
fn sections(heights: &Field, result: &ResultFolder, shift: f64) -> Vec<BodySection> {
    let ResultFolder { pressure, gap, side, .. } = result;
    let grid = pressure.grid();
    let peak = peak(pressure);
    let (px, py) = (peak % grid.nx(), peak / grid.nx());
    let lines = [
        ("x", grid.centre(px, py).y, (0..grid.nx()).map(|ix| grid.index(ix, py)).collect::<Vec<_>>()),
        ("y", grid.centre(px, py).x, (0..grid.ny()).map(|iy| grid.index(px, iy)).collect()),
    ];
    let section = |(axis, at, line): (&'static str, f64, Vec<usize>)| {
        // A touched block has a mean gap.
        let is_closed = |i: usize| pressure.values()[i] > 0.0 && result.is_of_elements();
        let gap = |i: usize| if is_closed(i) { 0.0 } else { gap.values()[i] };
        let kept: Vec<usize> = line
            .chunks(line.len().div_ceil(POINTS))
            .filter_map(|block| block.iter().copied().min_by(|a, b| gap(*a).total_cmp(&gap(*b))))
            .collect();
        let point = |&i: &usize| {
            let at = grid.centre(i % grid.nx(), i / grid.nx());
            let rigid = heights.values()[i] * side + shift;
            [if axis == "x" { at.x } else { at.y } * side, rigid, rigid + gap(i)].map(rounded)
        };
        let contact = kept.iter().map(|&i| pressure.values()[i] > 0.0).collect();
        BodySection { axis, at: at * side, points: kept.iter().map(point).collect(), contact }
    };
    // A profile has no section along y.
    let n = if grid.ny() > 1 { 2 } else { 1 };
    lines.into_iter().take(n).map(section).collect()
}

/// `value` with seven digits, which is finer than a picture and shorter in the page.
fn rounded(value: f64) -> f64 {
    format!("{value:.6e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::super::contact::tests::summary;
    use super::*;

    #[test]
    fn a_long_section_keeps_the_contact() {
        let grid = Grid::new(4000, 4).expect("a grid");
        let touching = |i: usize| i == 2 * 4000 + 1234;
        let field = |value: fn(bool) -> f64| {
            Field::new(grid, (0..grid.len()).map(|i| value(touching(i))).collect()).expect("a field")
        };
        let result = ResultFolder {
            summary: summary(grid, 1.0, 0.1, None),
            side: 2.0,
            e_star: 1.0,
            direction: None,
            pressure: field(|touches| if touches { 4.0 } else { 0.0 }),
            gap: field(|touches| if touches { 1e-12 } else { 0.5 }),
            plastic_gap: None,
            slip: None,
        };
        let heights = field(|touches| if touches { 1.0 } else { 0.25 });
        let [along_x, along_y] = &sections(&heights, &result, -0.5)[..] else { panic!("two sections") };
        assert_eq!((along_x.points.len(), along_x.contact.iter().filter(|touches| **touches).count()), (1000, 1));
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        let peak = 2.0 * 1234.5 / 4000.0;
        assert!(near(along_x.points[308], [peak, 1.5, 1.5]), "in contact: {:?}", along_x.points[308]);
        assert!(near(along_x.points[0], [2.5e-4, 0.0, 0.5]), "above by the gap: {:?}", along_x.points[0]);
        assert_eq!((along_y.points.len(), along_y.contact[2]), (4, true));
        assert!((along_y.at - peak).abs() < 1e-12, "at {}", along_y.at);
    }
}
