//! How the vectors of a mesh are divided into blocks, and sums over them.

use std::sync::Arc;

/// Blocks of so many values; the last may be shorter. All elements of a block are of one size.
#[derive(Clone, Debug)]
pub(crate) struct BlockLayout {
    len: usize,
    /// Area of an element of each block, in units of the smallest; empty when all are of that size.
    areas: Arc<[f64]>,
}

impl BlockLayout {
    /// Of elements of one size.
    pub(crate) fn of(len: usize) -> Self {
        Self { len, areas: Arc::default() }
    }

    /// With the area of an element of each block.
    pub(crate) fn with_areas(len: usize, areas: Vec<f64>) -> Self {
        Self { len, areas: areas.into() }
    }

    /// Values in a block.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Area of an element of block `i`.
    pub(crate) fn area(&self, i: usize) -> f64 {
        self.areas.get(i).copied().unwrap_or(1.0)
    }

    /// Area-weighted sums from those of each block, added in the order of blocks.
    pub(crate) fn total<const N: usize>(&self, blocks: Vec<[f64; N]>) -> [f64; N] {
        let mut sum = [0.0; N];
        for (i, block) in blocks.into_iter().enumerate() {
            let area = self.area(i);
            for (sum, value) in sum.iter_mut().zip(block) {
                *sum += area * value;
            }
        }
        sum
    }
}
