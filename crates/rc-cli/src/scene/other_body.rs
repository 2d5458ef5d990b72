//! The heights of the other body, which are mirrored along x and added.

use std::path::{Path, PathBuf};

use rc_core::quantity::engineering;
use rc_core::{Field, PeriodicCell};
use rc_heights::{HeightMap, ReadNote};
use rc_sweep::Warning;

use super::heights;
use super::keys::SurfaceKeys;
use super::like;
use crate::error::CliError;
use crate::warnings;

/// The map of the other body.
pub(super) struct OtherBody {
    path: PathBuf,
    map: HeightMap,
}

impl OtherBody {
    /// Reads the map in metres, which may be that of a folder. `keys` say how files are read.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is not a map without missing points, or not of this cell.
    pub(super) fn read(path: &Path, keys: &SurfaceKeys, cell: PeriodicCell) -> Result<Self, CliError> {
        let params = keys.read_params();
        let path = &like::file_of(path);
        let map = heights::read(path, &params, keys.scales())?;
        heights::check_heights(path, &map.heights, &params)?;
        // Sides without a unit are not known.
        let sides = map.sides.filter(|_| !map.notes.contains(&ReadNote::SidesAssumedMetres));
        if let Some(sides) = sides.filter(|sides| !sides.iter().zip(cell.sides()).all(|(a, b)| heights::same(*a, b))) {
            let of = |[x, y]: [f64; 2]| format!("{} x {}", engineering(x, "m"), engineering(y, "m"));
            return Err(Self::refused(
                path,
                format_args!("is {}, but the cell is {}; both bodies need the same cell", of(sides), of(cell.sides())),
            ));
        }
        Ok(Self { path: path.to_owned(), map })
    }

    /// Adds the map, mirrored along x, to the `heights` (m) of a body, and returns the doubts about it.
    ///
    /// Both are positive towards the other body, so one of them is seen from behind.
    ///
    /// # Errors
    /// [`CliError::Input`] when the grids differ.
    pub(super) fn add_mirrored(&self, heights: &mut Field) -> Result<Vec<Warning>, CliError> {
        let (grid, other) = (heights.grid(), self.map.heights.grid());
        if [grid.nx(), grid.ny()] != [other.nx(), other.ny()] {
            return Err(Self::refused(
                &self.path,
                format_args!(
                    "has {other} points, but the surface has {grid}; both bodies need the same grid (rc surface --resample)"
                ),
            ));
        }
        for (row, other) in heights.values_mut().chunks_mut(grid.nx()).zip(self.map.heights.values().chunks(grid.nx()))
        {
            row.iter_mut().zip(other.iter().rev()).for_each(|(height, other)| *height += other);
        }
        let doubts = warnings::surface::of_file(&self.path, &self.map)
            .into_iter()
            .chain(warnings::surface::of_record(&self.path));
        Ok(doubts.map(|doubt| Warning::new(doubt.code, format!("add: {}", doubt.text))).collect())
    }

    fn refused(path: &Path, message: impl std::fmt::Display) -> CliError {
        CliError::input(format_args!("add: {} {message}", path.display()))
    }
}
