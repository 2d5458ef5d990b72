//! `rc inspect`: statistics of a height map or of a result.

pub(crate) mod args;
pub(crate) mod record;
pub(crate) mod text;

mod pictures;

use std::path::{Path, PathBuf};

use rc_core::quantity::digits;
use rc_core::{Field, PeriodicCell};
use rc_fractal::moments_of_grid;
use rc_heights::{ChannelInfo, HeightMap, ReadParams, Scales, npy};
use rc_solver::PressureStatistics;
use rc_sweep::memory::Budget;
use rc_sweep::{Summary, files, to_json};
use serde::Serialize;

use self::args::InspectArgs;
use self::record::{ChannelRow, SurfaceRecord};
use crate::error::CliError;
use crate::files::result::{ResultFolder, SUMMARY_FILE};
use crate::scene::keys::SurfaceKeys;
use crate::scene::surface::{HEIGHTS_FILE, LoadedSurface};
use crate::scene::values::GridSpec;
use crate::scene::{file, heights, resolve};
use crate::terminal;
use crate::text::{solved, written};

/// Names of files that identify a result.
const RESULT_FILES: [&str; 2] = [SUMMARY_FILE, "pressure.npy"];

/// Statistics of a result, with its summary.
#[derive(Serialize)]
struct ResultStatistics {
    summary: Summary,
    pressure: PressureStatistics,
}

/// Runs `rc inspect`.
///
/// # Errors
/// [`CliError::Input`] when the file is neither a height map nor part of a result.
pub(crate) fn run(args: &InspectArgs) -> Result<(), CliError> {
    let text = match result_folder(&args.file).filter(|_| !args.spectrum) {
        Some(_) if args.cell.is_some() || args.cell_y.is_some() => {
            return Err(CliError::input("cell: a result has its own, in its scene.toml; omit --cell and --cell-y"));
        }
        Some(_) if args.out.is_some() => {
            return Err(CliError::input("out: the pictures of a result are made by rc plot; omit --out"));
        }
        Some(folder) => inspect_result(&folder, args.json)?,
        None if args.file.file_name().is_some_and(|name| name == "pressure.npy") => {
            let statistics = PressureStatistics::of(&finite(&args.file, npy::read(&args.file)?)?);
            if args.json { to_json(&statistics) } else { text::pressure(&statistics, statistics.grid) }
        }
        None if args.spectrum => inspect_waves(args)?,
        None => inspect_heights(args)?,
    };
    terminal::print(&text)
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
    inspect_result(folder, true)
}

/// The text of `rc inspect --json` for a height map in metres.
///
/// `name` is the map's name. `sides` of its cell (m) are used where the map does not know them.
///
/// # Errors
/// [`CliError::Input`] for a map that has no statistics.
pub fn height_map(name: &Path, map: HeightMap, sides: [Option<f64>; 2]) -> Result<String, CliError> {
    Ok(to_json(&Inspected::new(name, map, &ReadParams::default(), sides)?.record))
}

/// The text of `rc surface --json` for a surface in a cell of side `side` (m).
///
/// # Errors
/// [`CliError::Input`] when the grid is too coarse for the waves.
pub fn surface(surface: &LoadedSurface, side: f64) -> Result<String, CliError> {
    let heights = surface.heights()?;
    Ok(to_json(&SurfaceRecord::of(&heights, side, surface.moments())))
}

fn inspect_result(folder: &Path, json: bool) -> Result<String, CliError> {
    // A folder of `rc surface` has heights, but not pressures.
    let heights = folder.join(HEIGHTS_FILE);
    if !folder.join(SUMMARY_FILE).exists() && heights.is_file() {
        return Err(CliError::in_file(folder, format_args!("not a result; inspect {} instead", heights.display())));
    }
    let result = ResultFolder::read(folder)?;
    let sides = result.sides();
    let elements = result.summary.grid;
    let pressure = PressureStatistics::of(&finite(&folder.join("pressure.npy"), result.pressure)?);
    if json {
        return Ok(to_json(&ResultStatistics { summary: result.summary, pressure }));
    }
    Ok(solved(&result.summary, sides, result.e_star) + "\nstored pressure\n" + &text::pressure(&pressure, elements))
}

/// A height map with its statistics.
struct Inspected {
    /// Heights in λ.
    heights: Field,
    record: SurfaceRecord,
    /// Note that is printed before the statistics.
    note: String,
}

