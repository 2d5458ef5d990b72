//! One application of the multilevel operator.
//!
//! It goes up to the base grid, applies its convolution, and goes down again.

use std::borrow::Borrow;
use std::ops::Range;
use std::sync::Arc;

use pulp::Arch;
use rc_fft::{BLOCK_ROWS, Convolution, Instructions};
use rc_quadtree::{BLOCK_CELLS, CELLS, TILE};

use crate::descent::layout::BlockLayout;
use crate::descent::operators::BlockOperator;
use crate::grid::passes::{read_rows, write_rows};
use crate::parallel;
use crate::parallel::Tasks;
use crate::tiles::base::Base;
use crate::tiles::operator::coarse::Leaves;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::passes::{
    CoarseDensity, CoarseDisplacement, Displacement, Restriction, ShortRange, Targets, UnevenDisplacement,
    UnevenRestriction,
};
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::tables::Tables;
use crate::tiles::operator::tails::TileRows;
use crate::tiles::operator::tile_values::TileValues;
use crate::tiles::part::{Part, blocks, own_blocks};

/// The operator of some tables on one hierarchy.
///
/// Blocks of vectors have [`BLOCK_CELLS`] cells. Memory for vectors is taken when pressures are written. `B` is the
/// tables or a reference to them.
pub(crate) struct TileOperator<T, B> {
    hierarchy: Arc<Hierarchy>,
    tables: B,
    arch: Arch,
    convolution: Convolution<T>,
    source: Vec<T>,
    /// Densities and displacements of each level below the finest.
    densities: Vec<Vec<T>>,
    displacements: Vec<Vec<T>>,
    /// Values of the ghosts of each level of coarse elements.
    ghosts: Vec<Vec<T>>,
    /// The rows of tiles of the levels above the base grid, with the tails of stencils there. Empty at rest.
    tails: Vec<(TileRows, Vec<T>)>,
}

/// What another operator on the base grid and the elements may use and change between two applications.
pub(crate) struct Buffers<'a, T> {
    pub(crate) arch: Arch,
    pub(crate) convolution: &'a mut Convolution<T>,
    /// Room for values of the finest elements, including those of other ranks that this rank reads.
    pub(crate) finest: &'a mut [T],
    /// Room for two values of each cell of the levels below the finest. It may be made larger.
    pub(crate) of_levels: [&'a mut [Vec<T>]; 2],
}

impl<T: Real, B: Borrow<Tables<T>> + Sync> TileOperator<T, B> {
    /// The operator with the `tables` of the levels of `hierarchy`.
    ///
    /// Under a sliding surface, all elements have one size and are on one rank.
    pub(crate) fn new(hierarchy: Arc<Hierarchy>, tables: B) -> Self {
        let above_base = hierarchy.levels[1..].iter().zip(&tables.borrow().tails);
        let tails = above_base.map(|(part, table)| (table.rows(part.tiles()), Vec::new())).collect();
        Self {
            tails,
            arch: match Instructions::of_process() {
                Instructions::Best => Arch::new(),
                Instructions::Scalar | Instructions::Sse => Arch::Scalar,
            },
            convolution: Convolution::new(hierarchy.base().periodic_grid()),
            source: Vec::new(),
            densities: Vec::new(),
            displacements: Vec::new(),
            ghosts: Vec::new(),
            hierarchy,
            tables,
        }
    }

    /// Takes memory for vectors, if they have none.
    fn reserve(&mut self) {
        let hierarchy = &self.hierarchy;
        if self.source.is_empty() {
            let zeros = |part: &Part| vec![T::default(); part.n_cells()];
            let below_finest = &hierarchy.levels[..hierarchy.n_levels()];
            self.densities = below_finest.iter().map(zeros).collect();
            self.displacements = below_finest.iter().map(zeros).collect();
            self.ghosts = hierarchy.leaves.iter().map(|leaves| vec![T::default(); leaves.ghosts.n_cells()]).collect();
            self.source = vec![T::default(); hierarchy.elements().len()];
            for ((_, tails), part) in self.tails.iter_mut().zip(&hierarchy.levels[1..]) {
                *tails = zeros(part);
            }
        }
    }

