//! A mesh whose vectors are dealt among ranks.

use std::borrow::Cow;
use std::ops::{Deref, Range};
use std::sync::Arc;

use rc_comm::Ranks;
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, Elements, TileSet};

use crate::descent::values::Values;
use crate::parallel;
use crate::tiles::deal::Deal;
use crate::tiles::part::{Part, append_around, pack_tile, unpack_tiles};

/// The elements of a mesh, which all ranks know, and those that this rank has.
///
/// A vector has a value for each element that this rank has. The tiles of the finest level are dealt among ranks. There
/// are larger elements only if a single rank has the whole mesh.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    elements: Elements,
    ranks: Ranks,
    /// The tiles of the finest level that this rank has.
    own_tiles: Range<usize>,
    /// Ends of the blocks of vectors that are shorter than others ([`Mesh::thinned`]).
    block_ends: Option<Arc<[usize]>>,
}

/// Values on the elements that a rank has and on those around them.
pub(crate) struct Surroundings<'a> {
    pub(crate) elements: Cow<'a, Elements>,
    pub(crate) values: Cow<'a, [f64]>,
    /// The own tiles of the finest level.
    pub(crate) own_tiles: Range<usize>,
}

impl From<Elements> for Mesh {
    /// A mesh whose elements all belong to this rank.
    fn from(elements: Elements) -> Self {
        Self::new(elements, &Ranks::alone())
    }
}

impl Deref for Mesh {
    type Target = Elements;

    fn deref(&self) -> &Elements {
        &self.elements
    }
}

impl Mesh {
    /// A mesh whose elements are dealt anew.
    pub(crate) fn new(elements: Elements, ranks: &Ranks) -> Self {
        debug_assert!(ranks.size() == 1 || elements.levels().len() == 1, "elements of one size");
        let own_tiles = Deal::equal(elements.finest().len(), ranks).range(ranks.rank());
        Self { elements, ranks: ranks.clone(), own_tiles, block_ends: None }
    }

    /// The ranks.
    pub(crate) fn ranks(&self) -> &Ranks {
        &self.ranks
    }

    /// All elements.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    /// The deal of the tiles of the finest level.
    pub(crate) fn deal(&self) -> Deal {
        Deal::equal(self.finest().len(), &self.ranks)
    }

    /// The range of the values that this rank has among those of the whole mesh.
    pub(crate) fn own(&self) -> Range<usize> {
        let after = self.finest().len() - self.own_tiles.end;
        self.own_tiles.start * CELLS..self.elements.len() - after * CELLS
    }

    /// Number of values that this rank has.
    pub(crate) fn n_own(&self) -> usize {
        self.own().len()
    }

    /// The levels of which this rank has tiles, finest first.
    ///
    /// Each comes with its coarseness relative to the finest, the places of its own tiles, and the range of their
    /// values in vectors.
    pub(crate) fn own_levels(&self) -> impl Iterator<Item = (usize, &[[u32; 2]], Range<usize>)> {
        let first = self.own().start;
        self.levels().iter().enumerate().map(move |(coarser, tiles)| {
            let own = if coarser == 0 { self.own_tiles.clone() } else { 0..tiles.len() };
            let values = [own.start, own.end].map(|tile| self.cells(coarser).start + tile * CELLS - first);
            (coarser, &tiles.places()[own], values[0]..values[1])
        })
    }

    /// The places of the tiles of the finest level that this rank has.
    pub(crate) fn own_places(&self) -> &[[u32; 2]] {
        &self.finest().places()[self.own_tiles.clone()]
    }

    /// The tiles of a block of vectors, which this rank has: their level, their range there, and their places.
    ///
    /// The level is given by its coarseness. On the finest level, the range is among the own tiles.
    pub(crate) fn tiles_of(&self, block: Range<usize>) -> (usize, Range<usize>, &[[u32; 2]]) {
        let mut levels = self.own_levels();
        let found = levels.find(|(.., values)| values.contains(&block.start));
        let (coarser, places, values) = found.expect("levels begin with whole blocks");
        let [start, end] = [block.start, block.end.min(values.end)].map(|value| (value - values.start) / CELLS);
        (coarser, start..end, &places[start..end])
    }

