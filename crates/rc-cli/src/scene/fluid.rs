//! The pressure of a fluid, from a file or a program.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rc_core::{Field, Grid};
use rc_heights::{Format, Layout, ReadParams};

use crate::error::CliError;

/// Where the pressure of a fluid comes from.
#[derive(Clone, Debug)]
pub enum FluidSource {
    /// A file.
    File(PathBuf),
    /// An array of a program (Pa).
    Held(Arc<Field>),
}

impl FluidSource {
    /// The pressure (Pa) on `grid`, the grid of the solve.
    ///
    /// # Errors
    /// [`CliError::Input`] for a file that is no array of numbers, for another number of elements, and for a value that
    /// is negative or not finite.
    pub(crate) fn load(&self, grid: Grid) -> Result<Field, CliError> {
        let values = match self {
            Self::File(path) => read(path)?,
            Self::Held(field) => field.as_ref().clone(),
        };
        let refuse = |message: String| match self {
            Self::File(path) => CliError::in_file(path, format_args!("fluid_pressure: {message}")),
            Self::Held(_) => CliError::input(format_args!("fluid_pressure: {message}")),
        };
        let [given, wanted] = [values.grid(), grid].map(|grid| [grid.nx(), grid.ny()]);
        if given != wanted {
            return Err(refuse(format!(
                "{} x {} values, but the solve has {} x {} elements; give one value (Pa) for each",
                given[0], given[1], wanted[0], wanted[1]
            )));
        }
        if let Some(i) = values.values().iter().position(|value| !(*value >= 0.0 && value.is_finite())) {
            return Err(refuse(format!(
                "row {}, column {} (from 0) is {}; pressures must be finite and at least 0 (Pa)",
                i / grid.nx(),
                i % grid.nx(),
                values.values()[i]
            )));
        }
        Field::new(grid, values.into_values()).map_err(CliError::input)
    }
}

/// The numbers of a file, as they are.
fn read(path: &Path) -> Result<Field, CliError> {
    let format = rc_heights::format_of(path)?;
    if !matches!(format, Format::Npy | Format::Csv | Format::Xyz) {
        return Err(CliError::in_file(
            path,
            format_args!(
                "fluid_pressure: a file of {format} is no map of pressures; give .npy, or text with one row in each line"
            ),
        ));
    }
    let params = ReadParams { layout: Some(Layout::Matrix), ..ReadParams::default() };
    Ok(rc_heights::read_with(path, &params)?.heights)
}