    /// Buffers that another operator on the base grid and the elements may use and change.
    ///
    pub(crate) fn buffers(&mut self) -> Buffers<'_, T> {
        self.reserve();
        let Self { arch, convolution, source: finest, densities, displacements, .. } = self;
        Buffers { arch: *arch, convolution, finest, of_levels: [densities, displacements] }
    }

    /// The base grid.
    pub(crate) fn base(&self) -> Base {
        self.hierarchy.base()
    }

    /// The smooth remainder: the displacement of the cells of the base grid's period.
    ///
    /// It is that of the last [`BlockOperator::apply`], tile by tile, row-major.
    pub(crate) fn base_displacement(&self) -> &[T] {
        &self.displacements[0]
    }

    /// Frees the values of all levels but those that reading needs. Nothing is written any more.
    ///
    /// The displacement of the base grid is lost. Elements of several sizes read all levels.
    pub(crate) fn end(&mut self) {
        if self.hierarchy.leaves.is_empty() {
            let n_tails = self.tails.len().saturating_sub(1);
            self.tails[..n_tails].iter_mut().for_each(|(_, tails)| *tails = Vec::new());
            self.densities = Vec::new();
            let last = self.hierarchy.n_levels() - 1;
            self.displacements[..last].iter_mut().for_each(|values| *values = Vec::new());
        }
    }

    fn set_ghosts(&mut self) {
        let elements = self.hierarchy.elements();
        for (i, (leaves, ghosts)) in self.hierarchy.leaves.iter().zip(&mut self.ghosts).enumerate() {
            let values = &self.source[elements.cells(i + 1)];
            parallel::for_each(blocks(leaves.ghosts.places(), ghosts), |(places, cells)| {
                leaves.set_ghosts(values, places, cells);
            });
        }
    }

    /// Computes the densities of the levels between the finest and the base grid.
    fn restrict(&mut self) {
        let tables = self.tables.borrow();
        let (n_levels, arch) = (self.hierarchy.n_levels(), self.arch);
        let levels = &self.hierarchy.levels;
        for level in (1..n_levels).rev() {
            let (coarser, finer) = self.densities.split_at_mut(level + 1);
            let finer = TileValues::new(finer.first().unwrap_or(&self.source), levels[level + 1].tiles());
            let density = &mut coarser[level];
            parallel::for_each(own_blocks(&levels[level], density), |(places, cells)| {
                restrict(tables, (level, n_levels), finer, (arch, Targets { places, cells }));
            });
            if let Some((cells, tiles)) = self.hierarchy.elements_of(level) {
                let elements = TileValues::new(&self.source[cells], tiles);
                let pass = CoarseDensity { table: tables.coarse_table(n_levels - level), elements };
                parallel::for_each(own_blocks(&levels[level], density), |(places, cells)| {
                    (tables.sizes.passes.add_coarse)(arch, &pass, Targets { places, cells });
                });
            }
            levels[level].exchange(density);
        }
    }

    /// Computes the base grid: its density from level 1, its convolution, its displacement as tiles.
    fn convolve_base(&mut self) {
        let tables = self.tables.borrow();
        let (side, arch, levels) = (self.hierarchy.base().period()[0], self.arch, &self.hierarchy.levels);
        let finer = TileValues::new(self.densities.get(1).unwrap_or(&self.source), levels[1].tiles());
        let n_levels = self.hierarchy.n_levels();
        let tiles_per_block = BLOCK_ROWS / TILE * (side / TILE);
        let density = self.hierarchy.base_part.values(|places, cells| {
            restrict(tables, (0, n_levels), finer, (arch, Targets { places, cells }));
        });
        write_rows(&mut self.convolution, &|i, rows| {
            let mut cells = vec![T::default(); rows.len()];
            let places = &levels[0].tiles().places()[i * tiles_per_block..][..rows.len() / CELLS];
            density.copy(places, &mut cells);
            tiles_to_rows(&cells, rows, side);
        });
        tables.base.apply(&mut self.convolution);
        let blocks = Tasks::new(self.displacements[0].chunks_mut(BLOCK_ROWS * side));
        read_rows(&self.convolution, &|i, rows| blocks.run(i, |cells| rows_to_tiles(rows, cells, side)));
    }

    /// Computes the displacements of the levels between the base grid and the finest.
    fn prolong(&mut self) {
        let tables = self.tables.borrow();
        let (arch, levels) = (self.arch, &self.hierarchy.levels);
        for level in 1..self.hierarchy.n_levels() {
            let (coarser, finer) = self.displacements.split_at_mut(level);
            let pass = Displacement {
                table: &tables.levels[level - 1],
                density: TileValues::new(&self.densities[level], levels[level].tiles()),
                coarser: TileValues::new(&coarser[level - 1], levels[level - 1].tiles()),
            };
            parallel::for_each(own_blocks(&levels[level], &mut finer[0]), |(places, cells)| {
                (tables.sizes.passes.displace)(arch, &pass, Targets { places, cells });
            });
            if let Some((rows, tails)) = self.tails.get(level - 1) {
                rows.add_all(tails, &mut finer[0]);
            }
            levels[level].exchange(&mut finer[0]);
        }
    }

    /// Computes the tails of the stencils of all levels.
    fn compute_tails(&mut self) {
        let tables = self.tables.borrow();
        for (i, ((rows, tails), table)) in self.tails.iter_mut().zip(&tables.tails).enumerate() {
            let density = self.densities.get(i + 1).unwrap_or(&self.source);
            let density = TileValues::new(density, self.hierarchy.levels[i + 1].tiles());
            rows.compute(self.arch, table, density, tails);
        }
    }

    /// Writes the displacement of some tiles of the finest elements.
    fn displace_finest(&self, tiles: Range<usize>, cells: &mut [T]) {
        let tables = self.tables.borrow();
        let (levels, level) = (&self.hierarchy.levels, self.hierarchy.n_levels());
        let table = &tables.levels[level - 1];
        let density = TileValues::new(&self.source, levels[level].tiles());
        let coarser = TileValues::new(&self.displacements[level - 1], levels[level - 1].tiles());
        let first = tiles.start;
        let targets = Targets { places: &levels[level].tiles().places()[tiles], cells: &mut *cells };
        if let Some(uneven) = &tables.uneven {
            let pass = UnevenDisplacement { taps: &table.0, uneven, density, coarser };
            (tables.sizes.passes.displace_uneven)(self.arch, &pass, targets);
        } else {
            let pass = Displacement { table, density, coarser };
            (tables.sizes.passes.displace)(self.arch, &pass, targets);
        }
        if let Some((rows, tails)) = self.tails.last() {
            rows.add(first, tails, cells);
        }
    }

    /// Writes the displacement of some tiles of elements 2^`coarser` times as large as the finest.
    fn displace_coarse(&self, coarser: usize, tiles: Range<usize>, cells: &mut [T]) {
        let tables = self.tables.borrow();
        let Hierarchy { levels, leaves, .. } = self.hierarchy.as_ref();
        let (elements, level) = (self.hierarchy.elements(), self.hierarchy.n_levels() - coarser);
        let Leaves { tiles: here, ghosts } = &leaves[coarser - 1];
        let finer = &self.source[elements.cells(coarser - 1)];
        let pass = CoarseDisplacement {
            table: tables.coarse_table(coarser),
            elements: TileValues::new(&self.source[elements.cells(coarser)], here),
            finer: TileValues::new(finer, &elements.levels()[coarser - 1]),
            ghosts,
            level: TileValues::new(&self.displacements[level], levels[level].tiles()),
        };
        (tables.sizes.passes.displace_coarse)(self.arch, &pass, Targets { places: &here.places()[tiles], cells });
    }

    /// Adds the displacement that larger elements nearby cause in some tiles.
    ///
    /// The tiles have elements 2^`coarser` times as large as the finest.
    fn add_ghosts(&self, coarser: usize, tiles: Range<usize>, cells: &mut [T]) {
        let tables = self.tables.borrow();
        let Some(larger) = self.hierarchy.leaves.get(coarser) else { return };
        let Some(table) = tables.coarse_table(coarser + 1) else { return };
        let ghosts = TileValues::new(&self.ghosts[coarser], &larger.ghosts);
        let places = &self.hierarchy.elements().levels()[coarser].places()[tiles];
        let pass = ShortRange { taps: &table.across, values: ghosts };
        (tables.sizes.passes.add_stencil)(self.arch, &pass, Targets { places, cells });
    }
}

