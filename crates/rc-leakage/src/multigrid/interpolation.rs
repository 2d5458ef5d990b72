//! Interpolation from a coarser level, with weights from the bonds of the finer one.
//!
//! Source: black box multigrid, Dendy, J. Comput. Phys. 48, 1982.

use super::stencil::Stencil;
use crate::parallel;
use crate::real::Real;

/// A row of weights of the elements after coarse ones, along x and along y.
type EdgeRows<'a, T> = (usize, (&'a mut [[T; 2]], &'a mut [[T; 2]]));

/// Weights of an interpolation.
///
/// Along a coarsened axis, every second element belongs to the coarser level. The weights are for the elements between.
#[derive(Debug)]
pub(super) struct Interpolation<T> {
    /// Numbers of elements of the finer level.
    pub(super) fine: [usize; 2],
    /// Numbers of elements of the coarser level.
    pub(super) coarse: [usize; 2],
    /// 2 along a coarsened axis, else 1.
    pub(super) factor: [usize; 2],
    /// Weights of the element after a coarse one along x.
    ///
    /// They are those of the coarse one and of the next.
    along_x: Vec<[T; 2]>,
    /// Weights of the element after a coarse one along y.
    ///
    /// They are those of the coarse one and of the next.
    along_y: Vec<[T; 2]>,
    /// Weights of the element after a coarse one along both axes.
    ///
    /// They are those of the coarse one, the next along x, the next along y, and the next along both.
    centre: Vec<[T; 4]>,
}

/// Weights of an element between two coarse ones, from its bonds to both sides.
///
/// An element without bonds to either gets the weight of a side that is a wall. So every element with a flow has a
/// coarse one.
fn weights<T: Real>(towards: [T; 2], is_wall: [bool; 2]) -> [T; 2] {
    let [first, second] = towards.map(|bond| if bond > T::ZERO { bond } else { T::ZERO });
    let total = first + second;
    if total > T::TINY {
        return truncated([first / total, second / total]);
    }
    match is_wall {
        [true, _] => [T::ONE, T::ZERO],
        [false, true] => [T::ZERO, T::ONE],
        [false, false] => [T::of(0.5); 2],
    }
}

/// Limit below which a weight becomes zero.
///
/// The coarser network of smaller weights would consist of their rounding.
const SMALLEST: f64 = 1e-3;

/// The weights without those that are too small, with the sum 1.
fn truncated<T: Real, const N: usize>(weights: [T; N]) -> [T; N] {
    let kept = weights.map(|weight| if weight.abs() < T::of(SMALLEST) { T::ZERO } else { weight });
    let total: T = kept.into_iter().sum();
    kept.map(|weight| weight / total)
}

