//! The tiles of all levels between the base grid and the finest elements.

use std::ops::Range;
use std::sync::Arc;

use rc_quadtree::{Elements, TILE, TileSet};

use crate::descent::layout::BlockLayout;
use crate::tiles::base::Base;
use crate::tiles::ladder;
use crate::tiles::ladder::sides_of;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::base_part::BasePart;
use crate::tiles::operator::coarse::Leaves;
use crate::tiles::part::{Part, append_around};

/// The tiles of all levels, coarsest first.
///
/// The first level is the whole base grid. The last has the finest elements.
pub(crate) struct Hierarchy {
    base: Base,
    reach: Reach,
    mesh: Mesh,
    /// The division of vectors on the mesh into blocks.
    layout: BlockLayout,
    /// The elements that operators keep values for, on levels that have the operator's period.
    ///
    /// They are those of this rank, and those of other ranks that it reads.
    elements: Elements,
    /// The blocks of a vector: their coarseness and their tiles.
    ///
    /// The coarseness is relative to the finest level.
    pub(crate) blocks: Vec<(usize, Range<usize>)>,
    /// The parts with the densities of each level, including those of coarser elements.
    ///
    /// On the finest level they are its elements.
    pub(crate) levels: Vec<Part>,
    /// The part of the base grid that this rank computes.
    pub(crate) base_part: BasePart,
    /// The elements that are 2, 4, … times as large as the finest.
    pub(crate) leaves: Vec<Leaves>,
}

/// Number of cells of a level that values reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reach {
    /// Reach of filters, between levels and within one.
    pub(crate) filter: usize,
    /// Reach of stencils.
    pub(crate) stencil: usize,
}

impl Hierarchy {
    /// The levels over `elements` down to the base grid.
    ///
    /// Each has the tiles that filters need. The sides of the base grid must be multiples of 8. The coarsest elements
    /// must be finer than the base grid's. Elements whose sizes differ by more than a factor of 2 must be farther apart
    /// than stencils of the level between them reach.
    pub(crate) fn new(base: impl Into<Base>, mesh: impl Into<Mesh>, reach: Reach) -> Self {
        let (base, mesh) = (base.into(), mesh.into());
        let elements = in_period(base, mesh.elements());
        let mut levels = vec![elements.finest().clone()];
        let [nx, ny] = mesh.elements().finest().sides();
        let finest = base.grid().with_elements(nx, ny).expect("a level of a checked grid");
        for level in (1..ladder::n_levels(base.grid(), finest)).rev() {
            let sides = base.period_of(sides_of(ladder::doubled(base.grid(), level)));
            let parents = mesh.on_coarser(&levels[levels.len() - 1], sides, reach.filter);
            levels.push(match elements.levels().get(levels.len()) {
                Some(leaves) => parents.with(&leaves.around(reach.filter)),
                None => parents,
            });
        }
        levels.push(TileSet::full(base.period()));
        levels.reverse();
        debug_assert!(elements.levels().len() < levels.len(), "no elements are on the base grid");
        let pairs = elements.levels().windows(2);
        let leaves = pairs.map(|pair| Leaves::new(pair[1].clone(), &pair[0], reach.stencil)).collect();
        let (levels, base_part) = dealt(&levels, &mesh, reach);
        let finest = &levels[levels.len() - 1];
        let layout = mesh.layout();
        let blocks = blocks(&mesh, finest.own().start, &layout);
        let tiles = std::iter::once(finest.tiles()).chain(&elements.levels()[1..]);
        let elements = Elements::new(tiles.cloned().collect());
        Self { base, reach, mesh, layout, elements, blocks, levels, base_part, leaves }
    }

    /// The elements that operators keep values for, on levels that have the operator's period.
    pub(crate) fn elements(&self) -> &Elements {
        &self.elements
    }

    /// The division of vectors on the mesh into blocks.
    pub(crate) fn layout(&self) -> &BlockLayout {
        &self.layout
    }

    /// The range of the own values among those of [`Hierarchy::elements`].
    pub(crate) fn own_values(&self) -> Range<usize> {
        let first = self.finest().own_cells().start;
        first..first + self.mesh.n_own()
    }

