//! The tiles of a level that a rank has, and those that it reads.

use std::borrow::Cow;
use std::ops::Range;

use rc_comm::{Packed, Ranks};
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, TileSet};

use crate::tiles::deal::Deal;

/// The tiles of a level that a rank has, and those of other ranks that it reads.
///
/// Values are those of [`Part::tiles`]. The own values are in one piece, since a rank has a range of the curve that
/// tiles are sorted along. A single rank has all tiles and reads no others.
#[derive(Debug)]
pub(crate) struct Part {
    ranks: Ranks,
    tiles: TileSet,
    own: Range<usize>,
    /// Tiles that other ranks read, by rank.
    sent: Vec<(usize, Vec<usize>)>,
    /// Tiles that this rank reads, by rank.
    received: Vec<(usize, Vec<usize>)>,
}

impl Part {
    /// All tiles of a level, for a single rank or for each rank.
    pub(crate) fn whole(tiles: TileSet) -> Self {
        Self { ranks: Ranks::alone(), own: 0..tiles.len(), tiles, sent: Vec::new(), received: Vec::new() }
    }

    /// The tiles of `level` that this rank has, and those that it reads.
    ///
    /// It reads the tiles at the places of `read`, where there are tiles. The places are only computed if other ranks
    /// have tiles. All ranks call this together.
    pub(crate) fn new(ranks: &Ranks, level: &TileSet, deal: &Deal, read: impl FnOnce() -> Vec<[u32; 2]>) -> Self {
        let own = deal.range(ranks.rank());
        let find = |tiles: &TileSet, place: [u32; 2]| tiles.find(place[0].into(), place[1].into());
        let tiles = if own.len() == level.len() {
            level.clone()
        } else {
            let mut places = read();
            places.retain(|&place| find(level, place).is_some());
            places.extend_from_slice(&level.places()[own.clone()]);
            level.of_same_cell(level.sides(), places)
        };
        let first = level.places()[own.clone()].first().and_then(|&place| find(&tiles, place)).unwrap_or(0);
        let here = first..first + own.len();
        let mut received: Vec<(usize, Vec<usize>)> = Vec::new();
        let mut wanted = vec![Vec::new(); ranks.size()];
        for other in (0..here.start).chain(here.end..tiles.len()) {
            let tile = find(level, tiles.places()[other]).expect("all tiles are of the level");
            let owner = deal.owner(tile);
            u64::pack(&[tile as u64], &mut wanted[owner]);
            // Owners follow each other in the order of tiles.
            match received.last_mut().filter(|(rank, _)| *rank == owner) {
                Some((_, tiles)) => tiles.push(other),
                None => received.push((owner, vec![other])),
            }
        }
        let asked = ranks.exchange_all(wanted).into_iter().map(|bytes| u64::unpack_all(&bytes));
        let asked = asked.map(|tiles| tiles.into_iter().map(|tile| first + (tile as usize - own.start)).collect());
        let sent = asked.enumerate().filter(|(_, tiles): &(usize, Vec<usize>)| !tiles.is_empty()).collect();
        Self { ranks: ranks.clone(), tiles, own: here, sent, received }
    }

    /// The tiles of the values.
    pub(crate) fn tiles(&self) -> &TileSet {
        &self.tiles
    }

    /// The range of the own tiles.
    pub(crate) fn own(&self) -> Range<usize> {
        self.own.clone()
    }

    /// The places of the own tiles.
    pub(crate) fn own_places(&self) -> &[[u32; 2]] {
        &self.tiles.places()[self.own()]
    }

    /// The range of the own tiles' values among all values.
    pub(crate) fn own_cells(&self) -> Range<usize> {
        self.own.start * CELLS..self.own.end * CELLS
    }

    /// Number of values.
    pub(crate) fn n_cells(&self) -> usize {
        self.tiles.n_cells()
    }

    /// The values of all tiles, from the own values.
    ///
    /// All ranks call this together.
    pub(crate) fn exchanged<'a>(&self, own: &'a [f64]) -> Cow<'a, [f64]> {
        if self.sent.is_empty() && self.received.is_empty() {
            return Cow::Borrowed(own);
        }
        let mut all = vec![0.0; self.n_cells()];
        all[self.own_cells()].copy_from_slice(own);
        self.exchange(&mut all);
        Cow::Owned(all)
    }

    /// Fills in the values of tiles that other ranks have.
    ///
    /// All ranks call this together.
    pub(crate) fn exchange<T: Packed>(&self, values: &mut [T]) {
        let message = |(rank, tiles): &(usize, Vec<usize>)| {
            let mut bytes = Vec::with_capacity(tiles.len() * CELLS * T::BYTES);
            for tile in tiles {
                T::pack(&values[tile * CELLS..][..CELLS], &mut bytes);
            }
            (*rank, bytes)
        };
        let outgoing = self.sent.iter().map(message).collect();
        let from: Vec<usize> = self.received.iter().map(|(rank, _)| *rank).collect();
        for ((_, tiles), bytes) in self.received.iter().zip(self.ranks.exchange(outgoing, &from)) {
            for (tile, bytes) in tiles.iter().zip(bytes.chunks_exact(CELLS * T::BYTES)) {
                T::unpack(bytes, &mut values[tile * CELLS..][..CELLS]);
            }
        }
    }
}

/// Appends a tile to a message.
pub(crate) fn pack_tile(place: [u32; 2], values: &[f64; CELLS], message: &mut Vec<u8>) {
    Packed::pack(&place, message);
    Packed::pack(values, message);
}

/// The tiles of a message.
pub(crate) fn unpack_tiles(message: &[u8]) -> impl Iterator<Item = ([u32; 2], [f64; CELLS])> {
    message.chunks_exact(<[u32; 2]>::BYTES + <[f64; CELLS]>::BYTES).map(|tile| {
        let (mut place, mut values) = ([0; 2], [0.0; CELLS]);
        u32::unpack(tile, &mut place);
        f64::unpack(&tile[<[u32; 2]>::BYTES..], &mut values);
        (place, values)
    })
}

/// Tiles block by block. There may be more values than tiles.
pub(crate) fn blocks<'a, T>(
    places: &'a [[u32; 2]],
    cells: &'a mut [T],
) -> impl Iterator<Item = (&'a [[u32; 2]], &'a mut [T])> {
    places.chunks(BLOCK_TILES).zip(cells.chunks_mut(BLOCK_CELLS))
}

/// The own tiles of a level, block by block, from the values of all tiles.
pub(crate) fn own_blocks<'a, T>(
    part: &'a Part,
    cells: &'a mut [T],
) -> impl Iterator<Item = (&'a [[u32; 2]], &'a mut [T])> {
    blocks(part.own_places(), &mut cells[part.own_cells()])
}

/// Appends the places at most `margin` tiles from a square of tiles.
///
/// The square is between the places `first` and `last`, both included. The level is periodic, with `extent` tiles along
/// both axes.
pub(crate) fn append_around(
    places: &mut Vec<[u32; 2]>,
    (first, last): ([u32; 2], [u32; 2]),
    margin: usize,
    extent: [usize; 2],
) {
    let margin = margin as i64;
    let along = |axis: usize| {
        let n = extent[axis] as i64;
        let range = i64::from(first[axis]) - margin..=i64::from(last[axis]) + margin;
        range.take(extent[axis]).map(move |i| i.rem_euclid(n) as u32)
    };
    for row in along(1) {
        places.extend(along(0).map(|column| [column, row]));
    }
}
