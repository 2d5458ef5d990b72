//! Interpolation of values from one grid of a cell to another.
//!
//! The other grid is finer or coarser by any ratio.

use rayon::prelude::*;
use rc_core::{Boundary, Grid};

/// Interpolates between `N` neighbours along each axis (Lagrange).
///
/// `read` changes each value before, and `written` after. At free borders the neighbours are the outermost ones. Beyond
/// the last centre, a value is that of the centre.
pub(super) fn interpolate<const N: usize>(
    values: &[f64],
    ([from, to], boundary): ([Grid; 2], Boundary),
    read: impl Fn(f64) -> f64 + Sync,
    written: impl Fn(f64) -> f64 + Sync,
) -> Vec<f64> {
    let nx = from.nx();
    let (along_x, along_y) =
        (Taps::<N>::of_centres(nx, to.nx(), boundary), Taps::<N>::of_centres(from.ny(), to.ny(), boundary));
    let mut result = vec![0.0; to.len()];
    result.par_chunks_mut(to.nx()).zip(&along_y).for_each_init(
        || vec![0.0; nx],
        |blended, (row, taps)| {
            blended.fill(0.0);
            for (iy, weight) in taps.iter() {
                for (sum, value) in blended.iter_mut().zip(&values[iy * nx..][..nx]) {
                    *sum += weight * read(*value);
                }
            }
            for (value, taps) in row.iter_mut().zip(&along_x) {
                *value = written(taps.iter().map(|(ix, weight)| weight * blended[ix]).sum());
            }
        },
    );
    result
}

/// The neighbours of one centre along one axis, and their weights.
struct Taps<const N: usize> {
    neighbours: [usize; N],
    weights: [f64; N],
}

impl<const N: usize> Taps<N> {
    /// Taps for each centre of `to` elements on a side that has `from` elements.
    fn of_centres(from: usize, to: usize, boundary: Boundary) -> Vec<Self> {
        let ratio = from as f64 / to as f64;
        // Places of neighbours, in elements from the last centre before.
        let place_of = |tap: usize| tap as f64 - (N / 2 - 1) as f64;
        let is_free = boundary == Boundary::Free;
        let of_centre = |i: usize| {
            let mut place = (i as f64 + 0.5) * ratio - 0.5;
            let mut before = place.floor();
            if is_free {
                place = place.clamp(0.0, (from - 1) as f64);
                let inner = (N / 2 - 1) as f64;
                before = place.floor().min(from as f64 - 1.0 - (N / 2) as f64).max(inner);
            }
            let at = place - before;
            let weights = std::array::from_fn(|tap| {
                let others = (0..N).filter(|&other| other != tap).map(place_of);
                let (mut product, mut divisor) = (1.0, 1.0);
                for other in others {
                    product *= at - other;
                    divisor *= place_of(tap) - other;
                }
                product / divisor
            });
            let neighbour = |tap: usize| {
                let index = before + place_of(tap);
                // On a side of fewer than N elements, some neighbours occur twice.
                let index = if is_free { index.clamp(0.0, (from - 1) as f64) } else { index.rem_euclid(from as f64) };
                index as usize
            };
            Self { neighbours: std::array::from_fn(neighbour), weights }
        };
        (0..to).map(of_centre).collect()
    }

    fn iter(&self) -> impl Iterator<Item = (usize, f64)> {
        self.neighbours.iter().copied().zip(self.weights)
    }
}
