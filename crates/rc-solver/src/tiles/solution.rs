//! The solution on tiles: pressures, and everything else on request.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;
use rc_comm::Ranks;
use rc_core::{DVec2, Field, Grid};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet, put_tile};

use crate::descent::contact_element::ContactElement;
use crate::descent::contact_system::solve_on_contact;
use crate::descent::info::{SolveInfo, Status};
use crate::descent::operators::{BlockOperator, LevelOperators, read_blocks, write_blocks};
use crate::descent::stiffness::{elastic_part, least_rise, stiffness_by_gmres, stiffness_pressure, stiffness_under};
use crate::parallel;
use crate::problem::capabilities::Feature;
use crate::solution::contact_area::area::ContactArea;
use crate::solution::contact_area::plastic::PlasticEdges;
use crate::solution::gap_part::GapPart;
use crate::solution::gradient_error::GradientError;
use crate::solution::observables::Observables;
use crate::solution::rows::{Halted, Receiver, Rows, TakeRows};
use crate::solution::solved::{Counts, Solved};
use crate::tiles::bands::{bands, hand_out};
use crate::tiles::base::Base;
use crate::tiles::data::TileData;
use crate::tiles::kernels::Kernels;
use crate::tiles::ladder::sides_of;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::operator::hierarchy::{Hierarchy, Reach};
use crate::tiles::operator::tables::{Prepared, Tables};
use crate::tiles::operator::tile_operator::TileOperator;
use crate::tiles::scaled_operator::ScaledOperator;
use crate::tiles::split::GapSplit;

/// A solved finest level on tiles, with the heights and kernels that later questions need.
///
/// Only tiles in contact are stored. Over ranks, each rank has its own tiles. Rows of fields are passed on one tile
/// high at a time, for files and pictures.
pub(crate) struct TileSolution<'a> {
    pub(crate) data: Arc<TileData<'a>>,
    /// Maximum height, in λ.
    pub(crate) h_max: f64,
    /// Whether the certificate meets the tolerance.
    pub(crate) converged: bool,
    /// The grid of the fields, on which pressures are means.
    pub(crate) grid: Grid,
    /// The grid of the smallest elements.
    pub(crate) finest: Grid,
    pub(crate) mesh: Mesh,
    pub(crate) pressure: Vec<f64>,
    pub(crate) area: ContactArea,
    /// The maximum pressure. Infinite without a hardness.
    pub(crate) hardness: f64,
    pub(crate) plastic: Option<PlasticEdges>,
    /// How the solution was found. The certificate holds for the whole cell.
    pub(crate) info: SolveInfo,
    /// Number of elements whose gap the certificate computed. With border levels, they have several sizes.
    pub(crate) evaluated: usize,
    /// Number of elements of the smallest size that were proven to be out of contact.
    ///
    /// Their gap was not computed. They are the rest of the cell.
    pub(crate) proven: usize,
}

