//! Proven upper bounds of the heights in squares of the cell.
//!
//! For a map they are its maxima. For a band-limited surface, each cell of side 2d of a grid is bounded by the
//! expansion about its centre,
//!
//! ```text
//! h(c + t) ≤ h + max_|t|≤d (hx t + hxx t²/2) + max_|t|≤d (hy t + hyy t²/2) + |hxy| d² + R,
//! R = d³/6 · (max |hxxx| + 3 max |hxxy| + 3 max |hxyy| + max |hyyy|),   maxima over the whole surface.
//! ```
//!
//! Third derivatives follow from second ones by Bernstein's inequality: `max |f'| ≤ n max |f|` for a trigonometric
//! polynomial of degree n in an angle.
//!
//! The maximum of second derivatives follows from their values at the centres. In either direction, no point is farther
//! than d from the nearest centre. Let |f| have its maximum F at some angle. M. Riesz's lemma says `|f| ≥ F cos(n t)`
//! at an angle t ≤ π/n from there (Jahresber. Dtsch. Math.-Ver. 23 (1914) 354-368). So with M centres in a period, some
//! centre has |f| ≥ F cos(πn/M) (Ehlich, Zeller, Math. Z. 86 (1964) 41-44). In two directions, one after the other,
//! this gives |f| ≥ F cos²(πn/M).

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;
use rc_core::Field;

use crate::problem::checked::HeightStatistics;
use crate::tiles::heights::interpolation::{Interpolation, across};
use crate::tiles::heights::pyramid::MaxPyramid;
use crate::tiles::heights::stencil::{MAX_WIDTH, Stencils};
use crate::tiles::heights::window::{Derivative, ERRORS};
use rc_quadtree::TILE;

/// Remainder R that is small enough, in units of the rms height.
///
/// On most surfaces, heights differ by more than that in a cell. Where R is larger, cells are quartered. This reduces R
/// to about a tenth and costs four times as much.
const SMALL_REMAINDER: f64 = 0.01;

/// Maximum number of times that cells are quartered.
const MAX_REFINEMENT: u32 = 1;

/// Upper bounds of the heights (or of their negatives).
///
/// They are `offset + (remainder + scale · b)` for the bounds b of a pyramid. The brackets matter: an addition to a
/// large offset is rounded only as heights themselves are.
#[derive(Clone)]
pub(super) struct Bounds {
    pyramid: MaxPyramid,
    offset: f64,
    remainder: f64,
    scale: f64,
    curvature: f64,
}

impl Bounds {
    /// The maxima of a map, over its tiles of 8 × 8 elements.
    pub(super) fn of_map(map: &Field, extremes: &HeightStatistics) -> Self {
        let sides = [map.grid().nx(), map.grid().ny()];
        let (offset, scale) = (extremes.mean, scale(extremes));
        let leaves = map.values().par_chunks(TILE * sides[0]).flat_map_iter(|rows| {
            (0..sides[0]).step_by(TILE).map(move |x| {
                let inside = rows.chunks_exact(sides[0]).flat_map(|row| &row[x..(x + TILE).min(sides[0])]);
                round_up((inside.fold(f64::NEG_INFINITY, |max, &h| max.max(h)) - offset) / scale)
            })
        });
        Self {
            pyramid: MaxPyramid::new(sides, TILE, leaves.collect()),
            offset,
            remainder: 0.0,
            scale,
            curvature: second_differences(map),
        }
    }

    /// Bounds of a band-limited surface everywhere, and of its negative, by cell of its coefficients.
    ///
    /// `samples` are the statistics of any samples of the surface.
    pub(super) fn of_surface(surface: &Interpolation, samples: &HeightStatistics) -> [Self; 2] {
        let scale = scale(samples);
        let side = surface.side();
        let mut leaves = [(); 2].map(|()| vec![0.0_f32; side * side]);
        let (mut remainder, mut curvature) = (f64::INFINITY, f64::INFINITY);
        for refinement in 0..=MAX_REFINEMENT {
            if remainder > SMALL_REMAINDER * surface.rms() {
                (remainder, curvature) = Expansions::new(surface, refinement).bound(scale, &mut leaves);
            }
        }
        let mut signs = [surface.mean(), -surface.mean()].into_iter();
        leaves.map(|leaves| {
            let offset = signs.next().unwrap_or(0.0);
            Self { pyramid: MaxPyramid::new([side; 2], 1, leaves), offset, remainder, scale, curvature }
        })
    }

    /// Upper bound of the heights in the block at `place`.
    ///
    /// There are `blocks` equal blocks along both sides of the cell.
    ///
    /// # Panics
    /// When the block is outside the cell.
    pub(super) fn of_block(&self, blocks: [usize; 2], place: [usize; 2]) -> f64 {
        self.height(self.pyramid.max(blocks, place))
    }

