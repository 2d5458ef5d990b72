//! Summary of the flow through the gap.

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::content::Cells;

/// Flow of a thin film along x and along y, as lists of two values.
///
/// The pressure decreases by ΔP across the cell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LeakageSummary {
    /// K of the flow Q = K ΔP/(12 η) with the viscosity η (m³). It is 0 without percolation.
    pub permeance: [f64; 2],
    /// Certified relative error of the solver.
    ///
    /// The permeance of the network is between `permeance` times (1 - this error) and `permeance`.
    pub relative_error: [f64; 2],
    /// Error bar of the grid (m³), from the permeances on coarser grids.
    ///
    /// Where nothing percolates, it is the leak on coarser grids, or through contacts that are a little smaller.
    pub permeance_error: [Option<f64>; 2],
    /// Flow (m³/s) for the given viscosity and pressure drop, K ΔP/(12 η).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow: Option<[f64; 2]>,
    /// Error bar of the flow (m³/s), from that of the permeance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flow_error: Option<[Option<f64>; 2]>,
    /// Axis with the larger permeance, `x` or `y`, or null without flow.
    ///
    /// The flow along this axis is drawn and written.
    pub flow_direction: Option<String>,
    /// Whether the film winds around the cell.
    pub percolates: [bool; 2],
    /// Gap (m) at the narrowest place of the widest path.
    pub critical_gap: [Option<f64>; 2],
    /// Position (m) of that place.
    pub critical_place: [Option<[f64; 2]>; 2],
    /// Maximum relative difference of the flow through a section from the mean.
    ///
    /// The mean is over all sections, and the difference is relative to it.
    pub conservation_error: [f64; 2],
    /// Number of iterations.
    pub iterations: [usize; 2],
    /// Time for both flows, in seconds.
    pub wall_seconds: f64,
}

/// Columns of a flow in a table.
const COLUMNS: [&str; 5] = ["permeance_x", "permeance_y", "permeance_error_x", "permeance_error_y", "percolates"];

/// Columns of a flow in m³/s.
const FLOW_COLUMNS: [&str; 4] = ["flow_x", "flow_y", "flow_error_x", "flow_error_y"];

impl LeakageSummary {
    /// The flow as cells of a row.
    pub(crate) fn cells(&self) -> impl Iterator<Item = (&'static str, Value)> {
        let ([x, y], [error_x, error_y]) = (self.permeance, self.permeance_error);
        let values = [json!(x), json!(y), json!(error_x), json!(error_y), json!(self.percolates)];
        let flows = self.flow.map(|[x, y]| {
            let [error_x, error_y] = self.flow_error.unwrap_or_default();
            FLOW_COLUMNS.into_iter().zip([json!(x), json!(y), json!(error_x), json!(error_y)])
        });
        COLUMNS.into_iter().zip(values).chain(flows.into_iter().flatten())
    }

    /// Adds empty cells to the row of a flow that did not converge.
    ///
    /// Every row then has the same columns.
    ///
    /// With `has_film` they have flows in m³/s.
    pub fn complete(cells: &mut Cells, has_film: bool) {
        let flows = has_film.then_some(FLOW_COLUMNS).into_iter().flatten();
        for column in COLUMNS.into_iter().chain(flows) {
            cells.entry(column).or_insert(Value::Null);
        }
    }
}