impl TileSolution<'_> {
    fn base(&self) -> Base {
        self.data.kernels.base()
    }

    /// Number of elements in contact.
    fn n_in_contact(&self) -> usize {
        self.mesh.ranks().count(self.pressure.par_iter().filter(|&&p| p > 0.0).count())
    }

    /// Whether elements cover the cell and all of them are in contact.
    fn is_full_contact(&self) -> bool {
        self.mesh.cover_cell() && self.n_in_contact() == self.mesh.n_cells()
    }

    /// Tiles of one size wherever there are elements, and the pressure on them.
    ///
    /// They are tiles of the grid, with means over smaller elements. With `finest`, they are tiles of the smallest
    /// elements, and a larger element stands for its parts.
    fn on_one_size(&self, finest: bool) -> (Mesh, Cow<'_, [f64]>) {
        let on_level = if finest { Elements::on_finest } else { Elements::on_coarsest };
        let (tiles, pressure) = on_level(&self.mesh, &self.pressure);
        (Mesh::new(Elements::uniform(tiles), self.mesh.ranks()), pressure)
    }

    /// Passes on the displacement v of the grid's pressure, rows of tiles at a time.
    ///
    /// This costs about one application of L on the whole grid. If `rows` are those of the finest grid, v is that of
    /// the pressure itself, on the grid of the smallest elements.
    fn rows_of_displacement(&self, rows: Rows, take: TakeRows<'_>) -> Result<(), Halted> {
        let (own, pressure) = self.on_one_size(rows.finest);
        let (own_tiles, [columns, _]) = (own.finest(), own.finest().extent());
        let prepared = self.data.kernels.response();
        let tables = prepared.tables(if rows.finest { self.finest } else { self.grid });
        for (band, to) in bands(&own, rows.receiver) {
            let more = band.clone().flat_map(|row| (0..columns).map(move |column| [column as u32, row as u32]));
            let tiles =
                own_tiles.of_same_cell(own_tiles.sides(), own_tiles.places().iter().copied().chain(more).collect());
            let mesh = Mesh::new(Elements::uniform(tiles), own.ranks());
            let hierarchy = Arc::new(Hierarchy::new(self.base(), mesh.clone(), prepared.reach()));
            let mut values = own.moved(&mesh, &pressure, 0.0);
            // If the pressure is on a part of the cell, the mean over the whole cell does not tell its size.
            let mean = if own.cover_cell() { self.info.mean_pressure } else { 0.0 };
            let size = self.info.penetration_full_contact;
            let mut fresh = ScaledOperator::new(hierarchy, &tables, mean, size);
            write_blocks(&mut fresh, values.chunks(BLOCK_CELLS), |p, cells| cells.copy_from_slice(p));
            fresh.apply();
            read_blocks(&fresh, values.chunks_mut(BLOCK_CELLS), |v, cells| v.copy_from_slice(cells));
            hand_out((&mesh, &values), (band, to), take)?;
        }
        Ok(())
    }

    /// Whether no element is plastic.
    fn is_elastic(&self) -> bool {
        self.plastic.is_none_or(|plastic| plastic.contact.cells <= 0.0)
    }

    /// dσ0/dΔ if the elements with a `pressure` are held down, which may be `all` in contact.
    fn stiffness_of(&self, kernels: &Kernels, pressure: &[f64], all: bool) -> f64 {
        if all && self.is_full_contact() && !self.base().is_free() {
            return kernels.compliance().recip();
        }
        let n = self.finest.len() as f64;
        if kernels.is_sliding() {
            let mut preconditioner = kernels.preconditioner().tables(self.finest);
            let (hierarchy, tables) = self.operator_of(kernels.response());
            let mut operator = TileCorrections::new(hierarchy, &tables, &mut preconditioner);
            return stiffness_by_gmres(pressure, (n, self.converged), &mut operator);
        }
        // The quick operator alone would be up to a percent off.
        let x = {
            let mut preconditioner = kernels.preconditioner().tables(self.finest);
            let (hierarchy, tables) = self.operator_of(kernels.quick());
            let mut corrections = TileCorrections::new(hierarchy, &tables, &mut preconditioner);
            stiffness_pressure(pressure, n, &mut corrections, self.converged)
        };
        let (hierarchy, tables) = self.operator_of(kernels.response());
        stiffness_under(&x, n, &mut TileOperator::new(hierarchy, &tables))
    }

    /// `map` gets the value of each element and that of the same element of the grid. Elements are of one size.
    fn exchange(&self, values: &mut [f64], on_grid: &mut [f64], map: impl Fn(&mut f64, &mut f64)) {
        let tiles = self.mesh.finest();
        let [nx, ny] = tiles.sides();
        for (place, values) in tiles.places().iter().zip(values.chunks_mut(CELLS)) {
            let [column, row] = place.map(|i| i as usize * TILE);
            for (y, values) in values.chunks_mut(TILE).enumerate().take(ny - row) {
                let width = TILE.min(nx - column);
                let on_grid = &mut on_grid[(row + y) * nx + column..][..width];
                values.iter_mut().zip(on_grid).for_each(|(value, on_grid)| map(value, on_grid));
            }
        }
    }

    /// The hierarchy and tables of L by this kernel on the mesh.
    fn operator_of(&self, prepared: &Prepared<f32>) -> (Arc<Hierarchy>, Tables<f32>) {
        (self.hierarchy(&self.mesh, prepared.reach()), prepared.tables(self.finest))
    }

    fn hierarchy(&self, mesh: &Mesh, reach: Reach) -> Arc<Hierarchy> {
        Arc::new(Hierarchy::new(self.base(), mesh.clone(), reach))
    }
}

