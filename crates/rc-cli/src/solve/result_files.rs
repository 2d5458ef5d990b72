//! The files of a result.

use std::io;
use std::path::Path;

use rc_core::{DVec2, Field, Grid, Units};
use rc_heights::npy::{self, RowWriter};
use rc_plot::{ContactRows, save_png};
use rc_solver::{ContactElement, Solution};
use rc_sweep::Summary;
use rc_sweep::files::{FileError, Staged};

use crate::files::coarsen::BlockMean;
use crate::scene::as_read::AsRead;
use crate::scene::file;
use crate::scene::keys::{ContactKeys, SurfaceKeys};
use crate::scene::resolve::ContactSetup;
use crate::scene::surface::{HEIGHTS_FILE, LoadedSurface};
use crate::scene::values::GridSpec;

/// Writes the result folder. The method decides whether pressure and gap are ever whole in memory: they are handed out some
/// rows at a time.
pub(super) fn write(
    folder: &Path,
    surface: &LoadedSurface,
    contact: &ContactSetup,
    solution: &Solution<'_>,
    summary: &Summary,
) -> Result<(), FileError> {
    let mut staged = Staged::new(folder)?;
    add_fields(&mut staged, contact, solution)?;
    if let Some((heights, as_read)) = surface.map() {
        staged.add(HEIGHTS_FILE, |path| write_as_read(path, heights, as_read))?;
    }
    staged.add_text("scene.toml", &scene_text(&surface.keys, &contact.keys, solution))?;
    staged.add_text("summary.json", &summary.to_json())?;
    staged.commit()
}

/// Writes heights (λ) as they are in the file that they come from, row by row.
fn write_as_read(path: &Path, heights: &Field, as_read: &AsRead) -> io::Result<()> {
    let mut file = RowWriter::create(path, heights.grid(), 1.0)?;
    let mut row = vec![0.0; heights.grid().nx()];
    for iy in 0..heights.grid().ny() {
        row.copy_from_slice(heights.row(iy));
        as_read.restore(iy * row.len(), &mut row);
        file.write(&row)?;
    }
    file.finish()
}

/// Pressure, gap, elements and the picture of the contact.
fn add_fields(staged: &mut Staged, contact: &ContactSetup, solution: &Solution<'_>) -> Result<(), FileError> {
    let (units, grid) = (contact.units, solution.grid());
    let (side, e_star) = (units.cell().side(), units.elasticity().e_star());
    let output_grid = contact.keys.output_grid;
    staged.add("pressure.npy", |path| {
        let mut file = MapFile::create(path, grid, output_grid, e_star)?;
        solution.pressure_rows(|_, rows| file.take(rows))?;
        file.finish()
    })?;
    staged.add("gap.npy", |path| {
        let mut file = MapFile::create(path, grid, output_grid, side)?;
        solution.gap_rows(|_, rows| file.take(rows))?;
        file.finish()
    })?;
    if let Some(elements) = solution.elements() {
        staged.add("elements.csv", |path| write_elements(path, elements, units))?;
    }
    let mut picture = ContactRows::new(grid);
    let Ok(()) = solution.pressure_rows(|_, rows| {
        picture.take(rows);
        Ok::<_, std::convert::Infallible>(())
    });
    let picture = picture.finish(e_star, side);
    staged.add("contact.png", |path| save_png(&picture, path))
}

/// An npy file from rows of the finest grid, on that grid or averaged to a coarser one.
enum MapFile<'a> {
    Full(RowWriter),
    Averaged { path: &'a Path, mean: BlockMean, factor: f64 },
}

impl<'a> MapFile<'a> {
    /// A file for rows of `grid`, on `output_grid` if there is one, values multiplied by `factor`.
    fn create(path: &'a Path, grid: Grid, output_grid: Option<GridSpec>, factor: f64) -> io::Result<Self> {
        Ok(match output_grid {
            None => Self::Full(RowWriter::create(path, grid, factor)?),
            Some(spec) => Self::Averaged { path, mean: BlockMean::new(grid, spec), factor },
        })
    }

    /// Takes the next rows.
    fn take(&mut self, rows: &[f64]) -> io::Result<()> {
        match self {
            Self::Full(file) => file.write(rows),
            Self::Averaged { mean, .. } => {
                mean.take(rows);
                Ok(())
            }
        }
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Full(file) => file.finish(),
            Self::Averaged { path, mean, factor } => npy::write(path, &mean.finish(), factor),
        }
    }
}

/// Centre (m), side (m) and pressure (Pa) of each element, as `elements.csv`; given in λ and E*.
fn write_elements(path: &Path, elements: impl Iterator<Item = ContactElement>, units: Units) -> Result<(), csv::Error> {
    let mut out = csv::Writer::from_path(path)?;
    out.write_record(["x", "y", "size", "pressure"])?;
    for ContactElement { centre: DVec2 { x, y }, side, pressure } in elements {
        out.serialize((units.metres(x), units.metres(y), units.metres(side), units.pascals(pressure)))?;
    }
    out.flush()?;
    Ok(())
}

/// The scene as it was solved: every key that determines the result, the grid and the method that ran included.
fn scene_text(surface: &SurfaceKeys, contact: &ContactKeys, solution: &Solution<'_>) -> String {
    let grid = solution.grid();
    let grid = GridSpec { nx: grid.nx(), ny: grid.ny() };
    let surface = SurfaceKeys { grid: Some(grid), ..surface.clone() };
    let contact = ContactKeys { method: Some(solution.method()), ..contact.clone() };
    let [surface, contact] = [file::to_toml(&surface), file::to_toml(&contact)];
    format!("# The scene as it was solved: `rc solve scene.toml` repeats the result.\n\n{surface}\n{contact}")
}
