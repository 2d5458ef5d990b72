//! The rough surface of a scene: realised or read, and its heights on a grid only where a method needs them.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rc_core::{Boundary, Field, Grid, HeightSource, PeriodicCell};
use rc_fractal::{
    Moments, SpectrumParams, Surface, height_and_slope_of_grid, height_and_slope_of_patch, moments_of_grid,
};
use rc_heights::{HeightMap, ReadParams, Scales};

use super::as_read::AsRead;
use super::heights;
use super::keys::SurfaceKeys;
use super::values::GridSpec;
use super::wave_file::{WAVES_FILE, WaveFile};
use crate::error::CliError;

/// A checked surface, before it is realised or read.
#[derive(Clone, Debug)]
pub struct SurfaceSetup {
    /// The cell (m).
    pub cell: PeriodicCell,
    /// Where the heights come from.
    pub source: Source,
    /// Whether a map whose heights are all the same is a surface: a flat punch, with free borders.
    pub may_be_flat: bool,
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
        /// What is read of it.
        params: ReadParams,
        /// What the user knows of its units.
        scales: Scales,
    },
    /// A random surface.
    Random {
        /// Its parameters, in units of λ.
        spectrum: SpectrumParams,
        /// The finest grid.
        grid: Grid,
    },
    /// A surface whose waves are in a file.
    Waves {
        /// The file.
        path: PathBuf,
        /// What was read from it.
        waves: Arc<WaveFile>,
        /// The finest grid.
        grid: Grid,
    },
}

/// A surface, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct LoadedSurface {
    /// What is known of it.
    pub shape: Shape,
    /// The finest grid.
    pub grid: Grid,
    /// The keys as resolved: the grid is known now, and a height map is called as in a result folder.
    pub keys: SurfaceKeys,
}

/// A surface as a sum of waves, or as a map.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A random surface; it has heights anywhere.
    Random(Arc<Surface>),
    /// A surface of the waves in a file; it too has heights anywhere.
    Waves(Arc<WaveFile>),
    /// A height map.
    Map {
        /// Heights in λ.
        heights: Arc<Field>,
        /// What makes them the heights in the file.
        as_read: AsRead,
    },
}

/// The name of a height map in a result folder.
pub const HEIGHTS_FILE: &str = "heights.npy";

impl SurfaceKeys {
    /// The keys of a height map that a program holds, with the sides of its cell (m) where it knows them. The map is
    /// called as in a result folder.
    ///
    /// # Errors
    /// [`CliError::Input`] when keys of a random surface, or of a file, are given; or another size than that of the
    /// map.
    pub fn of_map(self, sides: Option<[f64; 2]>) -> Result<Self, CliError> {
        if self.heights.is_some() || self.generates() {
            let message =
                "heights defines the surface; omit the parameters of a random surface (waves, hurst, rms, ...)";
            return Err(CliError::input(message));
        }
        let [cell, cell_y] = heights::sides(Path::new("heights"), sides, [self.cell, self.cell_y])?;
        Ok(Self { heights: Some(HEIGHTS_FILE.into()), cell, cell_y, ..self })
    }
}

impl SurfaceSetup {
    /// Elements of the finest grid; at most, for a height map, by the length of its file.
    #[must_use]
    pub fn max_elements(&self) -> f64 {
        match &self.source {
            Source::Random { grid, .. } | Source::Waves { grid, .. } => grid.len() as f64,
            // Two bytes are the least that a useful map has for a height.
            Source::File { path, .. } => path.metadata().map_or(0.0, |file| file.len() as f64 / 2.0),
        }
    }

    /// Reads the map or realises the random surface. Heights of a sum of waves are not evaluated yet.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is not a height map, is on another grid than the scene says, or is flat.
    pub fn load(&self) -> Result<LoadedSurface, CliError> {
        match &self.source {
            Source::File { path, expected, params, scales } => {
                self.of_map(path, heights::read(path, params, *scales)?, *expected)
            }
            Source::Random { spectrum, grid } => {
                let surface = Surface::new(spectrum).map_err(CliError::input)?;
                Ok(LoadedSurface { shape: Shape::Random(Arc::new(surface)), grid: *grid, keys: self.keys.clone() })
            }
            Source::Waves { waves, grid, .. } => {
                let keys = SurfaceKeys { spectrum: Some(WAVES_FILE.into()), ..self.keys.clone() };
                Ok(LoadedSurface { shape: Shape::Waves(Arc::clone(waves)), grid: *grid, keys })
            }
        }
    }