    /// The `values` of the tile at a place of a level, if this rank has it.
    pub(crate) fn tile<'v>(
        &self,
        coarser: usize,
        [column, row]: [u32; 2],
        values: &'v [f64],
    ) -> Option<&'v [f64; CELLS]> {
        let (_, _, level) = self.own_levels().nth(coarser)?;
        let first = if coarser == 0 { self.own_tiles.start } else { 0 };
        let tile = self.levels()[coarser].find(column.into(), row.into())?.checked_sub(first)?;
        values[level].as_chunks().0.get(tile)
    }

    /// Ends of the blocks of vectors that are shorter than others.
    pub(crate) fn block_ends(&self) -> Option<Arc<[usize]>> {
        self.block_ends.clone()
    }

    /// The mesh of the tiles for which `wanted` is true, given the range of their values.
    ///
    /// Blocks of vectors lose the other tiles, and stay apart otherwise. Sums over blocks therefore keep their digits
    /// if values on the other tiles are zero. `None` for elements of several sizes or on several ranks.
    pub(crate) fn thinned(&self, wanted: impl Fn(Range<usize>) -> bool) -> Option<Self> {
        if self.levels().len() > 1 || self.ranks.size() > 1 {
            return None;
        }
        debug_assert!(self.block_ends.is_none(), "whole blocks");
        let (tiles, mut places, mut ends) = (self.finest(), Vec::new(), Vec::new());
        for (block, of_block) in tiles.places().chunks(BLOCK_TILES).enumerate() {
            let starts = (block * BLOCK_TILES * CELLS..).step_by(CELLS);
            let chosen = of_block.iter().zip(starts).filter(|&(_, first)| wanted(first..first + CELLS));
            places.extend(chosen.map(|(&place, _)| place));
            ends.push(places.len() * CELLS);
        }
        ends.dedup();
        let ends = if ends.first() == Some(&0) { &ends[1..] } else { &ends };
        let tiles = tiles.of_same_cell(tiles.sides(), places);
        Some(Self { block_ends: Some(ends.into()), ..Self::new(Elements::uniform(tiles), &self.ranks) })
    }

    /// The elements of this rank alone.
    fn own_elements(&self) -> Cow<'_, Elements> {
        if self.n_own() == self.elements.len() {
            return Cow::Borrowed(&self.elements);
        }
        let tiles = self.finest();
        Cow::Owned(Elements::uniform(tiles.of_same_cell(tiles.sides(), self.own_places().to_vec())))
    }

    /// Values on the elements of `to`, as [`Elements::moved`] gives them.
    ///
    /// They go to the ranks that have the tiles there. All ranks call this together.
    pub(crate) fn moved(&self, to: &Self, values: &[f64], elsewhere: f64) -> Vec<f64> {
        let mut result = self.own_elements().moved(&to.own_elements(), values, elsewhere);
        let own = self.own_places().iter().copied().zip(values.as_chunks().0);
        to.deliver(own.filter(|&(place, _)| to.own_tile(place).is_none()), &mut result);
        result
    }

    /// A vector on the elements of `to`, as [`Mesh::moved`] gives it.
    ///
    /// In single precision, all elements of both meshes have one size, and are on one rank.
    pub(crate) fn moved_vector(&self, to: &Self, values: &Values, elsewhere: f64) -> Values {
        match values {
            Values::Double(values) => Values::Double(self.moved(to, values, elsewhere)),
            Values::Single { origin, differences } => {
                let mut moved = vec![(elsewhere - origin) as f32; to.n_own()];
                let blocks = to.finest().places().chunks(BLOCK_TILES).zip(moved.chunks_mut(BLOCK_CELLS));
                parallel::for_each(blocks, |(places, cells)| {
                    for ([column, row], cells) in places.iter().zip(cells.chunks_mut(CELLS)) {
                        if let Some(tile) = self.finest().find((*column).into(), (*row).into()) {
                            cells.copy_from_slice(&differences[tile * CELLS..][..CELLS]);
                        }
                    }
                });
                Values::Single { origin: *origin, differences: moved }
            }
        }
    }

    /// The index of a tile of the finest level among those that this rank has.
    fn own_tile(&self, [column, row]: [u32; 2]) -> Option<usize> {
        let tile = self.finest().find(column.into(), row.into()).filter(|tile| self.own_tiles.contains(tile))?;
        Some(tile - self.own_tiles.start)
    }

    /// The mesh of the tiles for which `wanted` is true.
    ///
    /// `wanted` gets the sides of the level in cells, the place, and the range of the values. All ranks call this
    /// together.
    pub(crate) fn chosen(&self, wanted: impl Fn([usize; 2], [u32; 2], Range<usize>) -> bool) -> Self {
        let levels = self.own_levels().map(|(coarser, places, values)| {
            let tiles = &self.levels()[coarser];
            let chosen = places.iter().zip(values.step_by(CELLS));
            let chosen = chosen.filter(|&(&place, first)| wanted(tiles.sides(), place, first..first + CELLS));
            let chosen = chosen.map(|(&place, _)| place).collect();
            tiles.of_same_cell(tiles.sides(), self.ranks.concatenate(chosen))
        });
        Self::new(Elements::new(levels.collect()), &self.ranks)
    }

    /// Puts tiles of any rank into the vectors of the ranks that have them.
    ///
    /// Tiles that the mesh does not have are dropped. All ranks call this together.
    pub(crate) fn deliver<'v>(&self, tiles: impl Iterator<Item = ([u32; 2], &'v [f64; CELLS])>, vector: &mut [f64]) {
        let deal = self.deal();
        let mut outgoing = vec![Vec::new(); self.ranks.size()];
        for (place, values) in tiles {
            if let Some(tile) = self.own_tile(place) {
                vector[tile * CELLS..][..CELLS].copy_from_slice(values);
            } else if let Some(tile) = self.finest().find(place[0].into(), place[1].into()) {
                pack_tile(place, values, &mut outgoing[deal.owner(tile)]);
            }
        }
        for bytes in self.ranks.exchange_all(outgoing) {
            for (place, values) in unpack_tiles(&bytes) {
                let tile = self.own_tile(place).expect("tiles are sent to the rank that has them");
                vector[tile * CELLS..][..CELLS].copy_from_slice(&values);
            }
        }
    }

    /// A vector with the values of the neighbours of all own tiles.
    ///
    /// All ranks call this together.
    pub(crate) fn surroundings<'a>(&'a self, values: &'a [f64]) -> Surroundings<'a> {
        let (finest, mut around) = (self.finest(), Vec::new());
        let part = Part::new(&self.ranks, finest, &self.deal(), || {
            for &place in self.own_places() {
                append_around(&mut around, (place, place), 1, finest.extent());
            }
            around
        });
        let elements = if part.tiles().len() == finest.len() {
            Cow::Borrowed(&self.elements)
        } else {
            Cow::Owned(Elements::uniform(part.tiles().clone()))
        };
        Surroundings { elements, values: part.exchanged(values), own_tiles: part.own() }
    }

    /// The tiles of [`TileSet::on_coarser`], for tiles that all ranks have.
    ///
    /// Each rank checks some of them. All ranks call this together.
    pub(crate) fn on_coarser(&self, tiles: &TileSet, sides: [usize; 2], halo: usize) -> TileSet {
        let own = Deal::equal(tiles.len(), &self.ranks).range(self.ranks.rank());
        let mine = tiles.on_coarser(&tiles.places()[own], sides, halo).places().to_vec();
        tiles.of_same_cell(sides, self.ranks.concatenate(mine))
    }
}

