//! Flags laid over a scene file.

use std::path::Path;

use crate::error::CliError;
use crate::scene::file;
use crate::scene::keys::Scene;

/// Flags laid over the scene file, without defaults.
///
/// Flags and file are each checked for alternatives that exclude each other.
///
/// # Errors
/// [`CliError::Input`].
pub fn layers(file: Option<&Path>, flags: Scene) -> Result<Scene, CliError> {
    check_alternatives(&flags).map_err(CliError::input)?;
    let Some(path) = file else { return Ok(flags) };
    let scene = file::read(path)?;
    check_alternatives(&scene).map_err(|message| CliError::in_file(path, message))?;
    Ok(flags.over(scene))
}

/// Refuses keys that exclude each other in one place.
fn check_alternatives(scene: &Scene) -> Result<(), String> {
    let Scene { surface, contact, .. } = scene;
    if contact.pressure.is_some() && contact.penetration.is_some() {
        return Err("both pressure and penetration are given; give exactly one".into());
    }
    if contact.e_star.is_some() && (contact.young.is_some() || contact.poisson.is_some()) {
        return Err("e_star replaces young and poisson; give either e_star or both of them".into());
    }
    if [surface.rms, surface.rms_slope, surface.c0].iter().flatten().count() > 1 {
        return Err("rms, rms_slope and c0 are alternatives; give one".into());
    }
    if surface.grid.is_some() && contact.area_error.is_some() {
        return Err("area_error chooses the grid; give either area_error or grid".into());
    }
    if surface.heights.is_some() && surface.spectrum.is_some() {
        return Err("heights and spectrum both define the surface; give one of them".into());
    }
    if let (Some((key, _)), true) = (surface.file(), surface.generates()) {
        return Err(format!(
            "{key} defines the surface; omit the parameters of a random surface (waves, hurst, rms, ...)"
        ));
    }
    Ok(())
}
