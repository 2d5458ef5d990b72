//! Tiles, the squares of 8 × 8 cells in which a level of the mesh is stored.

use std::ops::{Add, Mul};
use std::sync::Arc;

use rc_core::Boundary;

use crate::tile_index::{TileIndex, TileMarks};

/// Number of cells per side of a tile.
pub const TILE: usize = 8;

/// Number of cells of a tile.
pub const CELLS: usize = TILE * TILE;

/// The tiles of one level, sorted along the Morton curve.
///
/// Neighbours are therefore near in memory. A value of the level is at `tile · 64 + row · 8 + column`. The index of a
/// tile is looked up in a table with 16 bytes for every 64 possible tiles, or 1/256 byte for each cell of the level.
/// All other memory grows with the contact only.
///
/// Where a side is not a multiple of 8, the last tiles along it extend beyond the level. Cells there are not part of
/// the level. [`crate::gather`] and [`Elements::around`](crate::Elements::around) continue the level periodically and
/// never read the values of these cells. A level with free borders has no tiles beyond them.
#[derive(Clone, Debug)]
pub struct TileSet {
    sides: [usize; 2],
    /// Numbers of columns and rows of tiles.
    extent: [usize; 2],
    boundary: Boundary,
    // Shared, because meshes are cloned often and never changed.
    places: Arc<Vec<[u32; 2]>>,
    /// `None` if all tiles exist, row by row.
    index: Option<Arc<TileIndex>>,
}

impl TileSet {
    /// The tiles at `places` of a level of `sides` cells along x and y.
    ///
    /// A place is a column and a row. Places may have any order. Duplicates are dropped.
    ///
    /// # Panics
    /// When a place is outside the level.
    #[must_use]
    pub fn new(sides: [usize; 2], places: Vec<[u32; 2]>) -> Self {
        let mut marks = marks_of(sides);
        for place in places {
            marks.mark(place);
        }
        Self::marked(sides, marks)
    }

    fn marked(sides: [usize; 2], marks: TileMarks) -> Self {
        let (places, index) = marks.into_sorted();
        let extent = sides.map(|side| side.div_ceil(TILE));
        let boundary = Boundary::Periodic;
        Self { sides, extent, boundary, places: Arc::new(places), index: Some(Arc::new(index)) }
    }

    /// The same tiles, on a level with this boundary.
    ///
    /// Other constructors make tiles of a periodic level.
    #[must_use]
    pub fn with_boundary(self, boundary: Boundary) -> Self {
        Self { boundary, ..self }
    }

    /// Other tiles of the same cell, on a level of `sides` cells.
    ///
    /// The boundary is the same.
    ///
    /// # Panics
    /// As [`TileSet::new`].
    #[must_use]
    pub fn of_same_cell(&self, sides: [usize; 2], places: Vec<[u32; 2]>) -> Self {
        Self::new(sides, places).with_boundary(self.boundary)
    }

    /// What is beyond the borders of the level.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// All tiles of a level of `sides` cells along x and y, row by row.
    #[must_use]
    pub fn full(sides: [usize; 2]) -> Self {
        let [columns, rows] = sides.map(|side| side.div_ceil(TILE));
        let places = (0..columns * rows).map(|i| [(i % columns) as u32, (i / columns) as u32]);
        let (boundary, places) = (Boundary::Periodic, Arc::new(places.collect()));
        Self { sides, extent: [columns, rows], boundary, places, index: None }
    }

    /// Numbers of columns and rows of tiles of the whole level.
    #[must_use]
    pub fn extent(&self) -> [usize; 2] {
        self.extent
    }

    /// Numbers of cells of the whole level along x and y.
    #[must_use]
    pub fn sides(&self) -> [usize; 2] {
        self.sides
    }

    /// Number of tiles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are no tiles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Number of values, [`CELLS`] for each tile.
    #[must_use]
    pub fn n_cells(&self) -> usize {
        self.places.len() * CELLS
    }

    /// Number of cells that are part of the level.
    ///
    /// It equals [`TileSet::n_cells`] where sides are multiples of 8.
    #[must_use]
    pub fn n_inside(&self) -> usize {
        if self.is_whole() {
            return self.n_cells();
        }
        self.places.iter().map(|&place| self.inside(place).into_iter().product::<usize>()).sum()
    }

