//! The ranges in which the tiles of a level are dealt among ranks.
//!
//! They follow the order of the tiles, which is that of the Morton curve.

use std::ops::Range;

use rc_comm::Ranks;
use rc_quadtree::TileSet;

/// Ranges begin at multiples of this number of tiles.
///
/// Sums are over blocks of 16 and of 64 tiles, and a block is never divided.
const AT_ONCE: usize = 64;

/// The ranges of tiles that ranks have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Deal {
    /// The first tile of each rank, and last the number of tiles.
    starts: Vec<usize>,
}

impl Deal {
    /// A deal of `n` tiles in nearly equal numbers.
    pub(crate) fn equal(n: usize, ranks: &Ranks) -> Self {
        let size = ranks.size();
        let start = |rank: usize| (n as u128 * rank as u128 / size as u128) as usize / AT_ONCE * AT_ONCE;
        Self { starts: (0..size).map(start).chain([n]).collect() }
    }

    /// The deal of a coarser level. `self` is the deal of the level `finer`.
    ///
    /// A rank has about the tiles over those that it has of `finer`.
    pub(crate) fn of_coarser(&self, finer: &TileSet, coarser: &TileSet) -> Self {
        let (fine, coarse) = (finer.extent(), coarser.extent());
        let mut next = 0;
        let start = |(rank, &tile): (usize, &usize)| {
            let over = finer.places().get(tile).map(|place| {
                let [column, row] = [0, 1].map(|axis| (place[axis] as usize * coarse[axis] / fine[axis]) as i64);
                coarser.find(column, row)
            });
            next = match over {
                _ if rank == 0 => 0,
                // Where the order of the levels differs, a range may be empty.
                Some(over) => over.map_or(next, |over| over.max(next)),
                None => coarser.len(),
            };
            next
        };
        Self { starts: self.starts.iter().enumerate().map(start).collect() }
    }

    /// The tiles of a rank.
    pub(crate) fn range(&self, rank: usize) -> Range<usize> {
        self.starts[rank]..self.starts[rank + 1]
    }

    /// The rank that has the tile with this index.
    pub(crate) fn owner(&self, tile: usize) -> usize {
        self.starts.partition_point(|&start| start <= tile) - 1
    }
}

#[cfg(test)]
mod tests {
    use rc_comm::run_threads;
    use rc_core::testing::quasi_random;

    use super::*;

    #[test]
    fn every_tile_of_every_level_has_one_owner() {
        for (sides, threshold) in [([1024, 1024], 0.3), ([1024, 512], 0.05), ([256, 2048], 0.9), ([64, 64], 0.0)] {
            let [columns, rows] = [sides[0] / 8, sides[1] / 8];
            let chosen = (0..columns * rows).filter(|&i| quasi_random(i) >= threshold);
            let finest = TileSet::new(sides, chosen.map(|i| [(i % columns) as u32, (i / columns) as u32]).collect());
            for size in [2, 3, 8] {
                let deals = run_threads(size, |ranks| Deal::equal(finest.len(), &ranks)).expect("all ranks end");
                let mut deal = deals[0].clone();
                assert!(deals.iter().all(|other| *other == deal));
                let most = (0..size).map(|rank| deal.range(rank).len()).max().expect("ranks");
                assert!(most <= finest.len().div_ceil(size) + 2 * AT_ONCE, "{most} of {}", finest.len());
                let mut level = finest.clone();
                loop {
                    let ranges: Vec<_> = (0..size).map(|rank| deal.range(rank)).collect();
                    assert_eq!((ranges[0].start, ranges[size - 1].end), (0, level.len()), "{ranges:?}");
                    assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start), "{ranges:?}");
                    let all = (0..level.len()).all(|tile| deal.range(deal.owner(tile)).contains(&tile));
                    assert!(all, "{ranges:?}");
                    if !level.sides().iter().all(|side| side.is_multiple_of(16)) {
                        break;
                    }
                    let coarser = level.parents(3);
                    deal = deal.of_coarser(&level, &coarser);
                    level = coarser;
                }
            }
        }
    }
}
