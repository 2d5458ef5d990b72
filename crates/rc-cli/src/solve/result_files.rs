//! Writer of the files of a result.

use std::convert::Infallible;
use std::io;
use std::path::Path;
use std::time::Duration;

use rc_core::{DVec2, Field, Grid, Units};
use rc_fractal::height_and_slope_of_grid;
use rc_heights::npy::{Precision, RowWriter};
use rc_plot::{ContactRows, save_png};
use rc_solver::{ContactElement, Solution, Status};
use rc_sweep::files::{FileError, Staged};
use rc_sweep::{MapOrigin, PathDifference, SecondBody, SolveContext, Summary, Warning};

use super::fluid::SolvedFluid;
use super::leakage::SolvedFlow;
use super::map_file::MapFile;
use super::shear::SolvedShear;
use super::{flow_files, shared_fields, shear};
use crate::error::CliError;
use crate::files::kind::Kind;
use crate::files::names::{FLUID_FILE, GROUP, HEIGHTS_FILE, PLASTIC_GAP_FILE, RESIDUAL_FILE, SCENE_FILE, SUMMARY_FILE};
use crate::scene::as_read::AsRead;
use crate::scene::file;
use crate::scene::keys::{ContactKeys, SurfaceKeys};
use crate::scene::resolve::ContactSetup;
use crate::scene::resolve::sliding::SlidingSolid;
use crate::scene::values::{Conductivity, GridSpec};
use crate::scene::wave_file::WaveFile;
use crate::warnings::result::after;

/// A solution with the data that its summary and its files need.
#[derive(Clone, Copy, Debug)]
pub struct ResultFiles<'a> {
    /// Resolved keys of the surface.
    pub surface: &'a SurfaceKeys,
    /// The height map of the solve; `None` for a random surface.
    pub map: Option<MapHeights<'a>>,
    /// The file of waves of the solve, if the surface is from one.
    pub waves: Option<&'a WaveFile>,
    /// Half-space, load and method.
    pub contact: &'a ContactSetup,
    /// The solution.
    pub solution: &'a Solution<'a>,
    /// The unloaded surface after a history of loads (λ).
    pub residual: Option<&'a Field>,
    /// What the steps of the history change, if they were asked for.
    pub path: Option<PathDifference>,
    /// The fluid that presses on the surfaces, if there is one.
    pub fluid: Option<&'a SolvedFluid>,
    /// The flow through the gap, if it was asked for.
    pub flow: Option<&'a SolvedFlow>,
    /// The shear of the contact, if it was asked for.
    pub shear: Option<&'a SolvedShear>,
    /// The warnings that were known before the solve.
    pub warnings: &'a [Warning],
    /// The file of the map, if it was read from one.
    pub origin: Option<&'a MapOrigin>,
}

/// The heights of a map.
#[derive(Clone, Copy, Debug)]
pub enum MapHeights<'a> {
    /// Heights in λ.
    InCell {
        /// Heights in λ.
        heights: &'a Field,
        /// Data that restore the heights of the file.
        as_read: &'a AsRead,
    },
    /// Heights in m, row by row.
    InMetres {
        /// The grid.
        grid: Grid,
        /// The heights (m).
        values: &'a [f64],
    },
}

