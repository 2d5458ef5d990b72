//! Weighted sums along rows and columns.

use rc_core::{Field, Grid};

/// What lies beyond the borders of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// The mirror image of the map.
    Mirrored,
    /// The map itself again.
    Periodic,
}

impl Edges {
    /// The point of `n` points that represents point `i`, which may be outside.
    pub(super) fn inside(self, i: i64, n: usize) -> usize {
        let (n, wide) = (n as i64, n as i64 * 2);
        match self {
            Self::Periodic => i.rem_euclid(n) as usize,
            Self::Mirrored => {
                let i = i.rem_euclid(wide);
                i.min(wide - 1 - i) as usize
            }
        }
    }
}

/// Weights of consecutive points.
pub(super) struct Taps<'a> {
    /// The first point. It may be outside.
    pub(super) first: i64,
    /// Weights of the first point and the following ones.
    pub(super) weights: &'a [f64],
}

/// A field of `nx` points along x. Point `i` is the sum with `taps(i)` over its row.
pub(super) fn along_x<'a>(field: &Field, nx: usize, edges: Edges, taps: impl Fn(usize) -> Taps<'a>) -> Field {
    let grid = field.grid();
    let wanted = Grid::new(nx, grid.ny()).expect("a checked number of points");
    let mut values = Vec::with_capacity(wanted.len());
    for iy in 0..grid.ny() {
        let row = field.row(iy);
        for ix in 0..nx {
            let Taps { first, weights } = taps(ix);
            let whole = usize::try_from(first).ok().and_then(|from| row.get(from..from + weights.len()));
            values.push(match whole {
                Some(part) => part.iter().zip(weights).map(|(value, weight)| value * weight).sum(),
                None => (first..).zip(weights).map(|(i, weight)| row[edges.inside(i, row.len())] * weight).sum::<f64>(),
            });
        }
    }
    Field::new(wanted, values).expect("as many values as points")
}

/// The sums with the same `weights` about each point of a row. Their number is odd.
///
/// The sums are those of [`along_x`] bit for bit. All points of a row are summed together, which is several times
/// faster for many weights.
pub(super) fn about_x(field: &Field, weights: &[f64], edges: Edges) -> Field {
    let (grid, reach) = (field.grid(), (weights.len() / 2) as i64);
    let mut sums = Field::zeros(grid);
    for (iy, sum) in sums.values_mut().chunks_exact_mut(grid.nx()).enumerate() {
        let row = field.row(iy);
        let around: Vec<f64> = (-reach..grid.nx() as i64 + reach).map(|i| row[edges.inside(i, row.len())]).collect();
        for (part, weight) in around.windows(grid.nx()).zip(weights) {
            sum.iter_mut().zip(part).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    sums
}

/// A field of `ny` points along y. Point `i` is the sum with `taps(i)` over its column.
pub(super) fn along_y<'a>(field: &Field, ny: usize, edges: Edges, taps: impl Fn(usize) -> Taps<'a>) -> Field {
    let grid = field.grid();
    let wanted = Grid::new(grid.nx(), ny).expect("a checked number of points");
    let mut sums = Field::zeros(wanted);
    for (iy, sum) in sums.values_mut().chunks_exact_mut(grid.nx()).enumerate() {
        let Taps { first, weights } = taps(iy);
        for (i, weight) in (first..).zip(weights) {
            let row = field.row(edges.inside(i, grid.ny()));
            sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
        }
    }
    sums
}
