//! Transfer between the finest level and an uneven level below it.
//!
//! The coarser level does not have half as many elements along a side. Each element has its own taps along each axis.

use std::ops::Range;

use pulp::Simd;
use rc_kernel::UnevenFilter;
use rc_quadtree::{CELLS, Patch, TILE};

use crate::tiles::operator::real::{Arithmetic, add_product};

/// The taps of all elements along one axis, both ways.
#[derive(Clone, Debug)]
pub(crate) struct Axis<T> {
    /// Taps of each fine element: the coarse elements that it takes from.
    prolong: Lines<T>,
    /// Taps of each coarse element: the fine elements that it takes from.
    restrict: Lines<T>,
}

/// The taps of the elements of one side.
///
/// They are for neighbours from a first one on, which is counted periodically.
#[derive(Clone, Debug)]
struct Lines<T> {
    n_taps: usize,
    first: Vec<i64>,
    taps: Vec<T>,
}

impl<T: Arithmetic> Lines<T> {
    fn taps(&self, element: usize) -> &[T] {
        &self.taps[element * self.n_taps..][..self.n_taps]
    }

    /// The indices of the elements of a tile along the axis.
    ///
    /// The last tile may have fewer elements.
    fn of_tile(&self, tile: u32) -> Range<usize> {
        let first = tile as usize * TILE;
        first..(first + TILE).min(self.first.len())
    }

    /// The first tile that a tile takes from, and the places from its corner on.
    fn under(&self, tile: u32) -> (i64, Range<usize>) {
        let elements = self.of_tile(tile);
        let corner = self.first[elements.start].div_euclid(TILE as i64);
        let place = |element: usize| (self.first[element] - corner * TILE as i64) as usize;
        (corner, place(elements.start)..place(elements.end - 1) + self.n_taps)
    }
}

impl<T: Arithmetic> Axis<T> {
    /// The taps between `fine` and `coarse` elements on a side.
    pub(crate) fn new(filter: &UnevenFilter, fine: usize, coarse: usize) -> Self {
        let ratio = coarse as f64 / fine as f64;
        let of_fine: Vec<(i64, Vec<f64>)> = (0..fine)
            .map(|i| {
                let place = (i as f64 + 0.5) * ratio - 0.5;
                let taps = filter.taps(place - place.floor());
                (place.floor() as i64 + 1 - taps.len() as i64 / 2, taps)
            })
            .collect();
        let n_taps = of_fine[0].1.len();
        // Where sides are halved, this is a quarter of the transpose in two dimensions. A constant stays the same.
        let (mut first, mut rows) = (Vec::with_capacity(coarse), Vec::with_capacity(coarse));
        for c in 0..coarse as i64 {
            let mut row = Vec::with_capacity(2 * n_taps + 2);
            // The range is more than large enough on either side.
            let least = ((c as f64 - n_taps as f64) / ratio).floor() as i64;
            let most = ((c as f64 + n_taps as f64) / ratio).ceil() as i64;
            let mut start = None;
            for i in least..=most {
                let (turns, inside) = (i.div_euclid(fine as i64), i.rem_euclid(fine as i64) as usize);
                let (begins, taps) = &of_fine[inside];
                let tap = usize::try_from(c - begins - turns * coarse as i64).ok().and_then(|at| taps.get(at));
                if let Some(tap) = tap {
                    start.get_or_insert(i);
                    row.push(ratio * tap);
                }
            }
            first.push(start.unwrap_or(least));
            rows.push(row);
        }
        let longest = rows.iter().map(Vec::len).max().unwrap_or(0);
        let taps = rows.into_iter().flat_map(|row| row.into_iter().chain(std::iter::repeat(0.0)).take(longest));
        let taps = taps.map(T::rounded).collect();
        Self {
            restrict: Lines { n_taps: longest, first, taps },
            prolong: Lines {
                n_taps,
                first: of_fine.iter().map(|(first, _)| *first).collect(),
                taps: of_fine.iter().flat_map(|(_, taps)| taps.iter().map(|&tap| T::rounded(tap))).collect(),
            },
        }
    }
}

/// The taps along both axes.
#[derive(Clone, Debug)]
pub(crate) struct Uneven<T> {
    axes: [Axis<T>; 2],
}

/// The source of one tile.
///
/// It has the corner of its patch, in tiles, and the rows of the patch that matter.
pub(crate) struct Under {
    pub(crate) corner: (i64, i64),
    pub(crate) rows: Range<usize>,
    columns: Range<usize>,
}

impl<T: Arithmetic> Uneven<T> {
    /// The taps between grids of `fine` and `coarse` elements, with a filter for each axis.
    pub(crate) fn new(filters: &[UnevenFilter; 2], fine: [usize; 2], coarse: [usize; 2]) -> Self {
        Self { axes: [0, 1].map(|axis| Axis::new(&filters[axis], fine[axis], coarse[axis])) }
    }

    /// The source of a fine tile.
    pub(crate) fn to_prolong(&self, place: [u32; 2]) -> Under {
        Self::under([&self.axes[0].prolong, &self.axes[1].prolong], place)
    }

