//! The solution of the adaptive method: pressures on tiles, and everything else on request.

use std::borrow::Cow;
use std::sync::Arc;

use rayon::prelude::*;
use rc_core::{DVec2, Grid};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet, put_tile};

use crate::descent::contact_element::ContactElement;
use crate::descent::info::SolveInfo;
use crate::descent::info::Status;
use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::descent::stiffness::{elastic_part, stiffness_pressure, stiffness_under};
use crate::solution::contact_area::area::ContactArea;
use crate::solution::contact_area::plastic::PlasticEdges;
use crate::solution::observables::Observables;
use crate::solution::rows::{Receiver, Rows};
use crate::tiles::bands::{bands, hand_out};
use crate::tiles::base::Base;
use crate::tiles::kernels::Kernels;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tables::{Prepared, Tables};
use crate::tiles::operator::tile_operator::TileOperator;
use crate::tiles::scaled_operator::ScaledOperator;

/// A contact problem solved on an adaptive mesh.
///
/// Only tiles in contact are stored. Over ranks, each rank has its own tiles. [`AdaptiveSolution::pressure_rows`] gives
/// the rows of the finest grid one tile high at a time, for files and pictures.
#[derive(Clone, Debug)]
pub(crate) struct AdaptiveSolution {
    /// Whether the certificate meets the tolerance.
    pub(crate) converged: bool,
    pub(crate) base: Base,
    pub(crate) grid: Grid,
    /// The grid of the smallest elements.
    pub(crate) finest: Grid,
    pub(crate) elements: Mesh,
    pub(crate) pressure: Vec<f64>,
    pub(crate) area: ContactArea,
    /// The maximum pressure. Infinite without a hardness.
    pub(crate) hardness: f64,
    pub(crate) plastic: Option<PlasticEdges>,
    /// How the solution was found, and how good it is.
    ///
    /// The certificate holds for the whole cell.
    pub info: SolveInfo,
    /// Number of elements whose gap the certificate computed. With border levels, they have several sizes.
    pub evaluated: usize,
    /// Number of elements of the smallest size that were proven to be out of contact.
    ///
    /// Their gap was not computed. They are the rest of the cell.
    pub proven: usize,
}

impl AdaptiveSolution {
    /// The grid of the problem.
    ///
    /// The smallest elements are 2^([`crate::SolveParams::border_level`]) times smaller than its elements.
    #[must_use]
    pub(crate) fn grid(&self) -> Grid {
        self.grid
    }

