//! The command, from the file to the folder.

use std::path::Path;

use rc_heights::{HeightMap, Treatment};
use rc_sweep::files::Staged;
use rc_sweep::memory::Budget;
use rc_sweep::to_json;

use super::args::{PrepareArgs, after_crops, check_filled, treatments};
use super::pictures;
use super::record::PrepareRecord;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::files::names::PREPARE_FILE;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, Scene};
use crate::scene::resolve;
use crate::surface::surface_files::stage_folder;
use crate::surface::treated::{self, Prepared};
use crate::warnings::shown::{refuse, tell};
use crate::{terminal, text};

/// Runs `rc prepare`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: PrepareArgs) -> Result<(), CliError> {
    if args.run.time_limit.is_some() {
        return Err(CliError::input("time_limit: rc prepare has none; omit --time-limit"));
    }
    let keys = args.steps.keys();
    let treatments = treatments(&keys)?;
    let flags = Scene { surface: args.surface, contact: ContactKeys::default(), run: args.run };
    let Scene { surface, run, .. } = resolve::layers(Some(&args.file), flags)?;
    threads::start(run.threads)?;
    let budget = Budget::new(run.memory_limit);
    let folder = run.out.as_deref().unwrap_or(Path::new("."));
    Kind::Surface.check_out(folder)?;
    let read = treated::read(surface)?;
    let before = read.map.clone();
    if keys.fill.is_none() {
        let crops = &treatments[..after_crops(&treatments)];
        let (cropped, _) =
            rc_heights::apply(before.clone(), crops).map_err(|cause| CliError::in_file(&read.path, cause))?;
        check_filled(&read.path, &keys, &cropped)?;
    }
    let prepared = treated::treat(read, &treatments, budget)?;
    let heights = prepared.surface.heights()?;
    let surface = prepared.record(&heights);
    refuse(&surface.warnings, run.strict, "; nothing was written")?;
    tell(&surface.warnings, &run);
    let record = PrepareRecord::new(&surface, &prepared.effects);
    let mut staged = stage_folder(folder, &prepared.surface, &heights, &surface, prepared.cell.side())?;
    add_pictures(&mut staged, before, &prepared, &treatments)?;
    staged.add_text(PREPARE_FILE, &to_json(&record))?;
    staged.commit()?;
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&record)),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&(record.text(&surface) + &text::written(Some(folder)))),
    }
}

/// Adds the pictures of the map as read, and of the points that were despiked.
fn add_pictures(
    staged: &mut Staged,
    before: HeightMap,
    prepared: &Prepared,
    treatments: &[Treatment],
) -> Result<(), CliError> {
    pictures::add_before(staged, &before)?;
    let Some(at) = treatments.iter().position(|treatment| matches!(treatment, Treatment::Despike { .. })) else {
        return Ok(());
    };
    let (spiky, _) = rc_heights::apply(before, &treatments[..at]).map_err(CliError::input)?;
    // The first state is that before all treatments.
    let points: Vec<usize> = prepared.effects[at + 1].removed.iter().map(|(point, _)| *point).collect();
    Ok(pictures::add_despiked(staged, spiky, &points)?)
}
