//! The operations of the multilevel operator on whole grids, cell by cell.
//!
//! They are the filters between two levels and the stencils. The solver does the same on tiles, with vector
//! instructions. These functions are for a picture, so they need not be fast.

use anyhow::Result;
use rc_core::{Field, Grid};
use rc_kernel::Stencil;

/// The coarse cell that a tap of the filter reads for cell `fine`.
///
/// The tap is number `tap` of `n_taps`, and the coarser grid has `n` cells, which repeat. The centre of a fine cell of
/// odd index is a quarter of a coarse cell beyond the centre of its coarse cell. The centre of a fine cell of even
/// index is as far before it.
fn coarse_cell(fine: usize, (tap, n_taps): (usize, usize), n: usize) -> usize {
    let shift = tap as isize - (n_taps as isize / 2 - 1);
    let shift = if fine % 2 == 1 { shift } else { -shift };
    (fine as isize / 2 + shift).rem_euclid(n as isize) as usize
}

/// Calls `visit` with every pair of a fine and a coarse cell, and its weight.
fn pairs(fine: Grid, coarse: Grid, taps: &[f64], mut visit: impl FnMut(usize, usize, f64)) {
    let n = taps.len();
    for (iy, ix) in (0..fine.ny()).flat_map(|iy| (0..fine.nx()).map(move |ix| (iy, ix))) {
        for (i, weight_y) in taps.iter().enumerate() {
            let row = coarse_cell(iy, (i, n), coarse.ny());
            for (j, weight_x) in taps.iter().enumerate() {
                let column = coarse_cell(ix, (j, n), coarse.nx());
                visit(fine.index(ix, iy), coarse.index(column, row), weight_x * weight_y);
            }
        }
    }
}

/// Restriction of a level's pressure to the next coarser level, ρ = ¼ Fᵀ p.
pub(super) fn restricted(fine: &Field, taps: &[f64]) -> Result<Field> {
    let grid = fine.grid();
    let mut coarse = Field::zeros(grid.with_elements(grid.nx() / 2, grid.ny() / 2)?);
    let coarse_grid = coarse.grid();
    let values = coarse.values_mut();
    pairs(grid, coarse_grid, taps, |at, below, weight| values[below] += 0.25 * weight * fine.values()[at]);
    Ok(coarse)
}

/// Prolongation of a level's displacement to the next finer level, F u.
pub(super) fn prolonged(coarse: &Field, taps: &[f64]) -> Result<Field> {
    let grid = coarse.grid();
    let mut fine = Field::zeros(grid.with_elements(2 * grid.nx(), 2 * grid.ny())?);
    let fine_grid = fine.grid();
    let values = fine.values_mut();
    pairs(fine_grid, grid, taps, |at, below, weight| values[at] += weight * coarse.values()[below]);
    Ok(fine)
}

/// The displacement that a stencil adds on its level, h S p.
///
/// h is the side of an element.
pub(super) fn displaced(pressure: &Field, stencil: &Stencil) -> Field {
    let grid = pressure.grid();
    let (reach, side) = (stencil.radius() as i32, grid.spacing().x);
    let wrapped = |at: usize, offset: i32, n: usize| (at as i32 + offset).rem_euclid(n as i32) as usize;
    let mut displacement = Field::zeros(grid);
    for (iy, ix) in (0..grid.ny()).flat_map(|iy| (0..grid.nx()).map(move |ix| (iy, ix))) {
        let offsets = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        let terms = offsets.map(|(dx, dy)| {
            stencil.weight(dx, dy) * pressure.at(wrapped(ix, dx, grid.nx()), wrapped(iy, dy, grid.ny()))
        });
        displacement.values_mut()[grid.index(ix, iy)] = side * terms.sum::<f64>();
    }
    displacement
}
