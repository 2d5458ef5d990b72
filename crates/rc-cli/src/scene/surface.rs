//! The rough surface of a scene, generated or read from a file.
//!
//! Its heights on a grid are evaluated only where a method needs them.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rc_core::quantity::digits;
use rc_core::{Boundary, Field, Grid, HeightSource, PeriodicCell};
use rc_fractal::{
    Moments, SpectrumParams, Surface, height_and_slope_of_grid, height_and_slope_of_patch, moments_of_grid,
};
use rc_heights::{HeightMap, ReadParams, Scales};

use super::as_read::AsRead;
use super::heights::{self, CellOfMap};
use super::keys::SurfaceKeys;
use super::origin;
use super::values::GridSpec;
use super::wave_file::{WAVES_FILE, WaveFile};
use crate::error::CliError;
use crate::files::names::HEIGHTS_FILE;
use crate::warnings;
use rc_sweep::{MapOrigin, Warning};

/// A checked surface, before it is generated or read.
#[derive(Clone, Debug)]
pub struct SurfaceSetup {
    /// Sides of the cell (m).
    pub cell: PeriodicCell,
    /// Origin of the heights.
    pub source: Source,
    /// Whether a map with equal heights is a surface. It is a flat punch with free borders.
    pub may_be_flat: bool,
    /// The resolved keys, for `scene.toml`.
    pub keys: SurfaceKeys,
    /// What was assumed about a map, one clause each.
    pub assumed: Vec<String>,
    /// The map of the file, which was read for its size. The first [`SurfaceSetup::load`] takes it.
    pub(crate) held: Arc<Mutex<Option<HeightMap>>>,
}

/// Origin of the heights.
#[derive(Clone, Debug)]
pub enum Source {
    /// A height map in a file.
    File {
        /// The file.
        path: PathBuf,
        /// Grid that the user expects of the map.
        expected: Option<Grid>,
        /// Channel and layout to read.
        params: ReadParams,
        /// Units that the user gives.
        scales: Scales,
    },
    /// A random surface.
    Random {
        /// Parameters of the surface, in units of λ.
        spectrum: SpectrumParams,
        /// The finest grid.
        grid: Grid,
    },
    /// A surface whose waves are in a file.
    Waves {
        /// The file.
        path: PathBuf,
        /// Content of the file.
        waves: Arc<WaveFile>,
        /// The finest grid.
        grid: Grid,
    },
}

/// A surface whose heights can be evaluated.
#[derive(Clone, Debug)]
pub struct LoadedSurface {
    /// The waves or the map.
    pub shape: Shape,
    /// The finest grid.
    pub grid: Grid,
    /// The resolved keys.
    ///
    /// They include the grid, and a height map has the name of a result folder.
    pub keys: SurfaceKeys,
    /// Doubts about the values of a map and what was assumed about it.
    pub warnings: Vec<Warning>,
    /// What the reader did, one line each.
    pub notes: Vec<String>,
    /// The file of a map that was read.
    pub origin: Option<MapOrigin>,
    /// rms height (λ) and rms slope of a map, with periodic and with free borders, after their first use.
    of_map: [OnceLock<[f64; 2]>; 2],
}

/// A surface as a sum of waves, or as a map.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A random surface, which has heights anywhere.
    Random(Arc<Surface>),
    /// A surface of the waves in a file, which has heights anywhere.
    Waves(Arc<WaveFile>),
    /// A height map.
    Map {
        /// Heights in λ.
        heights: Arc<Field>,
        /// Data that restore the heights of the file.
        as_read: AsRead,
    },
}

