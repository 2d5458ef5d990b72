//! Tails of stencils under a surface that slides along x ([`rc_kernel::RelaxedStencil`]).
//!
//! Beyond the reach r of a level's stencil, each mode adds to the displacement w of a cell what decays along its row:
//!
//! ```text
//! z(x, y) = a z(x + 1, y) + Σ_y' T(y' - y) ρ(x, y'),        w(x, y) = z(x + r + 1, y),        a = exp(-h/ℓ).
//! ```
//!
//! The recursion passes over the columns of tiles that have a density near the row, or where w reads z. Over n cells
//! between them, z falls to a^n. A row is periodic: the sum without images is divided by 1 - a^N and starts the row
//! anew. With ℓ < 0 the recursion runs in the other direction. Rows of tiles do not depend on each other, so digits do
//! not depend on the number of threads. Each row has all of its tiles on one rank.

use std::collections::BTreeSet;

use pulp::{Arch, Simd, WithSimd};
use rc_kernel::Tail;
use rc_quadtree::{BLOCK_TILES, CELLS, TILE, TileSet};

use crate::parallel;
use crate::tiles::operator::real::{Arithmetic, add_product};
use crate::tiles::operator::tile_values::TileValues;

/// Values of the cells of a tile: its columns, each with its rows.
type Columns = [[f64; TILE]; TILE];

/// The tails of one level, in the precision of the values.
#[derive(Clone, Debug)]
pub(crate) struct TailTable<T> {
    radius: usize,
    modes: Vec<Mode<T>>,
}

/// One tail.
#[derive(Clone, Debug)]
struct Mode<T> {
    /// Whether the cells that act are those at larger x.
    is_ahead: bool,
    /// h/|ℓ|.
    rate: f64,
    /// Weights of the cells of a column, from the lowest on.
    taps: Vec<T>,
}

impl<T: Arithmetic> TailTable<T> {
    /// Tails of `factor` times a stencil with this radius.
    pub(crate) fn new(tails: &[Tail], factor: f64, radius: usize) -> Self {
        let mode = |Tail { length, weights }: &Tail| Mode {
            is_ahead: *length > 0.0,
            rate: length.abs().recip(),
            taps: weights.iter().map(|weight| T::rounded(factor * weight)).collect(),
        };
        Self { radius, modes: tails.iter().map(mode).collect() }
    }

    /// The rows of the tiles of a level.
    pub(crate) fn rows(&self, tiles: &TileSet) -> TileRows {
        let has = |ahead: bool| self.modes.iter().any(|mode| mode.is_ahead == ahead);
        TileRows::new(tiles, self.radius, [has(true), has(false)])
    }
}

impl<T: Copy> Mode<T> {
    /// The order of columns and of cells in which the recursion passes: from large to small x, or the reverse.
    fn turned(&self, i: usize, n: usize) -> usize {
        if self.is_ahead { n - 1 - i } else { i }
    }
}

/// The tiles of a level, row by row. Values of tiles in this order are in one piece for each row.
pub(crate) struct TileRows {
    rows: Vec<TileRow>,
    /// Place of each tile in this order.
    places: Vec<usize>,
}

/// A row of tiles.
struct TileRow {
    row: u32,
    /// Numbers of the columns, of all tiles on and around the row and of those where tails are read, in increasing
    /// order.
    columns: Vec<u32>,
    /// Whether there is a density on or around the row in each of these columns.
    has_density: Vec<bool>,
    /// For each tile of the row, the two columns where its tails are read, ahead and behind.
    read: Vec<[[usize; 2]; 2]>,
}

