//! Pressure and gap as a Zarr group that all ranks write together.
//!
//! Each rank writes the chunks of its rows.

use std::io;
use std::path::{Path, PathBuf};

use rc_core::Units;
use rc_solver::Solution;

use crate::error::CliError;
use crate::export::{xarray, zarr};
use crate::files::names::GROUP;
use crate::run::together::together;

/// Rows of a chunk, which are those of a tile. A chunk has all columns.
const ROWS: usize = 8;

/// Dimensions of a field: rows, columns.
const PLANE: [&str; 2] = ["y", "x"];

/// Writes the group to the folder `path` of the first rank.
///
/// Other ranks are told the path. All ranks call this together.
///
/// # Errors
/// [`CliError::Write`], on all ranks.
pub(super) fn write(path: Option<&Path>, solution: &Solution<'_>, units: Units) -> Result<(), CliError> {
    let ranks = solution.ranks();
    let made = path.map_or(Ok(()), |path| describe(path, solution, units));
    together(&ranks, made.map_err(|cause| not_written(path, &cause)))?;
    let path = path_of_first(path, &ranks);
    let (side, e_star) = (units.cell().side(), units.elasticity().e_star());
    // A rank that cannot write still takes its rows, since other ranks take part in handing them out.
    let mut result = Ok(());
    let nx = solution.grid().nx();
    let mut chunk = |name: &str, first: usize, rows: &[f64], factor: f64| {
        if result.is_ok() {
            result = write_rows(&path.join(name), first, (rows, nx), factor);
        }
        Ok::<_, std::convert::Infallible>(())
    };
    let Ok(()) = solution.own_pressure_rows(|first, rows| chunk("pressure", first, rows, e_star));
    let Ok(()) = solution.own_gap_rows(|first, rows| chunk("gap", first, rows, side));
    together(&ranks, result.map_err(|cause| not_written(Some(&path), &cause)))
}

fn not_written(path: Option<&Path>, cause: &io::Error) -> CliError {
    CliError::write(path.unwrap_or(Path::new(GROUP)), cause)
}

/// The path of the first rank.
fn path_of_first(path: Option<&Path>, ranks: &rc_comm::Ranks) -> PathBuf {
    let mine = path.and_then(|path| std::path::absolute(path).ok());
    let mine = mine.and_then(|path| path.to_str().map(str::to_owned)).unwrap_or_default();
    let first = ranks.all_gather(mine.as_bytes()).into_iter().next().unwrap_or_default();
    path.map_or_else(|| String::from_utf8_lossy(&first).into_owned().into(), Path::to_owned)
}

fn describe(path: &Path, solution: &Solution<'_>, units: Units) -> io::Result<()> {
    if std::path::absolute(path)?.to_str().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "its path is not UTF-8"));
    }
    let grid = solution.grid();
    let (side, e_star) = (units.cell().side(), units.elasticity().e_star());
    let attributes = xarray::attributes(solution.status().name(), grid, side, e_star);
    let fields = [("pressure", "Pa", "contact pressure"), ("gap", "m", "gap between the surfaces")];
    let description = zarr::description("<f8", &[grid.ny(), grid.nx()], &[ROWS, grid.nx()]);
    let arrays =
        fields.map(|(name, unit, meaning)| (name, description.clone(), zarr::attributes(&PLANE, unit, meaning)));
    zarr::write_metadata(path, &attributes, arrays.into_iter())
}

/// Writes the chunk of some rows of `nx` values. Values beyond the grid are zero.
fn write_rows(folder: &Path, first: usize, (rows, nx): (&[f64], usize), factor: f64) -> io::Result<()> {
    for (i, rows) in rows.chunks(ROWS * nx).enumerate() {
        let mut bytes: Vec<u8> = rows.iter().flat_map(|value| (factor * value).to_le_bytes()).collect();
        bytes.resize(ROWS * nx * size_of::<f64>(), 0);
        zarr::write_chunk(&folder.join(format!("{}.0", first / ROWS + i)), &bytes)?;
    }
    Ok(())
}