    /// The source of a coarse tile.
    pub(crate) fn to_restrict(&self, place: [u32; 2]) -> Under {
        Self::under([&self.axes[0].restrict, &self.axes[1].restrict], place)
    }

    fn under([x, y]: [&Lines<T>; 2], [column, row]: [u32; 2]) -> Under {
        let ((left, columns), (below, rows)) = (x.under(column), y.under(row));
        Under { corner: (left, below), rows, columns }
    }

    /// Computes a fine tile from the coarse patch `under` it.
    #[inline(always)]
    pub(crate) fn prolong<S: Simd, const SIDE: usize>(
        &self,
        place: [u32; 2],
        (under, patch): (&Under, &Patch<T, SIDE>),
        out: &mut [T; CELLS],
    ) {
        let lines = [&self.axes[0].prolong, &self.axes[1].prolong];
        apply::<S, T, SIDE>(lines, place, (under, patch), out);
    }

    /// Computes a coarse tile from the fine patch `under` it.
    #[inline(always)]
    pub(crate) fn restrict<S: Simd, const SIDE: usize>(
        &self,
        place: [u32; 2],
        (under, patch): (&Under, &Patch<T, SIDE>),
        out: &mut [T; CELLS],
    ) {
        let lines = [&self.axes[0].restrict, &self.axes[1].restrict];
        apply::<S, T, SIDE>(lines, place, (under, patch), out);
    }
}

/// Sums along y and then along x. Values beyond the level are zero.
#[inline(always)]
fn apply<S: Simd, T: Arithmetic, const SIDE: usize>(
    [along_x, along_y]: [&Lines<T>; 2],
    [column, row]: [u32; 2],
    (under, patch): (&Under, &Patch<T, SIDE>),
    out: &mut [T; CELLS],
) {
    // Eight rows lie side by side, so that sums along x take whole vectors too.
    let mut lines = [[T::default(); TILE]; SIDE];
    let corner = under.corner.1 * TILE as i64;
    for (y, element) in along_y.of_tile(row).enumerate() {
        let first = (along_y.first[element] - corner) as usize;
        let taps = along_y.taps(element);
        let mut chunk = under.columns.start / TILE * TILE;
        while chunk < under.columns.end {
            let mut sums = [T::default(); TILE];
            for (row, &tap) in patch[first..first + taps.len()].iter().zip(taps) {
                let row = &row[chunk..][..TILE];
                for x in 0..TILE {
                    sums[x] = add_product::<S, T>(sums[x], tap, row[x]);
                }
            }
            for (x, sum) in sums.into_iter().enumerate() {
                lines[chunk + x][y] = sum;
            }
            chunk += TILE;
        }
    }
    *out = [T::default(); CELLS];
    let corner = under.corner.0 * TILE as i64;
    for (x, element) in along_x.of_tile(column).enumerate() {
        let first = (along_x.first[element] - corner) as usize;
        let taps = along_x.taps(element);
        let mut sums = [T::default(); TILE];
        for (line, &tap) in lines[first..first + taps.len()].iter().zip(taps) {
            for y in 0..TILE {
                sums[y] = add_product::<S, T>(sums[y], tap, line[y]);
            }
        }
        for (y, sum) in sums.into_iter().enumerate() {
            out[y * TILE + x] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_kernel::{ScaleSplit, SplitParams};

    use super::*;

    /// The two directions along one axis are transposes of each other, up to the ratio. Both keep a constant.
    #[test]
    fn restriction_is_the_transpose_of_prolongation() {
        for (fine, coarse) in [(1001, 512), (43, 24), (100, 56), (64, 32)] {
            let ratio = coarse as f64 / fine as f64;
            let filter = ScaleSplit::new(SplitParams::certified()).uneven_filter(ratio);
            let axis = Axis::<f64>::new(&filter, fine, coarse);
            let dense = |lines: &Lines<f64>, n: usize| {
                let mut matrix = vec![vec![0.0; n]; lines.first.len()];
                for (element, row) in matrix.iter_mut().enumerate() {
                    for (i, tap) in (lines.first[element]..).zip(lines.taps(element)) {
                        row[i.rem_euclid(n as i64) as usize] += tap;
                    }
                }
                matrix
            };
            let (down, up) = (dense(&axis.prolong, coarse), dense(&axis.restrict, fine));
            for (c, row) in up.iter().enumerate() {
                for (i, tap) in row.iter().enumerate() {
                    assert!((tap - ratio * down[i][c]).abs() < 1e-12, "{fine} and {coarse}: ({i}, {c})");
                }
            }
            // A constant stays the same, except for short waves, which the remainder does not pass.
            let sums: Vec<f64> = up.iter().map(|row| row.iter().sum()).collect();
            for k in 0..=coarse / 8 {
                let angle = |c: usize| TAU * (k * c) as f64 / coarse as f64;
                let part = |of: fn(f64) -> f64| -> f64 {
                    sums.iter().enumerate().map(|(c, sum)| (sum - 1.0) * of(angle(c))).sum::<f64>() / coarse as f64
                };
                let wave = part(f64::cos).hypot(part(f64::sin));
                assert!(wave < 1e-5, "{fine} and {coarse}: {k} waves of {wave:e}");
            }
        }
    }
}