impl Inspected {
    fn new(path: &Path, map: HeightMap, params: &ReadParams, given: [Option<f64>; 2]) -> Result<Self, CliError> {
        heights::check_heights(path, &map.heights, params)?;
        if map.heights.max() <= map.heights.min() {
            let message =
                format_args!("all heights are {}; a flat surface has no statistics", digits(map.heights.max(), 6));
            return Err(CliError::in_file(path, message));
        }
        let [side, side_y] = heights::sides(path, map.sides, given)?;
        let side = side.or(file::example().surface.cell).unwrap_or(1.0);
        let cell = PeriodicCell::rectangle(side, side_y.unwrap_or(side)).map_err(CliError::input)?;
        let (heights, _) = heights::in_cell(path, map.heights, cell)?;
        let grid = heights.grid();
        let assumed = if map.sides.is_none() && given[0].is_none() { ASSUMED } else { "" };
        let taken = if map.sides.is_none() && side_y.is_none() && grid.nx() != grid.ny() { TAKEN } else { "" };
        let note = [assumed, taken].concat();
        let record = SurfaceRecord::of(&heights, side, moments_of_grid(&heights));
        Ok(Self { heights, record, note })
    }
}

/// Statistics of a height map, after a list of its channels if it has several.
///
/// An error of such a file has the names of its channels.
fn inspect_heights(args: &InspectArgs) -> Result<String, CliError> {
    let channels = rc_heights::channels(&args.file, &ReadParams { layout: args.layout, ..ReadParams::default() })?;
    let several = channels.len() > 1;
    match statistics(args) {
        Err(CliError::Input(message)) if several && args.channel.is_none() && channels.iter().any(|c| c.is_height) => {
            Err(CliError::input(format_args!("{message}; the file has the channels {}", text::names(&channels))))
        }
        Err(error) => Err(error),
        Ok((mut record, note)) if args.json => {
            tell(&note);
            let row = |ChannelInfo { name, is_height }| ChannelRow { name, is_height };
            record.channels = if several { channels.into_iter().map(row).collect() } else { Vec::new() };
            Ok(to_json(&record))
        }
        Ok((record, note)) => Ok(list(&channels) + &note + &text::heights(&record) + &written(args.out.as_deref())),
    }
}

/// The channels of a file that has several.
fn list(channels: &[ChannelInfo]) -> String {
    if channels.len() > 1 { text::channels(channels) } else { String::new() }
}

/// The record of a height map and a note about its cell. Its pictures are written.
fn statistics(args: &InspectArgs) -> Result<(SurfaceRecord, String), CliError> {
    let params = ReadParams { channel: args.channel.clone(), layout: args.layout, ..ReadParams::default() };
    let map = heights::read(&args.file, &params, Scales { unit: args.unit, height_scale: args.height_scale })?;
    let Inspected { heights, record, note } = Inspected::new(&args.file, map, &params, [args.cell, args.cell_y])?;
    draw(args, &heights, &record)?;
    Ok((record, note))
}

/// Statistics of a file of waves.
///
/// Moments are those of the waves, and the distribution of heights is that of a grid.
fn inspect_waves(args: &InspectArgs) -> Result<String, CliError> {
    let keys = SurfaceKeys {
        spectrum: Some(args.file.clone()),
        cell: args.cell.or(file::example().surface.cell),
        cell_y: args.cell_y,
        unit: args.unit,
        height_scale: args.height_scale,
        grid: args.grid,
        ..SurfaceKeys::default()
    };
    let setup = resolve::surface(keys)?;
    let mut surface = setup.load()?;
    if let (None, Some(waves)) = (args.grid, surface.wave_file().map(|file| file.surface().waves())) {
        surface.grid = resolve::checked_grid(GridSpec::square(ELEMENTS_PER_WAVE * waves))?;
    }
    Budget::new(None).check_grid("the surface", surface.grid)?;
    let heights = surface.heights()?;
    let record = SurfaceRecord::of(&heights, setup.cell.side(), surface.moments());
    draw(args, &heights, &record)?;
    let note = if args.cell.is_none() { ASSUMED } else { "" };
    Ok(if args.json {
        tell(note);
        to_json(&record)
    } else {
        note.to_owned() + &text::heights(&record) + &written(args.out.as_deref())
    })
}

/// Prints a note beside JSON, on standard error.
fn tell(note: &str) {
    if !note.is_empty() {
        terminal::tell(note.trim_end());
    }
}

/// Writes the pictures, if the arguments ask for them.
fn draw(args: &InspectArgs, heights: &Field, record: &SurfaceRecord) -> Result<(), CliError> {
    if let Some(folder) = &args.out {
        files::check_folder(folder)?;
        pictures::write(folder, heights, record)?;
    }
    Ok(())
}

/// Elements per shortest wave for files of waves.
const ELEMENTS_PER_WAVE: usize = 4;

/// Note for a map or waves whose cell is the default.
const ASSUMED: &str = "the file has no size, so a side of 0.01 m is assumed; give --cell, the side along x\n\n";

/// Note for a map whose cell may be meant in two ways.
const TAKEN: &str = "this map has no size, so it is taken as a square with different point spacings along x and y, as in rc solve; if the \
                     spacings are in fact equal, give --cell-y, the side along y\n\n";

fn finite(path: &Path, field: Field) -> Result<Field, CliError> {
    heights::check_finite(path, &field)?;
    Ok(field)
}
