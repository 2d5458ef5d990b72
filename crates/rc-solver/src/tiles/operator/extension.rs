//! The approximate inverse of L among the active elements of a mesh.
//!
//! [`crate::grid::extension`] has the extension F of a residual to the whole cell. On tiles, u = F r is kept level by
//! level, as far as there are tiles. One share of u on a level comes from the means over active elements. The other
//! share is P u of the next coarser level, where P is the interpolation. The base grid has u on the whole cell, and
//! applies |q|/2 by its Fourier transform. Each level above adds its stencil of the difference w = u - P u, which is
//! zero where nothing is active. The inverse is the sum of all levels with the transposes around them, so it is
//! symmetric.
//!
//! The filters that L goes through between levels are not used here. They would see the ends of tiles as edges of u.
//! With the extension and one grid, residuals fall by ten in an iteration. With two or three levels as here, they do so
//! in one and a half iterations.

use std::ops::Range;
use std::sync::Arc;

use pulp::Arch;
use rc_fft::Convolution;
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS, TILE};

use crate::grid::extension::pyramid::Extension;
use crate::grid::extension::rows::{Parts, Shares, Weight};
use crate::grid::passes::{read_rows, write_rows};
use crate::parallel;
use crate::parallel::Tasks;
use crate::tiles::operator::extension_values::{Means, set_base};
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::interpolation::{cells_over, collect, interpolate};
use crate::tiles::operator::passes::{ShortRange, Targets};
use crate::tiles::operator::tables::Tables;
use crate::tiles::operator::tile_operator::{Buffers, rows_to_tiles, tiles_to_rows};
use crate::tiles::operator::tile_values::TileValues;
use crate::tiles::part::{Part, blocks, own_blocks};

/// Values on the base grid or a level between it and the finest.
struct Level {
    /// The parts of cells that are active. Those of the base grid are in rows.
    parts: Parts,
    /// Means and u on the way up, then the stencil of w, a pressure. On the way down, the values for u.
    values: Vec<f32>,
    /// Values w. On the way down, the values for the coarser level.
    detail: Vec<f32>,
}

impl Level {
    /// Takes or gives back the room for values.
    fn swap(levels: &mut [Self], [values, details]: [&mut [Vec<f32>]; 2]) {
        for (level, (values, detail)) in levels.iter_mut().zip(values.iter_mut().zip(details)) {
            std::mem::swap(&mut level.values, values);
            std::mem::swap(&mut level.detail, detail);
        }
    }
}

/// Values of the extension on one hierarchy.
pub(super) struct TileExtension {
    hierarchy: Arc<Hierarchy>,
    /// Levels 0 to K - 1.
    levels: Vec<Level>,
    /// The values of the base grid in rows.
    rows: Vec<f32>,
    /// F between the base grid and coarser grids.
    coarser: Extension,
}

impl TileExtension {
    pub(super) fn new(hierarchy: Arc<Hierarchy>) -> Self {
        let sides = hierarchy.base().period();
        let level = |part: &Part| {
            let parts = Parts::new(part.n_cells(), Weight::OfSquare);
            Level { parts, values: Vec::new(), detail: Vec::new() }
        };
        let levels = hierarchy.levels[..hierarchy.n_levels()].iter().map(level).collect();
        Self { levels, rows: vec![0.0; sides[0] * sides[1]], coarser: Extension::new(sides), hierarchy }
    }

    /// Prepares the extension for these active elements.
    ///
    /// The levels have no room for values but during [`TileExtension::precondition`] and this.
    pub(super) fn set_active(&mut self, active: &[bool], Buffers { finest, mut of_levels, .. }: Buffers<'_, f32>) {
        self.take_room(&mut of_levels);
        self.take_means(|cell| f32::from(u8::from(active[cell])), finest);
        for (level, Level { parts, values, .. }) in self.levels.iter_mut().enumerate() {
            parts.set(if level == 0 { &self.rows } else { values });
        }
        self.coarser.set_active(&self.rows, |part| part);
        Level::swap(&mut self.levels, of_levels);
    }

