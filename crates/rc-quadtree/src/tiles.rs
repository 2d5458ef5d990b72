//! Tiles: the squares of 8 × 8 cells in which a level of the mesh is stored.

use std::ops::{Add, Mul};
use std::sync::Arc;

use crate::tile_index::{TileIndex, TileMarks};

/// Cells per side of a tile.
pub const TILE: usize = 8;

/// Cells of a tile.
pub const CELLS: usize = TILE * TILE;

/// The tiles of one level, sorted along the Morton curve so that neighbours are near in memory.
///
/// A value of the level is at `tile · 64 + row · 8 + column`. Where tiles are is looked up in a table of 16 bytes for each 64
/// possible tiles: 1/256 byte a cell of the level, the only memory that grows with the cell and not with the contact.
#[derive(Clone, Debug)]
pub struct TileSet {
    per_side: usize,
    // Shared: meshes are cloned often, and never changed.
    places: Arc<Vec<[u32; 2]>>,
    /// None where all tiles are there, row by row.
    index: Option<Arc<TileIndex>>,
}

impl TileSet {
    /// The tiles at `places` (column, row) of a level of `per_side` tiles per side, in any order; double ones are dropped.
    ///
    /// # Panics
    /// When a place is outside the level.
    #[must_use]
    pub fn new(per_side: usize, places: Vec<[u32; 2]>) -> Self {
        let mut marks = TileMarks::new(per_side);
        for place in places {
            marks.mark(place);
        }
        Self::marked(per_side, marks)
    }

    fn marked(per_side: usize, marks: TileMarks) -> Self {
        let (places, index) = marks.into_sorted();
        Self { per_side, places: Arc::new(places), index: Some(Arc::new(index)) }
    }

    /// All tiles of a level of `per_side` tiles per side, row by row.
    #[must_use]
    pub fn full(per_side: usize) -> Self {
        let places = (0..per_side * per_side).map(|i| [(i % per_side) as u32, (i / per_side) as u32]);
        Self { per_side, places: Arc::new(places.collect()), index: None }
    }

    /// Tiles per side of the whole level.
    #[must_use]
    pub fn per_side(&self) -> usize {
        self.per_side
    }

    /// Cells per side of the whole level.
    #[must_use]
    pub fn side(&self) -> usize {
        self.per_side * TILE
    }

    /// Number of tiles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Is there no tile?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Number of cells.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.places.len() * CELLS
    }

    /// Column and row of each tile.
    #[must_use]
    pub fn places(&self) -> &[[u32; 2]] {
        &self.places
    }

    /// Index of the tile at a place of the periodically continued level; none where there is no tile.
    #[must_use]
    #[inline]
    pub fn find(&self, column: i64, row: i64) -> Option<usize> {
        let per_side = self.per_side as i64;
        // Most places are inside, and a division is slow.
        let wrap = |i: i64| if (0..per_side).contains(&i) { i } else { i.rem_euclid(per_side) };
        let (column, row) = (wrap(column) as usize, wrap(row) as usize);
        match &self.index {
            Some(index) => index.find(column, row),
            None => Some(row * self.per_side + column),
        }
    }

    /// Hands out the values of the whole level, zero where there is no tile, a row of tiles at a time: the index of the first row of
    /// cells, and eight rows one after the other. Stops at the first error.
    ///
    /// # Errors
    /// What `take` returns.
    ///
    /// # Panics
    /// When there are fewer than [`TileSet::n_cells`] values.
    pub fn rows<E>(&self, values: &[f64], mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        let mut rows = vec![0.0; TILE * self.side()];
        for row in 0..self.per_side {
            rows.fill(0.0);
            for column in 0..self.per_side {
                if let Some(tile) = self.find(column as i64, row as i64) {
                    put_tile(&mut rows, self.side(), column, &values[tile * CELLS..][..CELLS]);
                }
            }
            take(row * TILE, &rows)?;
        }
        Ok(())
    }

    /// These tiles and those within `halo` cells of them.
    #[must_use]
    pub fn around(&self, halo: usize) -> Self {
        let (n, reach) = (self.per_side as i64, halo.div_ceil(TILE) as i64);
        let mut marks = TileMarks::new(self.per_side);
        for &[column, row] in self.places() {
            for y in i64::from(row) - reach..=i64::from(row) + reach {
                for x in i64::from(column) - reach..=i64::from(column) + reach {
                    marks.mark([x.rem_euclid(n) as u32, y.rem_euclid(n) as u32]);
                }
            }
        }
        Self::marked(self.per_side, marks)
    }

    /// These tiles and others of the same level.
    #[must_use]
    pub fn with(&self, others: &Self) -> Self {
        let mut marks = TileMarks::new(self.per_side);
        for &place in self.places.iter().chain(others.places()) {
            marks.mark(place);
        }
        Self::marked(self.per_side, marks)
    }

    /// The tiles of the level with half as many cells per side that hold these tiles, or a cell within `halo` cells of that
    /// level from them.
    #[must_use]
    pub fn parents(&self, halo: usize) -> Self {
        let (half, halo) = (self.per_side as i64 / 2, halo as i64);
        let mut marks = TileMarks::new(half as usize);
        // A tile covers half a tile of the coarser level.
        let (quarter, tile) = (TILE as i64 / 2, TILE as i64);
        for &[column, row] in self.places() {
            let range = |i: u32| {
                let start = i64::from(i) * quarter;
                (start - halo).div_euclid(tile)..=(start + quarter + halo - 1).div_euclid(tile)
            };
            for y in range(row) {
                for x in range(column) {
                    marks.mark([x.rem_euclid(half) as u32, y.rem_euclid(half) as u32]);
                }
            }
        }
        Self::marked(half as usize, marks)
    }
}

