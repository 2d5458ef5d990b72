//! `rc surface`: a surface as files, without a contact.

pub(crate) mod args;

mod surface_files;
mod treatment;

pub use treatment::treatments;

use std::path::Path;

use rc_heights::{Effect, HeightMap, TreatError, Treatment};
use rc_sweep::memory::Budget;
use rc_sweep::{Warning, files, to_json};

use self::args::SurfaceArgs;
use self::surface_files::{is_map, write_folder, write_map};
use crate::error::CliError;
use crate::inspect::record::{SurfaceRecord, TreatmentRow};
use crate::inspect::text::heights as lines;
use crate::run::threads;
use crate::scene::heights::CellOfMap;
use crate::scene::keys::{ContactKeys, RunKeys, Scene, SurfaceKeys};
use crate::scene::loaded::LoadedSurface;
use crate::scene::{heights, resolve};
use crate::warnings::shown::{refuse, tell};
use crate::warnings::surface as doubts;
use crate::{terminal, text};

/// A surface in its cell, with the effects of its treatments.
struct Prepared {
    surface: LoadedSurface,
    /// Side of the cell along x (m).
    side: f64,
    /// Statistics of a height map before the treatments and after each; empty without treatments.
    effects: Vec<Effect>,
    /// Doubts about the map as read, and about its treatments.
    warnings: Vec<Warning>,
    /// What the reader of the map did.
    notes: Vec<String>,
}

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
        files::check_folder(if is_map(target) { target.parent().unwrap_or(Path::new("")) } else { target })?;
    }
    let prepared =
        if treatments.is_empty() { untreated(scene.surface)? } else { treated(scene.surface, &treatments, budget)? };
    budget.check_grid("the surface", prepared.surface.grid)?;
    write(&prepared, &scene.run)
}

/// Writes and prints the surface.
fn write(Prepared { surface, side, effects, warnings, notes }: &Prepared, run: &RunKeys) -> Result<(), CliError> {
    let heights = surface.heights()?;
    let mut record = SurfaceRecord::of(&heights, *side, surface.moments(&heights));
    record.treatments = effects.iter().map(TreatmentRow::from).collect();
    record.notes.clone_from(notes);
    record.warnings.clone_from(warnings);
    // Range and slope of what a shape is added to are doubted already.
    if surface.form.is_none() {
        record.warnings.extend(record.shape().warnings());
    }
    refuse(&record.warnings, run.strict, "; nothing was written")?;
    tell(&record.warnings, run);
    let target = run.out.as_deref();
    match target {
        Some(target) if is_map(target) => write_map(target, surface, &heights, *side)?,
        Some(folder) => write_folder(folder, surface, &heights, &record, *side)?,
        None => {}
    }
    match (run.json, run.quiet) {
        (true, _) => terminal::print(&to_json(&record)),
        (false, true) => Ok(()),
        (false, false) => terminal::print(&(lines(&record) + &text::written(target))),
    }
}

fn untreated(keys: SurfaceKeys) -> Result<Prepared, CliError> {
    resolve::check_size(&keys)?;
    let setup = resolve::surface(keys)?;
    let mut surface = setup.load()?;
    let (warnings, notes) = (std::mem::take(&mut surface.warnings), std::mem::take(&mut surface.notes));
    Ok(Prepared { surface, side: setup.cell.side(), effects: Vec::new(), warnings, notes })
}

/// A height map after `treatments`.
fn treated(keys: SurfaceKeys, treatments: &[Treatment], budget: Budget) -> Result<Prepared, CliError> {
    let Some(path) = keys.heights.clone() else {
        let message =
            "crop, flip, fill, level, periodic, low_pass, resample and repeat are for height maps; give --heights FILE";
        return Err(CliError::input(message));
    };
    resolve::check_size(&keys)?;
    let mut map = heights::read(&path, &keys.read_params(), keys.scales())?;
    let CellOfMap { cell, cell_y, assumed } = CellOfMap::of(&path, &map, [keys.cell, keys.cell_y])?;
    let mut warnings = doubts::of_map(&map);
    warnings.extend(doubts::assumed(&assumed));
    let notes = map.notes.iter().filter(|note| !note.is_assumption()).map(ToString::to_string).collect();
    map.sides = cell.map(|cell| [cell, cell_y.unwrap_or(cell)]);
    map.notes.clear();
    let grids = rc_heights::grids_after(&map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    for (grid, treatment) in grids.into_iter().zip(treatments) {
        budget.check_grid(&format!("the map after {treatment}"), grid)?;
    }
    let mut effects = vec![Effect::of(&map, "as read")];
    let (map, after) = rc_heights::apply(map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    effects.extend(after);
    warnings.extend(filled(treatments, &effects));
    warnings.extend(doubts::of_record(&path));
    let CellOfMap { cell, cell_y, .. } = CellOfMap::of(&path, &map, [None, None])?;
    let expected = keys.grid.map(resolve::checked_grid).transpose()?;
    let setup = resolve::surface_in_cell(SurfaceKeys { cell, cell_y, grid: None, ..keys })?;
    Ok(Prepared { surface: setup.of_map(&path, map, expected)?, side: setup.cell.side(), effects, warnings, notes })
}

/// A map in metres after treatments that are checked, and the doubts that `rc surface` has about it.
///
/// # Errors
/// [`TreatError`].
pub fn prepared(map: HeightMap, treatments: &[Treatment]) -> Result<(HeightMap, Vec<Warning>), TreatError> {
    let mut warnings = doubts::of_map(&map);
    let mut effects = vec![Effect::of(&map, "as read")];
    let (map, after) = rc_heights::apply(map, treatments)?;
    effects.extend(after);
    warnings.extend(filled(treatments, &effects));
    Ok((map, warnings))
}

/// A doubt about the points that a treatment has filled.
fn filled(treatments: &[Treatment], effects: &[Effect]) -> Option<Warning> {
    let at = treatments.iter().position(|treatment| matches!(treatment, Treatment::Fill(_)))?;
    // The first state is that before all treatments.
    let before = effects.get(at)?;
    doubts::filled(before.missing, before.grid.len())
}
