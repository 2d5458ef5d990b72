//! `rc solve --dry-run`: an estimate of the cost of a solve.

use rc_core::quantity::digits;
use rc_solver::Plan;
use rc_sweep::memory::ByteSize;
use rc_sweep::to_json;
use serde::Serialize;

use super::solved::ProblemSetup;
use crate::error::CliError;
use crate::scene::keys::RunKeys;
use crate::{terminal, text};

/// Memory of the process without that of the method, in bytes.
const PROCESS_BYTES: f64 = 1e7;

/// Expected numbers of a solve.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Expected {
    status: &'static str,
    method: String,
    grid: [usize; 2],
    /// Contact area relative to the cell. Only the adaptive method estimates it.
    area_fraction: Option<f64>,
    /// Number of unknowns on the finest level; `None` if it is not known before the solve.
    elements: Option<f64>,
    memory_bytes: Option<f64>,
    /// Time on an idle machine (s).
    wall_seconds: Option<f64>,
    threads: usize,
    /// Whether elements have several sizes.
    #[serde(skip)]
    has_border: bool,
}

/// Prints the estimate, without solving or writing anything.
///
/// # Errors
/// [`CliError::Input`] for a problem that a solve would refuse before its first iteration.
pub(super) fn run(problem: &ProblemSetup<'_>, threads: usize, run: &RunKeys) -> Result<(), CliError> {
    let expected = Expected::of(problem, &problem.plan()?, threads);
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&expected)),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&expected.lines()),
    }
}

impl Expected {
    fn of(problem: &ProblemSetup<'_>, plan: &Plan<'_>, threads: usize) -> Self {
        let (cost, grid) = (problem.cost(plan), problem.surface.grid);
        Self {
            status: "dry_run",
            method: plan.reason().to_string(),
            grid: [grid.nx(), grid.ny()],
            area_fraction: cost.area_fraction,
            elements: cost.elements,
            memory_bytes: cost.bytes.map(|bytes| bytes + PROCESS_BYTES),
            wall_seconds: cost.cpu_seconds.map(|seconds| seconds / threads as f64),
            threads,
            has_border: problem.contact.params.border_level > 0,
        }
    }

    fn lines(&self) -> String {
        let or_unknown = |text: Option<String>| text.unwrap_or_else(|| "not known before the solve".to_owned());
        let seconds = |value: f64| format!("{} s with {} threads of an idle machine", digits(value, 2), self.threads);
        let [nx, ny] = self.grid;
        let elements = |value: f64| {
            let count = digits(value.round(), 3);
            if self.has_border {
                format!("{count} of several sizes to evaluate")
            } else {
                format!("{count} of {nx} x {ny} to evaluate")
            }
        };
        let memory = |bytes: f64| {
            let [all, program] = [bytes, PROCESS_BYTES].map(|bytes| ByteSize(bytes as u64));
            format!("{all}, of which the program itself {program}")
        };
        text::aligned(&[
            ("method", self.method.clone()),
            ("elements", or_unknown(self.elements.map(elements))),
            ("memory", or_unknown(self.memory_bytes.map(memory))),
            ("time", or_unknown(self.wall_seconds.map(seconds))),
        ]) + "\nNothing was solved or written; elements, memory and time are right within a factor of two for solves of a second or longer.\n"
    }
}
