//! The difference of two fields, on the grid that both have.

use rc_core::{Field, Grid};
use serde::Serialize;

use crate::files::coarsen::BlockMean;
use crate::files::result::ResultFolder;
use crate::scene::values::GridSpec;

/// Relative difference of the sides of cells that are equal.
const SAME: f64 = 1e-9;

/// The difference of one field, B minus A.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    pub(super) field: Field,
    /// Greatest absolute value of both fields, on the common grid.
    pub(super) scale: f64,
}

/// The differences of pressure (Pa) and gap (m).
#[derive(Clone, Debug)]
pub(super) struct Differences {
    /// Side of the cell along x (m).
    pub(super) side: f64,
    pub(super) pressure: Difference,
    pub(super) gap: Difference,
}

/// The numbers of a difference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Numbers {
    /// Elements of the common grid along x and y.
    grid: [usize; 2],
    /// Root of the mean square.
    pub(super) rms: f64,
    /// Greatest absolute value.
    pub(super) max: f64,
    /// Mean over the cell.
    mean: f64,
}

impl Difference {
    pub(super) fn numbers(&self) -> Numbers {
        let (grid, values) = (self.field.grid(), self.field.values());
        Numbers {
            grid: [grid.nx(), grid.ny()],
            rms: (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt(),
            max: values.iter().fold(0.0, |max: f64, value| max.max(value.abs())),
            mean: self.field.mean(),
        }
    }
}

impl Differences {
    /// The differences of the fields of two results.
    ///
    /// # Errors
    /// A line that says why the fields cannot be compared.
    pub(super) fn of(a: &ResultFolder, b: &ResultFolder) -> Result<Self, String> {
        let ([ax, ay], [bx, by]) = (a.sides(), b.sides());
        let is_same = |a: f64, b: f64| (a - b).abs() <= SAME * a;
        if !is_same(ax, bx) || !is_same(ay, by) {
            return Err(format!("the cells differ: {ax} m by {ay} m, and {bx} m by {by} m"));
        }
        let (grid_a, grid_b) = (a.pressure.grid(), b.pressure.grid());
        let coarse = if grid_a.len() <= grid_b.len() { grid_a } else { grid_b };
        let fits = |fine: Grid| fine.nx().is_multiple_of(coarse.nx()) && fine.ny().is_multiple_of(coarse.ny());
        if !fits(grid_a) || !fits(grid_b) {
            return Err(format!("the grids of {grid_a} and {grid_b} elements are no multiples of each other"));
        }
        let difference = |a: &Field, b: &Field| Difference::of(&on(a, coarse), &on(b, coarse));
        Ok(Self { side: a.side, pressure: difference(&a.pressure, &b.pressure), gap: difference(&a.gap, &b.gap) })
    }
}

impl Difference {
    /// `b` minus `a`, which are on the same grid.
    fn of(a: &Field, b: &Field) -> Self {
        let values = a.values().iter().zip(b.values()).map(|(a, b)| b - a).collect();
        let field = Field::new(a.grid(), values).expect("as many values as the grid has elements");
        Self { field, scale: a.max().max(b.max()) }
    }
}

/// The means of `field` over the elements of a coarser grid.
fn on(field: &Field, coarse: Grid) -> Field {
    let mut mean = BlockMean::new(field.grid(), GridSpec { nx: coarse.nx(), ny: coarse.ny() });
    mean.take(field.values());
    mean.finish()
}
