//! Writer of a field of a result.

use std::io;
use std::path::Path;

use rc_core::Grid;
use rc_heights::npy::{self, RowWriter};

use crate::files::coarsen::BlockMean;
use crate::scene::values::GridSpec;

/// An npy file that is written from rows of the finest grid.
///
/// It is on that grid, or averaged to a coarser one.
pub(super) enum MapFile<'a> {
    Full(RowWriter),
    Averaged { path: &'a Path, mean: BlockMean, factor: f64 },
}

impl<'a> MapFile<'a> {
    /// A file for rows of `grid`, with values multiplied by `factor`.
    ///
    /// The file is on `output_grid` if that is given.
    pub(super) fn create(path: &'a Path, grid: Grid, output_grid: Option<GridSpec>, factor: f64) -> io::Result<Self> {
        Ok(match output_grid {
            None => Self::Full(RowWriter::create(path, grid, factor)?),
            Some(spec) => Self::Averaged { path, mean: BlockMean::new(grid, spec), factor },
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
            Self::Averaged { path, mean, factor } => npy::write(path, &mean.finish(), factor),
        }
    }
}