impl ResultFiles<'_> {
    /// The summary in SI units.
    ///
    /// It needs the surface's rms height (λ) and rms slope, the time `wall` and the number `threads`. Ranks call this
    /// together.
    #[must_use]
    pub fn summary(&self, [rms_height, rms_slope]: [f64; 2], wall: Duration, threads: usize) -> Summary {
        let context = SolveContext {
            control: self.contact.control.into(),
            border_level: self.contact.params.border_level,
            rms_height,
            rms_slope,
            wall,
            threads,
            conductivity: self.contact.keys.conductivity.map(Conductivity::mean),
            jump_distance: self.contact.keys.jump_distance,
            slides: self.contact.sliding.is_some(),
        };
        let leakage = self.flow.map(|flow| flow.summary.clone());
        let summary = Summary::of(self.solution, self.contact.units, &context);
        let summary = match self.fluid {
            Some(SolvedFluid { both, .. }) => summary.under_fluid(both, self.contact.units),
            None => summary,
        };
        let warnings = self.all_warnings();
        let keys = &self.contact.keys;
        let second_body = keys.young2.zip(keys.poisson2).map(|(young, poisson)| SecondBody { young, poisson });
        let control = if keys.force.is_some() { "force".to_owned() } else { summary.control };
        let (force, source) = (keys.force, self.origin.cloned());
        let is_open = self.shear.is_some_and(|shear| !shear.has_converged);
        let status = if is_open { Status::NotConverged.name().to_owned() } else { summary.status };
        let shear = self.shear.map(|shear| shear.summary(self.contact));
        let least_pressure_rise = self.contact.creep.and_then(|_| self.solution.least_pressure_rise());
        let residual_rms_height =
            self.residual.map(|heights| self.contact.units.metres(height_and_slope_of_grid(heights)[0]));
        // A load that an earlier one has prepared just reaches the hardness, and any smaller one does not.
        let is_again = self.contact.is_reloaded();
        let plastic_area_fraction_error =
            if is_again { summary.plastic_area_fraction } else { summary.plastic_area_fraction_error };
        Summary {
            status,
            control,
            force,
            residual_rms_height,
            path_difference: self.path,
            plastic_area_fraction_error,
            least_pressure_rise,
            leakage,
            shear,
            warnings,
            source,
            second_body,
            ..summary
        }
    }

    /// The warnings from before the solve, and those that only the solution shows.
    ///
    /// Ranks call this together.
    #[must_use]
    pub fn all_warnings(&self) -> Vec<Warning> {
        let mut warnings = self.warnings.to_vec();
        warnings.extend(after(self.solution, self.contact, self.surface.heights.is_some()));
        warnings
    }

    /// Writes the result folder.
    ///
    /// Pressure and gap are handed out some rows at a time. The method decides whether they are ever stored as a whole.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub fn write(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        if self.solution.ranks().rank() > 0 {
            hand_over(self.contact, self.solution);
            return Ok(());
        }
        Ok(self.stage(folder, summary)?)
    }

    /// Writes the result folder with pressure and gap as a Zarr group.
    ///
    /// Ranks write the group in parallel. It replaces the files that one rank writes: pressure.npy, gap.npy,
    /// elements.csv and contact.png.
    ///
    /// # Errors
    /// [`CliError::Write`], [`CliError::Input`].
    pub(super) fn write_shared(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        let units = self.contact.units;
        if self.solution.ranks().rank() > 0 {
            return shared_fields::write(None, self.solution, units);
        }
        let mut staged = Kind::Result.stage(folder)?;
        staged.add(GROUP, |path| shared_fields::write(Some(path), self.solution, units))?;
        Ok(self.finish(staged, summary)?)
    }

    /// The solved scene as the text of `scene.toml`.
    #[must_use]
    pub fn scene(&self) -> String {
        scene_text(self.surface, &self.contact.keys, self.solution)
    }

    fn stage(&self, folder: &Path, summary: &Summary) -> Result<(), FileError> {
        let mut staged = Kind::Result.stage(folder)?;
        add_fields(&mut staged, self.contact, self.solution)?;
        if let Some(flow) = self.flow {
            flow_files::add(&mut staged, self.contact, flow, self.solution)?;
        }
        if let Some(shear) = self.shear {
            shear::add(&mut staged, self.contact, shear)?;
        }
        self.finish(staged, summary)
    }

    /// Adds the small files, and gives all files their names.
    fn finish(&self, mut staged: Staged, summary: &Summary) -> Result<(), FileError> {
        if let Some(map) = self.map {
            staged.add(HEIGHTS_FILE, |path| map.write(path))?;
        }
        let side = self.contact.units.cell().side();
        let residual = self.residual.map(|residual| (RESIDUAL_FILE, residual, side));
        let fluid = self.fluid.map(|fluid| (FLUID_FILE, &fluid.pressure, 1.0));
        for (name, field, unit) in residual.into_iter().chain(fluid) {
            staged.add(name, |path| {
                let mut file = RowWriter::create(path, field.grid(), unit, Precision::Double)?;
                file.write(field.values())?;
                file.finish()
            })?;
        }
        if let Some(waves) = self.waves {
            staged.add(waves.name(), |path| waves.write(path))?;
        }
        staged.add_text(SCENE_FILE, &self.scene())?;
        staged.add_text(SUMMARY_FILE, &summary.to_json())?;
        staged.commit()
    }
}

impl MapHeights<'_> {
    /// Writes the heights of the caller or of the file, row by row.
    fn write(self, path: &Path) -> io::Result<()> {
        let grid = match self {
            Self::InCell { heights, .. } => heights.grid(),
            Self::InMetres { grid, .. } => grid,
        };
        let mut file = RowWriter::create(path, grid, 1.0, Precision::Double)?;
        let mut row = vec![0.0; grid.nx()];
        for iy in 0..grid.ny() {
            let first = iy * row.len();
            match self {
                Self::InCell { heights, as_read } => {
                    row.copy_from_slice(heights.row(iy));
                    as_read.restore(first, &mut row);
                }
                Self::InMetres { values, .. } => row.copy_from_slice(&values[first..first + grid.nx()]),
            }
            file.write(&row)?;
        }
        file.finish()
    }
}

