//! `rc surface`: a surface as files, without a contact.

use std::path::Path;

use rc_core::Field;
use rc_heights::{Effect, Treatment, text};

use crate::args::SurfaceArgs;
use crate::error::CliError;
use crate::output;
use crate::scene::{ContactKeys, Scene, SurfaceKeys};
use crate::statistics::{HeightStatistics, TreatmentRow};
use crate::surface::{HEIGHTS_FILE, LoadedSurface};
use crate::{heights, npy, report, resolve, scene_file};
use rc_plot::{Map, MapPicture, Palette, Shade, save_png};
use rc_sweep::files::{self, FileError, Staged};
use rc_sweep::memory::Budget;
use rc_sweep::to_json;

/// Runs `rc surface`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn run(args: SurfaceArgs) -> Result<(), CliError> {
    let flags = Scene { surface: args.surface, contact: ContactKeys::default(), run: args.run };
    let scene = resolve::layers(args.scene_file.as_deref(), flags)?;
    let treatments = args.treatment.treatments().map_err(|cause| CliError::input(format_args!("resample: {cause}")))?;
    resolve::start_threads(scene.run.threads)?;
    let budget = Budget::new(scene.run.memory_limit);
    let target = scene.run.out.as_deref();
    if let Some(target) = target {
        files::check_folder(if is_map(target) { target.parent().unwrap_or(Path::new("")) } else { target })?;
    }
    let (side, surface, effects) = if treatments.is_empty() {
        let problem = resolve::surface(scene.surface)?;
        (problem.cell.side(), problem.load()?, Vec::new())
    } else {
        treated(scene.surface, &treatments, budget)?
    };
    budget.check_grid("the surface", surface.grid)?;
    let heights = surface.heights()?;
    let mut statistics = HeightStatistics::of(&heights, side, surface.moments());
    statistics.treatments = effects.iter().map(TreatmentRow::from).collect();
    match target {
        Some(target) if is_map(target) => write_map(target, &surface, &heights, side)?,
        Some(folder) => write_folder(folder, &surface, &heights, &statistics, side)?,
        None => {}
    }
    match (scene.run.quiet, scene.run.json) {
        (true, _) => Ok(()),
        (false, true) => output::print(&to_json(&statistics)),
        (false, false) => output::print(&(report::heights(&statistics) + &report::written(target))),
    }
}

/// The side of the cell (m), a height map after `treatments`, and what it was like before them and after each.
fn treated(
    keys: SurfaceKeys,
    treatments: &[Treatment],
    budget: Budget,
) -> Result<(f64, LoadedSurface, Vec<Effect>), CliError> {
    let Some(path) = keys.heights.clone() else {
        let message =
            "crop, flip, fill, level, periodic, low_pass, resample and repeat are for height maps; give --heights FILE";
        return Err(CliError::input(message));
    };
    let mut map = heights::read(&path, keys.scales())?;
    let [cell, cell_y] = heights::sides(&path, map.sides, [keys.cell, keys.cell_y])?;
    let cell = cell.or(scene_file::example().surface.cell).unwrap_or(1.0);
    // A map without a size has points that are equally far apart along both sides.
    map.sides = map.sides.or_else(|| Some(cell_y.map_or_else(|| map.sides_of_width(cell), |cell_y| [cell, cell_y])));
    let grids = rc_heights::grids_after(&map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    for (grid, treatment) in grids.into_iter().zip(treatments) {
        budget.check_grid(&format!("the map after {treatment}"), grid)?;
    }
    let mut effects = vec![Effect::of(&map, "as read")];
    let (map, after) = rc_heights::apply(map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    effects.extend(after);
    let [cell, cell_y] = heights::sides(&path, map.sides, [None, None])?;
    let expected = keys.grid;
    let problem = resolve::surface_in_cell(SurfaceKeys { cell, cell_y, grid: None, ..keys })?;
    let expected = expected.map(resolve::checked_grid).transpose()?;
    let surface = problem.of_map(&path, map, expected)?;
    Ok((problem.cell.side(), surface, effects))
}

/// Whether the heights alone are to go into a file of this name.
fn is_map(target: &Path) -> bool {
    target.extension().is_some_and(|e| e.eq_ignore_ascii_case("npy") || e.eq_ignore_ascii_case("csv"))
}

/// Heights and the factor that makes them metres: as read, where they come from a file.
fn in_metres<'a>(surface: &'a LoadedSurface, heights: &'a Field, side: f64) -> (&'a Field, f64) {
    surface.as_read().map_or((heights, side), |field| (field, 1.0))
}

fn write_map(target: &Path, surface: &LoadedSurface, heights: &Field, side: f64) -> Result<(), FileError> {
    let (field, factor) = in_metres(surface, heights, side);
    let csv = target.extension().is_some_and(|e| e.eq_ignore_ascii_case("csv"));
    let write = if csv { text::write } else { npy::write };
    files::write_file(target, |path| write(path, field, factor))
}

fn write_folder(
    folder: &Path,
    surface: &LoadedSurface,
    heights: &Field,
    statistics: &HeightStatistics,
    side: f64,
) -> Result<(), FileError> {
    let (field, factor) = in_metres(surface, heights, side);
    let scene = format!(
        "# The surface; `rc solve scene.toml --pressure ...` presses it.\n\n{}",
        scene_file::to_toml(&surface.keys)
    );
    let range = (heights.min(), heights.max());
    let shade = Shade::Values { range, palette: Palette::Viridis, factor: side, unit: "m" };
    let picture = MapPicture(Map { title: "Height", field: heights, shade, side });
    let mut staged = Staged::new(folder)?;
    staged.add(HEIGHTS_FILE, |path| npy::write(path, field, factor))?;
    staged.add("surface.png", |path| save_png(&picture, path))?;
    staged.add_text("scene.toml", &scene)?;
    staged.add_text("surface.json", &to_json(statistics))?;
    staged.commit()
}
