//! The files of a result.

use std::io;
use std::path::Path;

use rc_core::{Field, Grid};
use rc_solver::{AdaptiveProblem, AdaptiveSolution, GridSolution, MeshPressure};

use super::Solved;
use super::found::Pressure;
use crate::coarsen::BlockMean;
use crate::npy::{self, RowWriter};
use crate::resolve::ContactProblem;
use crate::scene::ContactKeys;
use crate::scene_file;
use crate::surface::HEIGHTS_FILE;
use crate::values::GridSpec;
use rc_plot::{ContactPicture, ContactRows, save_png};
use rc_sweep::Summary;
use rc_sweep::files::{FileError, Staged};

/// Factors that make lengths metres and pressures pascals.
#[derive(Clone, Copy)]
struct Units {
    side: f64,
    e_star: f64,
}

/// Writes the result folder.
pub(super) fn write(folder: &Path, solved: &Solved<'_>, summary: &Summary) -> Result<(), FileError> {
    let contact = solved.contact;
    let units = Units { side: solved.side, e_star: contact.elasticity.e_star() };
    let mut staged = Staged::new(folder)?;
    match &solved.found.pressure {
        Pressure::Whole(solution) => add_whole(&mut staged, solution, contact.keys.output_grid, units)?,
        Pressure::Tiles { solution, problem } => {
            add_tiles(&mut staged, solution, problem, contact.keys.output_grid, units)?;
        }
    }
    if let Some(heights) = solved.surface.as_read() {
        staged.add(HEIGHTS_FILE, |path| npy::write(path, heights, 1.0))?;
    }
    staged.add_text("scene.toml", &scene_text(solved, contact))?;
    staged.add_text("summary.json", &summary.to_json())?;
    staged.commit()
}

fn add_whole(
    staged: &mut Staged,
    solution: &GridSolution,
    output_grid: Option<GridSpec>,
    units: Units,
) -> Result<(), FileError> {
    let mut add_field = |name: &str, field: &Field, factor: f64| {
        staged.add(name, |path| {
            let mut file = MapFile::create(path, field.grid(), output_grid, factor)?;
            file.take(field.values())?;
            file.finish()
        })
    };
    add_field("pressure.npy", &solution.pressure, units.e_star)?;
    add_field("gap.npy", &solution.gap, units.side)?;
    if let Some(MeshPressure { mesh, pressure }) = &solution.elements {
        let rows = mesh.elements().zip(pressure).map(|(e, &pressure)| [e.centre.x, e.centre.y, e.side, pressure]);
        staged.add("elements.csv", |path| write_elements(path, rows, units))?;
    }
    let picture = ContactPicture::of(&solution.pressure, units.e_star, units.side);
    staged.add("contact.png", |path| save_png(&picture, path))
}

/// As [`add_whole`], from rows of the finest grid: pressure, gap and heights are never whole in memory.
fn add_tiles(
    staged: &mut Staged,
    solution: &AdaptiveSolution,
    problem: &AdaptiveProblem<'_>,
    output_grid: Option<GridSpec>,
    units: Units,
) -> Result<(), FileError> {
    let grid = solution.grid();
    staged.add("pressure.npy", |path| {
        let mut file = MapFile::create(path, grid, output_grid, units.e_star)?;
        solution.pressure_rows(|_, rows| file.take(rows))?;
        file.finish()
    })?;
    staged.add("gap.npy", |path| {
        let mut file = MapFile::create(path, grid, output_grid, units.side)?;
        problem.gap_rows(solution, |_, rows| file.take(rows))?;
        file.finish()
    })?;
    let rows = solution.elements().map(|e| [e.centre.x, e.centre.y, e.side, e.pressure]);
    staged.add("elements.csv", |path| write_elements(path, rows, units))?;
    let mut picture = ContactRows::new(grid);
    let Ok(()) = solution.pressure_rows(|_, rows| {
        picture.take(rows);
        Ok::<_, std::convert::Infallible>(())
    });
    let picture = picture.finish(units.e_star, units.side);
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
fn write_elements(path: &Path, elements: impl Iterator<Item = [f64; 4]>, units: Units) -> Result<(), csv::Error> {
    let Units { side, e_star } = units;
    let mut out = csv::Writer::from_path(path)?;
    out.write_record(["x", "y", "size", "pressure"])?;
    for [x, y, size, pressure] in elements {
        out.serialize((x * side, y * side, size * side, pressure * e_star))?;
    }
    out.flush()?;
    Ok(())
}

/// The scene as it was solved: every key that determines the result, the method that ran included.
fn scene_text(solved: &Solved<'_>, contact: &ContactProblem) -> String {
    let keys = ContactKeys { method: Some(solved.found.method), ..contact.keys.clone() };
    let [surface, contact] = [scene_file::to_toml(&solved.surface.keys), scene_file::to_toml(&keys)];
    format!("# The scene as it was solved: `rc solve scene.toml` repeats the result.\n\n{surface}\n{contact}")
}
