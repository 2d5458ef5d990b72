//! Writer of the files of a surface.

use std::borrow::Cow;
use std::path::Path;

use rc_core::Field;
use rc_heights::{gsf, netcdf, npy, text};
use rc_plot::{Map, MapPicture, Shade, save_png};
use rc_sweep::files::{self, FileError, Staged};
use rc_sweep::to_json;

use crate::files::kind::Kind;
use crate::files::names::{HEIGHTS_FILE, RECORD_FILE, SCENE_FILE};
use crate::inspect::record::SurfaceRecord;
use crate::scene::file;
use crate::scene::loaded::LoadedSurface;

/// A format of the heights alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MapFormat {
    Npy,
    Csv,
    Gsf,
    NetCdf,
}

impl MapFormat {
    /// The format that the name of a file asks for; `None` for a folder.
    fn of(target: &Path) -> Option<Self> {
        let formats = [("npy", Self::Npy), ("csv", Self::Csv), ("gsf", Self::Gsf), ("nc", Self::NetCdf)];
        let extension = target.extension()?;
        formats.into_iter().find(|(name, _)| extension.eq_ignore_ascii_case(name)).map(|(_, format)| format)
    }
}

/// Whether `target` is the name of a file for the heights alone.
pub(super) fn is_map(target: &Path) -> bool {
    MapFormat::of(target).is_some()
}

/// Heights, and the factor that makes them metres.
///
/// Heights from a file are returned as in the file.
fn in_metres<'a>(surface: &LoadedSurface, heights: &'a Field, side: f64) -> (Cow<'a, Field>, f64) {
    match surface.map() {
        None => (Cow::Borrowed(heights), side),
        Some((heights, as_read)) => {
            let mut heights = heights.clone();
            as_read.restore(0, heights.values_mut());
            (Cow::Owned(heights), 1.0)
        }
    }
}

/// Writes the heights alone.
///
/// # Errors
/// [`FileError::Write`].
pub(super) fn write_map(target: &Path, surface: &LoadedSurface, heights: &Field, side: f64) -> Result<(), FileError> {
    let (field, factor) = in_metres(surface, heights, side);
    let sides = [side, side * heights.grid().cell_ratio()];
    files::write_file(target, |path| match MapFormat::of(target) {
        Some(MapFormat::Csv) => text::write(path, &field, factor),
        Some(MapFormat::Gsf) => gsf::write(path, &field, factor, sides),
        Some(MapFormat::NetCdf) => netcdf::write(path, &field, factor, sides),
        Some(MapFormat::Npy) | None => npy::write(path, &field, factor),
    })
}

/// The files of the folder of a surface, which `rc solve` can solve.
///
/// # Errors
/// [`FileError::Write`].
pub(crate) fn stage_folder(
    folder: &Path,
    surface: &LoadedSurface,
    heights: &Field,
    record: &SurfaceRecord,
    side: f64,
) -> Result<Staged, FileError> {
    let (field, factor) = in_metres(surface, heights, side);
    // A generated surface has a default material, the others have none.
    let material = if surface.keys.file().is_some() || surface.keys.is_shape() { "--e-star ... " } else { "" };
    let scene = format!(
        "# The surface; `rc solve scene.toml {material}--pressure ...` presses it.\n\n{}",
        file::to_toml(&surface.keys)
    );
    let shade = Shade::of_heights(heights, side);
    let picture = MapPicture(Map { title: "Height", field: heights, shade, side });
    let mut staged = Kind::Surface.stage(folder)?;
    staged.add(HEIGHTS_FILE, |path| npy::write(path, &field, factor))?;
    if let Some(waves) = surface.wave_file() {
        staged.add(waves.name(), |path| waves.write(path))?;
    }
    staged.add("surface.png", |path| save_png(&picture, path))?;
    staged.add_text(SCENE_FILE, &scene)?;
    staged.add_text(RECORD_FILE, &to_json(record))?;
    Ok(staged)
}