impl<T: Real, B: Borrow<Tables<T>> + Sync> BlockOperator<T> for TileOperator<T, B> {
    fn layout(&self) -> BlockLayout {
        self.hierarchy.layout().clone()
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [T]) + Sync)) {
        self.reserve();
        let own = &mut self.source[self.hierarchy.own_values()];
        parallel::for_each(self.hierarchy.layout().chunks_mut(own).enumerate(), |(i, cells)| write(i, cells));
    }

    /// Applies the tables, except for the part of the elements' own level, which [`BlockOperator::read`] adds.
    fn apply(&mut self) {
        self.hierarchy.finest().exchange(&mut self.source);
        self.set_ghosts();
        self.restrict();
        self.convolve_base();
        self.compute_tails();
        self.prolong();
    }

    fn read(&self, read: &(dyn Fn(usize, &[T]) + Sync)) {
        let (blocks, n_own) = (&self.hierarchy.blocks, self.hierarchy.own_values().len());
        parallel::for_each_index(blocks.len(), &|i| {
            let mut block = [T::default(); BLOCK_CELLS];
            let (coarser, tiles) = &blocks[i];
            let cells = &mut block[..tiles.len() * CELLS];
            if *coarser == 0 {
                self.displace_finest(tiles.clone(), cells);
            } else {
                self.displace_coarse(*coarser, tiles.clone(), cells);
            }
            self.add_ghosts(*coarser, tiles.clone(), cells);
            // Values that fill up the last block of a level have no displacement.
            read(i, &block[..self.hierarchy.layout().range(i, n_own).len()]);
        });
    }

    fn release(&mut self) {
        (self.source, self.densities, self.displacements, self.ghosts) = Default::default();
        self.tails.iter_mut().for_each(|(_, tails)| *tails = Vec::new());
    }
}

