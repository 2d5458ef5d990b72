//! From the gap of heavy contact on one grid to that on the next finer one.
//!
//! Inside a pool, the gap is smooth and is interpolated by cubics. At the distance s from an edge of contact, the gap is
//! proportional to s^{3/2} and the pressure to s^{1/2} (see [`crate::grid::prolongation`]). The power 2/3 of the gap,
//! continued into contact, is linear across the edge, and is interpolated linearly.

use rc_core::Grid;

use crate::parallel;

/// Weights of the coarse values before, at, behind and beyond a fine centre, which is a quarter of an element away.
const CUBIC: [f32; 4] = [-7.0 / 128.0, 105.0 / 128.0, 35.0 / 128.0, -5.0 / 128.0];

/// Typical distance of the centres on either side of an edge, in elements.
const EDGE_DISTANCE: f32 = 0.7;

/// Largest distance from an edge that matters, in elements.
const FARTHEST: f32 = 3.0;

/// The gap on a `finer` grid with twice the elements along both axes, from pressure and gap. It is zero in contact.
///
/// Gaps are in units of `unit`.
pub(super) fn prolong_gap([pressure, gap]: [Vec<f32>; 2], unit: f64, [grid, finer]: [Grid; 2]) -> Vec<f32> {
    let pools = CoarsePools::new(gap, &pressure, grid);
    let edges = pools.edges(&pressure, (grid.spacing().x as f32, unit as f32));
    let mut fine = vec![0.0; finer.len()];
    parallel::for_each(fine.chunks_mut(finer.nx()).enumerate(), |(y, row)| pools.prolong_row(&edges, y, row));
    fine
}

/// The gap on a coarse grid.
struct CoarsePools {
    sides: [usize; 2],
    gap: Vec<f32>,
    /// Whether an element or a neighbour in its row has a gap.
    beside: Vec<bool>,
}

impl CoarsePools {
    fn new(mut gap: Vec<f32>, pressure: &[f32], grid: Grid) -> Self {
        let (nx, ny) = (grid.nx(), grid.ny());
        let mut beside = vec![false; nx * ny];
        let rows = gap.chunks_mut(nx).zip(beside.chunks_mut(nx));
        parallel::for_each(rows.zip(pressure.chunks(nx)), |((gap, beside), pressure)| {
            for (x, (p, g)) in pressure.iter().zip(gap).enumerate() {
                if *p <= 0.0 && *g > 0.0 {
                    for x in [(x + nx - 1) % nx, x, (x + 1) % nx] {
                        beside[x] = true;
                    }
                } else {
                    *g = 0.0;
                }
            }
        });
        Self { sides: [nx, ny], gap, beside }
    }

    /// Whether elements of a row or their neighbours have a gap.
    fn near(&self, y: usize) -> Vec<bool> {
        let [nx, ny] = self.sides;
        let [below, here, above] = [y + ny - 1, y, y + 1].map(|y| &self.beside[y % ny * nx..][..nx]);
        here.iter().zip(below).zip(above).map(|((here, below), above)| *here || *below || *above).collect()
    }

    /// The power 2/3 of the gap, continued into contact. Away from edges of contact it is zero.
    fn edges(&self, pressure: &[f32], (side, unit): (f32, f32)) -> Vec<f32> {
        let [nx, ny] = self.sides;
        let mut edges = vec![0.0; nx * ny];
        parallel::for_each(edges.chunks_mut(nx).enumerate(), |(y, row)| {
            for (x, _) in self.near(y).into_iter().enumerate().filter(|(_, near)| *near) {
                let here = self.gap[y * nx + x];
                row[x] = if here > 0.0 {
                    here.cbrt().powi(2)
                } else {
                    let (p, slope) = (pressure[y * nx + x], self.slope([x, y]) / (EDGE_DISTANCE * side));
                    // g^{2/3} = slope · s outside, and p = c √s inside with g = (4c/3) s^{3/2}.
                    let c = 0.75 * unit * slope.powf(1.5);
                    -slope * (p / c).powi(2).min(FARTHEST * side)
                };
            }
        });
        edges
    }

    /// The mean of g^{2/3} over the neighbours of an element that have a gap.
    fn slope(&self, [x, y]: [usize; 2]) -> f32 {
        let [nx, ny] = self.sides;
        let (mut sum, mut count) = (0.0, 0.0);
        for y in [y + ny - 1, y, y + 1] {
            for x in [x + nx - 1, x, x + 1] {
                let gap = self.gap[y % ny * nx + x % nx];
                if gap > 0.0 {
                    sum += gap.cbrt().powi(2);
                    count += 1.0;
                }
            }
        }
        sum / count
    }

    fn prolong_row(&self, edges: &[f32], y: usize, row: &mut [f32]) {
        let [nx, ny] = self.sides;
        let rows = around(y, ny).map(|y| y * nx);
        for (x, _) in self.near(y / 2).into_iter().enumerate().filter(|(_, near)| *near) {
            for x in [2 * x, 2 * x + 1] {
                row[x] = self.value(edges, rows, around(x, nx));
            }
        }
    }

    fn value(&self, edges: &[f32], rows: [usize; 4], columns: [usize; 4]) -> f32 {
        let (mut is_inside, mut cubic) = (true, 0.0);
        for (row, wy) in rows.iter().zip(CUBIC) {
            for (column, wx) in columns.iter().zip(CUBIC) {
                let gap = self.gap[row + column];
                is_inside &= gap > 0.0;
                cubic += wx * wy * gap;
            }
        }
        if is_inside && cubic > 0.0 {
            return cubic;
        }
        let at = |i: usize, j: usize| edges[rows[j] + columns[i]];
        let linear = 0.5625 * at(1, 1) + 0.1875 * (at(2, 1) + at(1, 2)) + 0.0625 * at(2, 2);
        linear.max(0.0).powf(1.5)
    }
}

/// The coarse centres before, at, behind and beyond fine centre `i`, from the side that the nearest one is on.
fn around(i: usize, n: usize) -> [usize; 4] {
    let (nearest, step) = (i / 2, if i.is_multiple_of(2) { n - 1 } else { 1 });
    [(nearest + n - step) % n, nearest, (nearest + step) % n, (nearest + 2 * step) % n]
}
