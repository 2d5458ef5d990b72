//! The extension on a grid whose elements are active or not.

use rc_core::Grid;

use crate::grid::extension::pyramid::{Pyramid, add_squares, rows_per_task};
use crate::grid::extension::rows::{gather, interpolate, means};
use crate::parallel;

/// F and its transpose on a grid.
pub(crate) struct GridExtension {
    grid: Grid,
    /// The pyramid over squares of 2 × 2 elements.
    pyramid: Pyramid,
}

impl GridExtension {
    pub(crate) fn new(grid: Grid) -> Self {
        let pyramid = Pyramid::new(grid.nx().div_ceil(2), grid.ny().div_ceil(2));
        Self { grid, pyramid }
    }

    /// Prepares the extension for these active elements.
    pub(crate) fn set_active(&mut self, active: &[bool]) {
        self.for_each_row_of_squares(|[nx, ny], iy, row| {
            let parts = |y: usize| -> Option<Vec<f32>> {
                (y < ny).then(|| active[y * nx..][..nx].iter().map(|&active| f32::from(u8::from(active))).collect())
            };
            let [first, second] = [parts(2 * iy), parts(2 * iy + 1)];
            means([first.as_deref(), second.as_deref()], row);
        });
        self.pyramid.set_active();
    }

    /// Prepares [`GridExtension::fill`] for values that are zero where elements are not active.
    pub(crate) fn extend(&mut self, values: &[f32]) {
        self.for_each_row_of_squares(|[nx, ny], iy, row| {
            let part = |y: usize| (y < ny).then(|| &values[y * nx..][..nx]);
            means([part(2 * iy), part(2 * iy + 1)], row);
        });
        self.pyramid.extend();
    }

    /// F in whole rows of the grid: from the values of active elements to u.
    ///
    /// `first` is the index of the first row.
    pub(crate) fn fill(&self, first: usize, active: &[bool], rows: &mut [f32]) {
        let nx = self.grid.nx();
        let (mut line, mut around) = (Vec::new(), vec![0.0; nx]);
        for (iy, (row, active)) in rows.chunks_mut(nx).zip(active.chunks(nx)).enumerate() {
            interpolate(self.pyramid.values(), nx.div_ceil(2), first + iy, &mut line, &mut around);
            for ((value, &around), &active) in row.iter_mut().zip(&around).zip(active) {
                *value = if active { *value } else { around };
            }
        }
    }

    /// Fᵀ: adds to the values of active elements the shares of the values between them.
    ///
    /// Leaves zeros on the other elements.
    pub(crate) fn gather(&mut self, active: &[bool], values: &mut [f32]) {
        let height = self.grid.ny().div_ceil(2);
        self.for_each_row_of_squares(|[nx, ny], iy, row| {
            let add = |weight: f32, y: usize, line: &mut [f32]| {
                let here = y * nx..(y + 1) * nx;
                for (sum, (&value, &active)) in line.iter_mut().zip(values[here.clone()].iter().zip(&active[here])) {
                    *sum += if active { 0.0 } else { weight * value };
                }
            };
            gather([nx, ny], [iy, height], &mut Vec::new(), add, row);
        });
        self.pyramid.gather();
        let (nx, squares) = (self.grid.nx(), self.pyramid.values());
        let n_rows = rows_per_task(nx);
        let blocks = values.chunks_mut(nx * n_rows).zip(active.chunks(nx * n_rows)).enumerate();
        parallel::for_each(blocks, |(i, (rows, active))| {
            for (iy, (row, active)) in rows.chunks_mut(nx).zip(active.chunks(nx)).enumerate() {
                let above = (i * n_rows + iy) >> 1;
                add_squares(&squares[above * nx.div_ceil(2)..], row);
                for (value, &active) in row.iter_mut().zip(active) {
                    *value = if active { *value } else { 0.0 };
                }
            }
        });
    }

    /// Sets the values of the squares.
    ///
    /// `work` gets the numbers of elements along both axes, the index of a row of squares, and the row.
    fn for_each_row_of_squares(&mut self, work: impl Fn([usize; 2], usize, &mut [f32]) + Sync) {
        let grid = [self.grid.nx(), self.grid.ny()];
        let nx = grid[0].div_ceil(2);
        let n_rows = rows_per_task(nx);
        parallel::for_each(self.pyramid.values_mut().chunks_mut(nx * n_rows).enumerate(), |(i, rows)| {
            for (iy, row) in rows.chunks_mut(nx).enumerate() {
                work(grid, i * n_rows + iy, row);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;

    use super::*;

    /// F of `values` on the active elements.
    fn extended(extension: &mut GridExtension, active: &[bool], values: &[f32]) -> Vec<f32> {
        let mut values = values.to_vec();
        extension.extend(&values);
        extension.fill(0, active, &mut values);
        values
    }

    fn product(a: &[f32], b: &[f32]) -> f64 {
        a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    }

    #[test]
    fn it_keeps_constants_and_has_its_transpose_on_any_grid() {
        for (nx, ny) in [(64, 64), (61, 7), (1, 64), (33, 90), (2, 2), (1, 1)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            for threshold in [0.0, 0.3, 0.9] {
                let active: Vec<bool> = (0..grid.len()).map(|i| i == 0 || quasi_random(i) > threshold).collect();
                let mut extension = GridExtension::new(grid);
                extension.set_active(&active);
                let of_active = |value: &dyn Fn(usize) -> f64| -> Vec<f32> {
                    (0..grid.len()).map(|i| if active[i] { value(i) as f32 } else { 0.0 }).collect()
                };
                let ones = extended(&mut extension, &active, &of_active(&|_| 1.0));
                assert!(ones.iter().all(|u| (u - 1.0).abs() < 1e-5), "{grid}, {threshold}: {ones:?}");
                let r = of_active(&|i| quasi_random(3 * i + 1) - 0.5);
                let y: Vec<f32> = (0..grid.len()).map(|i| quasi_random(5 * i + 2) as f32 - 0.5).collect();
                let u = extended(&mut extension, &active, &r);
                assert!(
                    u.iter().zip(&r).zip(&active).all(|((u, r), &active)| !active || u.to_bits() == r.to_bits()),
                    "{grid}"
                );
                let mut gathered = y.clone();
                extension.gather(&active, &mut gathered);
                let (there, back) = (product(&u, &y), product(&r, &gathered));
                let size = product(&u, &u).sqrt() * product(&y, &y).sqrt();
                assert!((there - back).abs() < 1e-5 * size, "{grid}, {threshold}: {there} and {back}");
            }
        }
    }
}