/// Computes the densities of tiles of a level from those of the next finer one.
///
/// The last level is the finest.
fn restrict<T: Real>(
    tables: &Tables<T>,
    (level, n_levels): (usize, usize),
    finer: TileValues<'_, T>,
    (arch, targets): (Arch, Targets<'_, T>),
) {
    match &tables.uneven {
        Some(uneven) if level + 1 == n_levels => {
            (tables.sizes.passes.restrict_uneven)(arch, &UnevenRestriction { uneven, finer }, targets);
        }
        _ => (tables.sizes.passes.restrict)(arch, &Restriction { transfer: &tables.levels[level].1, finer }, targets),
    }
}

/// Copies whole rows of tiles to rows of `side` cells.
pub(crate) fn tiles_to_rows<T: Copy>(cells: &[T], rows: &mut [T], side: usize) {
    for (lines, tiles) in rows.chunks_exact_mut(TILE * side).zip(cells.chunks_exact(TILE * side)) {
        for (row, line) in lines.chunks_exact_mut(side).enumerate() {
            for (values, tile) in line.as_chunks_mut::<TILE>().0.iter_mut().zip(tiles.as_chunks::<CELLS>().0) {
                values.copy_from_slice(&tile[row * TILE..][..TILE]);
            }
        }
    }
}

/// Copies rows of cells to tiles: the reverse of [`tiles_to_rows`].
pub(crate) fn rows_to_tiles<T: Copy>(rows: &[T], cells: &mut [T], side: usize) {
    for (tiles, lines) in cells.chunks_exact_mut(TILE * side).zip(rows.chunks_exact(TILE * side)) {
        for (row, line) in lines.chunks_exact(side).enumerate() {
            for (tile, values) in tiles.as_chunks_mut::<CELLS>().0.iter_mut().zip(line.as_chunks::<TILE>().0) {
                tile[row * TILE..][..TILE].copy_from_slice(values);
            }
        }
    }
}
