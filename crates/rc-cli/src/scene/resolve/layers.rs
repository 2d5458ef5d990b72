//! Flags laid over a scene file.

use std::path::{Path, PathBuf};

use rc_heights::{FormatError, ReadError};

use crate::error::CliError;
use crate::files::names::SCENE_FILE;
use crate::scene::file;
use crate::scene::keys::{ContactKeys, Scene, SurfaceKeys};

/// Flags laid over the scene that `file` names, without defaults.
///
/// `file` is a scene file, a folder with one, or a height map.
///
/// Flags and file are each checked for alternatives that exclude each other.
///
/// # Errors
/// [`CliError::Input`].
pub fn layers(file: Option<&Path>, flags: Scene) -> Result<Scene, CliError> {
    check_alternatives(&flags).map_err(CliError::input)?;
    let mut scene = match file {
        None => over_folder(flags)?,
        Some(path) => {
            let lower = lower_layer(path)?;
            check_alternatives(&lower).map_err(|message| CliError::in_file(path, message))?;
            flags.over(lower)
        }
    };
    if scene.surface.line && scene.contact.force.is_some() {
        return Err(CliError::input(
            "force: a line contact has a force per length; give pressure (Pa), which is that force divided by the length of \
             the profile",
        ));
    }
    scene.surface.read_limit = scene.run.memory_limit;
    Ok(scene)
}

/// The flags, over the surface of the folder that `heights` names, if it is one of `rc surface`, `rc prepare` or `rc solve`.
fn over_folder(flags: Scene) -> Result<Scene, CliError> {
    let is_folder = |path: &&PathBuf| path.join(SCENE_FILE).is_file();
    let Some(folder) = flags.surface.heights.as_ref().filter(is_folder) else { return Ok(flags) };
    let surface = lower_layer(folder)?.surface;
    let flags = Scene { surface: SurfaceKeys { heights: None, ..flags.surface }, ..flags };
    Ok(flags.over(Scene { surface, ..Scene::default() }))
}

/// The scene that a path names: a scene file, a folder with one, or the file of a height map.
fn lower_layer(path: &Path) -> Result<Scene, CliError> {
    if path.is_dir() {
        let file = path.join(SCENE_FILE);
        if !file.is_file() {
            let message = format_args!(
                "a folder without {SCENE_FILE}; give a scene file, a height map, or a folder of rc surface or rc solve"
            );
            return Err(CliError::in_file(path, message));
        }
        return file::read(&file);
    }
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        return file::read(path);
    }
    match rc_heights::format_of(path) {
        Ok(_) => {
            let surface = SurfaceKeys { heights: Some(path.to_owned()), ..SurfaceKeys::default() };
            Ok(Scene { surface, ..Scene::default() })
        }
        // A scene may have any name.
        Err(ReadError { problem: FormatError::Unknown, .. }) => file::read(path),
        Err(error) => Err(error.into()),
    }
}

fn two_loads(contact: &ContactKeys) -> String {
    let loads = [
        ("pressure", contact.pressure.is_some()),
        ("penetration", contact.penetration.is_some()),
        ("force", contact.force.is_some()),
        ("history", contact.history.is_some()),
    ];
    let given: Vec<&str> = loads.iter().filter(|(_, is_given)| *is_given).map(|(key, _)| *key).collect();
    format!("both {} are given; give exactly one", given.join(" and "))
}

/// Refuses keys that exclude each other in one place.
fn check_alternatives(scene: &Scene) -> Result<(), String> {
    let Scene { surface, contact, .. } = scene;
    if contact.n_loads() > 1 {
        return Err(two_loads(contact));
    }
    if contact.e_star.is_some() && (contact.young.is_some() || contact.poisson.is_some()) {
        return Err("e_star replaces young and poisson; give either e_star or both of them".into());
    }
    if contact.e_star.is_some() && (contact.young2.is_some() || contact.poisson2.is_some()) {
        return Err(
            "e_star is that of both bodies; give either e_star, or young and poisson with young2 and poisson2".into()
        );
    }
    if [surface.rms, surface.rms_slope, surface.c0].iter().flatten().count() > 1 {
        return Err("rms, rms_slope and c0 are alternatives; give one".into());
    }
    if surface.grid.is_some() && contact.area_error.is_some() {
        return Err("area_error chooses the grid; give either area_error or grid".into());
    }
    let mut files = surface.files().map(|(key, _)| key);
    if let (Some(first), Some(second)) = (files.next(), files.next()) {
        return Err(format!("{first} and {second} both define the surface; give one of them"));
    }
    let is_random = if surface.is_realisation() { surface.has_law() } else { surface.generates() };
    if let (Some((key, _)), true) = (surface.file(), is_random) {
        return Err(format!(
            "{key} defines the surface; omit the parameters of a random surface (waves, hurst, rms, ...)"
        ));
    }
    Ok(())
}
