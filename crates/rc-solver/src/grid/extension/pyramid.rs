//! F and its transpose, from the values of a grid over means on coarser and coarser grids.

use crate::grid::extension::rows::{Parts, Shares, TASK, Weight, collect, interpolate, means};
use crate::parallel;

/// A grid of squares of 2 × 2 values of the next finer grid.
struct Level {
    nx: usize,
    /// The share of a square that each of its values has: a quarter, or a half in a single row.
    share: f32,
    parts: Parts,
    values: Vec<f32>,
}

impl Level {
    /// Sets the values to means over a finer grid of rows of `nx` values. `part` is applied to each of these.
    fn take_means<T: Copy + Sync>(&mut self, nx: usize, finer: &[T], part: impl Fn(T) -> f32 + Sync) {
        let share = self.share;
        for_each_row(&mut self.values, self.nx, |iy, row| {
            let line = |y: usize| finer.get(y * nx..(y + 1) * nx);
            means([line(2 * iy), line(2 * iy + 1)], share, &part, row);
        });
    }

    /// Changes rows of `nx` own values of the finer grid, from row `first` on, to u.
    fn fill(&self, first: usize, nx: usize, shares: Shares<'_>, rows: &mut [f32]) {
        let (mut line, mut around) = (Vec::new(), vec![0.0; nx]);
        for (iy, row) in rows.chunks_mut(nx).enumerate() {
            interpolate(&self.values, self.nx, first + iy, &mut line, &mut around);
            shares.part(iy * nx..(iy + 1) * nx).blend(&around, row);
        }
    }

    /// [`Level::fill`] for all rows of the finer grid.
    fn fill_all(&self, nx: usize, shares: Shares<'_>, values: &mut [f32]) {
        let n_rows = TASK.div_ceil(nx);
        parallel::for_each(values.chunks_mut(nx * n_rows).enumerate(), |(i, rows)| {
            let first = i * n_rows;
            self.fill(first, nx, shares.part(first * nx..first * nx + rows.len()), rows);
        });
    }

    /// Collects the rest of the values for u of a finer grid of rows of `nx` values.
    fn collect(&mut self, nx: usize, shares: Shares<'_>, finer: &[f32]) {
        let (n, height, share) = (finer.len() / nx, self.values.len() / self.nx, self.share);
        for_each_row(&mut self.values, self.nx, |iy, row| {
            let add = |weight: f32, y: usize, line: &mut [f32]| {
                let here = y * nx..(y + 1) * nx;
                shares.part(here.clone()).add_rest(weight, &finer[here], line);
            };
            collect([nx, n], ([iy, height], share), add, row);
        });
    }

    /// Changes the values for u of a finer grid to those for its own values.
    fn hand_down(&self, nx: usize, shares: Shares<'_>, finer: &mut [f32]) {
        for_each_row(finer, nx, |iy, row| {
            let squares = &self.values[iy / 2 * self.nx..][..self.nx];
            let over: Vec<f32> = squares.iter().flat_map(|&square| [square; 2]).collect();
            shares.part(iy * nx..(iy + 1) * nx).hand_down(&over, row);
        });
    }
}

/// F and its transpose on a grid, whose values and [`Shares`] the caller has.
pub(crate) struct Extension {
    nx: usize,
    /// Factor on the mean of the single square, around which there is nothing.
    top: f32,
    /// Grids of squares, finest first. The last is a single square.
    levels: Vec<Level>,
}

impl Extension {
    /// The extension on a grid with these numbers of values along both axes.
    pub(crate) fn new([nx, ny]: [usize; 2]) -> Self {
        let (mut levels, mut sides) = (Vec::new(), [nx, ny]);
        let is_line = ny == 1;
        let (share, weight) = if is_line { (0.5, Weight::OfLine) } else { (0.25, Weight::OfSquare) };
        while levels.is_empty() || sides != [1, 1] {
            sides = sides.map(|n| n.div_ceil(2));
            let n = sides[0] * sides[1];
            levels.push(Level { nx: sides[0], share, parts: Parts::new(n, weight), values: parallel::zeros(n) });
        }
        Self { nx, top: 0.0, levels }
    }

    /// Prepares the extension for the parts of `active` elements.
    pub(crate) fn set_active<T: Copy + Sync>(&mut self, active: &[T], part: impl Fn(T) -> f32 + Sync) {
        self.take_means(active, part);
        for level in &mut self.levels {
            level.parts.set(&level.values);
        }
        let single = self.levels.last().map_or(0.0, |level| level.values[0]);
        self.top = if single > 0.0 { single.recip() } else { 0.0 };
    }