#[cfg(test)]
mod tests {
    use rc_comm::run_threads;
    use rc_core::testing::quasi_random;

    use super::*;

    /// A mesh with about this part of the tiles of a level of 512² cells.
    fn mesh(part: f64, seed: usize, ranks: &Ranks) -> Mesh {
        let chosen = (0..64 * 64).filter(|i| quasi_random(7 * i + seed) < part);
        let tiles = TileSet::new([512, 512], chosen.map(|i| [(i % 64) as u32, (i / 64) as u32]).collect());
        Mesh::new(Elements::uniform(tiles), ranks)
    }

    fn values(n: usize) -> Vec<f64> {
        (0..n).map(|i| quasi_random(i) - 0.5).collect()
    }

    #[test]
    fn values_that_move_between_meshes_are_those_of_one_rank() {
        let all = values(64 * 64 * CELLS);
        let moved = |ranks: Ranks| {
            let (from, to) = (mesh(0.5, 1, &ranks), mesh(0.3, 2, &ranks));
            from.moved(&to, &all[from.own()], -1.0)
        };
        let alone = moved(Ranks::alone());
        assert!(alone.contains(&-1.0) && alone.iter().any(|&value| value > -0.6), "some tiles are new, others are not");
        for size in [2, 5] {
            let parts = run_threads(size, moved).expect("all ranks end");
            assert!(parts.iter().all(|part| part.len() < alone.len()));
            assert_eq!(parts.concat(), alone, "{size} ranks");
        }
    }

    #[test]
    fn the_neighbours_of_own_tiles_have_the_values_of_other_ranks() {
        let all = values(64 * 64 * CELLS);
        let patches = |ranks: Ranks| {
            let mesh = mesh(0.5, 3, &ranks);
            let around = mesh.surroundings(&all[mesh.own()]);
            let of_tile = |&place: &[u32; 2]| around.elements.around(&around.values, 0, place, -1.0);
            mesh.own_places().iter().map(of_tile).collect::<Vec<_>>()
        };
        let alone = patches(Ranks::alone());
        for size in [2, 5] {
            assert_eq!(run_threads(size, patches).expect("all ranks end").concat(), alone, "{size} ranks");
        }
    }
}
