//! Maxima over nested squares of a grid.

/// Maxima of a square field of bounds over blocks of 1, 2², 4², … leaves, as long as the number of blocks is even.
///
/// Bounds are kept in single precision, rounded up, relative to an offset and in units of the range of heights: 4 bytes a
/// leaf, and a third more for the larger blocks.
#[derive(Clone)]
pub(super) struct MaxPyramid {
    /// From the leaves on: blocks per side, and their maxima, row-major.
    levels: Vec<(usize, Vec<f32>)>,
}

impl MaxPyramid {
    /// From the bounds of `side` × `side` leaves, row-major.
    pub(super) fn new(side: usize, leaves: Vec<f32>) -> Self {
        let mut levels = vec![(side, leaves)];
        while let Some((side, finer)) = levels.last().filter(|(side, _)| side.is_multiple_of(2) && *side > 0) {
            let half = side / 2;
            let rows = finer.chunks_exact(2 * side).flat_map(|rows| {
                let (above, below) = rows.split_at(*side);
                let pairs = above.as_chunks::<2>().0.iter().zip(below.as_chunks::<2>().0);
                pairs.map(|(a, b)| a[0].max(a[1]).max(b[0].max(b[1])))
            });
            let coarser = (half, rows.collect());
            levels.push(coarser);
        }
        Self { levels }
    }

    /// Leaves per side.
    pub(super) fn side(&self) -> usize {
        self.levels[0].0
    }

    /// Bounds of the leaves, row-major.
    pub(super) fn leaves(&self) -> &[f32] {
        &self.levels[0].1
    }

    /// Greatest bound of the leaves that block (`ix`, `iy`) of `blocks` × `blocks` equal squares of the cell overlaps. One
    /// look-up when a level of the pyramid has this number of blocks, or when they divide its leaves, and a few otherwise.
    ///
    /// # Panics
    /// When the block is outside the cell.
    pub(super) fn max(&self, blocks: usize, ix: usize, iy: usize) -> f32 {
        let level = self.levels.iter().rev().find(|(side, _)| *side >= blocks);
        let (side, values) = level.unwrap_or(&self.levels[0]);
        let columns = ix * side / blocks..((ix + 1) * side).div_ceil(blocks);
        let rows = iy * side / blocks..((iy + 1) * side).div_ceil(blocks);
        let rows = rows.map(|row| &values[row * side..][columns.clone()]);
        rows.flatten().copied().fold(f32::NEG_INFINITY, f32::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_any_number_hold_the_leaves_they_overlap() {
        for side in [1, 6, 24, 25] {
            let leaf = |ix: usize, iy: usize| ((ix * 37 + iy * 53 + 11) % 101) as f32;
            let leaves = (0..side * side).map(|i| leaf(i % side, i / side)).collect();
            let pyramid = MaxPyramid::new(side, leaves);
            for blocks in 1..=2 * side {
                for (ix, iy) in (0..blocks * blocks).map(|i| (i % blocks, i / blocks)) {
                    let overlaps = |leaf: usize, block: usize| {
                        leaf * blocks < (block + 1) * side && (leaf + 1) * blocks > block * side
                    };
                    let inside = (0..side * side).map(|i| (i % side, i / side));
                    let inside = inside.filter(|&(lx, ly)| overlaps(lx, ix) && overlaps(ly, iy));
                    let expected = inside.map(|(lx, ly)| leaf(lx, ly)).fold(f32::NEG_INFINITY, f32::max);
                    let found = pyramid.max(blocks, ix, iy);
                    // A coarser level may hold more than the block when their borders do not meet.
                    let exact = side % blocks == 0 && (side / blocks).is_power_of_two() || blocks % side == 0;
                    // Leaves are whole numbers.
                    let excess = found - expected;
                    assert!(excess >= 0.0 && (excess < 0.5 || !exact), "{side} {blocks} ({ix}, {iy}): {excess}");
                }
            }
        }
    }
}
