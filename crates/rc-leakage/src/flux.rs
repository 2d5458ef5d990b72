//! The flow field.

use rc_core::Field;

use crate::flow_state::FlowState;
use crate::parallel;

/// The flux at the centres of elements, in λ².
///
/// It is the volume that flows across a unit of length, for a pressure that falls by 1 across the cell and 12 η = 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Flux {
    /// Component along x.
    pub x: Field,
    /// Component along y.
    pub y: Field,
}

impl Flux {
    /// The mean of the fluxes through opposite faces of each element.
    ///
    /// `factor` converts from a fall of 1 per element.
    pub(crate) fn of(state: FlowState<'_>, factor: f64) -> Self {
        let grid = state.network.grid();
        let (nx, spacing) = (grid.nx(), grid.spacing());
        let [per_x, per_y] = [0.5 * factor / spacing.y, 0.5 * factor / spacing.x];
        let (mut x, mut y) = (Field::zeros(grid), Field::zeros(grid));
        let block = parallel::rows_per_block(nx) * nx;
        let blocks = x.values_mut().chunks_mut(block).zip(y.values_mut().chunks_mut(block)).zip(state.network.blocks());
        parallel::for_each(blocks.collect(), |((x, y), rows): ((&mut [f64], &mut [f64]), [usize; 2])| {
            state.visit(rows, &mut |row| {
                let start = (row.iy - rows[0]) * nx;
                for ix in 0..nx {
                    x[start + ix] = per_x * (row.east[ix] + row.west(ix));
                    y[start + ix] = per_y * (row.north[ix] + row.south[ix]);
                }
            });
        });
        Self { x, y }
    }

    /// Magnitude of the flux of each element.
    #[must_use]
    pub fn magnitude(&self) -> Field {
        let values = self.x.values().iter().zip(self.y.values()).map(|(x, y)| x.hypot(*y)).collect();
        Field::new(self.x.grid(), values).unwrap_or_else(|_| Field::zeros(self.x.grid()))
    }
}
