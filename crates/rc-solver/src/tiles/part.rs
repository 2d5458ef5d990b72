//! The tiles of a level that a rank has, and those that it reads.

use std::ops::Range;

use rc_comm::{Packed, Ranks};
use rc_quadtree::{CELLS, TileSet};

use crate::tiles::deal::Deal;

/// The tiles of a level that a rank has, and those that it reads.
///
/// It reads tiles of other ranks. A single rank has all tiles. Values are those of [`Part::tiles`]. The own values are
/// in one piece, since a rank has a range of the curve that tiles are sorted along.
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
    /// It reads the tiles at the `read` places, where there are tiles. All ranks call this together.
    pub(crate) fn new(ranks: &Ranks, level: &TileSet, deal: &Deal, read: Vec<[u32; 2]>) -> Self {
        let own = deal.range(ranks.rank());
        let find = |place: [u32; 2]| level.find(place[0].into(), place[1].into());
        let mut places = read;
        places.retain(|&place| find(place).is_some());
        places.extend_from_slice(&level.places()[own.clone()]);
        let tiles = level.of_same_cell(level.sides(), places);
        let first = level.places().get(own.start).filter(|_| !own.is_empty());
        let first = first.and_then(|place| tiles.find(place[0].into(), place[1].into())).unwrap_or(0);
        let mut received: Vec<(usize, Vec<usize>)> = Vec::new();
        let mut wanted = vec![Vec::new(); ranks.size()];
        for (here, tile) in tiles.places().iter().enumerate().filter_map(|(here, &place)| Some((here, find(place)?))) {
            if own.contains(&tile) {
                continue;
            }
            let owner = deal.owner(tile);
            u64::pack(&[tile as u64], &mut wanted[owner]);
            // Owners follow each other in the order of tiles.
            match received.last_mut().filter(|(rank, _)| *rank == owner) {
                Some((_, tiles)) => tiles.push(here),
                None => received.push((owner, vec![here])),
            }
        }
        let asked = ranks.exchange_all(wanted).into_iter().map(|bytes| u64::unpack_all(&bytes));
        let here = |tile: u64| first + (tile as usize - own.start);
        let sent = asked.map(|tiles| tiles.into_iter().map(here).collect::<Vec<_>>()).enumerate();
        let sent = sent.filter(|(_, tiles)| !tiles.is_empty()).collect();
        Self { ranks: ranks.clone(), tiles, own: first..first + own.len(), sent, received }
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

    /// Fills in the values of tiles that other ranks have.
    ///
    /// All ranks call this together.
    pub(crate) fn exchange<T: Packed>(&self, values: &mut [T]) {
        if self.ranks.are_alone() {
            return;
        }
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