impl TileRows {
    /// The rows of `tiles` whose tails begin after `radius` cells, for modes ahead or behind.
    fn new(tiles: &TileSet, radius: usize, directions: [bool; 2]) -> Self {
        let [n_columns, n_rows] = tiles.extent();
        let mut by_row = vec![Vec::new(); n_rows];
        for (tile, place) in tiles.places().iter().enumerate() {
            by_row[place[1] as usize].push((tile, place[0]));
        }
        let (mut rows, mut places, mut first) = (Vec::new(), vec![0; tiles.len()], 0);
        let reach = radius.div_ceil(TILE).min(n_rows);
        for (row, own) in by_row.iter().enumerate().filter(|(_, own)| !own.is_empty()) {
            for (i, (tile, _)) in own.iter().enumerate() {
                places[*tile] = first + i;
            }
            first += own.len();
            let around = (0..=2 * reach).flat_map(|i| &by_row[(row + n_rows + i - reach) % n_rows]);
            let dense: BTreeSet<u32> = around.map(|(_, column)| *column).collect();
            // Of the columns ahead, the first that a tail reaches, and the next. Behind it is the same, mirrored.
            let ahead = |column: u32, i: usize| ((column as usize + (radius + 1) / TILE + i) % n_columns) as u32;
            let mirror = |column: u32| n_columns as u32 - 1 - column;
            let of_tile =
                |column: u32| [[0, 1].map(|i| ahead(column, i)), [0, 1].map(|i| mirror(ahead(mirror(column), i)))];
            let read = own.iter().flat_map(|(_, column)| {
                let pairs = of_tile(*column).into_iter().zip(directions);
                pairs.filter(|(_, is_used)| *is_used).flat_map(|(pair, _)| pair)
            });
            let columns: Vec<u32> = read.chain(dense.iter().copied()).collect::<BTreeSet<u32>>().into_iter().collect();
            // Columns that no mode reads are not there.
            let find = |column: u32| columns.binary_search(&column).unwrap_or(usize::MAX);
            rows.push(TileRow {
                row: row as u32,
                has_density: columns.iter().map(|column| dense.contains(column)).collect(),
                read: own.iter().map(|(_, column)| of_tile(*column).map(|pair| pair.map(find))).collect(),
                columns,
            });
        }
        Self { rows, places }
    }

    /// Computes the tails of `density` on its tiles, in the order of rows.
    pub(crate) fn compute<T: Arithmetic>(
        &self,
        arch: Arch,
        table: &TailTable<T>,
        density: TileValues<'_, T>,
        mut tails: &mut [T],
    ) {
        let mut work = Vec::with_capacity(self.rows.len());
        for row in &self.rows {
            let cells;
            (cells, tails) = tails.split_at_mut(row.read.len() * CELLS);
            work.push((row, cells));
        }
        parallel::for_each(work.into_iter(), |(row, cells)| {
            arch.dispatch(RowPass { table, row, density, cells });
        });
    }

    /// Adds the tails of some tiles, of which `first` is the first, to their values.
    pub(crate) fn add<T: Arithmetic>(&self, first: usize, tails: &[T], cells: &mut [T]) {
        for (place, cells) in self.places[first..].iter().zip(cells.chunks_mut(CELLS)) {
            for (value, &tail) in cells.iter_mut().zip(&tails[place * CELLS..]) {
                *value = *value + tail;
            }
        }
    }

    /// Adds the tails of all tiles to their values.
    pub(crate) fn add_all<T: Arithmetic>(&self, tails: &[T], cells: &mut [T]) {
        parallel::for_each(cells.chunks_mut(BLOCK_TILES * CELLS).enumerate(), |(i, cells)| {
            self.add(i * BLOCK_TILES, tails, cells);
        });
    }
}

/// The tails on one row of tiles.
struct RowPass<'a, T> {
    table: &'a TailTable<T>,
    row: &'a TileRow,
    density: TileValues<'a, T>,
    cells: &'a mut [T],
}

