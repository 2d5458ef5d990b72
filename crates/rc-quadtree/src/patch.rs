//! A tile with its neighbourhood, copied to contiguous memory for inner loops.

use crate::tiles::{CELLS, TILE, TileSet};

/// `SIDE` × `SIDE` values, row by row. `SIDE` is a multiple of [`TILE`].
pub type Patch<T, const SIDE: usize> = [[T; SIDE]; SIDE];

/// Fills `rows` of a patch with the values of `tiles`.
///
/// The lower left tile of the patch is at (`column`, `row`) of the level, which continues periodically. Where there is
/// no tile, values are those of `T::default()`. Returns false when none of the tiles exists. The contents of the patch
/// are then undefined. `values` has [`CELLS`] values for each of `tiles`.
///
/// # Panics
/// When there are fewer values, or when rows are outside the patch.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is part of vectorised loops, which are compiled for the machine at hand")]
pub fn gather<T: Copy + Default, const SIDE: usize>(
    values: &[T],
    tiles: &TileSet,
    (column, row): (i64, i64),
    rows: std::ops::Range<usize>,
    patch: &mut Patch<T, SIDE>,
) -> bool {
    if tiles.is_cut((column, row), SIDE / TILE) {
        return gather_cells(values, tiles, (column, row), (rows, T::default()), patch);
    }
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

/// As [`gather`], cell by cell.
///
/// It serves tiles that extend beyond their level, and patches across their seams. Values are `missing` where there is
/// no tile.
#[cold]
#[inline(never)]
pub(crate) fn gather_cells<T: Copy, const SIDE: usize>(
    values: &[T],
    tiles: &TileSet,
    (column, row): (i64, i64),
    (rows, missing): (std::ops::Range<usize>, T),
    patch: &mut Patch<T, SIDE>,
) -> bool {
    let mut any = false;
    let (left, below) = (column * TILE as i64, row * TILE as i64);
    for y in rows {
        for (x, value) in patch[y].iter_mut().enumerate() {
            let cell = tiles.find_cell(left + x as i64, below + y as i64);
            any |= cell.is_some();
            *value = cell.map_or(missing, |cell| values[cell]);
        }
    }
    any
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both functions agree where tiles are whole.
    ///
    /// After the last cell of a level whose tiles are cut, its first cells follow.
    #[test]
    fn patches_continue_the_level_periodically() {
        let mut values: Vec<f64> = (0..6 * CELLS).map(|i| i as f64).collect();
        for sides in [[24, 16], [19, 13]] {
            let tiles = TileSet::new(sides, vec![[0, 0], [1, 0], [2, 0], [0, 1], [2, 1]]);
            for (x, y) in (0..sides[0] * sides[1]).map(|i| (i % sides[0], i / sides[0])) {
                if let Some(cell) = tiles.find_cell(x as i64, y as i64) {
                    values[cell] = (100 * y + x + 1) as f64;
                }
            }
            for corner in [(-1, -1), (0, 0), (1, 1), (2, 0), (-3, 5)] {
                let mut patch = [[f64::NAN; 24]; 24];
                assert!(gather(&values, &tiles, corner, 3..22, &mut patch));
                for (x, y) in (0..24 * 24).map(|i| (i % 24, i / 24)).filter(|(_, y)| (3..22).contains(y)) {
                    let at =
                        |corner: i64, i: usize, side: usize| (8 * corner + i as i64).rem_euclid(side as i64) as usize;
                    let (x_inside, y_inside) = (at(corner.0, x, sides[0]), at(corner.1, y, sides[1]));
                    let is_missing = (x_inside / TILE, y_inside / TILE) == (1, 1);
                    let expected = if is_missing { 0.0 } else { (100 * y_inside + x_inside + 1) as f64 };
                    assert!((patch[y][x] - expected).abs() < 1e-9, "{sides:?}, {corner:?}: ({x}, {y})");
                }
            }
        }
    }
}
