//! Heights of the rigid surface, tile by tile, without the finest grid.
//!
//! A band-limited surface is sampled once, on a grid with at least four elements for its shortest wave, and interpolated from
//! there to nine digits on tiles of any finer level; a map is kept as it is. Both give coarser levels, and upper bounds of
//! the heights in any square, which say where the surface cannot touch.

mod bounds;
mod extremes;
mod interpolation;
mod pyramid;
mod stencil;
#[cfg(test)]
mod tests;
mod window;

use std::ops::Deref;
use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Field, Grid, HeightField, HeightSource};
use rc_quadtree::{TILE, put_tile};

use crate::ProblemError;
use crate::problem::HeightStatistics;
use crate::uniform::coarsen_without_pits;
use bounds::Bounds;
use interpolation::{Interpolation, smallest_side};

/// Heights at the centres of the levels `base_side · 2^k`, k = 0, …, K, of cells per side.
///
/// Memory for a band-limited surface with waves up to N is 16 M² bytes, where M × M is the interpolation grid: M is the least
/// `base_side` · 2^m that is at least 4N. Of these, 8 are coefficients, 8/3 coarser levels (8 if M is the base), and 16/3 bounds;
/// making it takes 5 more. Nothing but a few weights depends on the finest level. For a map it is 8/3 bytes an element for
/// coarser levels and 1/12 for bounds.
#[derive(Clone)]
pub(crate) struct Heights<'a> {
    base_side: usize,
    finest_side: usize,
    /// Levels that are kept whole, base first. Of a map all, of a band-limited surface those below the interpolation grid.
    grids: Vec<WholeGrid<'a>>,
    interpolation: Option<Interpolation>,
    bounds: Bounds,
    extremes: HeightStatistics,
}

impl<'a> Heights<'a> {
    /// Prepares the levels from `base_side` to the finest side.
    ///
    /// # Errors
    /// [`ProblemError::Height`] for a height that is not finite; of a surface, its element is one of the grid it is sampled on.
    ///
    /// # Panics
    /// When the finest side is not `base_side` · 2^K with K ≥ 0, above [`Grid::MAX_SIDE`], or a map not square.
    pub(crate) fn new(source: HeightSource<'a>, base_side: usize) -> Result<Self, ProblemError> {
        match source {
            HeightSource::Map(map) => Self::of_map(WholeGrid::Borrowed(map), base_side),
            HeightSource::SharedMap(map) => Self::of_map(WholeGrid::Shared(map), base_side),
            HeightSource::Surface { surface, grid } => Self::of_waves(surface, grid.nx(), base_side),
            HeightSource::SharedSurface { surface, grid } => Self::of_waves(surface.as_ref(), grid.nx(), base_side),
        }
    }

    /// Of a surface, band-limited or not.
    fn of_waves(surface: &dyn HeightField, finest_side: usize, base_side: usize) -> Result<Self, ProblemError> {
        let level = surface.band_limit().map(|limit| (limit, interpolation_level(limit, base_side)));
        match level {
            // A level finer than the interpolation grid; whole tiles on it are what extremes are searched in.
            Some((limit, level))
                if level < n_refinements(base_side, finest_side) && finest_side.is_multiple_of(TILE) =>
            {
                Self::of_surface(surface, limit, level, base_side, finest_side)
            }
            _ => Self::of_map(WholeGrid::new(surface.sample(square(finest_side))), base_side),
        }
    }

    fn of_map(map: WholeGrid<'a>, base_side: usize) -> Result<Self, ProblemError> {
        assert_eq!(map.grid().nx(), map.grid().ny(), "a map of heights must be square");
        let finest_side = map.grid().nx();
        let n_refinements = n_refinements(base_side, finest_side);
        let extremes = HeightStatistics::of(&map)?;
        let bounds = Bounds::of_map(&map, &extremes);
        let mut grids: Vec<WholeGrid<'a>> =
            coarsen_without_pits(&map, base_side).into_iter().map(WholeGrid::new).collect();
        grids.reverse();
        grids.push(map);
        debug_assert_eq!(grids.len(), n_refinements as usize + 1);
        Ok(Self { base_side, finest_side, grids, interpolation: None, bounds, extremes })
    }

    fn of_surface(
        surface: &dyn HeightField,
        band_limit: usize,
        level: u32,
        base_side: usize,
        finest_side: usize,
    ) -> Result<Self, ProblemError> {
        let samples = surface.sample(square(base_side << level));
        let of_samples = HeightStatistics::of(&samples)?;
        let mut grids = Vec::new();
        for coarser in 0..level.max(1) {
            let heights = surface.sample(square(base_side << coarser));
            HeightStatistics::of(&heights)?;
            grids.push(WholeGrid::new(heights));
        }
        let finest_level = n_refinements(base_side, finest_side) - level;
        let interpolation = Interpolation::new(samples, band_limit, finest_level + 1);
        let [bounds, of_negative] = Bounds::of_surface(&interpolation, &of_samples);
        let tiles = finest_side / TILE;
        let values = |tx, ty, sign: f64| {
            let mut heights = [0.0; TILE * TILE];
            interpolation.tile(finest_level as usize, tx, ty, &mut heights);
            extremes::of_tile(&heights.map(|h| sign * h))
        };
        let extremes = HeightStatistics {
            greatest: extremes::greatest(&bounds, tiles, |tx, ty| values(tx, ty, 1.0)),
            least: -extremes::greatest(&of_negative, tiles, |tx, ty| values(tx, ty, -1.0)),
            // Samples of whole waves, each more than two elements long, have mean zero.
            mean: of_samples.mean,
        };
        Ok(Self { base_side, finest_side, grids, interpolation: Some(interpolation), bounds, extremes })
    }

