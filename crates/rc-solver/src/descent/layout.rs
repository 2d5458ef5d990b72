//! The blocks of the vectors of a mesh, the places of their elements, and sums.

use std::ops::Range;
use std::sync::Arc;

use rc_comm::Ranks;

use crate::parallel;

/// Blocks of `len` values. The last may be shorter.
///
/// All elements of a block have one size. Over ranks, the blocks are those of this rank. They follow the blocks of the
/// ranks before it.
#[derive(Clone, Debug)]
pub(crate) struct BlockLayout {
    len: usize,
    /// Ends of blocks that are shorter. `None` if only the last one is.
    ends: Option<Arc<[usize]>>,
    /// Area of an element of each block, in units of the smallest. Empty when all have that size.
    areas: Arc<[f64]>,
    places: Places,
    ranks: Ranks,
}

/// The places of elements.
#[derive(Clone, Debug)]
enum Places {
    /// Unknown places.
    Anywhere,
    /// Rows of a grid with these numbers of elements along both axes.
    Rows([usize; 2]),
    /// Runs of `run` elements, each around its own centre.
    ///
    /// The cell has room for `sides` of the largest elements along both axes.
    Runs { run: usize, centres: Arc<[[f32; 2]]>, sides: [usize; 2] },
}

/// Number of elements of a row that count as one place.
const RUN: usize = 8;

impl BlockLayout {
    /// Blocks of elements of one size in unknown places.
    pub(crate) fn of(len: usize) -> Self {
        Self { len, ends: None, areas: Arc::default(), places: Places::Anywhere, ranks: Ranks::alone() }
    }

    /// Blocks of whole rows of a grid of `nx` × `ny` elements.
    pub(crate) fn of_rows(n_rows: usize, [nx, ny]: [usize; 2]) -> Self {
        Self { places: Places::Rows([nx, ny]), ..Self::of(n_rows * nx) }
    }

    /// Adds the area of an element of each block. All have one size if `areas` is empty.
    pub(crate) fn with_areas(self, areas: Vec<f64>) -> Self {
        Self { areas: areas.into(), ..self }
    }

    /// Adds the centres of runs of `run` elements, in parts of the cell.
    ///
    /// The cell has room for `sides` of the largest elements along both axes. Places behind the last element of a level
    /// have no element, but a centre.
    pub(crate) fn with_runs(self, run: usize, centres: Vec<[f32; 2]>, sides: [usize; 2]) -> Self {
        debug_assert!(self.len.is_multiple_of(run), "blocks of whole runs");
        Self { places: Places::Runs { run, centres: centres.into(), sides }, ..self }
    }

    /// Ends blocks earlier: at these indices of values, if there are any.
    pub(crate) fn with_ends(self, ends: Option<Arc<[usize]>>) -> Self {
        Self { ends, ..self }
    }

    /// Deals the blocks among these ranks.
    pub(crate) fn over(self, ranks: &Ranks) -> Self {
        Self { ranks: ranks.clone(), ..self }
    }

    /// The ranks that blocks are dealt among.
    pub(crate) fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// Number of the largest elements along both axes of the cell.
    ///
    /// It is 1 if places are unknown.
    pub(crate) fn sides(&self) -> [usize; 2] {
        match self.places {
            Places::Anywhere => [1, 1],
            Places::Rows(sides) | Places::Runs { sides, .. } => sides,
        }
    }

    /// Calls `take` with runs of neighbours among the first `n` elements of block `i`.
    ///
    /// It also gets the centre of each run, in parts of the cell.
    pub(crate) fn for_each_run(&self, i: usize, n: usize, mut take: impl FnMut(Range<usize>, [f64; 2])) {
        match &self.places {
            Places::Anywhere => take(0..n, [0.5, 0.5]),
            &Places::Rows([nx, ny]) => {
                for row in 0..n / nx {
                    let y = ((i * self.len / nx + row) as f64 + 0.5) / ny as f64;
                    for first in (0..nx).step_by(RUN) {
                        let last = (first + RUN).min(nx);
                        take(row * nx + first..row * nx + last, [0.5 * (first + last) as f64 / nx as f64, y]);
                    }
                }
            }
            Places::Runs { run, centres, .. } => {
                let centres = &centres[self.range(i, usize::MAX).start / run..];
                for (first, centre) in (0..n).step_by(*run).zip(centres) {
                    take(first..(first + run).min(n), centre.map(f64::from));
                }
            }
        }
    }