impl<T: Real> Interpolation<T> {
    /// The interpolation for the elements of `fine`, coarsened by `factor` along x and y.
    pub(super) fn new(fine: &Stencil<T>, factor: [usize; 2]) -> Self {
        let sides = [fine.nx, fine.ny];
        let coarse = [0, 1].map(|axis| sides[axis].div_ceil(factor[axis]));
        let n = coarse[0] * coarse[1];
        let mut this = Self {
            fine: sides,
            coarse,
            factor,
            along_x: vec![[T::ZERO; 2]; n],
            along_y: vec![[T::ZERO; 2]; n],
            centre: vec![[T::ZERO; 4]; n],
        };
        let mut edges = (std::mem::take(&mut this.along_x), std::mem::take(&mut this.along_y));
        let rows = edges.0.chunks_mut(coarse[0]).zip(edges.1.chunks_mut(coarse[0])).enumerate().collect();
        parallel::for_each(rows, |(row, (along_x, along_y)): EdgeRows<'_, T>| {
            for column in 0..coarse[0] {
                (along_x[column], along_y[column]) = this.edge_weights(fine, [column, row]);
            }
        });
        (this.along_x, this.along_y) = edges;
        let mut centre = std::mem::take(&mut this.centre);
        let rows = centre.chunks_mut(coarse[0]).enumerate().collect();
        parallel::for_each(rows, |(row, centre): (usize, &mut [[T; 4]])| {
            for (column, weights) in centre.iter_mut().enumerate() {
                *weights = this.centre_weights(fine, [column, row]);
            }
        });
        this.centre = centre;
        this
    }

    /// Elements from coarse element `at` to the next along x and y.
    ///
    /// There are 2, or 1 if no element is between.
    pub(super) fn widths(&self, at: [usize; 2]) -> [usize; 2] {
        [0, 1].map(|axis| if self.factor[axis] * at[axis] + 1 < self.fine[axis] { self.factor[axis] } else { 1 })
    }

    pub(super) fn index(&self, at: [usize; 2]) -> usize {
        (at[1] % self.coarse[1]) * self.coarse[0] + at[0] % self.coarse[0]
    }

    fn edge_weights(&self, fine: &Stencil<T>, at: [usize; 2]) -> ([T; 2], [T; 2]) {
        let bonds = Bonds(fine);
        let [x, y] = [self.factor[0] * at[0], self.factor[1] * at[1]];
        let widths = self.widths(at);
        let (mut along_x, mut along_y) = ([T::ZERO; 2], [T::ZERO; 2]);
        let is_wall = |x: usize, y: usize| fine.inverse[bonds.index(x, y)] == T::ZERO;
        if widths[0] == 2 && !is_wall(x + 1, y) {
            // Bonds are summed along the other axis.
            let sum = |x: usize, rising: usize, falling: usize| {
                bonds.east(x, y) + bonds.rising(x, rising) + bonds.falling(x, falling)
            };
            let below = y + fine.ny - 1;
            along_x = weights([sum(x, below, y), sum(x + 1, y, below)], [is_wall(x, y), is_wall(x + 2, y)]);
        }
        if widths[1] == 2 && !is_wall(x, y + 1) {
            let before = x + fine.nx - 1;
            let sum = |y: usize, rising: usize, falling: usize| {
                bonds.north(x, y) + bonds.rising(rising, y) + bonds.falling(falling, y)
            };
            along_y = weights([sum(y, before, x), sum(y + 1, x, before)], [is_wall(x, y), is_wall(x, y + 2)]);
        }
        (along_x, along_y)
    }

    fn centre_weights(&self, fine: &Stencil<T>, at: [usize; 2]) -> [T; 4] {
        let bonds = Bonds(fine);
        let [x, y] = [self.factor[0] * at[0] + 1, self.factor[1] * at[1] + 1];
        if self.widths(at) != [2, 2] || fine.inverse[bonds.index(x, y)] == T::ZERO {
            return [T::ZERO; 4];
        }
        let [west, east] = [at, [at[0] + 1, at[1]]].map(|at| self.along_y[self.index(at)]);
        let [south, north] = [at, [at[0], at[1] + 1]].map(|at| self.along_x[self.index(at)]);
        let faces = [bonds.east(x - 1, y), bonds.east(x, y), bonds.north(x, y - 1), bonds.north(x, y)];
        let corners =
            [bonds.rising(x - 1, y - 1), bonds.falling(x, y - 1), bonds.falling(x - 1, y), bonds.rising(x, y)];
        let [w, e, s, n] = faces;
        let sums = [
            corners[0] + w * west[0] + s * south[0],
            corners[1] + e * east[0] + s * south[1],
            corners[2] + w * west[1] + n * north[0],
            corners[3] + e * east[1] + n * north[1],
        ];
        let total: T = sums.into_iter().sum();
        if total > T::TINY { truncated(sums.map(|sum| sum / total)) } else { [T::of(0.25); 4] }
    }

    /// Weights of the fine element `offset` after coarse element `at`.
    ///
    /// They are of the coarse element, the next along x, the next along y, and the next along both.
    pub(super) fn corner_weights(&self, at: [usize; 2], offset: [usize; 2]) -> [T; 4] {
        let widths = self.widths(at);
        let ends = [0, 1].map(|axis| offset[axis] == widths[axis]);
        let between = [0, 1].map(|axis| offset[axis] > 0 && !ends[axis]);
        let next = [at[0] + usize::from(ends[0]), at[1] + usize::from(ends[1])];
        let corner = usize::from(ends[0]) + 2 * usize::from(ends[1]);
        let mut out = [T::ZERO; 4];
        match between {
            [true, true] => return self.centre[self.index(at)],
            [true, false] => {
                let [first, second] = self.along_x[self.index(next)];
                (out[corner], out[corner + 1]) = (first, second);
            }
            [false, true] => {
                let [first, second] = self.along_y[self.index(next)];
                (out[corner], out[corner + 2]) = (first, second);
            }
            [false, false] => out[corner] = T::ONE,
        }
        out
    }

    /// Adds the interpolation of `coarse` to `fine`.
    pub(super) fn prolong(&self, coarse: &[T], fine: &mut [T]) {
        let nx = self.fine[0];
        let rows = fine.chunks_mut(nx).enumerate().collect();
        parallel::for_each(rows, |(iy, fine): (usize, &mut [T])| {
            let (row, is_between) = (iy / self.factor[1], iy % self.factor[1] == 1);
            let [here, above] = [row, row + 1].map(|row| &coarse[self.index([0, row])..][..self.coarse[0]]);
            let first = self.index([0, row]);
            for column in 0..self.coarse[0] {
                let at = first + column;
                let next = if column + 1 < self.coarse[0] { column + 1 } else { 0 };
                let x = self.factor[0] * column;
                let has_next = self.factor[0] == 2 && x + 1 < nx;
                if is_between {
                    let [first, second] = self.along_y[at];
                    fine[x] += first * here[column] + second * above[column];
                    if has_next {
                        let [a, b, c, d] = self.centre[at];
                        fine[x + 1] += a * here[column] + b * here[next] + c * above[column] + d * above[next];
                    }
                } else {
                    fine[x] += here[column];
                    if has_next {
                        let [first, second] = self.along_x[at];
                        fine[x + 1] += first * here[column] + second * here[next];
                    }
                }
            }
        });
    }

    /// The pressure between those of the coarser elements, `half`.
    ///
    /// Both are without a mean fall: `fall` per element, and twice as much in the unit of `half`. The weights are
    /// those of pressures with this fall.
    pub(super) fn pressure_between(&self, half: &[f64], [fall_x, fall_y]: [f64; 2]) -> Vec<f64> {
        let [nx, ny] = self.fine;
        let [columns, rows] = self.coarse;
        let mut pressure = vec![0.0; nx * ny];
        let fine = pressure.chunks_mut(nx).enumerate().collect();
        parallel::for_each(fine, |(iy, fine): (usize, &mut [f64])| {
            let (first, above) = (iy / 2 * columns, (iy / 2 + 1) % rows * columns);
            for (column, fine) in fine.chunks_mut(2).enumerate() {
                let (at, next) = (first + column, (column + 1) % columns);
                let corners = [at, first + next, above + column, above + next].map(|at| 2.0 * half[at]);
                for (x, fine) in fine.iter_mut().enumerate() {
                    let weights = match [x, iy % 2] {
                        [0, 0] => [1.0, 0.0, 0.0, 0.0],
                        [_, 0] => {
                            let [first, second] = self.along_x[at].map(T::to_f64);
                            [first, second, 0.0, 0.0]
                        }
                        [0, _] => {
                            let [first, second] = self.along_y[at].map(T::to_f64);
                            [first, 0.0, second, 0.0]
                        }
                        _ => self.centre[at].map(T::to_f64),
                    };
                    let mean: f64 = weights.iter().zip(corners).map(|(weight, corner)| weight * corner).sum();
                    let [a, b, c, d] = weights;
                    let (along_x, along_y) = (x as f64 * fall_x, (iy % 2) as f64 * fall_y);
                    *fine = mean + along_x * (a + c - b - d) + along_y * (a + b - c - d);
                }
            }
        });
        pressure
    }

    /// Writes the restriction of the fine residual, by the adjoint of the interpolation, into `coarse`.
    ///
    /// `residual` writes a row of the fine residual.
    pub(super) fn restrict(&self, residual: &(dyn Fn(usize, &mut [T]) + Sync), coarse: &mut [T]) {
        let (nc, rows_per_block) = (self.coarse[0], (parallel::rows_per_block(self.fine[0]) / 2).max(4));
        let blocks = coarse.chunks_mut(rows_per_block * nc).enumerate().collect();
        parallel::for_each(blocks, |(block, coarse): (usize, &mut [T])| {
            let mut rows = [(); 3].map(|()| vec![T::ZERO; self.fine[0]]);
            let first = block * rows_per_block;
            let before = (first + self.coarse[1] - 1) % self.coarse[1];
            let mut has_below = self.between(before).is_some_and(|iy| {
                residual(iy, &mut rows[0]);
                true
            });
            for (row, out) in coarse.chunks_mut(nc).enumerate() {
                let row = first + row;
                residual(self.factor[1] * row, &mut rows[1]);
                let between = self.between(row);
                if let Some(iy) = between {
                    residual(iy, &mut rows[2]);
                }
                let [below, here, above] = &rows;
                let below = has_below.then_some(&below[..]);
                self.restrict_row(row, [below, Some(here), between.map(|_| &above[..])], out);
                rows.swap(0, 2);
                has_below = between.is_some();
            }
        });
    }

    /// The fine row between the coarse row `row` and the next.
    fn between(&self, row: usize) -> Option<usize> {
        (self.widths([0, row])[1] == 2).then(|| self.factor[1] * row + 1)
    }

    /// Restricts the fine rows below, at and above coarse row `row`.
    fn restrict_row(&self, row: usize, [below, here, above]: [Option<&[T]>; 3], out: &mut [T]) {
        let (nx, nc) = (self.fine[0], self.coarse[0]);
        let before_row = (row + self.coarse[1] - 1) % self.coarse[1];
        let of_row = |row: usize| row * nc..(row + 1) * nc;
        let along_x = &self.along_x[of_row(row)];
        let [along_y, along_y_below] = [row, before_row].map(|row| &self.along_y[of_row(row)]);
        let [centre, centre_below] = [row, before_row].map(|row| &self.centre[of_row(row)]);
        for (column, out) in out.iter_mut().enumerate() {
            let before = if column == 0 { nc - 1 } else { column - 1 };
            let x = self.factor[0] * column;
            // If no element is between, its weights are zero.
            let between = |column: usize| (self.factor[0] * column + 1).min(nx - 1);
            let (after, earlier) = (between(column), between(before));
            let mut sum = T::ZERO;
            if let Some(here) = here {
                sum += here[x] + along_x[column][0] * here[after] + along_x[before][1] * here[earlier];
            }
            if let Some(above) = above {
                sum += along_y[column][0] * above[x];
                sum += centre[column][0] * above[after] + centre[before][1] * above[earlier];
            }
            if let Some(below) = below {
                sum += along_y_below[column][1] * below[x];
                sum += centre_below[column][2] * below[after] + centre_below[before][3] * below[earlier];
            }
            *out = sum;
        }
    }
}

