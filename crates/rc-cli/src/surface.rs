//! The rough surface of a scene as numbers: heights on a grid, and its moments.

use std::path::PathBuf;

use rc_core::{Field, Grid, PeriodicCell};
use rc_fractal::{Moments, SpectrumParams, Surface};

use crate::error::CliError;
use crate::heights;
use crate::resolve;
use crate::scene::SurfaceKeys;
use crate::values::GridSpec;

/// A checked surface, before its heights are evaluated.
#[derive(Clone, Debug)]
pub struct SurfaceProblem {
    /// The cell (m).
    pub cell: PeriodicCell,
    /// Where the heights come from.
    pub source: Source,
    /// The keys as resolved, for `scene.toml`.
    pub keys: SurfaceKeys,
}

/// Where heights come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// A height map.
    File {
        /// The file.
        path: PathBuf,
        /// The grid that the user says it has.
        expected: Option<Grid>,
    },
    /// A random surface.
    Random {
        /// Its parameters, in units of λ.
        spectrum: SpectrumParams,
        /// The grid to evaluate it on.
        grid: Grid,
    },
}

/// A surface with its heights.
#[derive(Clone, Debug)]
pub struct Heights {
    /// Heights in λ.
    pub field: Field,
    /// Heights as read from a file (m); a result is repeated bit for bit only from these.
    pub as_read: Option<Field>,
    /// Exact moments of a random surface, in λ; those of a height map have to be computed.
    pub moments: Option<Moments>,
    /// The keys as resolved: the grid is known now, and a height map is called as in a result folder.
    pub keys: SurfaceKeys,
}

/// The name of a height map in a result folder.
pub const HEIGHTS_FILE: &str = "heights.npy";

impl SurfaceProblem {
    /// Reads or evaluates the heights.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is no height map, is on another grid than the scene says, or is flat.
    pub fn heights(&self) -> Result<Heights, CliError> {
        match &self.source {
            Source::File { path, expected } => {
                let as_read = heights::read(path)?;
                let grid = as_read.grid();
                if let Some(expected) = expected.filter(|expected| *expected != grid) {
                    let message = format_args!("the map has {grid} elements, grid says {expected}; leave grid away");
                    return Err(CliError::in_file(path, message));
                }
                if as_read.max() <= as_read.min() {
                    let message =
                        format_args!("all heights are {:e}; a flat surface has no contact problem", as_read.max());
                    return Err(CliError::in_file(path, message));
                }
                resolve::check_memory(grid)?;
                let side = self.cell.side();
                let scaled = as_read.values().iter().map(|height| height / side).collect();
                let field = Field::new(grid, scaled).map_err(|cause| CliError::in_file(path, cause))?;
                let keys =
                    SurfaceKeys { heights: Some(HEIGHTS_FILE.into()), grid: Some(spec(grid)), ..self.keys.clone() };
                Ok(Heights { moments: None, field, as_read: Some(as_read), keys })
            }
            Source::Random { spectrum, grid } => {
                let surface = Surface::new(spectrum).map_err(CliError::input)?;
                let field = surface.sample_on(*grid).map_err(|cause| CliError::input(format_args!("grid: {cause}")))?;
                Ok(Heights { moments: Some(surface.moments()), field, as_read: None, keys: self.keys.clone() })
            }
        }
    }
}

fn spec(grid: Grid) -> GridSpec {
    GridSpec { nx: grid.nx(), ny: grid.ny() }
}