    /// Number of values in a block that is not shorter than the others.
    pub(crate) fn len(&self) -> usize {
        debug_assert!(self.ends.is_none(), "blocks of one length");
        self.len
    }

    /// The range of block `i` of a vector of `n` values.
    pub(crate) fn range(&self, i: usize, n: usize) -> Range<usize> {
        match &self.ends {
            Some(ends) => i.checked_sub(1).map_or(0, |before| ends[before])..ends[i],
            None => i * self.len..n.min((i + 1) * self.len),
        }
    }

    /// The ranges of the blocks of a vector of `n` values.
    pub(crate) fn ranges(&self, n: usize) -> impl Iterator<Item = Range<usize>> {
        let n_blocks = self.ends.as_ref().map_or_else(|| n.div_ceil(self.len), |ends| ends.len());
        (0..n_blocks).map(move |i| self.range(i, n))
    }

    /// The blocks of a vector.
    pub(crate) fn chunks<'v, T>(&self, values: &'v [T]) -> impl Iterator<Item = &'v [T]> {
        self.ranges(values.len()).map(move |range| &values[range])
    }

    /// The blocks of a vector that is changed.
    pub(crate) fn chunks_mut<'v, T>(&self, mut values: &'v mut [T]) -> impl Iterator<Item = &'v mut [T]> {
        self.ranges(values.len()).map(move |range| values.split_off_mut(..range.len()).unwrap_or_default())
    }

    /// Area of an element of block `i`.
    pub(crate) fn area(&self, i: usize) -> f64 {
        self.areas.get(i).copied().unwrap_or(1.0)
    }

    /// Area-weighted sums from the sums of each block, added in the order of blocks.
    pub(crate) fn total<const N: usize>(&self, blocks: Vec<[f64; N]>) -> [f64; N] {
        self.ranks.fold([0.0; N], |mut sum| {
            for (i, block) in blocks.into_iter().enumerate() {
                let area = self.area(i);
                for (sum, value) in sum.iter_mut().zip(block) {
                    *sum += area * value;
                }
            }
            sum
        })
    }

    /// Maximum of a vector, but not less than `at_least`. NaN is passed over.
    pub(crate) fn maximum(&self, values: &[f64], at_least: f64) -> f64 {
        self.ranks.maximum(parallel::maximum(values, at_least), at_least)
    }

    /// Minimum of a vector. NaN is passed over.
    pub(crate) fn minimum(&self, values: &[f64]) -> f64 {
        -self.ranks.maximum(-parallel::minimum(values), f64::NEG_INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_rows_are_around_their_centres() {
        for [nx, ny] in [[1001, 37], [64, 64], [5, 3], [1, 40]] {
            let layout = BlockLayout::of_rows(16, [nx, ny]);
            let mut next = 0;
            for (block, first) in (0..nx * ny).step_by(layout.len()).enumerate() {
                let n = layout.len().min(nx * ny - first);
                layout.for_each_run(block, n, |run, place| {
                    assert_eq!(first + run.start, next, "{nx} x {ny}");
                    let mean = |of: &dyn Fn(usize) -> usize| {
                        run.clone().map(|i| of(first + i) as f64 + 0.5).sum::<f64>() / run.len() as f64
                    };
                    let centre = [mean(&|i| i % nx) / nx as f64, mean(&|i| i / nx) / ny as f64];
                    for (place, centre) in place.into_iter().zip(centre) {
                        assert!((place - centre).abs() < 1e-12, "{nx} x {ny}, {run:?}: {place} for {centre}");
                    }
                    next = first + run.end;
                });
            }
            assert_eq!(next, nx * ny);
        }
    }
}