    /// A map in metres, read from `path`, as a surface in this cell.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are missing, when it is flat, or of another grid or size than the scene says.
    pub fn of_map(&self, path: &Path, map: HeightMap, expected: Option<Grid>) -> Result<LoadedSurface, CliError> {
        heights::sides(path, map.sides, [Some(self.cell.side()), self.keys.cell_y])?;
        heights::check_finite(path, &map.heights)?;
        let range = [map.heights.min(), map.heights.max()];
        let (heights, as_read) = heights::in_cell(path, map.heights, self.cell)?;
        let grid = heights.grid();
        let (nx, ny) = (grid.nx(), grid.ny());
        if let Some(expected) = expected.filter(|expected| (expected.nx(), expected.ny()) != (nx, ny)) {
            let message = format_args!("the map has {grid} elements, grid says {expected}; omit grid");
            return Err(CliError::in_file(path, message));
        }
        if range[1] <= range[0] && !self.may_be_flat {
            let message = format_args!("all heights are {:e}; a flat surface has no contact problem", range[1]);
            return Err(CliError::in_file(path, message));
        }
        let spec = GridSpec { nx, ny };
        // The map in a result folder is an array in metres.
        let keys = SurfaceKeys {
            heights: Some(HEIGHTS_FILE.into()),
            unit: None,
            height_scale: None,
            channel: None,
            layout: None,
            grid: Some(spec),
            ..self.keys.clone()
        };
        let shape = Shape::Map { heights: Arc::new(heights), as_read };
        Ok(LoadedSurface { shape, grid, keys })
    }
}

impl Shape {
    /// The sum of waves that the surface is, or the map.
    fn waves_or_map(&self) -> Result<&Surface, &Field> {
        match self {
            Self::Random(surface) => Ok(surface),
            Self::Waves(file) => Ok(file.surface()),
            Self::Map { heights, .. } => Err(heights),
        }
    }
}

impl LoadedSurface {
    /// Heights on the finest grid, in λ; those of a sum of waves are evaluated for it, 8 bytes each.
    ///
    /// # Errors
    /// [`CliError::Input`] when the grid is too coarse for the waves.
    pub fn heights(&self) -> Result<Cow<'_, Field>, CliError> {
        match self.shape.waves_or_map() {
            Ok(waves) => {
                let sampled = waves.sample_on(self.grid);
                sampled.map(Cow::Owned).map_err(|cause| CliError::input(format_args!("grid: {cause}")))
            }
            Err(map) => Ok(Cow::Borrowed(map)),
        }
    }

    /// The heights of a contact problem on the finest grid; those of a sum of waves are not evaluated yet.
    #[must_use]
    pub fn source(&self) -> HeightSource<'static> {
        match &self.shape {
            Shape::Random(surface) => HeightSource::shared(Arc::<Surface>::clone(surface), self.grid),
            Shape::Waves(file) => HeightSource::shared(Arc::<Surface>::clone(file.surface()), self.grid),
            Shape::Map { heights, .. } => Arc::clone(heights).into(),
        }
    }

    /// rms height (λ) and rms slope: exact ones of a sum of waves, those of its grid for a height map, which meets
    /// itself across its borders unless they are free.
    #[must_use]
    pub fn height_and_slope(&self, boundary: Boundary) -> [f64; 2] {
        match self.shape.waves_or_map() {
            Ok(waves) => {
                let Moments { rms_height, rms_slope, .. } = waves.moments();
                [rms_height, rms_slope]
            }
            Err(map) if boundary == Boundary::Free => height_and_slope_of_patch(map),
            Err(map) => height_and_slope_of_grid(map),
        }
    }

    /// Moments, in λ: exact ones of a sum of waves, those of its grid for a height map.
    #[must_use]
    pub fn moments(&self) -> Moments {
        match self.shape.waves_or_map() {
            Ok(waves) => waves.moments(),
            Err(map) => moments_of_grid(map),
        }
    }

    /// The map that the heights are read from, if they are: in λ, and what makes them metres as in the file.
    #[must_use]
    pub fn map(&self) -> Option<(&Field, &AsRead)> {
        match &self.shape {
            Shape::Map { heights, as_read } => Some((heights, as_read)),
            Shape::Random(_) | Shape::Waves(_) => None,
        }
    }

    /// The file that has the waves of the surface, if one has.
    #[must_use]
    pub fn wave_file(&self) -> Option<&Arc<WaveFile>> {
        match &self.shape {
            Shape::Waves(file) => Some(file),
            Shape::Random(_) | Shape::Map { .. } => None,
        }
    }
}
