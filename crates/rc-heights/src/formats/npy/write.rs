//! Fields as `.npy` files.

use std::fs::File;
use std::io::{self, BufWriter, Write as _};
use std::path::Path;

use npyz::{DType, WriterBuilder as _};
use rc_core::{Field, Grid};

/// Type of the numbers of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// `float32`, with relative errors of 6e-8: half the size.
    Single,
    /// `float64`.
    #[default]
    Double,
}

/// Writes a field as a 2-D `f64` array, C order, little-endian, multiplied by `factor`.
///
/// The field is not copied.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, field: &Field, factor: f64) -> io::Result<()> {
    let mut out = RowWriter::create(path, field.grid(), factor, Precision::Double)?;
    out.write(field.values())?;
    out.finish()
}

/// A writer of a file like that of [`write()`], from rows one after the other.
#[derive(Debug)]
pub struct RowWriter {
    out: BufWriter<File>,
    factor: f64,
    precision: Precision,
    missing: usize,
}

impl RowWriter {
    /// Starts a file for a field on `grid`.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn create(path: &Path, grid: Grid, factor: f64, precision: Precision) -> io::Result<Self> {
        let shape = [grid.ny() as u64, grid.nx() as u64];
        let file = BufWriter::with_capacity(1 << 16, File::create(path)?);
        let plain = DType::Plain(precision.type_string().parse().map_err(io::Error::other)?);
        let options = npyz::WriteOptions::new_header_only().dtype(plain);
        let out = options.shape(&shape).writer(file).write_header_only()?;
        Ok(Self { out, factor, precision, missing: grid.len() })
    }

    /// Writes the next values.
    ///
    /// # Errors
    /// Errors of the file system, and an error for more values than the grid has elements.
    pub fn write(&mut self, values: &[f64]) -> io::Result<()> {
        let missing = self.missing.checked_sub(values.len());
        self.missing = missing.ok_or_else(|| io::Error::other("more values than the grid has elements"))?;
        let mut values = values.iter().map(|value| value * self.factor);
        match self.precision {
            Precision::Double => values.try_for_each(|value| self.out.write_all(&value.to_le_bytes())),
            Precision::Single => values.try_for_each(|value| self.out.write_all(&single(value).to_le_bytes())),
        }
    }

    /// Completes the file, and waits until the system has stored it.
    ///
    /// # Errors
    /// Errors of the file system, and an error for fewer values than the grid has elements.
    pub fn finish(self) -> io::Result<()> {
        if self.missing > 0 {
            return Err(io::Error::other(format!("{} values are missing", self.missing)));
        }
        self.out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
    }
}

impl Precision {
    fn type_string(self) -> &'static str {
        match self {
            Self::Single => "<f4",
            Self::Double => "<f8",
        }
    }
}

/// The nearest `f32`. A positive value stays positive, because the elements in contact are those with a pressure.
#[expect(clippy::cast_possible_truncation, reason = "the caller asks for it")]
fn single(value: f64) -> f32 {
    let near = value as f32;
    if near == 0.0 && value > 0.0 { f32::from_bits(1) } else { near }
}
