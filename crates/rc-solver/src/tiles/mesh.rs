//! A mesh whose vectors are dealt among ranks.

use std::borrow::Cow;
use std::ops::{Deref, Range};

use rc_comm::{Packed, Ranks};
use rc_quadtree::{CELLS, Elements, TileSet};

use crate::tiles::deal::Deal;
use crate::tiles::part::{Part, append_around};

/// The elements of a mesh, which all ranks know, and those that this rank has.
///
/// A vector has a value for each element that this rank has. A single rank has all elements. Over ranks, all elements
/// have one size.
#[derive(Clone, Debug)]
pub(crate) struct Mesh {
    elements: Elements,
    ranks: Ranks,
}

/// Values on the elements that a rank has and on those around them.
pub(crate) struct Surroundings<'a> {
    pub(crate) elements: Cow<'a, Elements>,
    pub(crate) values: Cow<'a, [f64]>,
    /// The first own tile of the finest level.
    first: usize,
}

impl From<Elements> for Mesh {
    /// A mesh whose elements all belong to this rank.
    fn from(elements: Elements) -> Self {
        Self { elements, ranks: Ranks::alone() }
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
        debug_assert!(ranks.are_alone() || elements.levels().len() == 1, "elements of one size");
        Self { elements, ranks: ranks.clone() }
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

    /// The tiles of the finest level that this rank has.
    pub(crate) fn own_tiles(&self) -> Range<usize> {
        self.deal().range(self.ranks.rank())
    }

    /// The range of the values that this rank has among those of the whole mesh.
    pub(crate) fn own(&self) -> Range<usize> {
        if self.ranks.are_alone() {
            return 0..self.elements.len();
        }
        let tiles = self.own_tiles();
        tiles.start * CELLS..tiles.end * CELLS
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
        let levels = self.levels().iter().enumerate();
        levels.map(|(coarser, tiles)| {
            if self.ranks.are_alone() {
                (coarser, tiles.places(), self.cells(coarser))
            } else {
                (coarser, &tiles.places()[self.own_tiles()], 0..self.n_own())
            }
        })
    }

    /// Values on the elements of `to`, as [`Elements::moved`] gives them.
    ///
    /// Over ranks they go to the ranks that have the tiles there.
    pub(crate) fn moved(&self, to: &Self, values: &[f64], elsewhere: f64) -> Vec<f64> {
        if self.ranks.are_alone() {
            return self.elements.moved(&to.elements, values, elsewhere);
        }
        let places = &self.finest().places()[self.own_tiles()];
        to.delivered(places.iter().copied().zip(values.chunks_exact(CELLS)), elsewhere)
    }

    /// The mesh of the tiles for which `wanted` is true.
    ///
    /// `wanted` gets the sides of the level in cells, the place, and the range of the values.
    pub(crate) fn chosen(&self, wanted: impl Fn([usize; 2], [u32; 2], Range<usize>) -> bool) -> Self {
        if self.ranks.are_alone() {
            return self.elements.filtered(wanted).into();
        }
        let (sides, own) = (self.finest().sides(), self.own_tiles());
        let tiles = self.finest().places()[own].iter().enumerate();
        let chosen = tiles.filter(|&(tile, &place)| wanted(sides, place, tile * CELLS..(tile + 1) * CELLS));
        let places = chosen.map(|(_, &place)| place).collect();
        let tiles = Self::tiles_of_places(sides, places, &self.ranks).with_boundary(self.finest().boundary());
        Self::new(Elements::uniform(tiles), &self.ranks)
    }

    /// A vector from tiles of any rank, with `elsewhere` on all others.
    ///
    /// Tiles that the mesh does not have are dropped. All ranks call this together.
    pub(crate) fn delivered<'v>(&self, tiles: impl Iterator<Item = ([u32; 2], &'v [f64])>, elsewhere: f64) -> Vec<f64> {
        let (deal, own) = (self.deal(), self.own_tiles());
        let mut result = vec![elsewhere; self.n_own()];
        let mut outgoing = vec![Vec::new(); self.ranks.size()];
        for ([column, row], values) in tiles {
            let Some(tile) = self.finest().find(column.into(), row.into()) else { continue };
            if own.contains(&tile) {
                result[(tile - own.start) * CELLS..][..CELLS].copy_from_slice(values);
            } else {
                let message = &mut outgoing[deal.owner(tile)];
                u64::pack(&[tile as u64], message);
                f64::pack(values, message);
            }
        }
        for bytes in self.ranks.exchange_all(outgoing) {
            for message in bytes.chunks_exact(u64::BYTES + CELLS * f64::BYTES) {
                let mut tile = [0];
                u64::unpack(message, &mut tile);
                f64::unpack(&message[u64::BYTES..], &mut result[(tile[0] as usize - own.start) * CELLS..][..CELLS]);
            }
        }
        result
    }

    /// A vector with the values of the neighbours of all own tiles.
    ///
    /// All ranks call this together.
    pub(crate) fn surroundings<'a>(&'a self, values: &'a [f64]) -> Surroundings<'a> {
        if self.ranks.are_alone() {
            let (elements, values) = (Cow::Borrowed(&self.elements), Cow::Borrowed(values));
            return Surroundings { elements, values, first: 0 };
        }
        let part = self.part();
        let mut all = vec![0.0; part.n_cells()];
        all[part.own_cells()].copy_from_slice(values);
        part.exchange(&mut all);
        let elements = Elements::uniform(part.tiles().clone());
        Surroundings { elements: Cow::Owned(elements), values: Cow::Owned(all), first: part.own().start }
    }

    /// The own tiles with their neighbours.
    fn part(&self) -> Part {
        let finest = self.finest();
        let mut around = Vec::new();
        for &place in &finest.places()[self.own_tiles()] {
            append_around(&mut around, (place, place), 1, finest.extent());
        }
        Part::new(&self.ranks, finest, &self.deal(), around)
    }

    /// The tiles of [`TileSet::on_coarser`], for tiles that all ranks have.
    ///
    /// Each rank checks some of them. All ranks call this together.
    pub(crate) fn on_coarser(&self, tiles: &TileSet, sides: [usize; 2], halo: usize) -> TileSet {
        if self.ranks.are_alone() {
            return tiles.on_coarser(sides, halo);
        }
        let own = Deal::equal(tiles.len(), &self.ranks).range(self.ranks.rank());
        let own = tiles.of_same_cell(tiles.sides(), tiles.places()[own].to_vec());
        let mine = own.on_coarser(sides, halo).places().to_vec();
        Self::tiles_of_places(sides, mine, &self.ranks).with_boundary(tiles.boundary())
    }

    /// The tiles of all ranks, from the tiles of each.
    ///
    /// All ranks call this together.
    pub(crate) fn tiles_of_places(sides: [usize; 2], mine: Vec<[u32; 2]>, ranks: &Ranks) -> TileSet {
        let flat = ranks.concatenate(mine.into_iter().flatten().collect());
        TileSet::new(sides, flat.as_chunks::<2>().0.to_vec())
    }
}

impl Surroundings<'_> {
    /// The own tiles of the finest level.
    pub(crate) fn own_tiles(&self, mesh: &Mesh) -> Range<usize> {
        self.first..self.first + mesh.own_tiles().len()
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
            mesh.finest().places()[mesh.own_tiles()].iter().map(of_tile).collect::<Vec<_>>()
        };
        let alone = patches(Ranks::alone());
        for size in [2, 5] {
            assert_eq!(run_threads(size, patches).expect("all ranks end").concat(), alone, "{size} ranks");
        }
    }
}
