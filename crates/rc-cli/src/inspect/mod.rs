//! `rc inspect`: statistics of a height map, a result or a sweep.

pub(crate) mod args;
pub(crate) mod mirrored;
pub(crate) mod record;
pub(crate) mod text;

mod areal;
mod pictures;
mod profile;
mod profile_pictures;
mod profile_row;

use std::path::{Path, PathBuf};

use rc_core::quantity::digits;
use rc_core::{Field, PeriodicCell};
use rc_fractal::moments_of_grid;
use rc_heights::{ChannelInfo, HeightMap, ReadParams, npy};
use rc_solver::PressureStatistics;
use rc_sweep::memory::Budget;
use rc_sweep::{Summary, Warning, files, to_json};
use serde::Serialize;

use self::args::InspectArgs;
use self::record::{ChannelRow, SurfaceRecord};
use crate::curves::folder::Rows;
use crate::curves::text as curves_text;
use crate::error::CliError;
use crate::files::names::{SCENE_FILE, SUMMARY_FILE};
use crate::files::result::ResultFolder;
use crate::scene::heights::CellOfMap;
use crate::scene::keys::{RunKeys, Scene, SurfaceKeys};
use crate::scene::loaded::LoadedSurface;
use crate::scene::profile::Profile;
use crate::scene::values::GridSpec;
use crate::scene::{file, heights, origin, resolve};
use crate::text::{solved, written};
use crate::warnings::shown::{refuse, tell};
use crate::{terminal, warnings};

/// Names of files that identify a result.
const RESULT_FILES: [&str; 2] = [SUMMARY_FILE, "pressure.npy"];

/// Statistics of a result, with its summary.
#[derive(Serialize)]
struct ResultStatistics {
    summary: Summary,
    pressure: PressureStatistics,
    warnings: Vec<Warning>,
}

/// Runs `rc inspect`.
///
/// # Errors
/// [`CliError::Input`] when the file is neither a height map nor part of a result.
pub(crate) fn run(args: &InspectArgs) -> Result<(), CliError> {
    let of_scene = is_scene(&args.file) && !args.spectrum;
    if of_scene && args.of_profiles().iter().any(|(_, is_given)| *is_given) {
        return terminal::print(&of_prepared_profile(args)?);
    }
    if let Some(rows) = Rows::of(&args.file)?.filter(|_| !args.spectrum && !of_scene) {
        return terminal::print(&of_rows(args, &rows)?);
    }
    let text = match result_folder(&args.file).filter(|_| !args.spectrum && !of_scene) {
        Some(_) if args.cell.is_some() || args.cell_y.is_some() => {
            return Err(CliError::input("cell: a result has its own, in its scene.toml; omit --cell and --cell-y"));
        }
        Some(_) if args.out.is_some() => {
            return Err(CliError::input("out: the pictures of a result are made by rc plot; omit --out"));
        }
        Some(folder) => {
            check_unread(args, "a result")?;
            let (text, warnings) = inspect_result(&folder, args.json)?;
            refuse(&warnings, args.strict, "")?;
            tell(&warnings, &args.run_keys());
            text
        }
        None if args.file.file_name().is_some_and(|name| name == "pressure.npy") => {
            let statistics = PressureStatistics::of(&finite(&args.file, npy::read(&args.file)?)?);
            if args.json { to_json(&statistics) } else { text::pressure(&statistics, statistics.grid) }
        }
        None if args.spectrum => {
            check_no_profile(args)?;
            inspect_waves(args)?
        }
        None if of_scene => shown(args, &of_surface(&args.file, args.over_scene())?)?,
        None => match Profile::read(&args.file, &args.keys())? {
            Some(found) => profile::shown(args, &found)?,
            None => of_map(args)?,
        },
    };
    terminal::print(&text)
}

/// The text about a sweep or a study.
fn of_rows(args: &InspectArgs, rows: &Rows) -> Result<String, CliError> {
    if args.cell.is_some() || args.cell_y.is_some() {
        return Err(CliError::input("cell: the rows of a sweep have their own; omit --cell and --cell-y"));
    }
    check_unread(args, if matches!(rows, Rows::Sweep) { "a sweep" } else { "a study" })?;
    match rows {
        Rows::Sweep => curves_text::of_sweep(&args.file, args.json, args.out.as_deref()),
        Rows::Study(_) if args.out.is_some() => {
            Err(CliError::input("out: the table of a study is its study.csv; omit --out"))
        }
        Rows::Study(record) if args.json => Ok(to_json(record)),
        Rows::Study(record) => Ok(record.text()),
    }
}

