//! The step from the keys of a twin to a checked surface.

use std::path::Path;
use std::sync::{Arc, Mutex};

use rc_core::PeriodicCell;

use super::checks::checked_grid;
use super::surface::{FIRST_SEED, checked_seed};
use crate::error::CliError;
use crate::scene::keys::SurfaceKeys;
use crate::scene::like::Reference;
use crate::scene::surface::{Source, SurfaceSetup};
use crate::scene::values::{GridSpec, HeightsLike};

/// The setup of a twin of the map that `like` names.
///
/// # Errors
/// [`CliError::Input`].
pub(super) fn twin(keys: SurfaceKeys, like: &Path) -> Result<SurfaceSetup, CliError> {
    if keys.amplitudes.is_some() {
        return Err(CliError::input("amplitudes: a twin has those of its map; omit amplitudes"));
    }
    let seed = checked_seed(keys.seed.unwrap_or(FIRST_SEED))?;
    let reference = Reference::read(like, &keys)?;
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
