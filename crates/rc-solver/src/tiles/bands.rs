//! Rows of a field over ranks.
//!
//! Tiles of any rank are brought together, a band of rows at a time.

use std::ops::Range;

use rc_quadtree::{CELLS, TILE, put_tile};

use crate::solution::rows::{Halted, Receiver, TakeRows};
use crate::tiles::mesh::Mesh;
use crate::tiles::part::{pack_tile, unpack_tiles};

/// Minimum number of cells of a band.
const BAND_CELLS: usize = 1_000_000;

/// The bands of the finest level: rows of tiles, and the rank that gets them.
pub(crate) fn bands(mesh: &Mesh, receiver: Receiver) -> impl Iterator<Item = (Range<usize>, usize)> {
    let ([nx, _], [_, n_rows]) = (mesh.finest().sides(), mesh.finest().extent());
    // With each band, all tiles of the level are evaluated again. With bands of as many cells, this doubles the work
    // and the memory of one evaluation.
    let at_once = (BAND_CELLS.max(mesh.finest().n_cells()) / (TILE * nx)).max(1);
    let (n_bands, size) = (n_rows.div_ceil(at_once), mesh.ranks().size());
    (0..n_bands).map(move |band| {
        let to = match receiver {
            Receiver::First => 0,
            Receiver::Each => band * size / n_bands,
        };
        (band * at_once..((band + 1) * at_once).min(n_rows), to)
    })
}

/// Hands the rows of a band to the rank that gets them.
///
/// `take` gets the rows of cells of one row of tiles at a time, with the index of the first row. They are zero where
/// there is no tile. `values` are those of this rank's tiles. All ranks call this together.
pub(crate) fn hand_out(
    (mesh, values): (&Mesh, &[f64]),
    (band, to): (Range<usize>, usize),
    take: TakeRows<'_>,
) -> Result<(), Halted> {
    let ([nx, ny], ranks) = (mesh.finest().sides(), mesh.ranks());
    let own = mesh.own_places().iter().zip(values.as_chunks::<CELLS>().0);
    let own = own.filter(|([_, row], _)| band.contains(&(*row as usize)));
    if ranks.rank() != to {
        let mut bytes = Vec::new();
        own.for_each(|(&place, values)| pack_tile(place, values, &mut bytes));
        let _ = ranks.exchange(vec![(to, bytes)], &[]);
        return Ok(());
    }
    let mut cells = vec![0.0; band.len() * TILE * nx];
    let mut put = |[column, row]: [u32; 2], values: &[f64; CELLS]| {
        let first = (row as usize - band.start) * TILE * nx;
        put_tile(&mut cells[first..first + TILE * nx], nx, column as usize, values);
    };
    own.for_each(|(&place, values)| put(place, values));
    let others: Vec<usize> = (0..ranks.size()).filter(|&rank| rank != to).collect();
    for bytes in ranks.exchange(Vec::new(), &others) {
        unpack_tiles(&bytes).for_each(|(place, values)| put(place, &values));
    }
    for (row, rows) in band.zip(cells.chunks_exact(TILE * nx)) {
        take(row * TILE, &rows[..TILE.min(ny - row * TILE) * nx])?;
    }
    Ok(())
}
