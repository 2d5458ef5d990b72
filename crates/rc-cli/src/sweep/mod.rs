//! `rc sweep`: many loads on many surfaces, kept row by row.
//!
//! A plan is what is to be solved, the journal what is done, workers do the difference, and a table is the result. No row
//! depends on another one, so that resumed and sharded sweeps give the rows of an uninterrupted one.

mod bar;
mod content;
mod interrupt;
mod journal;
mod lists;
mod lock;
mod merge;
mod plan;
mod row;
mod settings;
mod shard;
mod table;
mod workers;

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Instant;

pub use self::lists::{Loads, Seeds};
pub use self::shard::Shard;
pub(crate) use self::table::TABLE_FILE;

use self::bar::RowBar;
use self::content::{Cells, Content, Header, JOURNAL_FILE, Rows};
use self::journal::Journal;
use self::plan::Plan;
use self::workers::locked;
use crate::args::{SweepArgs, SweepCommand};
use crate::error::CliError;
use rc_core::quantity;

use crate::{output, resolve, summary};

/// What a sweep has in its folder; `rows` has a folder for the fields of each row.
const FILES: [&str; 3] = [JOURNAL_FILE, TABLE_FILE, ROWS_FOLDER];

const ROWS_FOLDER: &str = "rows";

/// Runs `rc sweep`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(crate) fn run(args: SweepArgs) -> Result<(), CliError> {
    if let Some(SweepCommand::Merge(args)) = args.command {
        return merge::run(&args);
    }
    let plan = Plan::new(&args)?;
    let missing = || CliError::input("out: a sweep keeps its rows in a folder; give --out DIR");
    let folder = plan.run.out.clone().ok_or_else(missing)?;
    let shard = args.shard.unwrap_or(Shard::WHOLE);
    if shard.count > plan.shape().rows() {
        let rows = plan.shape().rows();
        let message = format_args!("shard: {shard} of a sweep of {rows} rows is empty; use at most {rows} shards");
        return Err(CliError::input(message));
    }
    let header = Header::new(plan.shape(), shard, settings::of(&plan)?);
    let threads = resolve::start_threads(plan.run.threads)?;
    let journal = Journal::start(&folder, &header, args.resume)?;
    execute(&plan, shard, journal, &folder, threads)
}

/// Finished rows in the journal of a sweep (`sweep.jsonl`), whose last line may be incomplete.
///
/// # Errors
/// [`CliError::Input`] when it is no journal, or a line before the last is damaged.
pub fn finished_rows(journal: &[u8]) -> Result<usize, CliError> {
    Content::of_bytes(journal, Path::new(JOURNAL_FILE)).map(|content| content.rows.len())
}

/// Solves what is missing, writes the table, says what happened.
fn execute(plan: &Plan, shard: Shard, journal: Journal, folder: &Path, threads: usize) -> Result<(), CliError> {
    let started = Instant::now();
    let is_done = |row: &usize| journal.rows.contains_key(row) && (!plan.fields || has_fields(folder, *row));
    let todo: Vec<usize> = shard.rows(plan.shape()).filter(|row| !is_done(row)).collect();
    let n_rows = shard.rows(plan.shape()).count();
    let n_before = n_rows - todo.len();
    if !todo.is_empty() {
        table::write(folder, &journal.rows)?;
    }
    let bar = RowBar::new(n_before, n_rows, plan.run.quiet);
    let journal = Arc::new(Mutex::new(journal));
    interrupt::install(folder.to_owned(), Arc::clone(&journal), bar.clone(), n_rows);
    let solved = workers::run(plan, &todo, threads, &journal, &bar);
    bar.clear();
    let journal = locked(&journal);
    let written = table::write(folder, &journal.rows);
    if let Err(error) = solved {
        // What it says comes first: on a full disk, for one, the table fails as well.
        journal.discard_empty(folder);
        return Err(with_count(error, n_rows - journal.rows.len(), journal.rows.len()));
    }
    let path = written?;
    if plan.run.json && !plan.run.quiet {
        output::print(&summary::to_json(&journal.rows.values().collect::<Vec<_>>()))?;
    } else if !plan.run.quiet {
        let seconds = quantity::digits(started.elapsed().as_secs_f64(), 3);
        let before = if n_before > 0 { format!(" ({n_before} kept from before)") } else { String::new() };
        output::print(&format!(
            "{n_rows} rows{before} in {seconds} s, {threads} threads\n\nwritten to {}\n",
            path.display()
        ))?;
    }
    if let (missing @ 1.., Some(limit)) = (n_rows - journal.rows.len(), plan.run.time_limit) {
        return Err(CliError::NotConverged(format!(
            "time_limit: after {limit} {missing} of {n_rows} rows are not solved; --resume goes on"
        )));
    }
    check_converged(&journal.rows, &path)
}