/// Writes the [`CELLS`] values of a tile into a row of tiles, which is eight rows of `side` cells each, at this column of tiles.
///
/// # Panics
/// When the column is outside the rows.
pub fn put_tile(rows: &mut [f64], side: usize, column: usize, tile: &[f64]) {
    for (line, cells) in rows.chunks_exact_mut(side).zip(tile.as_chunks::<TILE>().0) {
        line[column * TILE..][..TILE].copy_from_slice(cells);
    }
}

/// The places of a tile's quarters, on the level of elements half as large: lower left, lower right, upper left, upper right.
#[must_use]
#[inline]
pub fn quarters([column, row]: [u32; 2]) -> [[u32; 2]; 4] {
    [0, 1, 2, 3].map(|quarter| [2 * column + quarter % 2, 2 * row + quarter / 2])
}

/// The cell of a tile that holds cell (`x`, `y`) of its quarter at a place (only whether its column and row are odd matters).
#[must_use]
#[inline]
pub fn cell_over([column, row]: [u32; 2], x: usize, y: usize) -> usize {
    let half = |i: u32| i as usize % 2 * (TILE / 2);
    (half(row) + y / 2) * TILE + half(column) + x / 2
}

/// Means over two by two cells of a tile's quarter at a place: `put` gets the cell of the tile, and the mean.
///
/// # Panics
/// When `fine` has fewer than [`CELLS`] values.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is part of vectorised loops, which are compiled for the machine at hand")]
pub fn means_of_quarter<T>(place: [u32; 2], fine: &[T], mut put: impl FnMut(usize, T))
where
    T: Copy + From<f32> + Add<Output = T> + Mul<Output = T>,
{
    let quarter = T::from(0.25);
    for y in (0..TILE).step_by(2) {
        for x in (0..TILE).step_by(2) {
            let corner = y * TILE + x;
            let sum = fine[corner] + fine[corner + 1] + fine[corner + TILE] + fine[corner + TILE + 1];
            put(cell_over(place, x, y), quarter * sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_found_across_the_seam() {
        let set = TileSet::new(6, vec![[5, 0], [0, 5], [2, 3], [2, 3]]);
        assert_eq!(set.len(), 3);
        assert_eq!(set.places()[set.find(-1, 6).expect("stored")], [5, 0]);
        assert_eq!(set.find(3, 2), None);
    }

    #[test]
    fn parents_hold_the_halo() {
        let set = TileSet::new(8, vec![[0, 0]]);
        let places = |halo| {
            let mut places = set.parents(halo).places().to_vec();
            places.sort_unstable();
            places
        };
        assert_eq!(places(0), [[0, 0]]);
        // The tile covers cells 0 to 3 of 8 of its parent: two more on either side reach beyond the seam on one side only.
        assert_eq!(places(2), [[0, 0], [0, 3], [3, 0], [3, 3]]);
        assert_eq!(places(5).len(), 9);
    }
}