    /// Takes the room of another operator for values, which may be on fewer cells.
    fn take_room(&mut self, of_levels: &mut [&mut [Vec<f32>]; 2]) {
        for room in &mut *of_levels {
            for (values, part) in room.iter_mut().zip(&self.hierarchy.levels) {
                values.resize(values.len().max(part.n_cells()), 0.0);
            }
        }
        let [values, details] = of_levels;
        Level::swap(&mut self.levels, [values, details]);
    }

    /// Computes z = Fᵀ |q|/2 F r.
    ///
    /// `values` has r on the active elements and zeros elsewhere, and gets z.
    pub(super) fn precondition(
        &mut self,
        Buffers { arch, convolution, finest, mut of_levels }: Buffers<'_, f32>,
        tables: &Tables<f32>,
        active: &[bool],
        values: &mut [f32],
    ) {
        self.take_room(&mut of_levels);
        self.extend(active, values, finest);
        self.apply_stencils(arch, tables, finest, values);
        self.convolve_base(convolution, tables);
        self.gather(active, values, finest);
        Level::swap(&mut self.levels, of_levels);
    }

    /// Computes means over the cells of all levels, from the values of own elements.
    ///
    /// `finest` gets these, and the values of other ranks that this rank reads.
    fn take_means(&mut self, of_element: impl Fn(usize) -> f32 + Sync, finest: &mut [f32]) {
        let hierarchy = &self.hierarchy;
        let own = finest[hierarchy.own_values()].chunks_mut(BLOCK_CELLS).enumerate();
        parallel::for_each(own, |(i, cells)| {
            cells.iter_mut().enumerate().for_each(|(cell, value)| *value = of_element(i * BLOCK_CELLS + cell));
        });
        hierarchy.finest().exchange(finest);
        for level in (0..hierarchy.n_levels()).rev() {
            let (here, finer) = self.levels.split_at_mut(level + 1);
            let values = &mut here[level].values;
            let means = Means::new(hierarchy, level, finer.first().map_or(&*finest, |finer| &finer.values), finest);
            if level == 0 {
                set_base(hierarchy, values, |places, cells| means.set(places, cells));
            } else {
                let part = &hierarchy.levels[level];
                parallel::for_each(own_blocks(part, values), |(places, cells)| means.set(places, cells));
                part.exchange(values);
            }
        }
        self.for_base_rows(|rows, cells, side| tiles_to_rows(cells, rows, side));
    }

    /// Computes u and w on all levels. `finest` gets w.
    fn extend(&mut self, active: &[bool], values: &mut [f32], finest: &mut [f32]) {
        self.take_means(|cell| values[cell], finest);
        self.coarser.extend(&self.rows);
        self.coarser.fill_all(self.levels[0].parts.shares(), &mut self.rows);
        self.for_base_rows(|rows, cells, side| rows_to_tiles(rows, cells, side));
        let tiles = &self.hierarchy.levels;
        for level in 1..tiles.len() {
            let (coarser, here) = self.levels.split_at_mut(level);
            let coarser = TileValues::new(&coarser[level - 1].values, tiles[level - 1].tiles());
            let (part, own_cells) = (&tiles[level], tiles[level].own_cells());
            let Some(Level { parts, values, detail, .. }) = here.first_mut() else {
                blend(part.own_places(), coarser, Shares::Active(active), (values, &mut finest[own_cells]));
                part.exchange(finest);
                continue;
            };
            let shares = parts.shares();
            blend(
                part.own_places(),
                coarser,
                shares.part(own_cells.clone()),
                (&mut values[own_cells.clone()], &mut detail[own_cells]),
            );
            part.exchange(values);
            part.exchange(detail);
        }
    }

