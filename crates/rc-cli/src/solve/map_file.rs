//! Writer of a field of a result.

use std::io;
use std::path::Path;

use rc_core::Grid;
use rc_heights::npy::{Precision, RowWriter};

use crate::files::coarsen::BlockMean;
use crate::scene::keys::ContactKeys;

/// An npy file that is written from rows of the finest grid.
///
/// It is on that grid, or averaged to a coarser one.
pub(super) enum MapFile<'a> {
    Full(RowWriter),
    Averaged { path: &'a Path, mean: BlockMean, factor: f64, precision: Precision },
}

impl<'a> MapFile<'a> {
    /// A file for rows of `grid`, with values multiplied by `factor`.
    ///
    /// The file is on the `output_grid` of the `keys` if they have one, in their `precision`.
    pub(super) fn create(path: &'a Path, grid: Grid, keys: &ContactKeys, factor: f64) -> io::Result<Self> {
        let precision = keys.precision.unwrap_or_default().into();
        Ok(match keys.output_grid {
            None => Self::Full(RowWriter::create(path, grid, factor, precision)?),
            Some(spec) => Self::Averaged { path, mean: BlockMean::new(grid, spec), factor, precision },
        })
    }

    /// Takes the next rows.
    pub(super) fn take(&mut self, rows: &[f64]) -> io::Result<()> {
        match self {
            Self::Full(file) => file.write(rows),
            Self::Averaged { mean, .. } => {
                mean.take(rows);
                Ok(())
            }
        }
    }

    pub(super) fn finish(self) -> io::Result<()> {
        match self {
            Self::Full(file) => file.finish(),
            Self::Averaged { path, mean, factor, precision } => {
                let mean = mean.finish();
                let mut file = RowWriter::create(path, mean.grid(), factor, precision)?;
                file.write(mean.values())?;
                file.finish()
            }
        }
    }
}