/// The folder of a scene file, or the folder itself.
pub(crate) fn folder_of(path: &Path) -> &Path {
    if !is_scene(path) || path.is_dir() {
        return path;
    }
    let parent = path.parent();
    parent.filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Whether `path` is a scene, or a folder of `rc surface`, which has a scene but no summary.
pub(crate) fn is_scene(path: &Path) -> bool {
    if path.is_dir() {
        return path.join(SCENE_FILE).is_file() && !path.join(SUMMARY_FILE).exists();
    }
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

/// The folder of the result that `file` is or belongs to.
fn result_folder(file: &Path) -> Option<PathBuf> {
    if file.is_dir() {
        return Some(file.to_owned());
    }
    let name = file.file_name()?.to_str()?;
    let folder = file.parent().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder })?;
    let complete = RESULT_FILES.iter().all(|other| folder.join(other).is_file());
    (name == SUMMARY_FILE || RESULT_FILES.contains(&name) && complete).then(|| folder.to_owned())
}

/// The text of `rc inspect --json` for the result in `folder`.
///
/// # Errors
/// [`CliError::Input`] with the name of the file that is missing or wrong.
pub fn result(folder: &Path) -> Result<String, CliError> {
    inspect_result(folder, true).map(|(text, _)| text)
}

/// The text of `rc inspect --json` for a height map in metres.
///
/// `name` is the map's name. `sides` of its cell (m) are used where the map does not know them.
///
/// # Errors
/// [`CliError::Input`] for a map that has no statistics.
pub fn height_map(name: &Path, map: HeightMap, sides: [Option<f64>; 2]) -> Result<String, CliError> {
    Ok(to_json(&Inspected::of_map(name, map, sides)?.record))
}

/// The text of `rc surface --json` for a surface in a cell of side `side` (m).
///
/// # Errors
/// [`CliError::Input`] when the grid is too coarse for the waves.
pub fn surface(surface: &LoadedSurface, side: f64) -> Result<String, CliError> {
    let heights = surface.heights()?;
    let record = SurfaceRecord::of(&heights, side, surface.moments(&heights));
    let warnings = [&surface.warnings[..], &record.shape().warnings()].concat();
    Ok(to_json(&SurfaceRecord { warnings, ..record }))
}

/// The text about a result, and its warnings.
fn inspect_result(folder: &Path, json: bool) -> Result<(String, Vec<Warning>), CliError> {
    let result = ResultFolder::read(folder)?;
    let sides = result.sides();
    let elements = result.summary.grid;
    let pressure = PressureStatistics::of(&finite(&folder.join("pressure.npy"), result.pressure)?);
    let warnings = result.summary.warnings.clone();
    let text = if json {
        to_json(&ResultStatistics { summary: result.summary, pressure, warnings: warnings.clone() })
    } else {
        let scene = file::read(&folder.join(SCENE_FILE))?;
        solved(&result.summary, sides, result.e_star, &scene.contact)
            + "\nstored pressure\n"
            + &text::pressure(&pressure, elements)
    };
    Ok((text, warnings))
}

/// A surface with its statistics.
pub(crate) struct Inspected {
    /// Heights in λ; `NaN` where missing.
    pub(crate) heights: Field,
    pub(crate) record: SurfaceRecord,
}