    /// Applies the stencils to w. `values` gets the result on the finest elements.
    fn apply_stencils(&mut self, arch: Arch, tables: &Tables<f32>, finest: &[f32], values: &mut [f32]) {
        for (level, part) in self.hierarchy.levels.iter().enumerate().skip(1) {
            let taps = &tables.levels[level - 1].0;
            let (detail, cells) = match self.levels.get_mut(level) {
                Some(here) => (&*here.detail, &mut here.values[part.own_cells()]),
                None => (finest, &mut *values),
            };
            let around = TileValues::new(detail, part.tiles());
            parallel::for_each(blocks(part.own_places(), cells), |(places, cells)| {
                cells.fill(0.0);
                (tables.sizes.passes.add_stencil)(
                    arch,
                    &ShortRange { taps, values: around },
                    Targets { places, cells },
                );
            });
        }
    }

    /// Applies |q|/2 to u on the base grid.
    fn convolve_base(&mut self, convolution: &mut Convolution<f32>, tables: &Tables<f32>) {
        let len = rc_fft::BLOCK_ROWS * self.hierarchy.base().period()[0];
        let values = &self.rows;
        write_rows(convolution, &|i, rows| rows.copy_from_slice(&values[i * len..][..rows.len()]));
        tables.base.apply(convolution);
        let tasks = Tasks::new(self.rows.chunks_mut(len));
        read_rows(convolution, &|i, rows| tasks.run(i, |to: &mut [f32]| to.copy_from_slice(rows)));
    }

    /// Applies Fᵀ and the transpose of u - P u.
    ///
    /// `values` has the stencils of the finest elements, and gets z.
    fn gather(&mut self, active: &[bool], values: &mut [f32], finest: &mut [f32]) {
        let hierarchy = &self.hierarchy;
        let elements = active.chunks(BLOCK_CELLS).zip(values.chunks(BLOCK_CELLS));
        let given = finest[hierarchy.own_values()].chunks_mut(BLOCK_CELLS);
        parallel::for_each(given.zip(elements), |(given, (active, pressure))| {
            for ((given, &active), pressure) in given.iter_mut().zip(active).zip(pressure) {
                *given = if active { -pressure } else { 0.0 };
            }
        });
        hierarchy.finest().exchange(finest);
        for level in (0..self.levels.len()).rev() {
            let (here, finer) = self.levels.split_at_mut(level + 1);
            let finer = finer.first().map_or(&*finest, |finer| &finer.detail);
            let finer = TileValues::new(finer, hierarchy.levels[level + 1].tiles());
            let Level { parts, values, detail } = &mut here[level];
            if level == 0 {
                set_base(hierarchy, values, |places, cells| collect(finer, places, cells));
                continue;
            }
            let (part, own) = (&hierarchy.levels[level], hierarchy.levels[level].own_cells());
            let (active, weight) = parts.of(own.clone());
            let blocks =
                own_blocks(part, values).zip(detail[own].chunks_mut(BLOCK_CELLS)).zip(active.chunks(BLOCK_CELLS));
            parallel::for_each(blocks, |(((places, values), given), active)| {
                let mut collected = [0.0; BLOCK_CELLS];
                collect(finer, places, &mut collected);
                let values = values.iter_mut().zip(given).zip(active.iter().zip(collected));
                for ((value, given), (&x, collected)) in values {
                    let pressure = *value;
                    *value += collected;
                    *given = weight.rest(x) * *value - pressure;
                }
            });
            part.exchange(detail);
        }
        self.for_base_rows(|rows, cells, side| {
            let mut collected = vec![0.0; rows.len()];
            tiles_to_rows(cells, &mut collected, side);
            rows.iter_mut().zip(collected).for_each(|(value, collected)| *value += collected);
        });
        self.coarser.gather(self.levels[0].parts.shares(), &mut self.rows);
        self.for_base_rows(|rows, cells, side| rows_to_tiles(rows, cells, side));
        self.hand_down(active, values);
    }

