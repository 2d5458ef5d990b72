//! Rows of a field over ranks.
//!
//! Tiles of any rank are brought together, a band of rows at a time.

use std::ops::Range;

use rc_comm::{Packed, Ranks};
use rc_quadtree::{CELLS, TILE, TileSet, put_tile};

/// The receiver of the rows of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Receiver {
    /// Rank 0 gets all rows. Without other ranks it is the only one.
    First,
    /// Each rank gets some rows that follow each other.
    Each,
}

/// The rows of a field that are handed out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rows {
    /// Whether they are rows of the grid of the smallest elements. Ranks do not share these.
    pub(crate) finest: bool,
    pub(crate) receiver: Receiver,
}

impl Rows {
    /// Rows of the grid on which the solution is a mean.
    pub(crate) fn on_grid(receiver: Receiver) -> Self {
        Self { finest: false, receiver }
    }

    /// Rows of the grid of the smallest elements.
    pub(crate) fn finest() -> Self {
        Self { finest: true, receiver: Receiver::First }
    }
}

/// Minimum number of cells of a band.
const BAND_CELLS: usize = 1_000_000;

/// The bands of a level: rows of tiles, and the rank that gets them.
pub(crate) fn bands(tiles: &TileSet, ranks: &Ranks, receiver: Receiver) -> impl Iterator<Item = (Range<usize>, usize)> {
    let ([nx, _], [_, n_rows]) = (tiles.sides(), tiles.extent());
    // With each band, all tiles of the level are evaluated again. With bands of as many cells, this doubles the work
    // and the memory of one evaluation.
    let of_level = ranks.maximum((tiles.places().len() * CELLS) as f64, 0.0) as usize;
    let at_once = (BAND_CELLS.max(of_level) / (TILE * nx)).max(1);
    let (n_bands, size) = (n_rows.div_ceil(at_once), ranks.size());
    (0..n_bands).map(move |band| {
        let to = match receiver {
            Receiver::First => 0,
            Receiver::Each => band * size / n_bands,
        };
        (band * at_once..((band + 1) * at_once).min(n_rows), to)
    })
}

/// Tiles, in the order of their rows.
pub(crate) struct TilesByRow(Vec<(u32, usize)>);

impl TilesByRow {
    pub(crate) fn new(places: &[[u32; 2]]) -> Self {
        let mut rows: Vec<(u32, usize)> = places.iter().enumerate().map(|(tile, place)| (place[1], tile)).collect();
        rows.sort_unstable();
        Self(rows)
    }

    /// The tiles of a band.
    pub(crate) fn of(&self, band: &Range<usize>) -> impl Iterator<Item = usize> + Clone {
        let at = |row: usize| self.0.partition_point(|(other, _)| (*other as usize) < row);
        self.0[at(band.start)..at(band.end)].iter().map(|(_, tile)| *tile)
    }
}

/// Hands the rows of a band to the rank that gets them.
///
/// `take` gets the rows of cells of one row of tiles at a time, with the index of the first row. They are zero where
/// there is no tile. `own` are the tiles that this rank has. All ranks call this together.
pub(crate) fn hand_out<'v, E>(
    (tiles, ranks): (&TileSet, &Ranks),
    (band, to): (Range<usize>, usize),
    own: impl Iterator<Item = ([u32; 2], &'v [f64])>,
    take: &mut impl FnMut(usize, &[f64]) -> Result<(), E>,
) -> Result<(), E> {
    let [nx, ny] = tiles.sides();
    if ranks.rank() != to {
        let mut bytes = Vec::new();
        for (place, values) in own {
            u32::pack(&place, &mut bytes);
            f64::pack(values, &mut bytes);
        }
        let _ = ranks.exchange(vec![(to, bytes)], &[]);
        return Ok(());
    }
    let mut cells = vec![0.0; band.len() * TILE * nx];
    let mut put = |[column, row]: [u32; 2], values: &[f64]| {
        let first = (row as usize - band.start) * TILE * nx;
        put_tile(&mut cells[first..first + TILE * nx], nx, column as usize, values);
    };
    own.for_each(|(place, values)| put(place, values));
    let others: Vec<usize> = (0..ranks.size()).filter(|&rank| rank != to).collect();
    for bytes in ranks.exchange(Vec::new(), &others) {
        for message in bytes.chunks_exact(2 * u32::BYTES + CELLS * f64::BYTES) {
            let (mut place, mut values) = ([0; 2], [0.0; CELLS]);
            u32::unpack(message, &mut place);
            f64::unpack(&message[2 * u32::BYTES..], &mut values);
            put(place, &values);
        }
    }
    for (row, rows) in band.zip(cells.chunks_exact(TILE * nx)) {
        take(row * TILE, &rows[..TILE.min(ny - row * TILE) * nx])?;
    }
    Ok(())
}
