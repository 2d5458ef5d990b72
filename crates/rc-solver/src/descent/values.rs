//! The vectors of a descent, which pass block by block.

use std::borrow::Cow;
use std::ops::Range;

use crate::descent::layout::BlockLayout;
use crate::descent::rows::ElementValues;
use crate::parallel;

/// A value for each element.
#[derive(Clone)]
pub(crate) enum Values {
    Double(Vec<f64>),
    /// Differences from `origin` in single precision, which take half of the memory.
    Single {
        origin: f64,
        differences: Vec<f32>,
    },
}

/// A block of values.
pub(crate) enum Block<'a> {
    Double(&'a mut [f64]),
    Single(f64, &'a mut [f32]),
}

impl Block<'_> {
    /// Changes the values in double precision.
    pub(crate) fn change<R>(self, work: impl FnOnce(&mut [f64]) -> R) -> R {
        match self {
            Self::Double(values) => work(values),
            Self::Single(origin, differences) => {
                let mut values = doubles(origin, differences);
                let result = work(&mut values);
                for (difference, value) in differences.iter_mut().zip(values) {
                    *difference = (value - origin) as f32;
                }
                result
            }
        }
    }
}

/// The ranges of blocks of `len` values.
fn ranges(n: usize, len: usize) -> impl Iterator<Item = Range<usize>> {
    (0..n).step_by(len).map(move |start| start..n.min(start + len))
}

fn doubles(origin: f64, differences: &[f32]) -> Vec<f64> {
    differences.iter().map(|&difference| origin + f64::from(difference)).collect()
}

impl Values {
    /// The same values, as differences from `origin` in single precision.
    pub(crate) fn to_single(&self, origin: f64) -> Self {
        let mut differences = parallel::zeros(self.len());
        let blocks = ranges(self.len(), parallel::BLOCK).zip(differences.chunks_mut(parallel::BLOCK));
        parallel::for_each(blocks, |(range, differences)| {
            for (difference, value) in differences.iter_mut().zip(&*self.part(range)) {
                *difference = (value - origin) as f32;
            }
        });
        Self::Single { origin, differences }
    }

    pub(crate) fn is_single(&self) -> bool {
        matches!(self, Self::Single { .. })
    }

    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Double(values) => values.len(),
            Self::Single { differences, .. } => differences.len(),
        }
    }

    /// Some of the values.
    pub(crate) fn part(&self, range: Range<usize>) -> Cow<'_, [f64]> {
        match self {
            Self::Double(values) => Cow::Borrowed(&values[range]),
            Self::Single { origin, differences } => Cow::Owned(doubles(*origin, &differences[range])),
        }
    }

    /// All values.
    pub(crate) fn all(&self) -> Cow<'_, [f64]> {
        self.part(0..self.len())
    }

    /// The value of an element.
    pub(crate) fn at(&self, i: usize) -> f64 {
        match self {
            Self::Double(values) => values[i],
            Self::Single { origin, differences } => origin + f64::from(differences[i]),
        }
    }

    /// All values, to be changed in double precision.
    ///
    /// # Panics
    /// In single precision, which a pressure with a hardness never has.
    pub(crate) fn all_mut(&mut self) -> &mut [f64] {
        match self {
            Self::Double(values) => values,
            Self::Single { .. } => panic!("a vector in double precision"),
        }
    }

    pub(crate) fn into_all(self) -> Vec<f64> {
        match self {
            Self::Double(values) => values,
            Self::Single { ref differences, .. } => {
                let mut all = parallel::zeros(differences.len());
                let blocks = ranges(all.len(), parallel::BLOCK).zip(all.chunks_mut(parallel::BLOCK));
                parallel::for_each(blocks, |(range, block)| block.copy_from_slice(&self.part(range)));
                all
            }
        }
    }

    /// Divides into blocks of `len` values.
    pub(crate) fn blocks(&mut self, len: usize) -> impl Iterator<Item = Block<'_>> {
        let (double, single, origin): (&mut [f64], &mut [f32], f64) = match self {
            Self::Double(values) => (values, &mut [], 0.0),
            Self::Single { origin, differences } => (&mut [], differences, *origin),
        };
        let single = single.chunks_mut(len).map(move |block| Block::Single(origin, block));
        double.chunks_mut(len).map(Block::Double).chain(single)
    }

    /// Changes each value.
    pub(crate) fn update(&mut self, change: impl Fn(&mut f64) + Sync) {
        parallel::for_each(self.blocks(parallel::BLOCK), |block| {
            block.change(|values| values.iter_mut().for_each(&change));
        });
    }

    /// Sets the value `old + part (new - old)` for each pair of an old and a new one.
    pub(crate) fn go_back(&mut self, old: &Self, part: f64) {
        let blocks = ranges(old.len(), parallel::BLOCK).zip(self.blocks(parallel::BLOCK));
        parallel::for_each(blocks, |(range, block)| {
            block.change(|new| {
                for (new, old) in new.iter_mut().zip(&*old.part(range)) {
                    *new = old + part * (*new - old);
                }
            });
        });
    }

    /// The sum of the values, weighted by the area of elements.
    pub(crate) fn sum(&self, layout: &BlockLayout) -> f64 {
        let [sum] = layout.total(parallel::map(layout.ranges(self.len()), |range| [self.part(range).iter().sum()]));
        sum
    }
}

