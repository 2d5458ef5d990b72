//! The index of the tiles of a level in a vector.
//!
//! It has a bit for each possible tile, and counts block by block.

use crate::morton::{morton_code, place_of};

/// Tiles per side of a block. A block has a tile for each bit of a word.
const BLOCK: usize = 8;

/// Marks of the tiles of a level with so many columns and rows of tiles.
pub(crate) struct TileMarks {
    extent: [usize; 2],
    /// The blocks row by row. Bit i belongs to the tile at position i of the Morton curve through the block.
    blocks: Vec<u64>,
}

/// Finds tiles that are sorted along the Morton curve. A block is a contiguous piece of this curve.
#[derive(Debug)]
pub(crate) struct TileIndex {
    /// Number of blocks in a row.
    columns: usize,
    blocks: Vec<Block>,
}

/// The tiles that exist in a block, and the number of tiles before it on the curve.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    bits: u64,
    before: u32,
}

impl TileMarks {
    pub(crate) fn new(extent: [usize; 2]) -> Self {
        let [columns, rows] = extent.map(|n| n.div_ceil(BLOCK));
        Self { extent, blocks: vec![0; columns * rows] }
    }

    /// Marks the tile at this column and row.
    ///
    /// # Panics
    /// When the tile is outside the level.
    pub(crate) fn mark(&mut self, [column, row]: [u32; 2]) {
        let ([columns, rows], [column, row]) = (self.extent, [column as usize, row as usize]);
        assert!(column < columns && row < rows, "tile ({column}, {row}) of {columns} x {rows}");
        let (block, bit) = block_and_bit(columns.div_ceil(BLOCK), column, row);
        self.blocks[block] |= 1 << bit;
    }

    /// The places of the marked tiles along the Morton curve, and their index.
    pub(crate) fn into_sorted(self) -> (Vec<[u32; 2]>, TileIndex) {
        let [columns, rows] = self.extent.map(|n| n.div_ceil(BLOCK));
        let n_tiles: u32 = self.blocks.iter().map(|bits| bits.count_ones()).sum();
        let mut places = Vec::with_capacity(n_tiles as usize);
        let mut blocks = vec![Block::default(); self.blocks.len()];
        // Along the longer side, the curve passes through squares as wide as the shorter side, one after the other.
        let side = columns.min(rows).next_power_of_two();
        let squares = 0..columns.max(rows).div_ceil(side);
        let places_of_blocks = squares.flat_map(|square| {
            (0..side.pow(2) as u64).map(move |code| {
                let ([x, y], shift) = (place_of(code), (square * side) as u32);
                if columns < rows { [x, y + shift] } else { [x + shift, y] }
            })
        });
        for [column, row] in places_of_blocks {
            if column as usize >= columns || row as usize >= rows {
                continue;
            }
            let block = row as usize * columns + column as usize;
            let mut bits = self.blocks[block];
            blocks[block] = Block { bits, before: places.len() as u32 };
            while bits != 0 {
                let [x, y] = place_of(u64::from(bits.trailing_zeros()));
                places.push([column * BLOCK as u32 + x, row * BLOCK as u32 + y]);
                bits &= bits - 1;
            }
        }
        (places, TileIndex { columns, blocks })
    }
}

impl TileIndex {
    /// Index of the tile at this column and row, which are inside the level.
    #[inline]
    pub(crate) fn find(&self, column: usize, row: usize) -> Option<usize> {
        let (block, bit) = block_and_bit(self.columns, column, row);
        let Block { bits, before } = self.blocks[block];
        let mark = 1_u64 << bit;
        (bits & mark != 0).then(|| before as usize + (bits & (mark - 1)).count_ones() as usize)
    }
}

/// The block of a tile, and its position on the curve through the block.
#[inline]
fn block_and_bit(columns: usize, column: usize, row: usize) -> (usize, u8) {
    const CODES: [u8; BLOCK * BLOCK] = codes();
    (row / BLOCK * columns + column / BLOCK, CODES[row % BLOCK * BLOCK + column % BLOCK])
}

/// Positions on the Morton curve through a block, row by row.
const fn codes() -> [u8; BLOCK * BLOCK] {
    let mut codes = [0; BLOCK * BLOCK];
    let mut i = 0;
    while i < codes.len() {
        codes[i] = morton_code((i % BLOCK) as u32, (i / BLOCK) as u32) as u8;
        i += 1;
    }
    codes
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;

    use super::*;

    #[test]
    fn marked_tiles_are_found_in_the_order_of_the_curve() {
        for [columns, rows] in [[1, 1], [5, 5], [8, 8], [13, 40], [40, 9], [200, 3], [3, 200]] {
            let chosen: Vec<[u32; 2]> = (0..columns * rows)
                .filter(|&i| quasi_random(i) < 0.3)
                .map(|i| [(i % columns) as u32, (i / columns) as u32])
                .collect();
            let mut marks = TileMarks::new([columns, rows]);
            for &place in chosen.iter().chain(&chosen) {
                marks.mark(place);
            }
            let (places, index) = marks.into_sorted();
            let mut sorted = chosen;
            sorted.sort_unstable_by_key(|&[column, row]| morton_code(column, row));
            assert_eq!(places, sorted);
            for i in 0..columns * rows {
                let [column, row] = [i % columns, i / columns];
                let expected = places.iter().position(|&place| place == [column as u32, row as u32]);
                assert_eq!(index.find(column, row), expected, "({column}, {row}) of {columns} x {rows}");
            }
        }
    }
}