    /// Whether elements cover the operator's period.
    pub(crate) fn cover_period(&self) -> bool {
        !self.base.is_free() && self.mesh.cover_cell()
    }

    /// The tiles of the finest level.
    pub(crate) fn finest(&self) -> &Part {
        &self.levels[self.n_levels()]
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.base
    }

    /// The hierarchy for the preconditioner, which halves every level.
    ///
    /// The finest level may have fewer than twice the elements of the level below it. A strip without elements, along
    /// the seam, then takes the place of the missing ones.
    pub(crate) fn halved(self: &Arc<Self>) -> Arc<Self> {
        let (sides, finest) = (sides_of(ladder::doubled(self.base.grid(), self.n_levels())), self.mesh.finest());
        if finest.sides() == sides {
            return Arc::clone(self);
        }
        let tiles = finest.of_same_cell(sides, finest.places().to_vec());
        let mesh = Mesh::new(Elements::uniform(tiles), self.mesh.ranks());
        Arc::new(Self::new(self.base, mesh, self.reach))
    }

    /// Number of levels above the base grid.
    pub(crate) fn n_levels(&self) -> usize {
        self.levels.len() - 1
    }

    /// The elements of a level: their range in a vector, and their tiles.
    pub(crate) fn elements_of(&self, level: usize) -> Option<(Range<usize>, &TileSet)> {
        let coarser = self.n_levels() - level;
        self.elements().levels().get(coarser).map(|tiles| (self.elements().cells(coarser), tiles))
    }
}

/// The elements, on levels that have the operator's period.
///
/// Tiles keep their order, so values keep their places.
fn in_period(base: Base, elements: &Elements) -> Elements {
    if !base.is_free() {
        return elements.clone();
    }
    let level = |tiles: &TileSet| TileSet::new(base.period_of(tiles.sides()), tiles.places().to_vec());
    Elements::new(elements.levels().iter().map(level).collect())
}

/// The parts of this rank in all levels, coarsest first, and in the base grid.
fn dealt(levels: &[TileSet], mesh: &Mesh, reach: Reach) -> (Vec<Part>, BasePart) {
    let ranks = mesh.ranks();
    // Tiles around one tile on its level or a coarser one, and around the four tiles under one.
    let near = reach.filter.max(reach.stencil).div_ceil(TILE);
    let under = (2 * reach.filter).div_ceil(TILE);
    // The tiles of the base grid that have a density.
    let active = mesh.on_coarser(&levels[1], levels[0].sides(), under * TILE / 2);
    let with_density = |level: usize| if level == 0 { &active } else { &levels[level] };
    let mut deals = vec![mesh.deal()];
    for finer in (1..levels.len()).rev() {
        deals.push(deals[deals.len() - 1].of_coarser(&levels[finer], with_density(finer - 1)));
    }
    deals.reverse();
    let own = |level: usize| &with_density(level).places()[deals[level].range(ranks.rank())];
    let part = |level: usize| {
        let (extent, mut read) = (levels[level].extent(), Vec::new());
        Part::new(ranks, &levels[level], &deals[level], || {
            for &place in own(level) {
                append_around(&mut read, (place, place), near, extent);
            }
            for &place in if level + 1 < levels.len() { own(level + 1) } else { &[] } {
                let over = place.map(|i| i / 2);
                append_around(&mut read, (over, over), near, extent);
            }
            for &place in own(level - 1) {
                append_around(&mut read, (place.map(|i| 2 * i), place.map(|i| 2 * i + 1)), under, extent);
            }
            read
        })
    };
    let parts = std::iter::once(Part::whole(levels[0].clone())).chain((1..levels.len()).map(part)).collect();
    let own = deals[0].range(ranks.rank());
    (parts, BasePart::new(ranks, active, own))
}

/// The blocks of this rank's vectors. `first` is the index of its first tile of the finest level.
fn blocks(mesh: &Mesh, first: usize, layout: &BlockLayout) -> Vec<(usize, Range<usize>)> {
    let tiles = layout.ranges(mesh.n_own()).map(|values| mesh.tiles_of(values));
    let shifted = tiles.map(|(coarser, tiles, _)| match coarser {
        0 => (coarser, first + tiles.start..first + tiles.end),
        _ => (coarser, tiles),
    });
    shifted.collect()
}