/// Bonds by the place of their elements, on the periodic grid.
pub(super) struct Bonds<'a, T>(pub(super) &'a Stencil<T>);

impl<T: Real> Bonds<'_, T> {
    pub(super) fn index(&self, x: usize, y: usize) -> usize {
        let wrap = |i: usize, n: usize| if i < n { i } else { i % n };
        wrap(y, self.0.ny) * self.0.nx + wrap(x, self.0.nx)
    }

    pub(super) fn east(&self, x: usize, y: usize) -> T {
        self.0.east[self.index(x, y)]
    }

    pub(super) fn north(&self, x: usize, y: usize) -> T {
        self.0.north[self.index(x, y)]
    }

    pub(super) fn rising(&self, x: usize, y: usize) -> T {
        self.0.corners.as_ref().map_or(T::ZERO, |corners| corners.rising[self.index(x, y)])
    }

    pub(super) fn falling(&self, x: usize, y: usize) -> T {
        self.0.corners.as_ref().map_or(T::ZERO, |corners| corners.falling[self.index(x, y)])
    }
}

#[cfg(test)]
mod tests {
    use rc_core::{Field, Grid};

    use super::super::finest;
    use super::*;
    use crate::network::{Axis, Network};

    /// A channel along x, with a step in its gap.
    ///
    /// The pressure is exact, because a flux is the same in all elements.
    #[test]
    fn the_pressure_between_every_second_element_is_exact_in_a_channel() {
        let n = 16;
        let grid = Grid::square(n).expect("a grid");
        let gap = Field::new(grid, (0..n * n).map(|i| if i % n < n / 2 { 1.0 } else { 2.0 }).collect());
        let network = Network::new(&gap.expect("a field"), 2.0, &|_, open: &mut [bool]| open.fill(true));
        // Pressure that falls by 8/9 and 1/9 of the total, between the centres of elements.
        let resistance = |i: usize| if i % n < n / 2 { 8.0 } else { 1.0 };
        let total: f64 = (0..n).map(resistance).sum();
        let mut pressure = vec![0.0; n];
        for i in 1..n {
            let fall = n as f64 * 0.5 * (resistance(i - 1) + resistance(i)) / total;
            pressure[i] = pressure[i - 1] - fall + 1.0;
        }
        let interpolation = Interpolation::new(&finest::<f64>(&network), [2, 2]);
        let half: Vec<f64> = (0..n * n / 4).map(|i| 0.5 * pressure[2 * (i % (n / 2))]).collect();
        let found = interpolation.pressure_between(&half, Axis::X.unit());
        let off = found.iter().enumerate().map(|(i, p)| (p - pressure[i % n]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{off:e}");
    }
}