    /// Elements in contact. Over ranks they are those of this rank.
    pub(crate) fn elements(&self) -> impl Iterator<Item = ContactElement> + '_ {
        let tiles = self.elements.own_levels().flat_map(|(coarser, places, values)| {
            places.iter().enumerate().map(move |(tile, place)| (coarser, place, values.start + tile * CELLS))
        });
        tiles.flat_map(move |(coarser, place, start)| {
            let side = self.elements.side(coarser);
            let [column, row] = place.map(|i| f64::from(i) * TILE as f64);
            let cells = self.pressure[start..start + CELLS].iter().enumerate();
            cells.filter(|&(_, &pressure)| pressure > 0.0).map(move |(cell, &pressure)| {
                let x = (column + (cell % TILE) as f64 + 0.5) * side;
                let y = (row + (cell / TILE) as f64 + 0.5) * side;
                ContactElement { centre: DVec2::new(x, y), side, pressure }
            })
        })
    }

    /// Number of elements in contact.
    #[must_use]
    pub(crate) fn n_elements(&self) -> usize {
        self.elements.ranks().count(self.pressure.par_iter().filter(|&&p| p > 0.0).count())
    }

    /// Whether elements cover the cell and all of them are in contact.
    #[must_use]
    pub(crate) fn is_full_contact(&self) -> bool {
        self.elements.cover_cell() && self.n_elements() == self.elements.n_cells()
    }

    /// How the solve ended.
    pub(crate) fn status(&self) -> Status {
        match self.converged {
            false => Status::NotConverged,
            true if self.is_full_contact() && !self.base.is_free() => Status::FullContact,
            true => Status::Converged,
        }
    }

    /// The grid of the smallest elements.
    pub(crate) fn finest_grid(&self) -> Grid {
        self.finest
    }

    /// Tiles of one size wherever there are elements, and the pressure on them.
    ///
    /// They are tiles of the grid, with means over smaller elements. With `finest`, they are tiles of the smallest
    /// elements, and a larger element stands for its parts.
    pub(crate) fn on_one_size(&self, finest: bool) -> (Mesh, Cow<'_, [f64]>) {
        let on_level = if finest { Elements::on_finest } else { Elements::on_coarsest };
        let (tiles, pressure) = on_level(&self.elements, &self.pressure);
        (Mesh::new(Elements::uniform(tiles), self.elements.ranks()), pressure)
    }

    /// Hands out the pressure on the grid in order, eight rows at a time.
    ///
    /// The pressure is the mean over smaller elements. `take` gets the index of the first row, and the rows one after
    /// the other. Stops at the first error.
    ///
    /// # Errors
    /// The error that `take` returns.
    pub(crate) fn pressure_rows<E>(
        &self,
        receiver: Receiver,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let (mesh, pressure) = self.on_one_size(false);
        bands(&mesh, receiver).try_for_each(|band| hand_out((&mesh, &pressure), band, &mut take))
    }

    /// Hands out the displacement v of the grid's pressure, rows of tiles at a time.
    ///
    /// The rows are those of [`AdaptiveSolution::pressure_rows`]. This costs about one application of L on the whole
    /// grid. With `finest`, v is that of the pressure itself, on the grid of the smallest elements. The gap is `v - h +
    /// offset`: see [`AdaptiveSolution::gap_offset`] and [`crate::levels::adaptive::AdaptiveProblem::gap_rows`].
    ///
    /// # Errors
    /// The error that `take` returns.
    pub(crate) fn displacement_rows<E>(
        &self,
        kernels: &Kernels,
        rows: Rows,
        mut take: impl FnMut(usize, &[f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        let (own, pressure) = self.on_one_size(rows.finest);
        let (own_tiles, [columns, _]) = (own.finest(), own.finest().extent());
        let prepared = kernels.response();
        let tables = prepared.tables(if rows.finest { self.finest } else { self.grid });
        for (band, to) in bands(&own, rows.receiver) {
            let more = band.clone().flat_map(|row| (0..columns).map(move |column| [column as u32, row as u32]));
            let tiles =
                own_tiles.of_same_cell(own_tiles.sides(), own_tiles.places().iter().copied().chain(more).collect());
            let mesh = Mesh::new(Elements::uniform(tiles), own.ranks());
            let hierarchy = Arc::new(Hierarchy::new(self.base, mesh.clone(), prepared.reach()));
            let mut values = own.moved(&mesh, &pressure, 0.0);
            // If the pressure is on a part of the cell, the mean over the whole cell does not tell its size.
            let mean = if own.cover_cell() { self.info.mean_pressure } else { 0.0 };
            let size = self.info.penetration_full_contact;
            let mut fresh = ScaledOperator::new(hierarchy, &tables, mean, size);
            write_blocks(&mut fresh, values.chunks(BLOCK_CELLS), |p, cells| cells.copy_from_slice(p));
            fresh.apply();
            read_blocks(&fresh, values.chunks_mut(BLOCK_CELLS), |v, cells| v.copy_from_slice(cells));
            hand_out((&mesh, &values), (band, to), &mut take)?;
        }
        Ok(())
    }

    /// Offset of the gap from v - h: the maximum height minus the penetration.
    #[must_use]
    pub(crate) fn gap_offset(&self, h_max: f64) -> f64 {
        h_max - self.info.penetration
    }

    /// Evaluates the observables, as [`Observables::of`] does for a solution on a uniform grid.
    #[must_use]
    pub(crate) fn observables(&self) -> Observables {
        let own = self.pressure.par_iter().copied().reduce(|| 0.0, f64::max);
        let max_pressure = self.elements.ranks().maximum(own, 0.0);
        let rms_pressure = rms_pressure(&self.elements, &self.pressure);
        Observables::new(&self.info, (self.area, self.plastic), rms_pressure, max_pressure)
    }

    /// Contact stiffness dσ0/dΔ at fixed contact area, in E*/λ, to 1e-3 relative.
    ///
    /// It is infinite in full contact, and to a few percent if the solve did not converge. It takes a few applications
    /// of L.
    #[must_use]
    pub(crate) fn contact_stiffness(&self, kernels: &Kernels) -> f64 {
        let pressure = elastic_part(&self.pressure, self.hardness);
        if self.is_full_contact()
            && !self.base.is_free()
            && self.plastic.is_none_or(|plastic| plastic.contact.cells <= 0.0)
        {
            return f64::INFINITY;
        }
        let n = self.finest.len() as f64;
        // The quick operator alone would be up to a percent off.
        let x = {
            let mut preconditioner = kernels.preconditioner().tables(self.finest);
            let (hierarchy, tables) = self.operator_of(kernels.quick());
            let mut corrections = TileCorrections::new(hierarchy, &tables, &mut preconditioner);
            stiffness_pressure(&pressure, n, &mut corrections, self.converged)
        };
        let (hierarchy, tables) = self.operator_of(kernels.response());
        stiffness_under(&x, n, &mut TileOperator::new(hierarchy, &tables))
    }

    /// The hierarchy and tables of L by this kernel on the mesh.
    fn operator_of(&self, prepared: &Prepared<f32>) -> (Arc<Hierarchy>, Tables<f32>) {
        let hierarchy = Hierarchy::new(self.base, self.elements.clone(), prepared.reach());
        (Arc::new(hierarchy), prepared.tables(self.finest))
    }
}

/// The values in a row of tiles, row by row. They are zero where there is no tile.
pub(crate) fn row_of_tiles(tiles: &TileSet, values: &[f64], row: usize) -> Vec<f64> {
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
    let squares = pressure.par_chunks(BLOCK_CELLS).map(|p| [p.iter().map(|p| p * p).sum()]).collect();
    let [squares] = elements.layout().total(squares);
    let n_cell: usize = elements.finest().sides().into_iter().product();
    (squares / n_cell as f64).sqrt()
}
