//! From the pressure on one grid to a start on the next finer one.
//!
//! Interpolating the pressure itself spreads every contact by half a coarse element, which costs the next level six
//! iterations. At the distance s from an edge, p = c √s inside and g = (4c/3) s^{3/2} outside, with the same c (`E* =
//! 1`). The edge function is φ = p² inside and φ = -c² (3g/4c)^{2/3} outside. It is linear in s across the edge, so
//! bilinear interpolation puts the edge where it belongs.

use rayon::prelude::*;
use rc_core::{Boundary, Grid};

use crate::descent::state::Descent;
use crate::grid::interpolation::interpolate;

/// The start on a `finer` grid of the same cell.
pub(crate) fn prolong(coarse: &Descent<'_>, finer: Grid) -> Vec<f64> {
    let boundary = coarse.boundary();
    pressure_from(&edge_function(coarse), ([coarse.grid(), finer], boundary))
}

/// The pressure on a finer grid from φ, which is interpolated linearly.
fn pressure_from(function: &[f64], grids: ([Grid; 2], Boundary)) -> Vec<f64> {
    interpolate::<2>(function, grids, |value| value, |value| value.max(0.0).sqrt())
}

/// The edge function φ at the coarse centres.
pub(crate) fn edge_function(coarse: &Descent<'_>) -> Vec<f64> {
    let (nx, ny) = (coarse.grid().nx(), coarse.grid().ny());
    let (pressure, gap) = (coarse.pressure(), coarse.gap());
    let zero_gap = coarse.contact_gap();
    let spacing = coarse.grid().spacing().min_element();
    let neighbours = Neighbours(coarse.boundary());
    let mut function = vec![0.0; nx * ny];
    function.par_chunks_mut(nx).enumerate().for_each(|(iy, row)| {
        let rows = neighbours.of(iy, ny).map(|y| &pressure[y * nx..(y + 1) * nx]);
        for (ix, value) in row.iter_mut().enumerate() {
            let here = rows[1][ix];
            *value = if here > 0.0 {
                here * here
            } else {
                let columns = neighbours.of(ix, nx);
                let near = rows.iter().flat_map(|row| columns.iter().map(|&column| &row[column]));
                edge_function_outside(near, (gap[iy * nx + ix] - zero_gap).max(0.0), spacing)
            };
        }
    });
    function
}

/// The neighbours of elements at this boundary.
#[derive(Clone, Copy)]
struct Neighbours(Boundary);

impl Neighbours {
    /// The element and its two neighbours. Beyond a free border it is its own neighbour.
    fn of(self, i: usize, n: usize) -> [usize; 3] {
        match self.0 {
            Boundary::Periodic => [(i + n - 1) % n, i, (i + 1) % n],
            Boundary::Free => [i.saturating_sub(1), i, (i + 1).min(n - 1)],
        }
    }
}

/// The edge function φ of an element out of contact, with the pressures `near` around it.
///
/// c² is estimated from its neighbours in contact, whose centres are about 0.7 elements inside the edge. Without such
/// neighbours the value has no influence.
pub(crate) fn edge_function_outside<'a>(near: impl Iterator<Item = &'a f64>, gap: f64, spacing: f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for p in near {
        if *p > 0.0 {
            sum += p * p;
            count += 1.0;
        }
    }
    if count == 0.0 {
        return 0.0;
    }
    let c_squared = sum / (count * EDGE_DISTANCE * spacing);
    let distance = (0.75 * gap / c_squared.sqrt()).powf(2.0 / 3.0);
    -c_squared * distance.min(3.0 * spacing)
}

/// Typical distance to the edge of an element in contact beside a free one.
///
/// The unit is an element.
const EDGE_DISTANCE: f64 = 0.7;

#[cfg(test)]
mod tests {
    use super::*;

    /// φ is linear across the straight edges of a strip. So p² on the fine elements is linear too, and the edges stay
    /// where they are.
    #[test]
    fn edges_of_a_strip_stay_where_they_are() {
        let (nx, ny) = (16, 8);
        // A strip of width 6.6 along y, then one along x. Places are in coarse elements from the middle.
        let inside = |at: f64, n: usize| 3.3 - (at - 0.5 * n as f64).abs();
        for along_x in [false, true] {
            let linear = |x: f64, y: f64| if along_x { inside(y, ny) } else { inside(x, nx) };
            let centre = |i: usize| i as f64 + 0.5;
            let coarse: Vec<f64> = (0..nx * ny).map(|i| linear(centre(i % nx), centre(i / nx))).collect();
            let grid = |nx, ny| Grid::new(nx, ny).expect("a grid");
            let finer = [[2 * nx, 2 * ny], [27, 15], [31, 17]];
            let all = finer.into_iter().flat_map(|[fx, fy]| {
                let fine = pressure_from(&coarse, ([grid(nx, ny), grid(fx, fy)], Boundary::Periodic));
                let at =
                    move |i: usize| [centre(i % fx) * nx as f64 / fx as f64, centre(i / fx) * ny as f64 / fy as f64];
                fine.into_iter().enumerate().map(move |(i, p)| (at(i), p))
            });
            for ([x, y], p) in all {
                let (squared, from_ridge) = (linear(x, y).max(0.0), 3.3 - linear(x, y));
                // Interpolation blunts the ridge in the middle and the valley across the seam.
                let valley = if along_x { 0.5 * ny as f64 } else { 0.5 * nx as f64 };
                if (1.0..valley - 1.0).contains(&from_ridge) {
                    assert!((p * p - squared).abs() < 1e-12, "({x}, {y}): p² = {} for {squared}", p * p);
                }
            }
        }
    }
}