impl Inspected {
    /// A map in metres, which may have missing points.
    fn of_map(path: &Path, map: HeightMap, given: [Option<f64>; 2]) -> Result<Self, CliError> {
        if map.heights.values().iter().any(|height| height.is_infinite()) {
            heights::check_finite(path, &map.heights)?;
        }
        if map.heights.max() <= map.heights.min() {
            let message =
                format_args!("all heights are {}; a flat surface has no statistics", digits(map.heights.max(), 6));
            return Err(CliError::in_file(path, message));
        }
        let default = file::example().surface.cell;
        let grid = map.heights.grid();
        let CellOfMap { cell, cell_y, mut assumed } = CellOfMap::of(path, &map, given)?;
        let (cell, cell_y) = if let Some(side) = cell {
            (side, cell_y)
        } else {
            let side = default.unwrap_or(1.0);
            assumed.push(assumed_side(side));
            let of_side = CellOfMap::default().of_points(Some(side), given[1], [grid.nx(), grid.ny()]);
            assumed.extend(of_side.assumed);
            (side, of_side.cell_y)
        };
        let mut warnings = warnings::surface::of_file(path, &map);
        warnings.extend(warnings::surface::assumed(&assumed));
        let mut notes: Vec<_> =
            map.notes.iter().filter(|note| !note.is_assumption()).map(ToString::to_string).collect();
        let cell = PeriodicCell::rectangle(cell, cell_y.unwrap_or(cell)).map_err(CliError::input)?;
        let is_complete = map.missing() == 0;
        let (heights, _) = heights::divided(heights::in_cell(path, map.heights, cell)?, cell.side());
        let record = if is_complete {
            let made_by = origin::of(path, None);
            let of_map = SurfaceRecord::of_source(&heights, cell.side(), moments_of_grid(&heights), Some(made_by));
            SurfaceRecord { source: None, ..of_map }
        } else {
            SurfaceRecord::of_measured(&heights, cell.side())
        };
        warnings.extend(record.shape().warnings());
        notes.extend(record.notes);
        Ok(Self { heights, record: SurfaceRecord { notes, warnings, ..record } })
    }
}

/// The surface of a scene, or of a folder with one, under the flags `over` it.
///
/// # Errors
/// [`CliError::Input`].
pub(crate) fn of_surface(path: &Path, over: Scene) -> Result<Inspected, CliError> {
    let scene = resolve::layers(Some(path), over)?;
    resolve::check_size(&scene.surface)?;
    let setup = resolve::surface(scene.surface)?;
    let budget = Budget::new(scene.run.memory_limit);
    let surface = setup.load_within(budget)?;
    budget.check_grid("the surface", surface.grid)?;
    let heights = surface.heights()?.into_owned();
    let moments = surface.moments(&heights);
    let record = SurfaceRecord::of_source(&heights, setup.cell.side(), moments, surface.origin);
    let warnings = [surface.warnings, record.shape().warnings()].concat();
    let notes = [surface.notes, record.notes].concat();
    Ok(Inspected { heights, record: SurfaceRecord { notes, warnings, ..record } })
}

/// Writes the pictures of the surface of a scene, and returns their names. Its warnings are told unless
/// `quiet`.
///
/// # Errors
/// [`CliError`].
pub(crate) fn draw_surface(path: &Path, folder: &Path, quiet: bool) -> Result<Vec<String>, CliError> {
    let Inspected { heights, record } = of_surface(path, Scene::default())?;
    tell(&record.warnings, &RunKeys { quiet, ..RunKeys::default() });
    files::check_folder(folder)?;
    Ok(pictures::write(folder, &heights, &record)?)
}

/// Statistics of a height map, which has no filters of profiles.
fn of_map(args: &InspectArgs) -> Result<String, CliError> {
    check_no_profile(args)?;
    inspect_heights(args)
}

/// Refuses the flags of profiles for a map.
fn check_no_profile(args: &InspectArgs) -> Result<(), CliError> {
    match args.of_profiles().iter().find(|(_, is_given)| *is_given) {
        Some((key, _)) => {
            Err(CliError::input(format_args!("{key}: applies to profiles, lines x z; omit it for a map")))
        }
        None => Ok(()),
    }
}

/// Refuses the flags of maps and profiles for the folder of `what`.
fn check_unread(args: &InspectArgs, what: &str) -> Result<(), CliError> {
    match args.of_reading() {
        Some(key) => {
            Err(CliError::input(format_args!("{key}: applies to height maps and profiles; omit it for {what}")))
        }
        None => Ok(()),
    }
}

