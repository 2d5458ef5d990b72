//! Heights of any tile, evaluated when they are asked for.

use std::ops::Deref;
use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{Boundary, Field, Grid, HeightField, HeightSource};
use rc_quadtree::{TILE, put_tile};

use crate::grid::coarser::{Pits, coarsen};
use crate::problem::checked::HeightStatistics;
use crate::problem::error::ProblemError;
use crate::problem::steps::Step;
use crate::problem::summit::Summit;
use crate::tiles::heights::bounds::Bounds;
use crate::tiles::heights::extremes;
use crate::tiles::heights::interpolation::{Interpolation, smallest_side};
use crate::tiles::ladder::Ladder;
use crate::tiles::memory::BYTES_PER_SAMPLE;

/// Heights at the centres of the levels of a [`Ladder`].
///
/// For a band-limited surface with waves up to N, the memory is 16 M² bytes. M × M is the interpolation grid: M is the
/// smallest side of a level that is at least 4N. Of these bytes, 8 are coefficients, 8/3 coarser levels (8 if M is the
/// base), and 16/3 bounds. Making it takes 5 more. Only a few weights depend on the finest level. For a map, the memory
/// is 8/3 bytes an element for coarser levels and 1/12 for bounds.
#[derive(Clone)]
pub(crate) struct Heights<'a> {
    ladder: Ladder,
    /// Levels that are kept whole, base first.
    ///
    /// These are all levels of a map, and those below the interpolation grid of a band-limited surface.
    grids: Vec<WholeGrid<'a>>,
    interpolation: Option<Interpolation>,
    bounds: Bounds,
    extremes: HeightStatistics,
    summit: Summit,
}

impl<'a> Heights<'a> {
    /// Prepares the levels from a base grid of these sides to the finest grid. Heights of opposite free borders are not
    /// interpolated.
    ///
    /// # Errors
    /// [`ProblemError::Height`] for a height that is not finite. For a surface, its element is one of the grid of
    /// samples.
    pub(crate) fn with_borders(
        source: HeightSource<'a>,
        base: [usize; 2],
        boundary: Boundary,
    ) -> Result<Self, ProblemError> {
        let ladder = (Ladder::new(base, source.grid()), boundary);
        match source {
            HeightSource::Map(map) => Self::of_map(WholeGrid::Borrowed(map), None, ladder),
            HeightSource::SharedMap(map) => Self::of_map(WholeGrid::Shared(map), None, ladder),
            HeightSource::Surface { surface, grid } => Self::of_waves(surface, grid, ladder),
            HeightSource::SharedSurface { surface, grid } => Self::of_waves(surface.as_ref(), grid, ladder),
        }
    }

    /// Prepares the levels of a periodic cell.
    #[cfg(test)]
    pub(crate) fn new(source: HeightSource<'a>, base: [usize; 2]) -> Result<Self, ProblemError> {
        Self::with_borders(source, base, Boundary::Periodic)
    }

    /// Bytes of a surface's samples on its whole grid and on coarser ones.
    ///
    /// They are 0 if samples are not needed, and for a map, whose own bytes are not counted.
    pub(crate) fn sampled_bytes(source: &HeightSource<'_>, ladder: Ladder) -> f64 {
        let Some(surface) = source.surface() else { return 0.0 };
        if is_interpolated(surface, source.grid(), ladder).is_some() {
            return 0.0;
        }
        BYTES_PER_SAMPLE * source.grid().len() as f64
    }

    /// Heights of a surface, band-limited or not.
    fn of_waves(
        surface: &dyn HeightField,
        grid: Grid,
        (ladder, boundary): (Ladder, Boundary),
    ) -> Result<Self, ProblemError> {
        let _running = Step::Heights.begin();
        match is_interpolated(surface, grid, ladder) {
            Some((limit, level)) => Self::of_surface(surface, (limit, level), ladder, boundary),
            None => Self::of_map(WholeGrid::new(surface.sample(grid)), Some(surface), (ladder, boundary)),
        }
    }

