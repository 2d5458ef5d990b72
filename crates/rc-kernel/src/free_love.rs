//! The paper's element on an infinite half-space whose surface is free beyond the heights.

use std::sync::Arc;

use rc_core::{DVec2, EdgeBias, Grid, Kernel, SplitByScale, Symbol};

use crate::half_space::HalfSpace;
use crate::{Love, love_rectangle_displacement};

/// [`Love`] without periodic images.
///
/// The pressure is uniform on each element of a finite patch. The displacement is taken at element centres and is zero
/// far away. The response between two elements is [`love_displacement`](crate::love_displacement), or its form for
/// rectangles. Each value is computed once. The solver sums the responses by a Fourier transform on a padded grid.
#[derive(Clone, Copy, Debug, Default)]
pub struct FreeLove;

impl Kernel for FreeLove {
    fn name(&self) -> &'static str {
        "love"
    }

    /// The symbol of the periodic cell, for preconditioning.
    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        Love.symbol(grid)
    }

    fn free_response(&self, grid: Grid) -> Option<Symbol<'_>> {
        let spacing = grid.spacing();
        // The sides of a square may differ by rounding.
        let is_square = (spacing.x - spacing.y).abs() <= 4.0 * f64::EPSILON * spacing.x;
        let half_sides = 0.5 * if is_square { DVec2::splat(spacing.x) } else { spacing };
        let distance = 2.0 * half_sides;
        Some(Box::new(move |ix, iy| {
            love_rectangle_displacement(distance * DVec2::new(ix as f64, iy as f64), half_sides)
        }))
    }

    /// That of [`Love`]. The mean displacement of a patch is less exact than that of a cell, which is zero.
    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        EdgeBias { gap_errors: [0.05, 0.13], ..Love.edge_bias(grid) }
    }

    fn split(&self) -> Option<&dyn SplitByScale> {
        Some(&HalfSpace)
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }
}