    /// Computes z from the values that active elements of base grid cells get.
    fn hand_down(&mut self, active: &[bool], values: &mut [f32]) {
        let tiles = &self.hierarchy.levels;
        for level in 1..tiles.len() {
            let (coarser, here) = self.levels.split_at_mut(level);
            let coarser = TileValues::new(&coarser[level - 1].values, tiles[level - 1].tiles());
            let part = &tiles[level];
            let Some(Level { parts, values, .. }) = here.first_mut() else {
                add_cells_over(part.own_places(), coarser, Shares::Active(active), values);
                continue;
            };
            let own_cells = part.own_cells();
            add_cells_over(part.own_places(), coarser, parts.shares().part(own_cells.clone()), &mut values[own_cells]);
            part.exchange(values);
        }
        for (level, here) in self.levels.iter().enumerate().skip(1) {
            let Some((range, leaves)) = self.hierarchy.elements_of(level) else { continue };
            let blocks = blocks(leaves.places(), &mut values[range.clone()]).zip(active[range].chunks(BLOCK_CELLS));
            parallel::for_each(blocks, |((places, values), active)| {
                let cells = values.as_chunks_mut::<CELLS>().0.iter_mut().zip(active.chunks(CELLS));
                for (&place, (cells, active)) in places.iter().zip(cells) {
                    let found = TileValues::new(&here.values, tiles[level].tiles()).tile(place);
                    let found = found.expect("levels have the tiles of their elements").iter().zip(active);
                    cells.iter_mut().zip(found).for_each(|(to, (z, &active))| *to = if active { *z } else { 0.0 });
                }
            });
        }
    }

    /// Calls `work` with rows of the base grid, the tiles in them, and the length of a row.
    fn for_base_rows(&mut self, work: impl Fn(&mut [f32], &mut [f32], usize) + Sync) {
        let side = self.hierarchy.base().period()[0];
        let rows = self.rows.chunks_mut(TILE * side).zip(self.levels[0].values.chunks_mut(TILE * side));
        parallel::for_each(rows, |(rows, cells)| work(rows, cells, side));
    }
}

/// The values of a tile.
fn cells_of(tile: usize) -> Range<usize> {
    tile * CELLS..(tile + 1) * CELLS
}

/// Changes own values on tiles to u, and sets w = u - P u.
fn blend(
    places: &[[u32; 2]],
    coarser: TileValues<'_, f32>,
    shares: Shares<'_>,
    (values, detail): (&mut [f32], &mut [f32]),
) {
    let blocks = blocks(places, values).zip(detail.chunks_mut(BLOCK_CELLS)).enumerate();
    parallel::for_each(blocks, |(block, ((places, values), detail))| {
        let mut around = [0.0; CELLS];
        let cells = values.as_chunks_mut::<CELLS>().0.iter_mut().zip(detail.as_chunks_mut::<CELLS>().0);
        for (i, (&place, (values, detail))) in places.iter().zip(cells).enumerate() {
            let shares = shares.part(cells_of(block * BLOCK_TILES + i));
            if shares.any_own() {
                interpolate(coarser, place, &mut around);
            }
            shares.blend(&around, values);
            for ((w, u), around) in detail.iter_mut().zip(values).zip(around) {
                *w = *u - around;
            }
        }
    });
}

/// Changes values for u on tiles to those for own values.
fn add_cells_over(places: &[[u32; 2]], coarser: TileValues<'_, f32>, shares: Shares<'_>, values: &mut [f32]) {
    parallel::for_each(blocks(places, values).enumerate(), |(block, (places, values))| {
        for (i, (&place, values)) in places.iter().zip(values.as_chunks_mut::<CELLS>().0).enumerate() {
            shares.part(cells_of(block * BLOCK_TILES + i)).hand_down(&cells_over(coarser, place), values);
        }
    });
}