/// The text about the profile of a scene with `line`, after the filters of the flags.
fn of_prepared_profile(args: &InspectArgs) -> Result<String, CliError> {
    let Scene { surface, .. } = resolve::layers(Some(&args.file), args.over_scene())?;
    let Some(path) = surface.heights.clone().filter(|_| surface.line) else {
        return check_no_profile(args).map(|()| String::new());
    };
    let map = heights::read(&path, &ReadParams { row_is_map: true, ..surface.read_params() }, surface.scales())?;
    let CellOfMap { cell, .. } = CellOfMap::of(&path, &map, [surface.cell, surface.cell])?;
    let length = cell.ok_or_else(|| CliError::in_file(&path, "a profile without a length; give cell (m)"))?;
    let values = map.heights.into_values();
    let (spacing, notes) = (length / values.len() as f64, map.notes);
    // The spectrum and the sections of a mirrored profile would be those of its edges too.
    let is_mirrored = origin::of(&path, None).treatments.iter().any(|step| step == "periodic mirror");
    let measured = if is_mirrored { &values[..values.len() / 2] } else { &values[..] };
    let text = profile::shown(args, &Profile { heights: measured.to_vec(), spacing, notes })?;
    let note = "note: this is the measured half, without its mirror image\n";
    Ok(if is_mirrored && !args.json { text + note } else { text })
}

/// Statistics of a height map, after a list of its channels if it has several.
///
/// An error of such a file has the names of its channels.
fn inspect_heights(args: &InspectArgs) -> Result<String, CliError> {
    let keys = args.keys();
    let params = keys.read_params();
    let channels = rc_heights::channels(&args.file, &params)?;
    let several = channels.len() > 1;
    let map = heights::read(&args.file, &params, keys.scales());
    match map.and_then(|map| Inspected::of_map(&args.file, map, [args.cell, args.cell_y])) {
        Err(CliError::Input(message)) if several && args.channel.is_none() && channels.iter().any(|c| c.is_height) => {
            Err(CliError::input(format_args!("{message}; the file has the channels {}", text::names(&channels))))
        }
        Err(error) => Err(error),
        Ok(mut found) => {
            let listed = if several && !args.json { text::channels(&channels) } else { String::new() };
            let row = |ChannelInfo { name, is_height }| ChannelRow { name, is_height };
            found.record.channels = if several { channels.into_iter().map(row).collect() } else { Vec::new() };
            Ok(listed + &shown(args, &found)?)
        }
    }
}

/// The text about a surface. Its pictures are written, and its warnings told.
fn shown(args: &InspectArgs, Inspected { heights, record }: &Inspected) -> Result<String, CliError> {
    refuse(&record.warnings, args.strict, "; nothing was written")?;
    tell(&record.warnings, &args.run_keys());
    if let Some(folder) = &args.out {
        files::check_folder(folder)?;
        pictures::write(folder, heights, record)?;
    }
    Ok(if args.json { to_json(record) } else { text::heights(record) + &written(args.out.as_deref()) })
}

/// Statistics of a file of waves.
///
/// Moments are those of the waves, and the distribution of heights is that of a grid.
fn inspect_waves(args: &InspectArgs) -> Result<String, CliError> {
    let side = args.cell.or(file::example().surface.cell).unwrap_or(1.0);
    let setup = resolve::surface(SurfaceKeys {
        spectrum: Some(args.file.clone()),
        heights: None,
        cell: Some(side),
        ..args.keys()
    })?;
    let mut surface = setup.load()?;
    if let (None, Some(waves)) = (args.grid, surface.wave_file().map(|file| file.surface().waves())) {
        surface.grid = resolve::checked_grid(GridSpec::square(ELEMENTS_PER_WAVE * waves))?;
    }
    Budget::new(None).check_grid("the surface", surface.grid)?;
    let heights = surface.heights()?.into_owned();
    let mut record = SurfaceRecord::of(&heights, setup.cell.side(), surface.moments(&heights));
    if args.cell.is_none() {
        record.warnings.extend(warnings::surface::assumed(&[assumed_side(side)]));
    }
    record.warnings.extend(record.shape().warnings());
    shown(args, &Inspected { heights, record })
}

/// Elements per shortest wave for files of waves.
const ELEMENTS_PER_WAVE: usize = 4;

/// The clause about a cell whose side is the default.
fn assumed_side(side: f64) -> String {
    format!("a side of {side} m, since the file has no size; --cell gives it")
}

fn finite(path: &Path, field: Field) -> Result<Field, CliError> {
    heights::check_finite(path, &field)?;
    Ok(field)
}
