//! Pictures of the contact under the largest load, one for each solved treatment.

use std::convert::Infallible;
use std::path::{Path, PathBuf};

use rc_core::quantity::{digits, engineering};
use rc_plot::{Map, MapPicture, PixelMean, Shade, save_small_png};
use rc_solver::Solution;
use rc_sweep::files;

use crate::error::CliError;

/// Folder of the pictures in that of the study.
const FOLDER: &str = "contact";

/// Maximum number of pixels per side of a map.
const MOST_PIXELS: usize = 300;

/// The picture of `treatment` in the folder of a study.
pub(crate) fn path_in(folder: &Path, treatment: &str) -> PathBuf {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
    folder.join(FOLDER).join(format!("{}.png", treatment.chars().map(plain).collect::<String>()))
}

/// Writes the picture of the contact of `treatment` under `pressure` (Pa), on a map that is `side` wide (m).
///
/// # Errors
/// [`CliError::Write`].
pub(super) fn write(
    path: &Path,
    treatment: &str,
    (pressure, side): (f64, f64),
    solution: &Solution<'_>,
) -> Result<(), CliError> {
    let grid = solution.grid();
    let mut means = PixelMean::new(grid, MOST_PIXELS);
    let Ok(()) = solution.pressure_rows(|_, rows| {
        for row in rows.chunks_exact(grid.nx()) {
            means.take(|ix| if row[ix] > 0.0 { 1.0 } else { 0.0 });
        }
        Ok::<_, Infallible>(())
    });
    // The located area, as in the table. The picture shows whole elements.
    let part = digits(100.0 * solution.observables().area.fraction, 3);
    let title = format!("{treatment}: {part} % at {}", engineering(pressure, "Pa"));
    let field = means.finish();
    let picture = MapPicture(Map { title: &title, field: &field, shade: Shade::PartOfContact, side });
    Ok(files::write_file(path, |path| save_small_png(&picture, path))?)
}
