//! Maxima over nested squares of a grid.

/// Maxima of a field of bounds over blocks of 1, 2², 4², … leaves.
///
/// Blocks are doubled as long as their numbers along both sides are even. Bounds are in single precision, rounded up,
/// relative to an offset and in units of the range of heights. They take 4 bytes a leaf, and a third more for the
/// larger blocks.
#[derive(Clone)]
pub(super) struct MaxPyramid {
    /// Number of cells along both sides, and of a leaf. The last leaves may reach beyond a side.
    cells: [usize; 2],
    of_leaf: usize,
    /// Numbers of blocks along both sides, and their maxima, row-major, from the leaves on.
    levels: Vec<([usize; 2], Vec<f32>)>,
}

impl MaxPyramid {
    /// The pyramid over the bounds of leaves, row-major.
    ///
    /// Each leaf has `of_leaf` × `of_leaf` cells.
    pub(super) fn new(cells: [usize; 2], of_leaf: usize, leaves: Vec<f32>) -> Self {
        let mut levels = vec![(cells.map(|n| n.div_ceil(of_leaf)), leaves)];
        let halves = |sides: &[usize; 2]| sides.iter().all(|&side| side.is_multiple_of(2) && side > 0);
        while let Some((sides, finer)) = levels.last().filter(|(sides, _)| halves(sides)) {
            let half = sides.map(|side| side / 2);
            let rows = finer.chunks_exact(2 * sides[0]).flat_map(|rows| {
                let (above, below) = rows.split_at(sides[0]);
                let pairs = above.as_chunks::<2>().0.iter().zip(below.as_chunks::<2>().0);
                pairs.map(|(a, b)| a[0].max(a[1]).max(b[0].max(b[1])))
            });
            let coarser = (half, rows.collect());
            levels.push(coarser);
        }
        Self { cells, of_leaf, levels }
    }

    /// Number of leaves along both sides.
    pub(super) fn sides(&self) -> [usize; 2] {
        self.levels[0].0
    }

    /// Bounds of the leaves, row-major.
    pub(super) fn leaves(&self) -> &[f32] {
        &self.levels[0].1
    }

    /// Maximum bound of the leaves that the block at `place` overlaps.
    ///
    /// There are `blocks` equal blocks along both sides of the cell. It takes one look-up when a level of the pyramid
    /// has this number of blocks, or when they divide its leaves, and a few otherwise.
    ///
    /// # Panics
    /// When the block is outside the cell.
    pub(super) fn max(&self, blocks: [usize; 2], place: [usize; 2]) -> f32 {
        let is_fine = |sides: &[usize; 2]| sides.iter().zip(blocks).all(|(&side, blocks)| side >= blocks);
        let level = self.levels.iter().rposition(|(sides, _)| is_fine(sides)).unwrap_or(0);
        let (sides, values) = &self.levels[level];
        let cells = self.of_leaf << level;
        let [columns, rows] = [0, 1].map(|axis| {
            let (i, n) = (place[axis], blocks[axis] * cells);
            i * self.cells[axis] / n..((i + 1) * self.cells[axis]).div_ceil(n)
        });
        let rows = rows.map(|row| &values[row * sides[0]..][columns.clone()]);
        rows.flatten().copied().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The bound of a leaf.
    ///
    /// # Panics
    /// When there is no such leaf.
    pub(super) fn leaf(&self, [ix, iy]: [usize; 2]) -> f32 {
        let (sides, values) = &self.levels[0];
        values[iy * sides[0] + ix]
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
            let pyramid = MaxPyramid::new([side, side], 1, leaves);
            for blocks in 1..=2 * side {
                for (ix, iy) in (0..blocks * blocks).map(|i| (i % blocks, i / blocks)) {
                    let overlaps = |leaf: usize, block: usize| {
                        leaf * blocks < (block + 1) * side && (leaf + 1) * blocks > block * side
                    };
                    let inside = (0..side * side).map(|i| (i % side, i / side));
                    let inside = inside.filter(|&(lx, ly)| overlaps(lx, ix) && overlaps(ly, iy));
                    let expected = inside.map(|(lx, ly)| leaf(lx, ly)).fold(f32::NEG_INFINITY, f32::max);
                    let found = pyramid.max([blocks, blocks], [ix, iy]);
                    // If the borders of blocks do not meet, a coarser level may hold more than the block.
                    let exact = side % blocks == 0 && (side / blocks).is_power_of_two() || blocks % side == 0;
                    // Leaves are whole numbers.
                    let excess = found - expected;
                    assert!(excess >= 0.0 && (excess < 0.5 || !exact), "{side} {blocks} ({ix}, {iy}): {excess}");
                }
            }
        }
    }
}
