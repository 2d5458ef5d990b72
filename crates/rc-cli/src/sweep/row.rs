//! One row: a contact problem solved, as cells.

use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::content::Cells;
use super::plan::{Plan, Row};
use crate::error::CliError;
use crate::progress::Progress;
use crate::scene::RunKeys;
use crate::solve::Solved;
use crate::summary::Summary;
use crate::surface::LoadedSurface;

/// The surface that was loaded last: its loads follow one another, so that one surface at a time serves all workers.
#[derive(Default)]
pub(super) struct LatestSurface(Mutex<Option<Loaded>>);

#[derive(Clone)]
struct Loaded {
    /// Row of its first load.
    first_row: usize,
    surface: Arc<LoadedSurface>,
    /// Time it took to load.
    time: Duration,
}

impl LatestSurface {
    fn get(&self, row: &Row<'_>, first_row: usize) -> Result<Loaded, CliError> {
        // A worker that panicked has stored nothing: the lock is as good as before.
        let mut latest = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(loaded) = latest.as_ref().filter(|loaded| loaded.first_row == first_row) {
            return Ok(loaded.clone());
        }
        let started = Instant::now();
        // The one before is let go of first.
        *latest = None;
        let surface = Arc::new(row.surface.problem.load()?);
        let loaded = Loaded { first_row, surface, time: started.elapsed() };
        *latest = Some(loaded.clone());
        Ok(loaded)
    }
}

/// Solves `row` of `plan`. With fields, its folder is complete when this returns. `wall_seconds` includes the time
/// that loading the surface took once.
///
/// # Errors
/// [`CliError`]; a row that did not converge is none.
pub(super) fn solve(plan: &Plan, row: &Row<'_>, surfaces: &LatestSurface, threads: usize) -> Result<Cells, CliError> {
    let named = |error: CliError| match error {
        CliError::Input(message) => CliError::input(format_args!("{}: {message}", row.describe(plan.control))),
        other => other,
    };
    let loaded = surfaces.get(row, row.index - row.index % plan.shape().loads).map_err(named)?;
    let started = Instant::now().checked_sub(loaded.time).unwrap_or_else(Instant::now);
    let folder = plan.fields_folder(row.index);
    let run = RunKeys { out: folder.clone(), ..plan.run.clone() };
    let side = row.surface.problem.cell.side();
    let progress = Progress::new(true);
    let solved = Solved::new(&loaded.surface, &row.contact, side, &run, started, &progress).map_err(named)?;
    let summary = solved.summary(threads);
    if let Some(folder) = folder {
        // A row that is solved has no folder, unless a process was killed while it wrote it.
        if let Err(cause) = std::fs::remove_dir_all(&folder)
            && cause.kind() != std::io::ErrorKind::NotFound
        {
            return Err(CliError::write(&folder, cause));
        }
        solved.write(&folder, &summary).inspect_err(|_| {
            // A row is there whole or not at all. What stays is replaced when the row is solved again.
            let _ = std::fs::remove_dir_all(&folder);
        })?;
    }
    Ok(cells(plan, row, &summary))
}

/// The columns of a row: scene, if there are several, seed, load, summary.
fn cells(plan: &Plan, row: &Row<'_>, summary: &Summary) -> Cells {
    let mut cells = Cells::new();
    if plan.names_scenes {
        cells.insert("scene".into(), json!(row.surface.scene));
    }
    cells.insert("seed".into(), json!(row.surface.seed));
    cells.insert("control_value".into(), json!(row.load));
    if let Value::Object(summary) = json!(summary) {
        cells.extend(summary);
    }
    cells
}
