//! The step from the keys of a twin to a checked surface.

use std::path::Path;
use std::sync::{Arc, Mutex};

use rc_core::{Grid, PeriodicCell};
use rc_fractal::MAX_WAVES;

use super::checks::{checked_grid, positive};
use super::realisation::{FIRST_SEED, checked_seed, realisation};
use crate::error::CliError;
use crate::scene::keys::SurfaceKeys;
use crate::scene::like::{Reference, file_of, read_map};
use crate::scene::profile::Profile;
use crate::scene::psd_file::PsdFile;
use crate::scene::surface::{Source, SurfaceSetup};
use crate::scene::values::{GridSpec, HeightsLike, PsdConvention};

/// Elements per shortest wave of a surface from a profile, which has waves up to the limit of resolution.
const ELEMENTS_PER_WAVE: f64 = 4.0;

/// The setup of a surface like the map or the profile that `like` names.
///
/// # Errors
/// [`CliError::Input`].
pub(super) fn like(keys: SurfaceKeys, like: &Path) -> Result<SurfaceSetup, CliError> {
    if let Some(profile) = Profile::read(like, &keys)? {
        return of_profile(keys, like, &profile.complete(like)?);
    }
    let map = read_map(like, &keys)?;
    match Profile::of_map(&file_of(like), &map)? {
        Some(profile) => of_profile(keys, like, &profile),
        None => twin(Reference::of(like, map, &keys)?, keys, like),
    }
}

/// The setup of an isotropic surface with the spectrum of a profile.
fn of_profile(keys: SurfaceKeys, like: &Path, profile: &Profile) -> Result<SurfaceSetup, CliError> {
    if keys.heights_like == Some(HeightsLike::Map) {
        return Err(CliError::input("heights_like: a profile gives a spectrum only; omit heights_like"));
    }
    if keys.cell_y.is_some() {
        return Err(CliError::input("cell_y: applies to maps; a surface from a profile has a square cell, so omit it"));
    }
    let side = positive("cell", "m", Some(keys.cell.unwrap_or(profile.length())))?;
    let cell = PeriodicCell::new(side).map_err(CliError::input)?;
    let given = keys.grid.map(checked_grid).transpose()?;
    let rows = profile.spectrum(side, given.map_or(MAX_WAVES, Grid::resolved_wavenumber));
    let table = PsdFile::of_rows(rows, PsdConvention::Plain, side).map_err(|cause| CliError::in_file(like, cause))?;
    let grid = match given {
        Some(grid) => grid,
        None => checked_grid(GridSpec::square((ELEMENTS_PER_WAVE * table.waves() as f64) as usize))?,
    };
    // The folder has the table instead of the profile. The file of another body is read in the same way.
    let of_file = if keys.add.is_some() { keys.clone() } else { SurfaceKeys::default() };
    let SurfaceKeys { unit, height_unit, height_scale, channel, layout, missing, mask, .. } = of_file;
    let keys = SurfaceKeys { cell: Some(side), heights_like: None, unit, height_unit, height_scale, ..keys };
    let keys = SurfaceKeys { missing, mask, channel, layout, ..keys };
    let mut setup = realisation(keys, (like.to_owned(), table), cell, grid)?;
    if profile.is_assumed() {
        setup.assumed.push("metres for the profile, which names no unit; --unit says otherwise".to_owned());
    }
    Ok(setup)
}

/// The setup of a twin of the map that `like` names.
fn twin(reference: Reference, keys: SurfaceKeys, like: &Path) -> Result<SurfaceSetup, CliError> {
    if keys.amplitudes.is_some() {
        return Err(CliError::input("amplitudes: a twin has those of its map; omit amplitudes"));
    }
    let seed = checked_seed(keys.seed.unwrap_or(FIRST_SEED))?;
    let sides = reference.sides_of_twin(&keys);
    let cell = PeriodicCell::rectangle(sides[0], sides[1]).map_err(CliError::input)?;
    let [nx, ny] = reference.points(sides);
    let spec = keys.grid.unwrap_or(GridSpec { nx, ny });
    let grid = checked_grid(spec)?;
    let heights_like = keys.heights_like.unwrap_or(HeightsLike::Map);
    let cell_y = (sides[0].to_bits() != sides[1].to_bits() || spec.nx != spec.ny).then_some(sides[1]);
    let of_map = Box::new(keys.clone());
    let keys = SurfaceKeys {
        cell: Some(sides[0]),
        cell_y,
        grid: Some(spec),
        seed: Some(seed),
        heights_like: Some(heights_like),
        ..keys
    };
    let assumed = reference.assumed.clone();
    let source = Source::Twin { like: like.to_owned(), of_map, heights: heights_like, seed, grid };
    let reference = Arc::new(Mutex::new(Some(reference)));
    Ok(SurfaceSetup { assumed, reference, ..SurfaceSetup::new(cell, source, keys) })
}