impl SurfaceKeys {
    /// The keys of a height map that a program holds.
    ///
    /// `sides` are those of its cell (m) if the program knows them, and `points` its numbers of points along x and y.
    /// The map has the name of a result folder. The second value is what was assumed.
    ///
    /// # Errors
    /// [`CliError::Input`] when keys of a random surface or of a file are given, or another size than that of the map.
    pub fn of_map(self, sides: Option<[f64; 2]>, points: [usize; 2]) -> Result<(Self, Vec<String>), CliError> {
        if self.heights.is_some() || self.generates() {
            let message =
                "heights defines the surface; omit the parameters of a random surface (waves, hurst, rms, ...)";
            return Err(CliError::input(message));
        }
        let CellOfMap { cell, cell_y, assumed } = match sides {
            Some(sides) => CellOfMap::of_sides(Path::new("heights"), sides, [self.cell, self.cell_y], points)?,
            None => CellOfMap::default().of_points(self.cell, self.cell_y, points),
        };
        Ok((Self { heights: Some(HEIGHTS_FILE.into()), cell, cell_y, ..self }, assumed))
    }
}

impl SurfaceSetup {
    /// A surface that is not flat, about which nothing was assumed.
    pub(crate) fn new(cell: PeriodicCell, source: Source, keys: SurfaceKeys) -> Self {
        Self { cell, source, may_be_flat: false, keys, assumed: Vec::new(), held: Arc::default() }
    }

    /// The setup without the map that was read for its size, for programs with many maps.
    pub(crate) fn without_map(mut self) -> Self {
        self.held = Arc::default();
        self
    }

    /// Number of elements of the finest grid.
    ///
    /// For a height map it is an upper bound from the length of its file.
    #[must_use]
    pub fn max_elements(&self) -> f64 {
        match &self.source {
            Source::Random { grid, .. } | Source::Waves { grid, .. } => grid.len() as f64,
            // A useful map has at least two bytes per height.
            Source::File { path, .. } => path.metadata().map_or(0.0, |file| file.len() as f64 / 2.0),
        }
    }

    /// Reads the map or generates the random surface.
    ///
    /// Heights of a sum of waves are not evaluated yet.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is not a height map, is on another grid than the scene says, or is flat.
    pub fn load(&self) -> Result<LoadedSurface, CliError> {
        match &self.source {
            Source::File { path, expected, params, scales } => {
                let held = self.held.lock().unwrap_or_else(PoisonError::into_inner).take();
                let map = held.map_or_else(|| heights::read(path, params, *scales), Ok)?;
                let mut surface = self.of_map(path, map, *expected)?;
                surface.warnings.extend(warnings::surface::of_record(path));
                surface.origin = Some(origin::of(path, params.channel.as_deref()));
                Ok(surface)
            }
            Source::Random { spectrum, grid } => {
                let surface = Surface::new(spectrum).map_err(CliError::input)?;
                Ok(LoadedSurface::of_waves(Shape::Random(Arc::new(surface)), *grid, self.keys.clone()))
            }
            Source::Waves { waves, grid, .. } => {
                let keys = SurfaceKeys { spectrum: Some(WAVES_FILE.into()), ..self.keys.clone() };
                Ok(LoadedSurface::of_waves(Shape::Waves(Arc::clone(waves)), *grid, keys))
            }
        }
    }

    /// A map in metres, read from `path`, as a surface in this cell.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are missing, when the map is flat, or when its grid or size differs from the
    /// scene's.
    pub fn of_map(&self, path: &Path, map: HeightMap, expected: Option<Grid>) -> Result<LoadedSurface, CliError> {
        CellOfMap::of(path, &map, [Some(self.cell.side()), self.keys.cell_y])?;
        heights::check_heights(path, &map.heights, &self.keys.read_params())?;
        let mut warnings = warnings::surface::of_map(&map);
        warnings.extend(warnings::surface::assumed(&self.assumed));
        let notes = map.notes.iter().filter(|note| !note.is_assumption()).map(ToString::to_string).collect();
        let range = [map.heights.min(), map.heights.max()];
        let (heights, as_read) = heights::in_cell(path, map.heights, self.cell)?;
        let grid = heights.grid();
        let (nx, ny) = (grid.nx(), grid.ny());
        if let Some(expected) = expected.filter(|expected| (expected.nx(), expected.ny()) != (nx, ny)) {
            let message = format_args!("the map has {grid} elements, but grid says {expected}; omit grid");
            return Err(CliError::in_file(path, message));
        }
        if range[1] <= range[0] && !self.may_be_flat {
            let message = format_args!(
                "all heights are {}; a flat surface in a periodic cell has no contact problem",
                digits(range[1], 6)
            );
            return Err(CliError::in_file(path, message));
        }
        let spec = GridSpec { nx, ny };
        // In a result folder the map is an array in metres.
        let keys = SurfaceKeys {
            heights: Some(HEIGHTS_FILE.into()),
            unit: None,
            height_unit: None,
            height_scale: None,
            missing: None,
            mask: None,
            channel: None,
            layout: None,
            grid: Some(spec),
            ..self.keys.clone()
        };
        let shape = Shape::Map { heights: Arc::new(heights), as_read };
        Ok(LoadedSurface { shape, grid, keys, warnings, notes, origin: None, of_map: Default::default() })
    }
}