/// Hands over this rank's rows and elements, which the first rank writes in [`add_fields`].
fn hand_over(contact: &ContactSetup, solution: &Solution<'_>) {
    let nothing = |_: usize, _: &[f64]| Ok::<_, Infallible>(());
    let Ok(()) = solution.pressure_rows(nothing);
    let Ok(()) = solution.gap_rows(nothing);
    if contact.keys.elements {
        let Ok(()) = solution.each_element(|_| Ok::<_, Infallible>(()));
    }
    let Ok(()) = solution.pressure_rows(nothing);
}

/// Adds pressure, gap, its plastic part, the elements if they are wanted, and the picture of the contact.
fn add_fields(staged: &mut Staged, contact: &ContactSetup, solution: &Solution<'_>) -> Result<(), FileError> {
    let (units, grid) = (contact.units, solution.grid());
    let (side, e_star) = (units.cell().side(), units.elasticity().e_star());
    let keys = &contact.keys;
    staged.add("pressure.npy", |path| {
        let mut file = MapFile::create(path, grid, keys, e_star)?;
        solution.pressure_rows(|_, rows| file.take(rows))?;
        file.finish()
    })?;
    staged.add("gap.npy", |path| {
        let mut file = MapFile::create(path, grid, keys, side)?;
        solution.gap_rows(|_, rows| file.take(rows))?;
        file.finish()
    })?;
    if solution.hardness().is_finite() {
        staged.add(PLASTIC_GAP_FILE, |path| {
            let mut file = MapFile::create(path, grid, keys, side)?;
            solution.plastic_gap_rows(|_, rows| file.take(rows))?;
            file.finish()
        })?;
    }
    // An element has one side.
    let has_squares = (grid.spacing().x / grid.spacing().y - 1.0).abs() < 1e-9;
    if keys.elements && (has_squares || solution.elements().is_some()) {
        staged.add("elements.csv", |path| write_elements(path, solution, units))?;
    }
    let mut picture = ContactRows::new(grid);
    let Ok(()) = solution.pressure_rows(|_, rows| {
        picture.take(rows);
        Ok::<_, Infallible>(())
    });
    let direction = contact.sliding.as_ref().and_then(SlidingSolid::heading);
    let picture = picture.finish(e_star, side).sliding(direction);
    staged.add("contact.png", |path| save_png(&picture, path))
}

/// Writes centre (m), side (m) and pressure (Pa) of each element into `elements.csv`.
///
/// The solution has them in λ and E*.
fn write_elements(path: &Path, solution: &Solution<'_>, units: Units) -> Result<(), csv::Error> {
    let mut out = csv::Writer::from_path(path)?;
    out.write_record(["x", "y", "size", "pressure"])?;
    let mut write = |ContactElement { centre: DVec2 { x, y }, side, pressure }| {
        out.serialize((units.metres(x), units.metres(y), units.metres(side), units.pascals(pressure)))
    };
    if solution.elements().is_some() {
        solution.each_element(&mut write)?;
    } else {
        // The elements of a method without a mesh are those of the grid.
        let (grid, pressure) = (solution.grid(), solution.pressure().values());
        for (i, &pressure) in pressure.iter().enumerate().filter(|&(_, &pressure)| pressure > 0.0) {
            let centre = grid.centre(i % grid.nx(), i / grid.nx());
            write(ContactElement { centre, side: grid.spacing().x, pressure })?;
        }
    }
    out.flush()?;
    Ok(())
}

/// The solved scene as text.
///
/// It has every key that determines the result, with the grid and the method that ran.
fn scene_text(surface: &SurfaceKeys, contact: &ContactKeys, solution: &Solution<'_>) -> String {
    let grid = solution.grid();
    let grid = GridSpec { nx: grid.nx(), ny: grid.ny() };
    let surface = SurfaceKeys { grid: Some(grid), ..surface.clone() };
    // The folder has its own copy.
    let fluid_pressure = contact.fluid_pressure.as_ref().map(|_| FLUID_FILE.into());
    let contact = ContactKeys { method: Some(solution.method()), fluid_pressure, ..contact.clone() };
    let [surface, contact] = [file::to_toml(&surface), file::to_toml(&contact)];
    format!("# The scene as it was solved: `rc solve scene.toml` repeats the result.\n\n{surface}\n{contact}")
}