    /// Numbers of columns and rows of a tile's cells that belong to the level.
    #[must_use]
    pub fn inside(&self, place: [u32; 2]) -> [usize; 2] {
        [0, 1].map(|axis| TILE.min(self.sides[axis] - TILE * place[axis] as usize))
    }

    /// Whether no tile extends beyond the level.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.sides.iter().all(|side| side.is_multiple_of(TILE))
    }

    /// Column and row of each tile.
    #[must_use]
    pub fn places(&self) -> &[[u32; 2]] {
        &self.places
    }

    /// Index of the tile at a place of the level, or `None`.
    ///
    /// The level is continued periodically, unless its borders are free.
    #[must_use]
    #[inline]
    pub fn find(&self, column: i64, row: i64) -> Option<usize> {
        let [columns, rows] = self.extent.map(|n| n as i64);
        // Most places are inside, and a division is slow.
        let wrap = |i: i64, n: i64| match self.boundary {
            _ if (0..n).contains(&i) => Some(i as usize),
            Boundary::Periodic => Some(i.rem_euclid(n) as usize),
            Boundary::Free => None,
        };
        let (column, row) = (wrap(column, columns)?, wrap(row, rows)?);
        match &self.index {
            Some(index) => index.find(column, row),
            None => Some(row * self.extent[0] + column),
        }
    }

    /// Index of the value of a cell of the level.
    ///
    /// The level is continued periodically, unless its borders are free. `None` where there is no tile.
    #[must_use]
    pub fn find_cell(&self, x: i64, y: i64) -> Option<usize> {
        let [nx, ny] = self.sides.map(|side| side as i64);
        if self.boundary == Boundary::Free && !((0..nx).contains(&x) && (0..ny).contains(&y)) {
            return None;
        }
        let (x, y) = (x.rem_euclid(nx) as usize, y.rem_euclid(ny) as usize);
        let tile = self.find((x / TILE) as i64, (y / TILE) as i64)?;
        Some(tile * CELLS + y % TILE * TILE + x % TILE)
    }

    /// Whether a patch contains tiles that extend beyond the level.
    ///
    /// Also true if it crosses a seam of such tiles. The patch has `n` × `n` tiles. The lower left one is at a place of
    /// the periodically continued level.
    #[must_use]
    #[inline]
    pub(crate) fn is_cut(&self, (column, row): (i64, i64), n: usize) -> bool {
        let cut = |side: usize, first: i64, extent: usize| {
            !side.is_multiple_of(TILE) && (first < 0 || first + n as i64 >= extent as i64)
        };
        cut(self.sides[0], column, self.extent[0]) || cut(self.sides[1], row, self.extent[1])
    }

    /// Passes the values of the whole level to `take`, by rows of tiles.
    ///
    /// `take` gets the index of the first row of cells, and the values of eight rows. There are fewer rows where the
    /// last tiles extend beyond the level. Values are zero where there is no tile. The first error ends the loop.
    ///
    /// # Errors
    /// The error that `take` returns.
    ///
    /// # Panics
    /// When there are fewer than [`TileSet::n_cells`] values.
    pub fn rows<E>(&self, values: &[f64], mut take: impl FnMut(usize, &[f64]) -> Result<(), E>) -> Result<(), E> {
        let ([nx, ny], [columns, rows_of_tiles]) = (self.sides, self.extent);
        let mut rows = vec![0.0; TILE * nx];
        for row in 0..rows_of_tiles {
            rows.fill(0.0);
            for column in 0..columns {
                if let Some(tile) = self.find(column as i64, row as i64) {
                    put_tile(&mut rows, nx, column, &values[tile * CELLS..][..CELLS]);
                }
            }
            take(row * TILE, &rows[..TILE.min(ny - row * TILE) * nx])?;
        }
        Ok(())
    }

    /// These tiles and all tiles within `halo` cells of them.
    #[must_use]
    pub fn around(&self, halo: usize) -> Self {
        let reach = halo.div_ceil(TILE) as i64;
        let mut marks = marks_of(self.sides);
        for &[column, row] in self.places() {
            for y in i64::from(row) - reach..=i64::from(row) + reach {
                for x in i64::from(column) - reach..=i64::from(column) + reach {
                    self.mark(&mut marks, self.extent, [x, y]);
                }
            }
        }
        Self::marked(self.sides, marks).with_boundary(self.boundary)
    }

    /// Marks the tile at `place` of another level of the same cell.
    ///
    /// The level has `extent` columns and rows of tiles. It is continued periodically, unless its borders are free.
    fn mark(&self, marks: &mut TileMarks, extent: [usize; 2], place: [i64; 2]) {
        let inside = [0, 1].map(|axis| place[axis].rem_euclid(extent[axis] as i64));
        if self.boundary == Boundary::Periodic || inside == place {
            marks.mark(inside.map(|i| i as u32));
        }
    }

    /// These tiles and other tiles of the same level.
    #[must_use]
    pub fn with(&self, others: &Self) -> Self {
        let mut marks = marks_of(self.sides);
        for &place in self.places.iter().chain(others.places()) {
            marks.mark(place);
        }
        Self::marked(self.sides, marks).with_boundary(self.boundary)
    }

    /// The tiles of the next coarser level over these tiles and their halo.
    ///
    /// The coarser level has half as many cells along both sides. The halo is `halo` of its cells wide.
    #[must_use]
    pub fn parents(&self, halo: usize) -> Self {
        self.on_coarser(self.places(), self.sides.map(|side| side / 2), halo)
    }

    /// The tiles of a coarser level over the tiles at `places` of this level, and over their halo.
    ///
    /// The coarser level has `sides` cells along x and y, which are whole numbers of tiles. The halo is `halo` cells of
    /// the coarser level wide.
    #[must_use]
    pub fn on_coarser(&self, places: &[[u32; 2]], sides: [usize; 2], halo: usize) -> Self {
        let extent = sides.map(|side| side / TILE);
        let mut marks = marks_of(sides);
        let tiles = |[column, row]: [u32; 2], axis: usize| {
            let first = TILE * if axis == 0 { column } else { row } as usize;
            let last = (first + TILE).min(self.sides[axis]);
            // The cells of the coarser level that the tile overlaps.
            let start = (first * sides[axis] / self.sides[axis]) as i64 - halo as i64;
            let end = ((last * sides[axis]).div_ceil(self.sides[axis]) + halo) as i64;
            start.div_euclid(TILE as i64)..=(end - 1).div_euclid(TILE as i64)
        };
        for &place in places {
            for y in tiles(place, 1) {
                for x in tiles(place, 0) {
                    self.mark(&mut marks, extent, [x, y]);
                }
            }
        }
        Self::marked(sides, marks).with_boundary(self.boundary)
    }
}