impl Shape {
    /// The sum of waves of the surface, or the map as the error.
    fn waves_or_map(&self) -> Result<&Surface, &Field> {
        match self {
            Self::Random(surface) => Ok(surface),
            Self::Waves(file) => Ok(file.surface()),
            Self::Map { heights, .. } => Err(heights),
        }
    }
}

impl LoadedSurface {
    /// A surface of waves.
    fn of_waves(shape: Shape, grid: Grid, keys: SurfaceKeys) -> Self {
        Self { shape, grid, keys, warnings: Vec::new(), notes: Vec::new(), origin: None, of_map: Default::default() }
    }

    /// Heights on the finest grid, in λ.
    ///
    /// Those of a sum of waves are evaluated now, with 8 bytes each.
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

    /// The heights of a contact problem on the finest grid.
    ///
    /// Those of a sum of waves are not evaluated yet.
    #[must_use]
    pub fn source(&self) -> HeightSource<'static> {
        match &self.shape {
            Shape::Random(surface) => HeightSource::shared(Arc::<Surface>::clone(surface), self.grid),
            Shape::Waves(file) => HeightSource::shared(Arc::<Surface>::clone(file.surface()), self.grid),
            Shape::Map { heights, .. } => Arc::clone(heights).into(),
        }
    }

    /// Rms height (λ) and rms slope.
    ///
    /// For a sum of waves they are exact. For a height map they are those of its grid, which continues across its
    /// borders unless the borders are free.
    #[must_use]
    pub fn height_and_slope(&self, boundary: Boundary) -> [f64; 2] {
        match self.shape.waves_or_map() {
            Ok(waves) => {
                let Moments { rms_height, rms_slope, .. } = waves.moments();
                [rms_height, rms_slope]
            }
            Err(map) if boundary == Boundary::Free => *self.of_map[1].get_or_init(|| height_and_slope_of_patch(map)),
            Err(map) => *self.of_map[0].get_or_init(|| height_and_slope_of_grid(map)),
        }
    }

    /// Moments in units of λ.
    ///
    /// They are exact for a sum of waves, and those of the grid for a height map.
    #[must_use]
    pub fn moments(&self) -> Moments {
        match self.shape.waves_or_map() {
            Ok(waves) => waves.moments(),
            Err(map) => moments_of_grid(map),
        }
    }

    /// The map from which the heights are read; `None` for a sum of waves.
    ///
    /// The heights are in λ. The other part restores the heights of the file in metres.
    #[must_use]
    pub fn map(&self) -> Option<(&Field, &AsRead)> {
        match &self.shape {
            Shape::Map { heights, as_read } => Some((heights, as_read)),
            Shape::Random(_) | Shape::Waves(_) => None,
        }
    }

    /// The file that has the waves of the surface; `None` for other surfaces.
    #[must_use]
    pub fn wave_file(&self) -> Option<&Arc<WaveFile>> {
        match &self.shape {
            Shape::Waves(file) => Some(file),
            Shape::Random(_) | Shape::Map { .. } => None,
        }
    }
}