    /// Upper bound of the heights in a tile of a map.
    ///
    /// # Panics
    /// When the tile is outside the map.
    pub(super) fn of_leaf(&self, place: [usize; 2]) -> f64 {
        self.height(self.pyramid.leaf(place))
    }

    /// Upper bound of |∂²h/∂x²| and |∂²h/∂y²| everywhere; for a map, of the second differences of its elements.
    pub(super) fn curvature(&self) -> f64 {
        self.curvature
    }

    /// Number of leaves along both sides.
    pub(super) fn sides(&self) -> [usize; 2] {
        self.pyramid.sides()
    }

    /// Upper bounds of the leaves, row-major.
    pub(super) fn leaves(&self) -> impl Iterator<Item = f64> {
        self.pyramid.leaves().iter().map(|&bound| self.height(bound))
    }

    fn height(&self, bound: f32) -> f64 {
        self.offset + (self.remainder + self.scale * f64::from(bound))
    }
}

/// Largest second difference of heights along an axis, divided by the square of the spacing, in 1/λ.
fn second_differences(map: &Field) -> f64 {
    let (grid, spacing) = (map.grid(), map.grid().spacing());
    let of_row = |iy: usize| {
        let row = map.row(iy);
        let (above, below) = (map.row((iy + 1) % grid.ny()), map.row((iy + grid.ny() - 1) % grid.ny()));
        let along_x = row.iter().zip(row.iter().cycle().skip(1)).zip(row.iter().cycle().skip(2));
        let along_x = along_x.map(|((a, b), c)| (a - 2.0 * b + c).abs()).fold(0.0, f64::max);
        let along_y = above.iter().zip(row).zip(below).map(|((a, b), c)| (a - 2.0 * b + c).abs()).fold(0.0, f64::max);
        (along_x / (spacing.x * spacing.x)).max(along_y / (spacing.y * spacing.y))
    };
    (0..grid.ny()).into_par_iter().map(of_row).reduce(|| 0.0, f64::max)
}

/// The unit in which bounds are stored.
///
/// It is the largest departure from the mean, or 1 for a flat surface.
fn scale(extremes: &HeightStatistics) -> f64 {
    let scale = (extremes.greatest - extremes.mean).max(extremes.mean - extremes.least);
    if scale > 0.0 { scale } else { 1.0 }
}

/// The next single-precision number above `value`.
///
/// It is always larger, which also covers earlier rounding in double precision.
fn round_up(value: f64) -> f32 {
    (value as f32).next_up()
}

/// Second-order expansions of a surface about the centres of a grid.
///
/// The unit of length is a coefficient cell.
struct Expansions<'a> {
    surface: &'a Interpolation,
    /// Number of expansions per side of a coefficient cell, as a power of two.
    refinement: u32,
    /// Stencils by order of the derivative.
    stencils: [Stencils; 3],
    /// Half the side of the squares that are bounded, in coefficient cells.
    half: f64,
}

impl<'a> Expansions<'a> {
    fn new(surface: &'a Interpolation, refinement: u32) -> Self {
        let stencils = Derivative::ALL.map(|derivative| Stencils::new(refinement, derivative));
        Self { surface, refinement, stencils, half: 0.5 / f64::from(1 << refinement) }
    }

    /// Fills the bounds of coefficient cells, of the heights and of their negatives.
    ///
    /// They are in units of `scale`. Returns the remainder to add to them, and the bound of second derivatives along
    /// the axes.
    fn bound(&self, scale: f64, [above, below]: &mut [Vec<f32>; 2]) -> (f64, f64) {
        let len = (TILE >> self.refinement) * self.surface.side();
        let rows = above.par_chunks_mut(len).zip(below.par_chunks_mut(len)).enumerate();
        let curvatures: Vec<[f64; 3]> =
            rows.map(|(ty, (above, below))| self.bound_rows(ty, scale, above, below)).collect();
        let greatest = |which: usize| curvatures.iter().map(|of_rows| of_rows[which]).fold(0.0, f64::max);
        self.remainder([greatest(0), greatest(1), greatest(2)])
    }

    /// Fills the bounds in a row of tiles, as far as the slices go.
    ///
    /// They hold a number of rows of cells. Returns the maxima of |hxx|, |hxy|, |hyy|.
    fn bound_rows(&self, ty: usize, scale: f64, above: &mut [f32], below: &mut [f32]) -> [f64; 3] {
        let (side, cells) = (self.surface.side(), TILE >> self.refinement);
        let mut greatest = [0.0; 3];
        let rows = above.chunks_exact_mut(side).zip(below.chunks_exact_mut(side)).enumerate();
        for (leaf_row, (above, below)) in rows {
            above.fill(f32::NEG_INFINITY);
            below.fill(f32::NEG_INFINITY);
            for row in leaf_row << self.refinement..(leaf_row + 1) << self.refinement {
                for (tx, (above, below)) in above.chunks_mut(cells).zip(below.chunks_mut(cells)).enumerate() {
                    let expansions = self.expand(tx, ty, row);
                    self.raise(above, &expansions.bounds(1.0, self.half), scale);
                    self.raise(below, &expansions.bounds(-1.0, self.half), scale);
                    greatest = expansions.greatest_curvatures(greatest);
                }
            }
        }
        greatest
    }