/// Marks of a level of `sides` cells, without a marked tile.
fn marks_of(sides: [usize; 2]) -> TileMarks {
    TileMarks::new(sides.map(|side| side.div_ceil(TILE)))
}

/// Writes the [`CELLS`] values of a tile into a row of tiles.
///
/// The tile is in column `column` of the tiles. A row of tiles is eight rows of `side` cells each. Values that extend
/// beyond the rows are omitted.
///
/// # Panics
/// When the column is outside the rows.
pub fn put_tile(rows: &mut [f64], side: usize, column: usize, tile: &[f64]) {
    for (line, cells) in rows.chunks_exact_mut(side).zip(tile.as_chunks::<TILE>().0) {
        let cells = &cells[..TILE.min(side - column * TILE)];
        line[column * TILE..][..cells.len()].copy_from_slice(cells);
    }
}

/// The places of the four quarters of a tile.
///
/// The order is lower left, lower right, upper left, upper right. The places are on the level of elements half as
/// large.
#[must_use]
#[inline]
pub fn quarters([column, row]: [u32; 2]) -> [[u32; 2]; 4] {
    [0, 1, 2, 3].map(|quarter| [2 * column + quarter % 2, 2 * row + quarter / 2])
}

/// The cell of a tile that contains a cell of one of its quarters.
///
/// The cell of the quarter is (`x`, `y`), and the quarter is at (`column`, `row`). Only whether column and row are odd
/// matters.
#[must_use]
#[inline]
pub fn cell_over([column, row]: [u32; 2], x: usize, y: usize) -> usize {
    let half = |i: u32| i as usize % 2 * (TILE / 2);
    (half(row) + y / 2) * TILE + half(column) + x / 2
}

/// Means over two by two cells of the quarter of a tile at a place.
///
/// `put` gets the cell of the tile and the mean.
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
mod tests;