    /// Prepares [`Extension::fill`] for means over all elements. Elements that are not active count as zero.
    pub(crate) fn extend(&mut self, values: &[f32]) {
        self.take_means(values, |value| value);
        for k in (0..self.levels.len()).rev() {
            let (finer, coarser) = self.levels.split_at_mut(k + 1);
            let Level { nx, parts, values, .. } = &mut finer[k];
            match coarser.first() {
                Some(coarser) => coarser.fill_all(*nx, parts.shares(), values),
                None => values[0] *= self.top,
            }
        }
    }

    /// F in whole rows of the grid, from row `first` on: from means to u.
    pub(crate) fn fill(&self, first: usize, shares: Shares<'_>, rows: &mut [f32]) {
        self.levels[0].fill(first, self.nx, shares, rows);
    }

    /// F in all rows of the grid.
    pub(crate) fn fill_all(&self, shares: Shares<'_>, values: &mut [f32]) {
        self.levels[0].fill_all(self.nx, shares, values);
    }

    /// Fᵀ: from values of u to the values that each active element gets.
    pub(crate) fn gather(&mut self, shares: Shares<'_>, values: &mut [f32]) {
        self.levels[0].collect(self.nx, shares, values);
        for k in 1..self.levels.len() {
            let (finer, coarser) = self.levels.split_at_mut(k);
            let Level { nx, parts, values, .. } = &finer[k - 1];
            coarser[0].collect(*nx, parts.shares(), values);
        }
        for k in (0..self.levels.len()).rev() {
            let (finer, coarser) = self.levels.split_at_mut(k + 1);
            let Level { nx, parts, values, .. } = &mut finer[k];
            match coarser.first() {
                Some(coarser) => coarser.hand_down(*nx, parts.shares(), values),
                None => values[0] *= self.top,
            }
        }
        self.levels[0].hand_down(self.nx, shares, values);
    }

    /// Computes the means on all grids of squares.
    fn take_means<T: Copy + Sync>(&mut self, values: &[T], part: impl Fn(T) -> f32 + Sync) {
        self.levels[0].take_means(self.nx, values, part);
        for k in 1..self.levels.len() {
            let (finer, coarser) = self.levels.split_at_mut(k);
            coarser[0].take_means(finer[k - 1].nx, &finer[k - 1].values, |mean| mean);
        }
    }
}

/// Calls `work` with the index of each row of `nx` values, and the row.
fn for_each_row(values: &mut [f32], nx: usize, work: impl Fn(usize, &mut [f32]) + Sync) {
    let n_rows = TASK.div_ceil(nx);
    parallel::for_each(values.chunks_mut(nx * n_rows).enumerate(), |(i, rows)| {
        for (iy, row) in rows.chunks_mut(nx).enumerate() {
            work(i * n_rows + iy, row);
        }
    });
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;
    use rc_core::testing::quasi_random;

    use super::*;

    /// F of `values` on the active elements.
    fn extended(extension: &mut Extension, active: &[bool], values: &[f32]) -> Vec<f32> {
        let mut values = values.to_vec();
        extension.extend(&values);
        extension.fill(0, Shares::Active(active), &mut values);
        values
    }

    fn product(a: &[f32], b: &[f32]) -> f64 {
        a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
    }

    #[test]
    fn it_keeps_constants_and_has_its_transpose_on_any_grid() {
        for (nx, ny) in [(64, 64), (61, 7), (1, 64), (61, 1), (256, 1), (33, 90), (2, 2), (1, 1)] {
            let grid = Grid::new(nx, ny).expect("a grid");
            for threshold in [0.0, 0.3, 0.9] {
                let active: Vec<bool> = (0..grid.len()).map(|i| i == 0 || quasi_random(i) > threshold).collect();
                let mut extension = Extension::new([nx, ny]);
                extension.set_active(&active, |active| f32::from(u8::from(active)));
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
                extension.gather(Shares::Active(&active), &mut gathered);
                let (there, back) = (product(&u, &y), product(&r, &gathered));
                let size = product(&u, &u).sqrt() * product(&y, &y).sqrt();
                assert!((there - back).abs() < 1e-5 * size, "{grid}, {threshold}: {there} and {back}");
            }
        }
    }
}