    /// Raises cells to the bounds of the squares that they consist of.
    ///
    /// If the last tile is larger than the rest of the row, there are fewer cells than squares.
    fn raise(&self, cells: &mut [f32], bounds: &[f64; TILE], scale: f64) {
        for (cell, bounds) in cells.iter_mut().zip(bounds.chunks_exact(1 << self.refinement)) {
            let greatest = bounds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            *cell = cell.max(round_up(greatest / scale));
        }
    }

    /// The expansions about one row of the centres of a tile.
    fn expand(&self, tx: usize, ty: usize, row: usize) -> RowOfExpansions {
        let [x, slope_x, curvature_x] = self.stencils.each_ref().map(|stencils| stencils.of_tile(tx));
        let [y, slope_y, curvature_y] = self.stencils.each_ref().map(|stencils| stencils.of_tile(ty));
        let values = self.surface.blend::<MAX_WIDTH>(x, y, row);
        let slopes = self.surface.blend::<MAX_WIDTH>(x, slope_y, row);
        let curvatures = self.surface.blend::<MAX_WIDTH>(x, curvature_y, row);
        RowOfExpansions {
            h: across(&values, x.0),
            x: across(&values, slope_x.0),
            y: across(&slopes, x.0),
            xx: across(&values, curvature_x.0),
            xy: across(&slopes, slope_x.0),
            yy: across(&curvatures, x.0),
        }
    }

    /// The remainder R, and the maximum of |hxx| and |hyy| anywhere, in 1/λ.
    ///
    /// They follow from the maxima of |hxx|, |hxy| and |hyy| at the centres. R includes the errors of interpolation, of
    /// the expansions and of the tiles that are to be bounded.
    fn remainder(&self, curvatures: [f64; 3]) -> (f64, f64) {
        let surface = self.surface;
        // Angle by which the shortest wave advances in a coefficient cell. A derivative multiplies a wave by at most
        // this angle.
        let angle = TAU * surface.band_limit() as f64 / surface.side() as f64;
        let [e0, e1, e2] = ERRORS;
        let curvature_error = (e2 + e0 * angle * angle).max(2.0 * angle * e1) * surface.amplitude();
        let sampling = (PI * surface.band_limit() as f64 / (surface.side() << self.refinement) as f64).cos().powi(2);
        let [xx, xy, yy] = curvatures.map(|at_centres| (at_centres + 2.0 * curvature_error) / sampling);
        let third_derivatives = angle * (xx + 3.0 * xx.min(xy) + 3.0 * yy.min(xy) + yy);
        let gradient_error = (e1 + e0 * angle) * surface.amplitude();
        let d = self.half;
        // The factor 2 covers products of two errors, which are far smaller.
        let errors = 2.0 * (2.0 * surface.error() + 2.0 * d * gradient_error + 2.0 * d * d * curvature_error);
        (d * d * d / 6.0 * third_derivatives + errors, xx.max(yy) * (surface.side() as f64).powi(2))
    }
}

/// Heights minus their mean, and their derivatives, at one row of the centres of a tile.
///
/// Derivatives are per coefficient cell.
struct RowOfExpansions {
    h: [f64; TILE],
    x: [f64; TILE],
    y: [f64; TILE],
    xx: [f64; TILE],
    xy: [f64; TILE],
    yy: [f64; TILE],
}

impl RowOfExpansions {
    /// Upper bounds of `sign` times the second-order expansions.
    ///
    /// They are for squares of side 2d about the centres.
    fn bounds(&self, sign: f64, d: f64) -> [f64; TILE] {
        std::array::from_fn(|i| {
            let along_x = greatest_rise(self.x[i], sign * self.xx[i], d);
            let along_y = greatest_rise(self.y[i], sign * self.yy[i], d);
            sign * self.h[i] + along_x + along_y + self.xy[i].abs() * (d * d)
        })
    }

    /// The maxima of |hxx|, |hxy| and |hyy| of these and `others`.
    fn greatest_curvatures(&self, others: [f64; 3]) -> [f64; 3] {
        let mut values = [&self.xx, &self.xy, &self.yy].into_iter();
        others.map(|other| values.next().into_iter().flatten().fold(other, |max, value| max.max(value.abs())))
    }
}

/// Maximum of `slope · t + curvature · t²/2` over |t| ≤ d.
fn greatest_rise(slope: f64, curvature: f64, d: f64) -> f64 {
    let slope = slope.abs();
    // A parabola falls beyond its summit.
    let t = if slope < -curvature * d { slope / -curvature } else { d };
    t * (slope + 0.5 * curvature * t)
}
