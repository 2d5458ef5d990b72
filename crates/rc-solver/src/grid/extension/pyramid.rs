//! Values on a grid of squares that are active in part, and on coarser grids.

use crate::grid::extension::rows::{gather, interpolate, means};
use crate::parallel;

/// Minimum number of values that one task works on.
const TASK: usize = 4096;

/// The part of its value that a square takes from its own active elements.
///
/// x is the part of its elements that are active. The square takes the rest from larger squares.
/// `docs/measurements-uniform.md` compares x^(3/4) with other powers.
pub(crate) fn own_part(x: f32) -> f32 {
    x.sqrt() * x.sqrt().sqrt()
}

/// The two shares of a square.
///
/// The first multiplies the mean over all its elements. The second multiplies the value around it.
fn shares(x: f32) -> [f32; 2] {
    let own = own_part(x);
    // The mean over all elements is x times the mean over the active ones.
    if x > 0.0 { [own / x, 1.0 - own] } else { [0.0, 1.0] }
}

/// Sets the shares of squares, of whose elements these `parts` are active.
pub(crate) fn set_shares(own: &mut [f32], rest: &mut [f32], parts: &[f32]) {
    let blocks = own.chunks_mut(TASK).zip(rest.chunks_mut(TASK)).zip(parts.chunks(TASK));
    parallel::for_each(blocks, |((own, rest), parts)| {
        for ((own, rest), &part) in own.iter_mut().zip(rest).zip(parts) {
            [*own, *rest] = shares(part);
        }
    });
}

/// A grid of squares.
struct Level {
    nx: usize,
    /// Factor on the mean over all elements of a square, active or not.
    own: Vec<f32>,
    /// Factor on the value that larger squares have at the place of the square.
    rest: Vec<f32>,
    values: Vec<f32>,
}

/// F and its transpose between a grid of squares and all coarser ones.
pub(crate) struct Pyramid {
    /// Grids, finest first. The last is a single square.
    levels: Vec<Level>,
}

impl Pyramid {
    /// A pyramid over a grid of `nx` × `ny` squares.
    pub(crate) fn new(nx: usize, ny: usize) -> Self {
        let (mut levels, mut sides) = (Vec::new(), [nx, ny]);
        loop {
            let [nx, ny] = sides;
            let zeros = || parallel::zeros(nx * ny);
            levels.push(Level { nx, own: zeros(), rest: zeros(), values: zeros() });
            if nx * ny <= 1 {
                return Self { levels };
            }
            sides = sides.map(|n| n.div_ceil(2));
        }
    }

    /// The values on the grid, row by row.
    pub(crate) fn values(&self) -> &[f32] {
        &self.levels[0].values
    }

    /// The values on the grid, which are set before the other functions are called.
    pub(crate) fn values_mut(&mut self) -> &mut [f32] {
        &mut self.levels[0].values
    }

    /// Takes the values as the parts of squares that are active.
    pub(crate) fn set_active(&mut self) {
        self.take_means();
        for level in &mut self.levels {
            set_shares(&mut level.own, &mut level.rest, &level.values);
        }
        if let Some(Level { own, rest, values, .. }) = self.levels.last_mut() {
            (own[0], rest[0]) = (if values[0] > 0.0 { values[0].recip() } else { 0.0 }, 0.0);
        }
    }

    /// F: from means over squares to u.
    ///
    /// The means are over all elements of a square. Elements that are not active count as zero.
    pub(crate) fn extend(&mut self) {
        self.take_means();
        for k in (0..self.levels.len()).rev() {
            let (finer, coarser) = self.levels.split_at_mut(k + 1);
            let (Level { nx, own, rest, values }, coarser) = (&mut finer[k], coarser.first());
            let (nx, n_rows) = (*nx, rows_per_task(*nx));
            let shares = own.chunks(nx * n_rows).zip(rest.chunks(nx * n_rows));
            parallel::for_each(values.chunks_mut(nx * n_rows).zip(shares).enumerate(), |(i, (rows, (own, rest)))| {
                let (mut line, mut around) = (Vec::new(), vec![0.0; nx]);
                let shares = own.chunks(nx).zip(rest.chunks(nx));
                for (iy, (row, (own, rest))) in rows.chunks_mut(nx).zip(shares).enumerate() {
                    if let Some(coarser) = coarser {
                        interpolate(&coarser.values, coarser.nx, i * n_rows + iy, &mut line, &mut around);
                    }
                    for ((value, around), (own, rest)) in row.iter_mut().zip(&around).zip(own.iter().zip(rest)) {
                        *value = own * *value + rest * around;
                    }
                }
            });
        }
    }

