//! The command, with what it prints.

use std::time::Instant;

use rc_core::quantity::{count, digits};
use rc_sweep::to_json;

use super::args::StudyArgs;
use super::solved::{self, SolvedStudy};
use crate::error::CliError;
use crate::{terminal, text};

/// Runs `rc study`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: StudyArgs) -> Result<(), CliError> {
    let started = Instant::now();
    let study = solved::run(args, None)?;
    let SolvedStudy { record, rows, n_threads, run, folder, .. } = &study;
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(record))?,
        (false, true) => {}
        (false, false) => {
            let seconds = digits(started.elapsed().as_secs_f64(), 3);
            let rows = format!("{} in {seconds} s, {}\n", count(rows.len(), "row"), count(*n_threads, "thread"));
            terminal::print(&(record.text() + &rows + &text::written(Some(folder))))?;
        }
    }
    study.verdict()
}
