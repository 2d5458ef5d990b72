//! Height maps from files, and their treatment.

use std::path::{Path, PathBuf};

use rc_core::{Grid, PeriodicCell};
use rc_heights::{Crop, Effect, HeightMap, TreatError, Treatment};
use rc_sweep::memory::Budget;
use rc_sweep::{MapOrigin, Warning, WarningCode};

use crate::error::CliError;
use crate::inspect::record::{SurfaceRecord, TreatmentRow};
use crate::scene::heights::CellOfMap;
use crate::scene::keys::SurfaceKeys;
use crate::scene::loaded::LoadedSurface;
use crate::scene::{heights, origin, resolve};
use crate::warnings::surface as doubts;

/// A map in metres with the size of its cell, before its treatments.
#[derive(Clone)]
pub(crate) struct MapRead {
    pub(crate) map: HeightMap,
    pub(crate) path: PathBuf,
    pub(crate) keys: SurfaceKeys,
    /// Doubts about the map, and what was assumed about it.
    warnings: Vec<Warning>,
    /// What the reader did.
    notes: Vec<String>,
}

/// A surface in its cell, with the effects of its treatments.
pub(crate) struct Prepared {
    pub(crate) surface: LoadedSurface,
    pub(crate) cell: PeriodicCell,
    /// Statistics of a height map before the treatments and after each; empty without treatments.
    pub(crate) effects: Vec<Effect>,
    /// Doubts about the map as read, and about its treatments.
    pub(crate) warnings: Vec<Warning>,
    /// What the reader of the map did.
    pub(crate) notes: Vec<String>,
}

impl Prepared {
    /// The record of the surface, whose heights are given in λ.
    pub(crate) fn record(&self, heights: &rc_core::Field) -> SurfaceRecord {
        let (side, source) = (self.cell.side(), self.surface.origin.clone());
        let record = SurfaceRecord::of_source(heights, side, self.surface.moments(heights), source);
        let warnings = [&self.warnings[..], &record.shape().warnings()].concat();
        SurfaceRecord {
            treatments: self.effects.iter().map(TreatmentRow::from).collect(),
            notes: [&self.notes[..], &record.notes].concat(),
            warnings,
            ..record
        }
    }
}

/// Reads the map of `keys`.
///
/// # Errors
/// [`CliError::Input`] when there is no map, or it cannot be read, or has no size.
pub(crate) fn read(keys: SurfaceKeys) -> Result<MapRead, CliError> {
    let Some(path) = keys.heights.clone() else {
        let message = "treatments (crop, flip, despike, level, fill, high_pass, periodic, low_pass, resample, repeat) are \
                       for height maps; give --heights FILE";
        return Err(CliError::input(message));
    };
    resolve::check_size(&keys)?;
    let mut map = heights::read(&path, &keys.read_params(), keys.scales())?;
    let given = [keys.cell, if keys.line { keys.cell } else { keys.cell_y }];
    let CellOfMap { cell, cell_y, assumed } = CellOfMap::of(&path, &map, given)?;
    let mut warnings = doubts::of_file(&path, &map);
    warnings.extend(doubts::assumed(&assumed));
    let notes = map.notes.iter().filter(|note| !note.is_assumption()).map(ToString::to_string).collect();
    map.sides = cell.map(|cell| [cell, cell_y.unwrap_or(cell)]);
    map.notes.clear();
    Ok(MapRead { map, path, keys, warnings, notes })
}

