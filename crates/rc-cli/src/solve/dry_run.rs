//! `rc solve --dry-run`: what a solve will take, before any of it is solved.

use serde::Serialize;

use rc_solver::UNIFORM_BYTES_PER_ELEMENT;

use super::method::{self, Choice, Plan};
use crate::coarsen::check_factor;
use crate::error::CliError;
use crate::output;
use crate::report;
use crate::resolve::ContactProblem;
use crate::scene::RunKeys;
use crate::surface::SurfaceProblem;
use rc_core::quantity::digits;
use rc_sweep::memory::ByteSize;
use rc_sweep::to_json;

/// Processor seconds for each cell of the adaptive method at a tolerance of 1e-6 or more: measured 1.1e-6 to 1.5e-6 for cells that are
/// evaluated, of which the estimate counts 0.55 to 0.9 (512² to 4096², 0.9 % to 20 % contact, H = 0.3 and 0.8).
const SECONDS_PER_ADAPTIVE_CELL: f64 = 1.7e-6;

/// The same for each element of the uniform grid: measured 0.6e-6 to 1.0e-6 (512² and 2048², 7 % to 71 % contact).
const SECONDS_PER_UNIFORM_ELEMENT: f64 = 0.85e-6;

/// Work added by each factor of ten in the tolerance below 1e-6: measured a factor 2.9 for 1e-9.
const WORK_PER_DECADE: f64 = 0.63;

/// Memory of the process besides that of the method.
const PROCESS_BYTES: f64 = 1e7;

/// What is to be expected of a solve.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Expected {
    status: &'static str,
    method: String,
    grid: [usize; 2],
    /// Contact area relative to the cell; only the adaptive method estimates it.
    area_fraction: Option<f64>,
    /// Cells that are solved for on the finest level; `None` where it is not known before.
    elements: Option<f64>,
    memory_bytes: Option<f64>,
    /// On an idle machine.
    wall_seconds: Option<f64>,
    threads: usize,
}

/// Prints the estimate; nothing is solved or written.
///
/// # Errors
/// [`CliError::Input`] for whatever a solve would refuse before its first iteration.
pub(super) fn run(
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    run: &RunKeys,
    threads: usize,
) -> Result<(), CliError> {
    let loaded = surface.load()?;
    if let Some(spec) = contact.keys.output_grid {
        check_factor(loaded.grid, spec)?;
    }
    let Choice { plan, reason } = method::choose(&loaded, contact, surface.cell.side(), run)?;
    let grid = [loaded.grid.nx(), loaded.grid.ny()];
    let n = loaded.grid.len() as f64;
    let (area_fraction, elements, memory_bytes, work) = match &plan {
        Plan::Adaptive(problem) => {
            let estimate = problem.estimate();
            let cells = estimate.cells;
            (
                Some(estimate.area_fraction),
                Some(cells),
                Some(estimate.adaptive_bytes),
                Some(SECONDS_PER_ADAPTIVE_CELL * cells),
            )
        }
        Plan::Uniform => {
            let bytes = n * UNIFORM_BYTES_PER_ELEMENT as f64;
            (None, Some(n), Some(bytes), Some(SECONDS_PER_UNIFORM_ELEMENT * n))
        }
        Plan::GaussSeidel => (None, None, None, None),
    };
    let memory_bytes = memory_bytes.map(|bytes| bytes + PROCESS_BYTES);
    let decades = (-6.0 - contact.params.tolerance.log10()).max(0.0);
    let wall_seconds = work.map(|work| work * (1.0 + WORK_PER_DECADE * decades) / threads as f64);
    let expected = Expected {
        status: "dry_run",
        method: reason,
        grid,
        area_fraction,
        elements,
        memory_bytes,
        wall_seconds,
        threads,
    };
    output::print(&if run.json { to_json(&expected) } else { expected.lines() })
}

impl Expected {
    fn lines(&self) -> String {
        let or_unknown = |text: Option<String>| text.unwrap_or_else(|| "not known before the solve".to_owned());
        let seconds = |value: f64| format!("{} s with {} threads of an idle machine", digits(value, 2), self.threads);
        let elements = |value: f64| format!("{} of {} x {}", digits(value.round(), 3), self.grid[0], self.grid[1]);
        report::aligned(&[
            ("method", self.method.clone()),
            ("elements", or_unknown(self.elements.map(elements))),
            ("memory", or_unknown(self.memory_bytes.map(|bytes| ByteSize(bytes as u64).to_string()))),
            ("time", or_unknown(self.wall_seconds.map(seconds))),
        ]) + "\nNothing was solved or written; expect elements, memory and time within a factor of two.\n"
    }
}
