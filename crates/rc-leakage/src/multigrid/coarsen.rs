//! The network of a coarser level, for interpolated pressures (Galerkin).

use super::interpolation::{Bonds, Interpolation};
use super::stencil::{Corners, Stencil};
use crate::parallel;
use crate::real::Real;

/// Bonds between the four corners of a coarse square.
#[derive(Clone, Copy, Default)]
struct Square<T> {
    bottom: T,
    left: T,
    rising: T,
    falling: T,
    right: T,
    top: T,
}

/// The network of the coarser level.
pub(super) fn coarsen<T: Real>(fine: &Stencil<T>, interpolation: &Interpolation<T>) -> Stencil<T> {
    let [nx, ny] = interpolation.coarse;
    let mut squares = vec![Square::default(); nx * ny];
    let rows = squares.chunks_mut(nx).enumerate().collect();
    parallel::for_each(rows, |(row, squares): (usize, &mut [Square<T>])| {
        for (column, out) in squares.iter_mut().enumerate() {
            *out = square(fine, interpolation, [column, row]);
        }
    });
    let of = |part: &(dyn Fn(usize, usize) -> T + Sync)| {
        let mut values = vec![T::ZERO; nx * ny];
        let rows = values.chunks_mut(nx).enumerate().collect();
        parallel::for_each(rows, |(row, values): (usize, &mut [T])| {
            values.iter_mut().enumerate().for_each(|(column, value)| *value = part(column, row));
        });
        values
    };
    let at = |column: usize, row: usize| &squares[row * nx + column];
    // A bond from an element to itself carries no flow.
    let east = |column: usize, row: usize| {
        if nx > 1 { at(column, row).bottom + at(column, (row + ny - 1) % ny).top } else { T::ZERO }
    };
    let north = |column: usize, row: usize| {
        if ny > 1 { at(column, row).left + at((column + nx - 1) % nx, row).right } else { T::ZERO }
    };
    let corner = |value: T| if nx > 1 || ny > 1 { value } else { T::ZERO };
    let corners = Corners {
        rising: of(&|column, row| corner(at(column, row).rising)),
        falling: of(&|column, row| corner(at(column, row).falling)),
    };
    let mut coarse =
        Stencil { nx, ny, east: of(&east), north: of(&north), corners: Some(corners), inverse: Vec::new() };
    coarse.invert_totals();
    coarse
}

/// The bonds that fine bonds contribute to the coarse square at `at`.
///
/// The fine bonds are those within it, on its left side and on its lower side.
fn square<T: Real>(fine: &Stencil<T>, interpolation: &Interpolation<T>, at: [usize; 2]) -> Square<T> {
    let bonds = Bonds(fine);
    let widths = interpolation.widths(at);
    let start = [0, 1].map(|axis| interpolation.factor[axis] * at[axis]);
    let mut weights = [[[T::ZERO; 4]; 3]; 3];
    for (y, row) in weights.iter_mut().enumerate().take(widths[1] + 1) {
        for (x, weights) in row.iter_mut().enumerate().take(widths[0] + 1) {
            *weights = interpolation.corner_weights(at, [x, y]);
        }
    }
    let mut sums = [T::ZERO; 6];
    let mut add = |bond: T, a: &[T; 4], b: &[T; 4]| {
        if bond == T::ZERO {
            return;
        }
        let d = [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]];
        for (sum, (k, l)) in sums.iter_mut().zip([(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]) {
            *sum -= bond * d[k] * d[l];
        }
    };
    for y in 0..widths[1] {
        for x in 0..widths[0] {
            let [i, j] = [start[0] + x, start[1] + y];
            add(bonds.east(i, j), &weights[y][x], &weights[y][x + 1]);
            add(bonds.north(i, j), &weights[y][x], &weights[y + 1][x]);
            if fine.corners.is_some() {
                add(bonds.rising(i, j), &weights[y][x], &weights[y + 1][x + 1]);
                add(bonds.falling(i, j), &weights[y][x + 1], &weights[y + 1][x]);
            }
        }
    }
    let [bottom, left, rising, falling, right, top] = sums;
    Square { bottom, left, rising, falling, right, top }
}
