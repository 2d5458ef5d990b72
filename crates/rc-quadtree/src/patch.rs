//! A tile with its neighbourhood, copied to one place for inner loops.

use crate::tiles::{CELLS, TILE, TileSet};

/// `SIDE` × `SIDE` values, row by row; `SIDE` is a multiple of [`TILE`].
pub type Patch<T, const SIDE: usize> = [[T; SIDE]; SIDE];

/// Fills `rows` of the patch whose lower left tile is at (`column`, `row`) of the periodically continued level. Where there is no
/// tile, values are those of `T::default()`. Returns false when none of the tiles exists; the patch is then undefined.
///
/// `values` has [`CELLS`] values for each of `tiles`.
///
/// # Panics
/// When there are fewer values than that, or rows are outside the patch.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is part of vectorised loops, which are compiled for the machine at hand")]
pub fn gather<T: Copy + Default, const SIDE: usize>(
    values: &[T],
    tiles: &TileSet,
    (column, row): (i64, i64),
    rows: std::ops::Range<usize>,
    patch: &mut Patch<T, SIDE>,
) -> bool {
    let mut any = false;
    for block_row in rows.start / TILE..rows.end.div_ceil(TILE) {
        let from = rows.start.max(block_row * TILE) - block_row * TILE;
        let to = rows.end.min((block_row + 1) * TILE) - block_row * TILE;
        for block_column in 0..SIDE / TILE {
            let left = block_column * TILE;
            match tiles.find(column + block_column as i64, row + block_row as i64) {
                Some(tile) => {
                    any = true;
                    let (cells, _) = values[tile * CELLS..][..CELLS].as_chunks::<TILE>();
                    for y in from..to {
                        patch[block_row * TILE + y][left..][..TILE].copy_from_slice(&cells[y]);
                    }
                }
                None => {
                    for y in from..to {
                        patch[block_row * TILE + y][left..][..TILE].fill(T::default());
                    }
                }
            }
        }
    }
    any
}
