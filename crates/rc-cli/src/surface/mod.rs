//! `rc surface`: a surface as files, without a contact.

pub(crate) mod args;

mod surface_files;
mod treatment;

pub use treatment::treatments;

use std::path::Path;

use rc_heights::{Effect, Treatment};
use rc_sweep::memory::Budget;
use rc_sweep::{files, to_json};

use self::args::SurfaceArgs;
use self::surface_files::{is_map, write_folder, write_map};
use crate::error::CliError;
use crate::inspect::record::{SurfaceRecord, TreatmentRow};
use crate::inspect::text::heights as lines;
use crate::run::threads;
use crate::scene::keys::{ContactKeys, RunKeys, Scene, SurfaceKeys};
use crate::scene::surface::LoadedSurface;
use crate::scene::{heights, resolve};
use crate::{terminal, text};

/// A surface in its cell, with the effects of its treatments.
struct Prepared {
    surface: LoadedSurface,
    /// Side of the cell along x (m).
    side: f64,
    /// Statistics of a height map before the treatments and after each; empty without treatments.
    effects: Vec<Effect>,
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
fn write(Prepared { surface, side, effects }: &Prepared, run: &RunKeys) -> Result<(), CliError> {
    let heights = surface.heights()?;
    let mut record = SurfaceRecord::of(&heights, *side, surface.moments());
    record.treatments = effects.iter().map(TreatmentRow::from).collect();
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
    Ok(Prepared { surface: setup.load()?, side: setup.cell.side(), effects: Vec::new() })
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
    let [cell, cell_y] = heights::sides(&path, map.sides, [keys.cell, keys.cell_y])?;
    // The points of a map without a size have equal distances along both sides.
    let sides = |cell| cell_y.map_or_else(|| map.sides_of_width(cell), |cell_y| [cell, cell_y]);
    map.sides = map.sides.or_else(|| cell.map(sides));
    let grids = rc_heights::grids_after(&map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    for (grid, treatment) in grids.into_iter().zip(treatments) {
        budget.check_grid(&format!("the map after {treatment}"), grid)?;
    }
    let mut effects = vec![Effect::of(&map, "as read")];
    let (map, after) = rc_heights::apply(map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    effects.extend(after);
    let [cell, cell_y] = heights::sides(&path, map.sides, [None, None])?;
    let expected = keys.grid.map(resolve::checked_grid).transpose()?;
    let setup = resolve::surface_in_cell(SurfaceKeys { cell, cell_y, grid: None, ..keys })?;
    Ok(Prepared { surface: setup.of_map(&path, map, expected)?, side: setup.cell.side(), effects })
}