    /// The same heights without a borrow: a borrowed map is copied.
    pub(crate) fn into_owned(self) -> Heights<'static> {
        let Self { base_side, finest_side, grids, interpolation, bounds, extremes } = self;
        let grids = grids.into_iter().map(WholeGrid::into_owned).collect();
        Heights { base_side, finest_side, grids, interpolation, bounds, extremes }
    }

    /// Cells per side of the finest level.
    pub(crate) fn finest_side(&self) -> usize {
        self.finest_side
    }

    /// Heights at the centres of the grid with `base_side` elements per side.
    pub(crate) fn base(&self) -> &Field {
        &self.grids[0]
    }

    /// Heights at the centres of tile (`tx`, `ty`) of the level with `side` cells per side, row-major, in λ.
    ///
    /// A band-limited surface is exact to 1e-9 of its rms height on every level. The coarser levels of a map are interpolated
    /// at their centres from the next finer ones.
    ///
    /// # Panics
    /// When there is no such level, its side is no multiple of [`TILE`], or the tile is outside it.
    pub(crate) fn tile(&self, side: usize, tx: usize, ty: usize, out: &mut [f64; TILE * TILE]) {
        let level = n_refinements(self.base_side, side) as usize;
        match (self.grids.get(level), &self.interpolation) {
            (Some(grid), _) => {
                for (iy, row) in out.as_chunks_mut::<TILE>().0.iter_mut().enumerate() {
                    row.copy_from_slice(&grid.row(TILE * ty + iy)[TILE * tx..TILE * (tx + 1)]);
                }
            }
            (None, Some(interpolation)) => {
                let coarsest = n_refinements(self.base_side, interpolation.side()) as usize;
                interpolation.tile(level - coarsest, tx, ty, out);
            }
            (None, None) => unreachable!("a map keeps all levels"),
        }
    }

    /// Heights of row `ty` of the tiles of the level with `side` cells per side: eight rows of cells.
    ///
    /// # Panics
    /// As [`Heights::tile`].
    pub(crate) fn row_of_tiles(&self, side: usize, ty: usize) -> Vec<f64> {
        let tile = |tx: usize| {
            let mut tile = [0.0; TILE * TILE];
            self.tile(side, tx, ty, &mut tile);
            tile
        };
        let tiles: Vec<[f64; TILE * TILE]> = (0..side / TILE).into_par_iter().map(tile).collect();
        let mut rows = vec![0.0; TILE * side];
        for (tx, tile) in tiles.iter().enumerate() {
            put_tile(&mut rows, side, tx, tile);
        }
        rows
    }

    /// Upper bound of the heights at all centres of the finest level in block (`ix`, `iy`) of `blocks` × `blocks` equal
    /// squares of the cell. Of a band-limited surface it bounds every point, and so the tiles of every level.
    ///
    /// One look-up when the blocks are the tiles of a level, a few otherwise. Blocks smaller than what is kept (cells of the
    /// interpolation grid, finest tiles of a map) get the bound of what contains them.
    ///
    /// # Panics
    /// When the block is outside the cell.
    pub(crate) fn upper_bound(&self, blocks: usize, ix: usize, iy: usize) -> f64 {
        self.bounds.of_block(blocks, ix, iy)
    }

    /// Upper bound of |∂²h/∂x²| and |∂²h/∂y²|, in 1/λ; infinite for a map.
    pub(crate) fn curvature(&self) -> f64 {
        self.bounds.curvature()
    }

    /// Greatest and least height at the centres of the finest level, and the mean height.
    pub(crate) fn extremes(&self) -> HeightStatistics {
        self.extremes
    }
}

/// Heights on a whole grid.
#[derive(Clone)]
enum WholeGrid<'a> {
    Borrowed(&'a Field),
    Shared(Arc<Field>),
}

impl WholeGrid<'_> {
    fn new(heights: Field) -> Self {
        Self::Shared(Arc::new(heights))
    }

    fn into_owned(self) -> WholeGrid<'static> {
        WholeGrid::Shared(match self {
            Self::Borrowed(heights) => Arc::new(heights.clone()),
            Self::Shared(heights) => heights,
        })
    }
}

impl Deref for WholeGrid<'_> {
    type Target = Field;

    fn deref(&self) -> &Field {
        match self {
            Self::Borrowed(heights) => heights,
            Self::Shared(heights) => heights,
        }
    }
}

/// The smallest level of `base_side` · 2^k elements per side that resolves the band limit for interpolation.
fn interpolation_level(band_limit: usize, base_side: usize) -> u32 {
    // What no grid resolves ends above every finest level.
    let smallest = smallest_side(band_limit).min(2 * Grid::MAX_SIDE);
    smallest.div_ceil(base_side.max(1)).next_power_of_two().ilog2()
}

/// k of the level with `side = base_side · 2^k` cells per side.
fn n_refinements(base_side: usize, side: usize) -> u32 {
    let k = (side / base_side.max(1)).checked_ilog2();
    let k = k.filter(|&k| base_side << k == side);
    k.expect("the side of a level is a power of two times that of the base")
}

fn square(side: usize) -> Grid {
    Grid::square(side).expect("the caller has checked the finest side")
}
