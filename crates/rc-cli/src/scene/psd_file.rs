//! Tables of isotropic spectra, in SI units.

use std::f64::consts::TAU;
use std::path::Path;

use rc_core::quantity::engineering;
use rc_fractal::{Amplitudes, Moments, SpectrumTable, Surface, TableError};
use rc_heights::pairs;

use super::values::PsdConvention;
use super::wave_file::WaveFile;
use crate::error::CliError;

/// A table of a spectrum, and the spectrum on the unit cell.
#[derive(Clone, Debug)]
pub struct PsdFile {
    /// q (rad/m) and C (m⁴) as read, in the convention of the keys.
    rows: Vec<[f64; 2]>,
    table: SpectrumTable,
}

impl PsdFile {
    /// Reads the table in `path` for a cell of side `side` (m), with at most `max_bytes` of memory.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file cannot be read, or is not a spectrum of this cell.
    pub(super) fn read(
        path: &Path,
        convention: PsdConvention,
        (side, max_bytes): (f64, u64),
    ) -> Result<Self, CliError> {
        let rows = pairs::read_within(path, max_bytes, "q (rad/m) and C (m^4)")?;
        Self::of_rows(rows, convention, side).map_err(|cause| CliError::in_file(path, cause))
    }

    /// The spectrum in `rows` on a cell of side `side` (m).
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn of_rows(rows: Vec<[f64; 2]>, convention: PsdConvention, side: f64) -> Result<Self, String> {
        let in_cell = |[q, c]: [f64; 2]| [q * side / TAU, c / convention.factor() / side.powi(4)];
        let table = SpectrumTable::new(rows.iter().copied().map(in_cell).collect());
        match table {
            Ok(table) => Ok(Self { rows, table }),
            Err(cause) => Err(in_units_of_rows(cause, &rows)),
        }
    }

    /// N of the surface, in waves per cell.
    #[must_use]
    pub fn waves(&self) -> usize {
        self.table.waves()
    }

    /// A realisation, with the rows that repeat it.
    ///
    /// # Errors
    /// [`CliError::Input`] when its heights are out of range.
    pub(super) fn realisation(&self, amplitudes: Amplitudes, seed: u64) -> Result<WaveFile, CliError> {
        let surface = Surface::from_table(&self.table, amplitudes, seed);
        let Moments { rms_height, rms_slope, .. } = surface.moments();
        if ![rms_height, rms_slope].iter().all(|moment| moment.is_finite() && *moment > 0.0) {
            return Err(CliError::input(format_args!(
                "psd: an rms height of {rms_height:e} cell sides is out of range; check cell and units"
            )));
        }
        Ok(WaveFile::of_spectrum(self.rows.clone(), surface))
    }
}

/// What is wrong with a table, in the units of its rows.
fn in_units_of_rows(cause: TableError, rows: &[[f64; 2]]) -> String {
    match cause {
        TableError::Wavenumber { row, .. } => TableError::Wavenumber { row, value: rows[row - 1][0] }.to_string(),
        TableError::Density { row, .. } => TableError::Density { row, value: rows[row - 1][1] }.to_string(),
        TableError::NoWaves { .. } if rows.iter().all(|row| row[1] == 0.0) => {
            "the spectrum is 0 in all rows; it must be above 0 for the waves of the surface".to_owned()
        }
        TableError::NoWaves { .. } => {
            let [longest, shortest] = [rows[0], rows[rows.len() - 1]].map(|row| engineering(TAU / row[0], "m"));
            format!(
                "the cell has no wave as in the table, from {longest} to {shortest}; check that its q is in rad/m, or \
                 take another cell"
            )
        }
        other => other.to_string(),
    }
}