/// The map after `treatments`, which must fit into the memory of `budget`.
///
/// # Errors
/// [`CliError::Input`] when a treatment is not possible, or leaves missing points.
pub(crate) fn treat(read: MapRead, treatments: &[Treatment], budget: Budget) -> Result<Prepared, CliError> {
    let MapRead { map, path, keys, warnings, notes } = read;
    let treatments = &if keys.line { of_profile(treatments)? } else { treatments.to_vec() };
    let grids = rc_heights::grids_after(&map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    for (grid, treatment) in grids.into_iter().zip(treatments) {
        budget.check_grid(&format!("the map after {treatment}"), grid)?;
    }
    let mut effects = vec![Effect::of(&map, "as read")];
    let mut origin = origin::of(&path, keys.channel.as_deref());
    check_once(&path, &origin, treatments)?;
    let mut warnings = despiked(warnings, &map, treatments);
    let (mut map, after) = rc_heights::apply(map, treatments).map_err(|cause| CliError::in_file(&path, cause))?;
    origin.treatments.extend(after.iter().map(|effect| effect.treatment.clone()));
    effects.extend(after);
    if keys.line {
        // The cell of a profile is the square of its length.
        let square = |sides: Option<[f64; 2]>| sides.map(|[length, _]| [length; 2]);
        map.sides = square(map.sides);
        for effect in &mut effects {
            effect.sides = square(effect.sides);
        }
    }
    let lay = doubts::mirrored(&map, treatments);
    let CellOfMap { cell, cell_y, .. } = CellOfMap::of(&path, &map, [None, None])?;
    // The scene of a folder has the grid of the map before its treatments.
    let as_read = effects[0].grid;
    let expected = keys.grid.filter(|grid| (grid.nx, grid.ny) != (as_read.nx(), as_read.ny()));
    let expected = expected.map(resolve::checked_grid).transpose()?;
    let setup = resolve::surface_in_cell(SurfaceKeys { cell, cell_y, grid: None, ..keys })?;
    let mut surface = setup.of_map(&path, map, expected)?;
    warnings.extend(filled(treatments, &effects));
    warnings.extend(lay);
    warnings.extend(doubts::of_record(&path));
    surface.origin = Some(origin);
    Ok(Prepared { surface, cell: setup.cell, effects, warnings, notes })
}

/// The treatments of a profile, which is a row. A number alone is that of its points.
///
/// # Errors
/// [`CliError::Input`] for several rows.
fn of_profile(treatments: &[Treatment]) -> Result<Vec<Treatment>, CliError> {
    let several =
        |key: &str, nx: usize| CliError::input(format_args!("{key}: a profile has one row; give {nx} or {nx}x1"));
    let one = |treatment: &Treatment| match *treatment {
        Treatment::Crop(Crop::Points { nx, ny, from }) if ny == nx || ny == 1 => {
            Ok(Treatment::Crop(Crop::Points { nx, ny: 1, from }))
        }
        Treatment::Crop(Crop::Points { nx, .. }) => Err(several("crop", nx)),
        Treatment::Resample(grid) if grid.ny() == grid.nx() || grid.ny() == 1 => {
            Ok(Treatment::Resample(Grid::new(grid.nx(), 1).map_err(CliError::input)?))
        }
        Treatment::Resample(grid) => Err(several("resample", grid.nx())),
        other => Ok(other),
    };
    treatments.iter().map(one).collect()
}

/// A map in metres after treatments that are checked, and the doubts that `rc surface` has about it.
///
/// # Errors
/// [`TreatError`].
pub fn prepared(map: HeightMap, treatments: &[Treatment]) -> Result<(HeightMap, Vec<Warning>), TreatError> {
    let mut warnings = despiked(doubts::of_map(&map), &map, treatments);
    let mut effects = vec![Effect::of(&map, "as read")];
    let (map, after) = rc_heights::apply(map, treatments)?;
    effects.extend(after);
    warnings.extend(filled(treatments, &effects));
    warnings.extend(doubts::mirrored(&map, treatments));
    Ok((map, warnings))
}

/// The doubts about a map as read, in which despiking leaves only spikes that are doubts about the map after it too.
///
/// A coarser map would have others, so that they are those before any resampling.
fn despiked(read: Vec<Warning>, map: &HeightMap, treatments: &[Treatment]) -> Vec<Warning> {
    let Some(at) = treatments.iter().position(|treatment| matches!(treatment, Treatment::Despike { .. })) else {
        return read;
    };
    let coarser = treatments[at..].iter().position(|treatment| matches!(treatment, Treatment::Resample(_)));
    let end = coarser.map_or(treatments.len(), |resample| at + resample);
    // What fails is told where all treatments are applied.
    let after =
        rc_heights::apply(map.clone(), &treatments[..end]).map_or_else(|_| Vec::new(), |(map, _)| doubts::of_map(&map));
    let is_spikes = |warning: &Warning| warning.code == WarningCode::Spikes;
    let others = read.into_iter().filter(|warning| !is_spikes(warning));
    others.chain(after.into_iter().filter(is_spikes)).collect()
}

/// Refuses to make a map periodic that was made so before, and would be mirrored or faded twice.
fn check_once(path: &Path, source: &MapOrigin, treatments: &[Treatment]) -> Result<(), CliError> {
    if !treatments.iter().any(|treatment| matches!(treatment, Treatment::Periodic(_))) {
        return Ok(());
    }
    let Some(step) = source.periodic_step() else { return Ok(()) };
    Err(CliError::in_file(
        path,
        format_args!(
            "is periodic already ({step}); give --no-periodic to rc prepare, omit --periodic, or give the file that was \
             measured, {}",
            source.file
        ),
    ))
}

/// A doubt about the points that a treatment has filled.
fn filled(treatments: &[Treatment], effects: &[Effect]) -> Option<Warning> {
    let at = treatments.iter().position(|treatment| matches!(treatment, Treatment::Fill(_)))?;
    // The first state is that before all treatments.
    let before = effects.get(at)?;
    doubts::filled(before.missing, before.grid.len())
}