    /// Fᵀ, times the number of elements in a square.
    ///
    /// It takes values of u, and gives the values that each active element of a square gets.
    pub(crate) fn gather(&mut self) {
        for k in 1..self.levels.len() {
            let (finer, coarser) = self.levels.split_at_mut(k);
            let (finer, Level { nx, values, .. }) = (&finer[k - 1], &mut coarser[0]);
            let (nx, n_rows, height) = (*nx, rows_per_task(*nx), values.len() / *nx);
            let n_finer = finer.values.len() / finer.nx;
            parallel::for_each(values.chunks_mut(nx * n_rows).enumerate(), |(i, rows)| {
                let mut line = Vec::new();
                for (iy, row) in rows.chunks_mut(nx).enumerate() {
                    let add = |weight: f32, y: usize, line: &mut [f32]| {
                        let here = y * finer.nx..(y + 1) * finer.nx;
                        let parts = finer.values[here.clone()].iter().zip(&finer.rest[here]);
                        for (sum, (value, rest)) in line.iter_mut().zip(parts) {
                            *sum += weight * rest * value;
                        }
                    };
                    gather([finer.nx, n_finer], [i * n_rows + iy, height], &mut line, add, row);
                }
            });
        }
        for k in (0..self.levels.len()).rev() {
            let (finer, coarser) = self.levels.split_at_mut(k + 1);
            let (Level { nx, own, values, .. }, coarser) = (&mut finer[k], coarser.first());
            let (nx, n_rows) = (*nx, rows_per_task(*nx));
            let blocks = values.chunks_mut(nx * n_rows).zip(own.chunks(nx * n_rows)).enumerate();
            parallel::for_each(blocks, |(i, (rows, own))| {
                for (iy, (row, own)) in rows.chunks_mut(nx).zip(own.chunks(nx)).enumerate() {
                    for (value, own) in row.iter_mut().zip(own) {
                        *value *= own;
                    }
                    if let Some(coarser) = coarser {
                        let above = (i * n_rows + iy) >> 1;
                        add_squares(&coarser.values[above * coarser.nx..], row);
                    }
                }
            });
        }
    }

    /// Computes the means on all coarser grids.
    fn take_means(&mut self) {
        for k in 1..self.levels.len() {
            let (finer, coarser) = self.levels.split_at_mut(k);
            let (finer, Level { nx, values, .. }) = (&finer[k - 1], &mut coarser[0]);
            let n_rows = rows_per_task(*nx);
            parallel::for_each(values.chunks_mut(*nx * n_rows).enumerate(), |(i, rows)| {
                for (iy, row) in rows.chunks_mut(*nx).enumerate() {
                    let first = 2 * (i * n_rows + iy);
                    let part = |y: usize| finer.values.get(y * finer.nx..(y + 1) * finer.nx);
                    means([part(first), part(first + 1)], row);
                }
            });
        }
    }
}

/// Adds the values of a row of squares to the values of their parts.
pub(crate) fn add_squares(squares: &[f32], parts: &mut [f32]) {
    for (parts, square) in parts.chunks_mut(2).zip(squares) {
        for part in parts {
            *part += square;
        }
    }
}

/// Rows of `nx` values that one task works on.
pub(crate) fn rows_per_task(nx: usize) -> usize {
    TASK.div_ceil(nx)
}
