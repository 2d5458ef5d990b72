//! `rc surface`: a surface as files, without a contact.

pub(crate) mod args;

pub(crate) mod surface_files;
pub(crate) mod treated;
pub(crate) mod treatment;

pub use treated::prepared;
pub use treatment::treatments;

use std::path::Path;

use rc_sweep::memory::Budget;
use rc_sweep::{files, to_json};

use self::args::SurfaceArgs;
use self::surface_files::{is_map, stage_folder, write_map};
use self::treated::Prepared;
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::inspect::text::heights as lines;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, RunKeys, Scene, SurfaceKeys};
use crate::scene::resolve;
use crate::warnings::shown::{refuse, tell};
use crate::{terminal, text};

/// Runs `rc surface`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: SurfaceArgs) -> Result<(), CliError> {
    if args.run.time_limit.is_some() {
        return Err(CliError::input("time_limit: rc surface has none; omit --time-limit"));
    }
    let flags = Scene { surface: args.surface, contact: ContactKeys::default(), run: args.run };
    let scene = resolve::layers(args.scene_file.as_deref(), flags)?;
    let treatments = args.treatment.treatments().map_err(|cause| CliError::input(format_args!("resample: {cause}")))?;
    threads::start(scene.run.threads)?;
    let budget = Budget::new(scene.run.memory_limit);
    if let Some(target) = scene.run.out.as_deref() {
        if is_map(target) {
            files::check_folder(target.parent().unwrap_or(Path::new("")))?;
        } else {
            Kind::Surface.check_out(target)?;
        }
    }
    let prepared = if treatments.is_empty() {
        untreated(scene.surface, budget)?
    } else {
        treated::treat(treated::read(scene.surface)?, &treatments, budget)?
    };
    budget.check_grid("the surface", prepared.surface.grid)?;
    write(&prepared, &scene.run)
}

/// Writes and prints the surface.
fn write(prepared: &Prepared, run: &RunKeys) -> Result<(), CliError> {
    let Prepared { surface, cell, .. } = prepared;
    let heights = surface.heights()?;
    let record = prepared.record(&heights);
    refuse(&record.warnings, run.strict, "; nothing was written")?;
    tell(&record.warnings, run);
    let target = run.out.as_deref();
    match target {
        Some(target) if is_map(target) => write_map(target, surface, &heights, cell.side())?,
        Some(folder) => stage_folder(folder, surface, &heights, &record, cell.side())?.commit()?,
        None => {}
    }
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&record)),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&(lines(&record) + &text::written(target))),
    }
}

fn untreated(keys: SurfaceKeys, budget: Budget) -> Result<Prepared, CliError> {
    resolve::check_size(&keys)?;
    let setup = resolve::surface(keys)?;
    let mut surface = setup.load_within(budget)?;
    let (warnings, notes) = (std::mem::take(&mut surface.warnings), std::mem::take(&mut surface.notes));
    Ok(Prepared { surface, cell: setup.cell, effects: Vec::new(), warnings, notes })
}
