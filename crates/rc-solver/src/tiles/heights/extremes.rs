//! The maximum height, without evaluating all heights.

use rc_core::{Boundary, DVec2};

use crate::problem::summit::{MAX_CLIMBS, climb};
use crate::tiles::heights::bounds::Bounds;
use crate::tiles::heights::interpolation::Interpolation;
use rc_quadtree::TILE;

/// The maximum value at the centres of `tiles_per_side`² tiles.
///
/// `tile(tx, ty)` is the maximum value of a tile. Only tiles that may hold the maximum are evaluated: those with a leaf
/// of `bounds` above the maximum found so far. These are a few leaves of a rough surface. On a wavy surface with a
/// level ridge, they are all leaves along the ridge.
pub(super) fn greatest(bounds: &Bounds, tiles_per_side: usize, tile: impl Fn(usize, usize) -> f64) -> f64 {
    let [side, _] = bounds.sides();
    let of_leaf = |leaf: usize| {
        let tiles = |i: usize| i * tiles_per_side / side..((i + 1) * tiles_per_side).div_ceil(side);
        let rows = tiles(leaf / side).flat_map(|ty| tiles(leaf % side).map(move |tx| (tx, ty)));
        rows.map(|(tx, ty)| tile(tx, ty)).fold(f64::NEG_INFINITY, f64::max)
    };
    let highest = bounds.leaves().enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    let mut best = highest.map_or(f64::NEG_INFINITY, |(leaf, _)| of_leaf(leaf));
    let mut candidates: Vec<(usize, f64)> = bounds.leaves().enumerate().filter(|(_, bound)| *bound > best).collect();
    candidates.sort_by(|a, b| b.1.total_cmp(&a.1));
    for (leaf, bound) in candidates {
        if bound <= best {
            break;
        }
        best = best.max(of_leaf(leaf));
    }
    best
}

/// Maximum of the heights of a tile.
pub(super) fn of_tile(heights: &[f64; TILE * TILE]) -> f64 {
    heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// The maximum of a surface between the centres of elements, at least `sampled`.
///
/// It is searched in the highest leaves of `bounds` above `sampled`.
pub(super) fn summit(surface: &Interpolation, bounds: &Bounds, (sampled, boundary): (f64, Boundary)) -> f64 {
    let inside = |at: DVec2| if boundary == Boundary::Free { at.clamp(DVec2::ZERO, DVec2::ONE) } else { at };
    let side = surface.side();
    let mut leaves: Vec<(usize, f64)> = bounds.leaves().enumerate().filter(|(_, bound)| *bound > sampled).collect();
    leaves.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut best = sampled;
    for (leaf, bound) in leaves.into_iter().take(MAX_CLIMBS) {
        if bound <= best {
            break;
        }
        let centre = DVec2::new((leaf % side) as f64 + 0.5, (leaf / side) as f64 + 0.5) / side as f64;
        best = best.max(climb(&|at| surface.height(inside(at)), centre, DVec2::splat(1.0 / side as f64)));
    }
    best
}