    /// Levels of a map, or of a `surface` whose samples it is.
    fn of_map(
        map: WholeGrid<'a>,
        surface: Option<&dyn HeightField>,
        (ladder, boundary): (Ladder, Boundary),
    ) -> Result<Self, ProblemError> {
        let extremes = HeightStatistics::of(&map)?;
        let summit = Summit::on_grid(surface, (&map, extremes.greatest), boundary);
        let bounds = Bounds::of_map(&map, &extremes);
        let coarser = (0..ladder.n_levels()).rev().map(|level| ladder.grid(level));
        let mut grids: Vec<WholeGrid<'a>> =
            coarsen(&map, boundary, Pits::Filled, coarser).into_iter().map(WholeGrid::new).collect();
        grids.reverse();
        grids.push(map);
        Ok(Self { ladder, grids, interpolation: None, bounds, extremes, summit })
    }

    fn of_surface(
        surface: &dyn HeightField,
        (band_limit, level): (usize, u32),
        ladder: Ladder,
        boundary: Boundary,
    ) -> Result<Self, ProblemError> {
        let (base_side, finest_side) = (ladder.base().nx(), ladder.finest().nx());
        let samples = surface.sample(square(base_side << level));
        let of_samples = HeightStatistics::of(&samples)?;
        let mut grids = Vec::new();
        for coarser in 0..level.max(1) {
            let heights = surface.sample(square(base_side << coarser));
            HeightStatistics::of(&heights)?;
            grids.push(WholeGrid::new(heights));
        }
        let finest_level = ladder.n_levels() as u32 - level;
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
            // Samples of whole waves, each more than two elements long, have the mean zero.
            mean: of_samples.mean,
        };
        let sampled = extremes.greatest;
        let summit =
            Summit { sampled, excess: extremes::summit(&interpolation, &bounds, (sampled, boundary)) - sampled };
        Ok(Self { ladder, grids, interpolation: Some(interpolation), bounds, extremes, summit })
    }

    /// The same heights without a borrow. A borrowed map is copied.
    pub(crate) fn into_owned(self) -> Heights<'static> {
        let grids = self.grids.into_iter().map(WholeGrid::into_owned).collect();
        let Self { ladder, interpolation, bounds, extremes, summit, .. } = self;
        Heights { ladder, grids, interpolation, bounds, extremes, summit }
    }

    /// The grids of the levels.
    pub(crate) fn ladder(&self) -> Ladder {
        self.ladder
    }

    /// Heights at the centres of the base grid.
    pub(crate) fn base(&self) -> &Field {
        &self.grids[0]
    }

    /// Heights on a grid that has all their waves. It is the grid of a map, or one that is not finer than the finest.
    pub(crate) fn all_waves(&self) -> &Field {
        self.grids.last().unwrap_or(&self.grids[0])
    }

    /// Writes the heights at the centres of tile (`tx`, `ty`), row-major, in λ.
    ///
    /// `sides` are those of its level, in cells. Cells beyond the level are left as they are. A band-limited surface is
    /// exact to 1e-9 of its rms height on every level. The coarser levels of a map are interpolated at their centres
    /// from the next finer ones.
    ///
    /// # Panics
    /// When there is no such level, or the tile is outside it.
    pub(crate) fn tile(&self, sides: [usize; 2], [tx, ty]: [usize; 2], out: &mut [f64; TILE * TILE]) {
        let level = self.ladder.level_of(sides);
        match (self.grids.get(level), &self.interpolation) {
            (Some(grid), _) => {
                let columns = TILE * tx..(TILE * (tx + 1)).min(sides[0]);
                for (iy, row) in (TILE * ty..sides[1]).zip(out.as_chunks_mut::<TILE>().0) {
                    row[..columns.len()].copy_from_slice(&grid.row(iy)[columns.clone()]);
                }
            }
            (None, Some(interpolation)) => {
                let side = interpolation.side();
                interpolation.tile(level - self.ladder.level_of([side, side]), tx, ty, out);
            }
            (None, None) => unreachable!("a map keeps all levels"),
        }
    }

    /// Heights of row `ty` of the tiles of the level of these sides, in cells.
    ///
    /// A row of tiles is eight rows of cells, or the rest of them.
    ///
    /// # Panics
    /// As [`Heights::tile`].
    pub(crate) fn row_of_tiles(&self, sides: [usize; 2], ty: usize) -> Vec<f64> {
        let tile = |tx: usize| {
            let mut tile = [0.0; TILE * TILE];
            self.tile(sides, [tx, ty], &mut tile);
            tile
        };
        let tiles: Vec<[f64; TILE * TILE]> = (0..sides[0].div_ceil(TILE)).into_par_iter().map(tile).collect();
        let mut rows = vec![0.0; TILE.min(sides[1] - TILE * ty) * sides[0]];
        for (tx, tile) in tiles.iter().enumerate() {
            put_tile(&mut rows, sides[0], tx, tile);
        }
        rows
    }

    /// Upper bound of the heights in the block at `place`.
    ///
    /// There are `blocks` equal blocks along both sides of the cell. The bound holds at all centres of the finest
    /// level. For a band-limited surface it holds at every point, and so for the tiles of every level.
    ///
    /// It takes one look-up when the blocks are the tiles of a level, and a few otherwise. The kept squares are cells
    /// of the interpolation grid, or finest tiles of a map. A smaller block gets the bound of the square that contains
    /// it.
    ///
    /// # Panics
    /// When the block is outside the cell.
    pub(crate) fn upper_bound(&self, blocks: [usize; 2], place: [usize; 2]) -> f64 {
        self.bounds.of_block(blocks, place)
    }

    /// Upper bound of the heights in a tile of an uneven finest level.
    ///
    /// The finest grid does not divide into such tiles evenly. Heights are those of a map then.
    ///
    /// # Panics
    /// When the tile is outside the level.
    pub(crate) fn upper_bound_of_tile(&self, place: [usize; 2]) -> f64 {
        self.bounds.of_leaf(place)
    }

    /// Upper bound of |∂²h/∂x²| and |∂²h/∂y²|, in 1/λ. Infinite for a map.
    pub(crate) fn curvature(&self) -> f64 {
        self.bounds.curvature()
    }

    /// Maximum and minimum height at the centres of the finest level, and the mean height.
    pub(crate) fn extremes(&self) -> HeightStatistics {
        self.extremes
    }

    /// The maximum height at the centres of the finest level, and between them.
    pub(crate) fn summit(&self) -> Summit {
        self.summit
    }
}

/// The band limit of a surface that is interpolated on the finest level.
///
/// The second number is the level of the grid that it is interpolated from.
fn is_interpolated(surface: &dyn HeightField, grid: Grid, ladder: Ladder) -> Option<(usize, u32)> {
    let limit = surface.band_limit().filter(|_| grid.is_square() && ladder.is_even())?;
    let level = interpolation_level(limit, ladder.grid(0).nx());
    // The level is finer than the interpolation grid. Extremes are searched in whole tiles on it.
    ((level as usize) < ladder.n_levels() && grid.nx().is_multiple_of(TILE)).then_some((limit, level))
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

/// The smallest level that resolves the band limit for interpolation.
///
/// A level has `base_side` · 2^k elements per side.
fn interpolation_level(band_limit: usize, base_side: usize) -> u32 {
    // If no grid resolves the waves, the side is above every finest level.
    let smallest = smallest_side(band_limit).min(2 * Grid::MAX_SIDE);
    smallest.div_ceil(base_side.max(1)).next_power_of_two().ilog2()
}

fn square(side: usize) -> Grid {
    Grid::square(side).expect("the caller has checked the finest side")
}