impl<T: Arithmetic> WithSimd for RowPass<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { table, row, density, cells } = self;
        let (radius, n_columns) = (table.radius, density.tiles.extent()[0]);
        let height = TILE + 2 * radius;
        let patches = patches(row, density, radius);
        let mut sums: Vec<Columns> = vec![[[0.0; TILE]; TILE]; row.read.len()];
        let mut blocks: Vec<Columns> = vec![[[0.0; TILE]; TILE]; row.columns.len()];
        for mode in &table.modes {
            let mut patches = patches.chunks_exact(height);
            for (block, has_density) in blocks.iter_mut().zip(&row.has_density) {
                let patch = if *has_density { patches.next() } else { None };
                *block = patch.map_or([[0.0; TILE]; TILE], |patch| weighted::<S, T>(&mode.taps, patch));
            }
            sweep(mode, &row.columns, n_columns, &mut blocks);
            for (sums, read) in sums.iter_mut().zip(&row.read) {
                let read = read[usize::from(!mode.is_ahead)].map(|column| &blocks[column]);
                // From the cell that the tail reaches first.
                for i in 0..TILE {
                    let at = i + (radius + 1) % TILE;
                    let turn = |i: usize| if mode.is_ahead { i } else { TILE - 1 - i };
                    let values = &read[at / TILE][turn(at % TILE)];
                    sums[turn(i)].iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                }
            }
        }
        for (sums, cells) in sums.iter().zip(cells.chunks_exact_mut(CELLS)) {
            for (i, value) in cells.iter_mut().enumerate() {
                *value = T::rounded(sums[i % TILE][i / TILE]);
            }
        }
    }
}

/// The density on and around a row, in its columns that have one.
///
/// Each has `radius` rows of cells below the row of tiles, and as many above it.
fn patches<T: Arithmetic>(row: &TileRow, density: TileValues<'_, T>, radius: usize) -> Vec<[T; TILE]> {
    let dense = row.columns.iter().zip(&row.has_density).filter(|(_, has_density)| **has_density);
    let mut patches = Vec::new();
    let (reach, skipped) = (radius.div_ceil(TILE), (TILE - radius % TILE) % TILE);
    for (&column, _) in dense {
        let first = patches.len();
        for i in 0..=2 * reach {
            let tile_row = i64::from(row.row) + i as i64 - reach as i64;
            match density.tiles.find(i64::from(column), tile_row) {
                Some(tile) => {
                    patches.extend_from_slice(density.values[tile * CELLS..][..CELLS].as_chunks::<TILE>().0);
                }
                None => patches.extend_from_slice(&[[T::default(); TILE]; TILE]),
            }
        }
        patches.truncate(patches.len() - skipped);
        patches.drain(first..first + skipped);
    }
    patches
}

/// Sums of a column of cells with the weights of a tail, for each cell of a tile.
#[inline(always)]
fn weighted<S: Simd, T: Arithmetic>(taps: &[T], patch: &[[T; TILE]]) -> Columns {
    let mut sums = [[T::default(); TILE]; TILE];
    for (y, sums) in sums.iter_mut().enumerate() {
        for (&tap, row) in taps.iter().zip(&patch[y..]) {
            for (sum, &value) in sums.iter_mut().zip(row) {
                *sum = add_product::<S, T>(*sum, tap, value);
            }
        }
    }
    std::array::from_fn(|x| std::array::from_fn(|y| sums[y][x].into()))
}

/// Passes over the columns of a row. `blocks` have what each cell adds, and get z.
#[inline(always)]
fn sweep<T: Copy>(mode: &Mode<T>, columns: &[u32], n_columns: usize, blocks: &mut [Columns]) {
    let cells = |n_tiles: usize| (TILE * n_tiles) as f64;
    let decay = (-mode.rate).exp();
    let fallen = |n_tiles: usize| (-mode.rate * cells(n_tiles)).exp();
    let mut start = [0.0; TILE];
    for is_last in [false, true] {
        let mut state = start;
        let mut done = 0;
        for i in 0..columns.len() {
            let i = mode.turned(i, columns.len());
            let place = mode.turned(columns[i] as usize, n_columns);
            if place > done {
                let factor = fallen(place - done);
                for value in &mut state {
                    *value *= factor;
                }
            }
            done = place + 1;
            for x in 0..TILE {
                let column = &mut blocks[i][mode.turned(x, TILE)];
                for (value, added) in state.iter_mut().zip(column.iter_mut()) {
                    *value = decay * *value + *added;
                    if is_last {
                        *added = *value;
                    }
                }
            }
        }
        // The sum over all periods.
        let factor = fallen(n_columns - done) / -(-mode.rate * cells(n_columns)).exp_m1();
        start = state.map(|value| factor * value);
    }
}
