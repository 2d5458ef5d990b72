//! The flow through the gap, as a summary has it.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::content::Cells;

/// Flow of a thin film along x and along y under a pressure that falls by ΔP across the cell. Lists are of these two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeakageSummary {
    /// K of the flow Q = K ΔP/(12 η) with the viscosity η (m³): 0 where nothing percolates.
    pub permeance: [f64; 2],
    /// Certified error of the solver, relative: the permeance of the network is at most `permeance`, and at least this
    /// part below it.
    pub relative_error: [f64; 2],
    /// Estimated error of the grid (m³): the difference from the permeance of every second element.
    pub permeance_error: [Option<f64>; 2],
    /// Axis with the larger permeance, whose flow is drawn and written: `x` or `y`; null where nothing flows.
    pub flow_direction: Option<String>,
    /// Whether the film winds around the cell.
    pub percolates: [bool; 2],
    /// Gap of the narrowest place of the widest path (m).
    pub critical_gap: [Option<f64>; 2],
    /// Where it is (m).
    pub critical_place: [Option<[f64; 2]>; 2],
    /// Largest difference of the flow through a section from the mean over all, relative to it.
    pub conservation_error: [f64; 2],
    /// Iterations.
    pub iterations: [usize; 2],
    /// Seconds for both flows.
    pub wall_seconds: f64,
}

/// Columns of a flow in a table.
const COLUMNS: [&str; 5] = ["permeance_x", "permeance_y", "permeance_error_x", "permeance_error_y", "percolates"];

impl LeakageSummary {
    /// The flow as cells of a row.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (&'static str, Value)> {
        let ([x, y], [error_x, error_y]) = (self.permeance, self.permeance_error);
        let values = [json!(x), json!(y), json!(error_x), json!(error_y), json!(self.percolates)];
        COLUMNS.into_iter().zip(values)
    }

    /// Adds empty cells to the row of a flow that did not converge: every row has the same columns.
    pub fn complete(cells: &mut Cells) {
        for column in COLUMNS {
            cells.entry(column).or_insert(Value::Null);
        }
    }
}