impl Solved for TileSolution<'_> {
    fn status(&self) -> Status {
        match self.converged {
            false => Status::NotConverged,
            true if self.is_full_contact() && !self.base().is_free() => Status::FullContact,
            true => Status::Converged,
        }
    }

    fn info(&self) -> &SolveInfo {
        &self.info
    }

    fn grid(&self) -> Grid {
        self.grid
    }

    fn finest_grid(&self) -> Grid {
        self.finest
    }

    fn ranks(&self) -> Ranks {
        self.mesh.ranks().clone()
    }

    fn counts(&self) -> Counts {
        let in_contact = self.n_in_contact();
        Counts { stated: in_contact, in_contact, evaluated: self.evaluated, proven: self.proven }
    }

    fn elements(&self) -> Option<Box<dyn Iterator<Item = ContactElement> + '_>> {
        let tiles = self.mesh.own_levels().flat_map(|(coarser, places, values)| {
            places.iter().enumerate().map(move |(tile, place)| (coarser, place, values.start + tile * CELLS))
        });
        Some(Box::new(tiles.flat_map(move |(coarser, place, start)| {
            let side = self.mesh.side(coarser);
            let [column, row] = place.map(|i| f64::from(i) * TILE as f64);
            let cells = self.pressure[start..start + CELLS].iter().enumerate();
            cells.filter(|&(_, &pressure)| pressure > 0.0).map(move |(cell, &pressure)| {
                let x = (column + (cell % TILE) as f64 + 0.5) * side;
                let y = (row + (cell / TILE) as f64 + 0.5) * side;
                ContactElement { centre: DVec2::new(x, y), side, pressure }
            })
        })))
    }

    fn observables(&self) -> Observables {
        let max_pressure = self.mesh.layout().maximum(&self.pressure, 0.0);
        let rms_pressure = rms_pressure(&self.mesh, &self.pressure);
        Observables::new(&self.info, (self.area, self.plastic), self.hardness, [rms_pressure, max_pressure])
    }

    /// To 1e-3 relative, or to a few percent if the solve did not converge. It takes a few applications of L.
    fn stiffness(&self) -> f64 {
        self.stiffness_of(&self.data.kernels, &elastic_part(&self.pressure, self.hardness), self.is_elastic())
    }

    fn least_rise(&self) -> Option<f64> {
        if self.is_full_contact() && !self.base().is_free() {
            return Some(1.0);
        }
        let kernels = &self.data.kernels;
        let mut preconditioner = kernels.preconditioner().tables(self.finest);
        let (hierarchy, tables) = self.operator_of(kernels.response());
        let mut operator = TileCorrections::new(hierarchy, &tables, &mut preconditioner);
        Some(least_rise(&self.pressure, self.finest.len() as f64, &mut operator))
    }

    fn conductance(&self) -> Option<f64> {
        let half_space = self.data.half_space.as_ref();
        let is_stiffness = half_space.is_none() && self.is_elastic();
        (!is_stiffness).then(|| self.stiffness_of(half_space.unwrap_or(&self.data.kernels), &self.pressure, true))
    }

    fn features(&self) -> Vec<Feature> {
        [
            (self.data.kernels.is_sliding(), Feature::Sliding),
            (self.base().is_free(), Feature::FreeBorders),
            (self.finest != self.grid, Feature::BorderLevel),
            (self.mesh.ranks().size() > 1, Feature::Ranks),
        ]
        .into_iter()
        .filter_map(|(has, feature)| has.then_some(feature))
        .collect()
    }

    /// Heights are evaluated again.
    fn highest(&self) -> Option<usize> {
        let sides @ [nx, ny] = sides_of(self.grid);
        let rows = (0..ny.div_ceil(TILE)).filter_map(|row| {
            let rows = self.data.heights.row_of_tiles(sides, row);
            let highest = (0..rows.len()).reduce(|one, i| if rows[i] > rows[one] { i } else { one })?;
            Some((row * TILE * nx + highest, rows[highest]))
        });
        rows.reduce(|one, other| if other.1 > one.1 { other } else { one }).map(|(index, _)| index)
    }

    /// L is that of the most accurate split.
    fn displaced_by(&self, displacement: &[f64], is_balanced: bool) -> Result<Vec<f64>, GradientError> {
        let (kernels, mut on_grid) = (&self.data.kernels, displacement.to_vec());
        let mut wanted = vec![0.0; self.pressure.len()];
        self.exchange(&mut wanted, &mut on_grid, |wanted, given| *wanted = *given);
        let mut preconditioner = kernels.preconditioner().tables(self.finest);
        let (quick, prepared) = (kernels.quick(), kernels.gap(GapSplit::most_accurate()));
        // GMRES works on whole blocks.
        let mesh = Mesh::new(self.mesh.elements().clone(), self.mesh.ranks());
        let (hierarchy, tables) = (self.hierarchy(&mesh, quick.reach()), quick.tables(self.finest));
        let fresh = prepared.tables(self.finest);
        let mut operators = LevelOperators {
            corrections: Box::new(TileCorrections::new(hierarchy, &tables, &mut preconditioner)),
            fresh: fresh.operator(self.hierarchy(&mesh, prepared.reach()), 0.0, 1.0),
        };
        let mut found =
            solve_on_contact(&self.pressure, &wanted, is_balanced, &mut operators).map_err(GradientError::Inexact)?;
        on_grid.fill(0.0);
        self.exchange(&mut found, &mut on_grid, |found, on_grid| *on_grid = *found);
        Ok(on_grid)
    }

    fn stored(&self) -> Option<[&Field; 2]> {
        None
    }

    /// The pressure is the mean over smaller elements.
    fn pressure_rows(&self, receiver: Receiver, take: TakeRows<'_>) -> Result<(), Halted> {
        let (mesh, pressure) = self.on_one_size(false);
        bands(&mesh, receiver).try_for_each(|band| hand_out((&mesh, &pressure), band, take))
    }

    /// Neither the gap nor the heights are ever whole in memory.
    fn gap_rows(&self, part: GapPart, rows: Rows, take: TakeRows<'_>) -> Result<(), Halted> {
        let (heights, offset) = (&self.data.heights, self.h_max - self.info.penetration);
        let grid = if rows.finest { self.finest } else { self.grid };
        let of_pressure = part.needs_pressure(self.hardness).then(|| self.on_one_size(rows.finest));
        self.rows_of_displacement(rows, &mut |first, displacement| {
            let mut rows = heights.row_of_tiles(sides_of(grid), first / TILE);
            for (h, v) in rows.iter_mut().zip(displacement) {
                *h = v - *h + offset;
            }
            if let Some((mesh, pressure)) = &of_pressure {
                for (g, p) in rows.iter_mut().zip(row_of_tiles(mesh.finest(), pressure, first / TILE)) {
                    *g = part.of(*g, p, self.hardness);
                }
            } else {
                for gap in &mut rows {
                    *gap = part.of(*gap, 0.0, f64::INFINITY);
                }
            }
            take(first, &rows)
        })
    }

    fn displacement_rows(&self, take: TakeRows<'_>) -> Result<(), Halted> {
        self.rows_of_displacement(Rows::on_grid(Receiver::First), take)
    }

    fn into_owned(self: Box<Self>) -> Box<dyn Solved> {
        let solution = *self;
        Box::new(TileSolution {
            data: Arc::new(TileData::into_owned(solution.data)),
            h_max: solution.h_max,
            converged: solution.converged,
            grid: solution.grid,
            finest: solution.finest,
            mesh: solution.mesh,
            pressure: solution.pressure,
            area: solution.area,
            hardness: solution.hardness,
            plastic: solution.plastic,
            info: solution.info,
            evaluated: solution.evaluated,
            proven: solution.proven,
        })
    }
}

/// The values in a row of tiles, row by row. They are zero where there is no tile.
fn row_of_tiles(tiles: &TileSet, values: &[f64], row: usize) -> Vec<f64> {
    let ([nx, ny], [columns, _]) = (tiles.sides(), tiles.extent());
    let mut rows = vec![0.0; TILE * nx];
    for column in 0..columns {
        let Some(tile) = tiles.find(column as i64, row as i64) else { continue };
        put_tile(&mut rows, nx, column, &values[tile * CELLS..][..CELLS]);
    }
    rows.truncate(TILE.min(ny - row * TILE) * nx);
    rows
}

/// Root mean square over the whole cell.
pub(crate) fn rms_pressure(elements: &Mesh, pressure: &[f64]) -> f64 {
    let layout = elements.layout();
    let squares = parallel::map(layout.chunks(pressure), |p| [p.iter().map(|p| p * p).sum()]);
    let [squares] = layout.total(squares);
    let n_cell: usize = elements.finest().sides().into_iter().product();
    (squares / n_cell as f64).sqrt()
}