/// The heights of elements.
#[derive(Clone, Copy)]
pub(crate) enum ElementHeights<'a> {
    Known(&'a [f64]),
    /// The number of elements, and what writes the heights of a block of a vector.
    OnDemand(usize, &'a (dyn Fn(Range<usize>, &mut [f64]) + Sync)),
}

impl<'a> From<&'a [f64]> for ElementHeights<'a> {
    fn from(heights: &'a [f64]) -> Self {
        Self::Known(heights)
    }
}

impl<'a> ElementHeights<'a> {
    pub(crate) fn len(self) -> usize {
        match self {
            Self::Known(heights) => heights.len(),
            Self::OnDemand(n, _) => n,
        }
    }

    /// The heights of a block, or of all elements where they are known.
    pub(crate) fn part(self, range: Range<usize>) -> Cow<'a, [f64]> {
        match self {
            Self::Known(heights) => Cow::Borrowed(&heights[range]),
            Self::OnDemand(_, write) => {
                let mut heights = vec![0.0; range.len()];
                write(range, &mut heights);
                Cow::Owned(heights)
            }
        }
    }
}

/// Heights, pressure and gap of all elements.
pub(crate) struct ElementVectors<'a> {
    pub(crate) heights: ElementHeights<'a>,
    pub(crate) pressure: &'a mut Values,
    pub(crate) gap: &'a mut Values,
}

/// Heights, pressure and gap of the elements of a block.
pub(crate) struct ElementBlock<'a> {
    range: Range<usize>,
    heights: ElementHeights<'a>,
    pressure: Block<'a>,
    gap: Block<'a>,
}

impl<'a> ElementVectors<'a> {
    /// Divides into blocks of `len` elements.
    pub(crate) fn blocks(self, len: usize) -> impl Iterator<Item = ElementBlock<'a>> {
        let (heights, blocks) = (self.heights, ranges(self.pressure.len(), len));
        let values = self.pressure.blocks(len).zip(self.gap.blocks(len));
        blocks.zip(values).map(move |(range, (pressure, gap))| ElementBlock { range, heights, pressure, gap })
    }
}

impl ElementBlock<'_> {
    /// Works on heights, pressure and gap.
    pub(crate) fn with_heights<R>(self, work: impl FnOnce(ElementValues<'_>) -> R) -> R {
        let heights = self.heights.part(self.range.clone());
        self.with(&heights, work)
    }

    /// Works on pressure and gap. There are no heights.
    pub(crate) fn without_heights<R>(self, work: impl FnOnce(ElementValues<'_>) -> R) -> R {
        self.with(&[], work)
    }

    fn with<R>(self, heights: &[f64], work: impl FnOnce(ElementValues<'_>) -> R) -> R {
        self.pressure.change(|pressure| self.gap.change(|gap| work(ElementValues { heights, pressure, gap })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_in_single_precision_keep_eight_digits_of_what_is_near_the_origin() {
        let origin = 0.031;
        let gaps: Vec<f64> = (0..5000).map(|i| origin + 1e-6 * f64::from(i) / 5000.0).collect();
        let mut single = Values::Double(gaps.clone()).to_single(origin);
        assert!(single.is_single() && single.len() == gaps.len());
        single.update(|gap| *gap += 1e-7);
        for (gap, &exact) in single.into_all().iter().zip(&gaps) {
            // Two roundings of at most 2⁻²⁴ of 1.1e-6, and those of the sum with the origin.
            assert!((gap - exact - 1e-7).abs() < 1.5e-13, "{gap} for {exact}");
        }
    }
}