/// The error of a row, and how many there are of which kind.
fn with_count(error: CliError, missing: usize, kept: usize) -> CliError {
    match error {
        CliError::Input(message) if kept > 0 => CliError::input(format_args!(
            "{message}; {missing} rows cannot be solved, the other {kept} are in {TABLE_FILE}"
        )),
        other => other,
    }
}

/// An error when a row did not converge.
fn check_converged(rows: &Rows, table: &Path) -> Result<(), CliError> {
    let failed = |cells: &&Cells| cells.get("status").is_some_and(|status| status == "not_converged");
    match rows.values().filter(failed).count() {
        0 => Ok(()),
        n => Err(CliError::NotConverged(format!(
            "{n} of {} rows did not converge; they are marked not_converged in {}",
            rows.len(),
            table.display()
        ))),
    }
}

/// The settings of the sweep in `folder`, from its journal, if there is one that can be read.
pub(crate) fn settings_in(folder: &Path) -> Option<serde_json::Value> {
    Some(Content::read(folder).ok()?.header.settings)
}

/// The folder for the fields of row `index` in the folder of a sweep: numbered from 1, as the lines of the table.
fn fields_folder(sweep: &Path, index: usize) -> PathBuf {
    sweep.join(ROWS_FOLDER).join(row_name(index))
}

fn row_name(index: usize) -> String {
    format!("{:04}", index + 1)
}

/// Whether the fields of a row are there; the summary is written last.
fn has_fields(sweep: &Path, index: usize) -> bool {
    fields_folder(sweep, index).join("summary.json").exists()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::row::LatestSurface;
    use super::*;
    use crate::args::{Cli, Command};
    use clap::Parser as _;

    #[test]
    fn a_row_that_did_not_converge_is_marked_and_makes_exit_code_3() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let flags = ["rc", "sweep", "--waves", "8", "--grid", "64", "--pressures", "1e4,1e5", "--quiet", "--out"];
        let out = dir.path().join("s");
        let cli = Cli::try_parse_from(flags.iter().map(std::ffi::OsStr::new).chain([out.as_os_str()]));
        let Command::Sweep(args) = cli.expect("a command line").command else { panic!("not a sweep") };
        let plan = Plan::new(&args).expect("a plan");
        let header = Header::new(plan.shape(), Shard::WHOLE, settings::of(&plan).expect("settings"));
        let mut journal = Journal::start(&out, &header, false).expect("a journal");
        let mut row = plan.row(0).expect("a row");
        row.contact.params.max_iterations = 1;
        let cells = row::solve(&plan, &row, &LatestSurface::default(), 1).expect("cells, not an error");
        assert_eq!(cells["status"], json!("not_converged"));
        journal.append(0, cells).expect("a row");
        let error = execute(&plan, Shard::WHOLE, journal, &out, 1).expect_err("a row did not converge");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().starts_with("1 of 2 rows did not converge"), "{error}");
        let table = std::fs::read_to_string(out.join(TABLE_FILE)).expect("a table");
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 3, "{table}");
        assert!(lines[1].contains("not_converged") && lines[2].contains(",converged,"), "{table}");
    }
}
