//! Friction of a contact on tiles under a surface that slides along x.

use rayon::prelude::*;
use rc_core::{Field, Grid, Kernel};
use rc_fft::half_plane_values;
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE};

use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::sliding::friction::Sums;
use crate::tiles::data::TileData;
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tile_operator::TileOperator;

/// Weights of a central difference of the eighth order, of the elements at distances 1 to 4.
///
/// At eight elements for a wave, a slope is 3e-4 too small, and 2e-6 at sixteen.
const DIFFERENCE: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Shortest length ℓ, in sides of the finest elements, whose lag counts in the force from the displacement.
///
/// The error of the operator would otherwise exceed what shorter ones add.
const SHORTEST: f64 = 0.01;

/// A pressure on the finest level of tiles.
pub(crate) struct SlidingContact<'a> {
    pub(crate) data: &'a TileData<'a>,
    pub(crate) kernel: &'a dyn Kernel,
    /// The whole grid of the elements.
    pub(crate) grid: Grid,
    pub(crate) mesh: &'a Mesh,
    pub(crate) pressure: &'a [f64],
}

impl SlidingContact<'_> {
    /// The sums that friction follows from. `None` if nothing slides.
    pub(crate) fn sums(&self) -> Option<Sums> {
        let velocity = self.kernel.sliding_velocity()?;
        let along = if velocity.x < 0.0 { -1.0 } else { 1.0 };
        let [x, y] = self.of_heights();
        let (slope, loss_tangent) = self.of_waves()?;
        Some(Sums {
            of_heights: [along * x, along * y],
            of_displacement: self.of_displacement()?,
            slope,
            missed: 0.0,
            of_finer: 0.0,
            loss_tangent,
        })
    }

    /// The force against the velocity, -⟨p ∂h⟩ along it.
    pub(crate) fn force(&self) -> f64 {
        let velocity = self.kernel.sliding_velocity().unwrap_or_default();
        self.of_heights()[0] * if velocity.x < 0.0 { -1.0 } else { 1.0 }
    }

    /// -⟨p ∂h⟩ along x and y.
    fn of_heights(&self) -> [f64; 2] {
        let (tiles, heights) = (self.mesh.finest(), &self.data.heights);
        let (sides, extent, spacing) = (tiles.sides(), tiles.extent(), self.grid.spacing());
        let of_tile = |(place, pressure): (&[u32; 2], &[f64])| {
            if pressure.iter().all(|&p| p <= 0.0) {
                return [0.0; 2];
            }
            let at = |axis: usize, step: usize| {
                let mut place = place.map(|i| i as usize);
                place[axis] = (place[axis] + extent[axis] + step - 1) % extent[axis];
                let mut tile = [0.0; CELLS];
                heights.tile(sides, place, &mut tile);
                tile
            };
            let lines = [0, 1].map(|axis| [0, 1, 2].map(|step| at(axis, step)));
            let mut sums = [0.0; 2];
            for (cell, p) in pressure.iter().enumerate() {
                let (x, y) = (cell % TILE, cell / TILE);
                let along_x = |i: usize| lines[0][i / TILE][y * TILE + i % TILE];
                let along_y = |i: usize| lines[1][i / TILE][i % TILE * TILE + x];
                sums[0] -= p * slope(along_x, TILE + x) / spacing.x;
                sums[1] -= p * slope(along_y, TILE + y) / spacing.y;
            }
            sums
        };
        let sums: Vec<[f64; 2]> = tiles.places().par_iter().zip(self.pressure.par_chunks(CELLS)).map(of_tile).collect();
        let n = self.grid.len() as f64;
        [0, 1].map(|axis| sums.iter().map(|sums| sums[axis]).sum::<f64>() / n)
    }

    /// -⟨p ∂u⟩ along the velocity, by the operator of the dissipation.
    fn of_displacement(&self) -> Option<f64> {
        let (kernels, elements) = (&self.data.kernels, Elements::uniform(self.mesh.finest().clone()));
        let prepared = kernels.dissipation(SHORTEST * self.grid.spacing().x)?;
        let hierarchy = Hierarchy::new(kernels.base(), elements, prepared.reach());
        let mut operator = TileOperator::new(hierarchy.into(), prepared.tables(self.grid));
        let blocks = || self.pressure.chunks(BLOCK_CELLS);
        write_blocks(&mut operator, blocks(), |p, cells| cells.copy_from_slice(p));
        operator.apply();
        let parts = read_blocks(&operator, blocks(), |p, cells| p.iter().zip(cells).map(|(p, v)| p * v).sum::<f64>());
        Some(parts.iter().sum::<f64>() / self.grid.len() as f64)
    }

    /// ⟨∂h S⁻¹ ∂h⟩ along x with the symmetric part S of L, and the maximum loss tangent of waves along x.
    fn of_waves(&self) -> Option<(f64, f64)> {
        let symbol = self.kernel.sliding_symbol(self.grid)?;
        let heights: &Field = self.data.heights.all_waves();
        let grid = heights.grid();
        let (nx, ny) = (grid.nx() as i64, grid.ny() as i64);
        let waves = half_plane_values(heights, heights.mean(), |wave| wave.norm_sqr());
        let of_wave = |(place, square): (usize, &f64)| {
            let (kx, row) = (place as i64 / ny, place as i64 % ny);
            let ky = if 2 * row > ny { row - ny } else { row };
            // A wave of half the elements has no slope at their centres.
            if kx == 0 || 2 * kx == nx {
                return 0.0;
            }
            2.0 * grid.angular_wave(kx, ky).x.powi(2) * square / symbol(kx, ky).re
        };
        let columns = waves.par_chunks(ny as usize).enumerate().map(|(kx, column)| {
            column.iter().enumerate().map(|(row, square)| of_wave((kx * ny as usize + row, square))).sum::<f64>()
        });
        let columns: Vec<f64> = columns.collect();
        let of_line = (1..=self.grid.nx() as i64 / 2).map(|kx| symbol(kx, 0));
        let loss_tangent = of_line.map(|factor| factor.im.abs() / factor.re).fold(0.0, f64::max);
        Some((columns.iter().sum::<f64>() * (grid.len() as f64).powi(-2), loss_tangent))
    }
}

/// The slope per element of values in a line, at one of them.
fn slope(value: impl Fn(usize) -> f64, at: usize) -> f64 {
    (1..).zip(DIFFERENCE).map(|(i, weight)| weight * (value(at + i) - value(at - i))).sum()
}
