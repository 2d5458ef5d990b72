//! The rough surface of a scene, generated or read from a file.
//!
//! Its heights on a grid are evaluated only where a method needs them.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use rc_core::quantity::digits;
use rc_core::{Boundary, Field, Grid, HeightField as _, HeightSource, PeriodicCell};
use rc_fractal::{
    Moments, SpectrumParams, Surface, height_and_slope_of_grid, height_and_slope_of_patch, moments_of_grid,
};
use rc_heights::{HeightMap, ReadParams, Scales};

use super::as_read::AsRead;
use super::form::{Form, FormedSurface};
use super::heights::{self, CellOfMap};
use super::keys::SurfaceKeys;
use super::other_body::OtherBody;
use super::values::GridSpec;
use super::wave_file::{WAVES_FILE, WaveFile};
use crate::error::CliError;
use crate::files::names::HEIGHTS_FILE;
use crate::warnings;
use rc_sweep::Warning;

/// Elements per side from which statistics of a shape are exact enough.
const ELEMENTS_OF_STATISTICS: usize = 512;

/// A checked surface, before it is generated or read.
#[derive(Clone, Debug)]
pub struct SurfaceSetup {
    /// Sides of the cell (m).
    pub cell: PeriodicCell,
    /// Origin of the heights.
    pub source: Source,
    /// A shape that is added to the heights, or is the surface.
    pub form: Option<Form>,
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
    /// A shape alone.
    Shape {
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
    /// The shape that is added to the heights, or is the surface.
    pub(crate) form: Option<Form>,
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
    /// A shape alone or on waves, which has heights anywhere.
    Formed {
        /// The surface.
        surface: Arc<FormedSurface>,
        /// The file of its waves, if they are from one.
        file: Option<Arc<WaveFile>>,
    },
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
        Self { cell, source, form: None, may_be_flat: false, keys, assumed: Vec::new(), held: Arc::default() }
    }

    /// The setup without the map that was read for its size, for programs with many maps.
    pub(crate) fn without_map(mut self) -> Self {
        self.held = Arc::default();
        self
    }

    /// The surface with this boundary.
    ///
    /// # Errors
    /// [`CliError::Input`] for a shape that has no contact problem in a periodic cell.
    pub(crate) fn bounded(self, boundary: Boundary) -> Result<Self, CliError> {
        let is_patch = boundary == Boundary::Free;
        let is_shape = matches!(self.source, Source::Shape { .. }) && self.keys.add.is_none();
        match self.form {
            Some(Form::Flat) if is_shape && !is_patch => Err(CliError::input(
                "shape: a flat surface in a periodic cell has no contact problem; give --boundary free",
            )),
            Some(Form::Wave { waves, .. }) if waves.fract() != 0.0 && !is_patch => Err(CliError::input(format_args!(
                "wavelength: {} waves in the cell do not repeat; give a whole part of the cell, or --boundary free",
                digits(waves, 6)
            ))),
            _ => Ok(Self { may_be_flat: is_patch, ..self }),
        }
    }

    /// Whether the heights are a sum, and not those of a file or a program alone.
    #[must_use]
    pub fn is_sum(&self) -> bool {
        self.form.is_some() || self.keys.add.is_some()
    }

    /// Number of elements of the finest grid.
    ///
    /// For a height map it is an upper bound from the length of its file.
    #[must_use]
    pub fn max_elements(&self) -> f64 {
        match &self.source {
            Source::Random { grid, .. } | Source::Waves { grid, .. } | Source::Shape { grid } => grid.len() as f64,
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
                Ok(surface)
            }
            Source::Random { spectrum, grid } => {
                let surface = Arc::new(Surface::new(spectrum).map_err(CliError::input)?);
                self.generated(Some((surface, None)), *grid)
            }
            Source::Waves { waves, grid, .. } => {
                self.generated(Some((Arc::clone(waves.surface()), Some(Arc::clone(waves)))), *grid)
            }
            Source::Shape { grid } => self.generated(None, *grid),
        }
    }

    /// A surface of waves, from a file or not, with what is added to it.
    fn generated(
        &self,
        waves: Option<(Arc<Surface>, Option<Arc<WaveFile>>)>,
        grid: Grid,
    ) -> Result<LoadedSurface, CliError> {
        if self.keys.add.is_some() {
            let sampled = waves.map_or_else(|| Ok(Field::zeros(grid)), |(surface, _)| sampled(&surface, grid))?;
            let mut heights = sampled;
            heights.values_mut().iter_mut().for_each(|height| *height *= self.cell.side());
            return self.of_map(Path::new("add"), HeightMap::bare(heights), None);
        }
        let file = waves.as_ref().and_then(|(_, file)| file.clone());
        let keys = match &file {
            Some(_) => SurfaceKeys { spectrum: Some(WAVES_FILE.into()), ..self.keys.clone() },
            None => self.keys.clone(),
        };
        let base = waves.map(|(surface, _)| surface);
        let mut warnings = Vec::new();
        if let (Some(_), Some(base)) = (self.form, &base) {
            let Moments { rms_height, rms_slope, .. } = base.moments();
            let shape = warnings::surface::Shape::of_waves(rms_height * self.cell.side(), rms_slope, self.cell.sides());
            warnings.extend(shape.warnings());
        }
        let shape = match (self.form, base, file) {
            (None, Some(_), Some(file)) => Shape::Waves(file),
            (None, Some(surface), None) => Shape::Random(surface),
            (form, base, file) => {
                let form = form.unwrap_or(Form::Flat);
                Shape::Formed { surface: Arc::new(FormedSurface { base, form }), file }
            }
        };
        let (form, notes) = (self.form, Vec::new());
        Ok(LoadedSurface { shape, grid, keys, warnings, notes, form, of_map: Default::default() })
    }

    /// A map in metres, read from `path`, as a surface in this cell.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are missing, when the map is flat, or when its grid or size differs from the
    /// scene's.
    pub fn of_map(&self, path: &Path, map: HeightMap, expected: Option<Grid>) -> Result<LoadedSurface, CliError> {
        CellOfMap::of(path, &map, [Some(self.cell.side()), self.keys.cell_y])?;
        heights::check_heights(path, &map.heights, &self.keys.read_params())?;
        let mut warnings = Vec::new();
        if matches!(self.source, Source::File { .. }) {
            warnings.extend(warnings::surface::of_map(&map));
        }
        warnings.extend(warnings::surface::assumed(&self.assumed));
        let notes = map.notes.iter().filter(|note| !note.is_assumption()).map(ToString::to_string).collect();
        let (nx, ny) = (map.heights.grid().nx(), map.heights.grid().ny());
        if let Some(expected) = expected.filter(|expected| (expected.nx(), expected.ny()) != (nx, ny)) {
            let message =
                format_args!("the map has {} elements, but grid says {expected}; omit grid", map.heights.grid());
            return Err(CliError::in_file(path, message));
        }
        let mut map = heights::in_cell(path, map.heights, self.cell)?;
        warnings.extend(self.add_to(&mut map)?);
        let range = [map.min(), map.max()];
        if range[1] <= range[0] && !self.may_be_flat {
            let message = format_args!(
                "all heights are {}; a flat surface in a periodic cell has no contact problem",
                digits(range[1], 6)
            );
            return Err(CliError::in_file(path, message));
        }
        let grid = map.grid();
        let (heights, as_read) = heights::divided(map, self.cell.side());
        // In a result folder the map is an array in metres, and a sum is a map.
        let SurfaceKeys { cell, cell_y, read_limit, .. } = self.keys;
        let (path, spec) = (Some(HEIGHTS_FILE.into()), Some(GridSpec { nx, ny }));
        let keys = SurfaceKeys { heights: path, cell, cell_y, grid: spec, read_limit, ..SurfaceKeys::default() };
        let shape = Shape::Map { heights: Arc::new(heights), as_read };
        let form = self.form;
        Ok(LoadedSurface { shape, grid, keys, warnings, notes, form, of_map: Default::default() })
    }

    /// Adds shape and other body to the `heights` (m) of a map, and returns the doubts about the parts.
    fn add_to(&self, heights: &mut Field) -> Result<Vec<Warning>, CliError> {
        let mut doubts = Vec::new();
        if let Some(form) = self.form {
            if matches!(self.source, Source::File { .. }) {
                doubts = warnings::surface::Shape::of_heights(heights, self.cell).warnings();
            }
            let grid = heights.grid();
            form.add_to(heights.values_mut(), grid, self.cell.side());
        }
        if let Some(other) = &self.keys.add {
            let read = OtherBody::read(other, &self.keys, self.cell)?;
            doubts.extend(read.add_mirrored(heights)?);
        }
        Ok(doubts)
    }
}

/// The heights (λ) of waves on a grid that resolves them.
fn sampled(waves: &Surface, grid: Grid) -> Result<Field, CliError> {
    waves.sample_on(grid).map_err(|cause| CliError::input(format_args!("grid: {cause}")))
}

impl Shape {
    /// The sum of waves of the surface; `None` if it is not one.
    fn waves(&self) -> Option<&Surface> {
        match self {
            Self::Random(surface) => Some(surface),
            Self::Waves(file) => Some(file.surface()),
            Self::Formed { .. } | Self::Map { .. } => None,
        }
    }

    /// The heights in λ on `grid`, which is that of a map.
    fn on(&self, grid: Grid) -> Result<Cow<'_, Field>, CliError> {
        match self {
            Self::Random(surface) => sampled(surface, grid).map(Cow::Owned),
            Self::Waves(file) => sampled(file.surface(), grid).map(Cow::Owned),
            Self::Formed { surface, .. } => {
                surface.base.as_ref().map_or(Ok(()), |base| sampled(base, grid).map(drop))?;
                Ok(Cow::Owned(surface.sample(grid)))
            }
            Self::Map { heights, .. } => Ok(Cow::Borrowed(heights)),
        }
    }
}

impl LoadedSurface {
    /// Heights on the finest grid, in λ.
    ///
    /// Those of a sum of waves are evaluated now, with 8 bytes each.
    ///
    /// # Errors
    /// [`CliError::Input`] when the grid is too coarse for the waves.
    pub fn heights(&self) -> Result<Cow<'_, Field>, CliError> {
        self.shape.on(self.grid)
    }

    /// The heights of a contact problem on the finest grid.
    ///
    /// Those of a sum of waves are not evaluated yet.
    #[must_use]
    pub fn source(&self) -> HeightSource<'static> {
        match &self.shape {
            Shape::Random(surface) => HeightSource::shared(Arc::<Surface>::clone(surface), self.grid),
            Shape::Waves(file) => HeightSource::shared(Arc::<Surface>::clone(file.surface()), self.grid),
            Shape::Formed { surface, .. } => HeightSource::shared(Arc::<FormedSurface>::clone(surface), self.grid),
            Shape::Map { heights, .. } => Arc::clone(heights).into(),
        }
    }

    /// Rms height (λ) and rms slope.
    ///
    /// For a sum of waves they are exact. For another surface they are those of a grid, which continues across its
    /// borders unless the borders are free.
    #[must_use]
    pub fn height_and_slope(&self, boundary: Boundary) -> [f64; 2] {
        if let Some(waves) = self.shape.waves() {
            let Moments { rms_height, rms_slope, .. } = waves.moments();
            return [rms_height, rms_slope];
        }
        let of = |statistics: fn(&Field) -> [f64; 2]| {
            self.shape.on(self.grid_of_statistics()).map_or([f64::NAN; 2], |h| statistics(&h))
        };
        match boundary {
            Boundary::Free => *self.of_map[1].get_or_init(|| of(height_and_slope_of_patch)),
            Boundary::Periodic => *self.of_map[0].get_or_init(|| of(height_and_slope_of_grid)),
        }
    }

    /// A grid that is fine enough for the statistics of the surface.
    fn grid_of_statistics(&self) -> Grid {
        let Shape::Formed { surface, .. } = &self.shape else { return self.grid };
        let enough = ELEMENTS_OF_STATISTICS.max(4 * surface.base.as_ref().map_or(0, |base| base.waves()));
        let sides = [self.grid.nx(), self.grid.ny()].map(|side| side.min(enough));
        self.grid.with_elements(sides[0], sides[1]).unwrap_or(self.grid)
    }

    /// Moments in units of λ.
    ///
    /// They are exact for a sum of waves. For another surface they are those of its `heights`.
    #[must_use]
    pub fn moments(&self, heights: &Field) -> Moments {
        self.shape.waves().map_or_else(|| moments_of_grid(heights), Surface::moments)
    }

    /// The map from which the heights are read; `None` for a sum of waves.
    ///
    /// The heights are in λ. The other part restores the heights of the file in metres.
    #[must_use]
    pub fn map(&self) -> Option<(&Field, &AsRead)> {
        match &self.shape {
            Shape::Map { heights, as_read } => Some((heights, as_read)),
            Shape::Random(_) | Shape::Waves(_) | Shape::Formed { .. } => None,
        }
    }

    /// The map of [`LoadedSurface::map`], as its owner.
    #[must_use]
    pub fn shared_map(&self) -> Option<(Arc<Field>, AsRead)> {
        match &self.shape {
            Shape::Map { heights, as_read } => Some((Arc::clone(heights), as_read.clone())),
            Shape::Random(_) | Shape::Waves(_) | Shape::Formed { .. } => None,
        }
    }

    /// The file that has the waves of the surface; `None` for other surfaces.
    #[must_use]
    pub fn wave_file(&self) -> Option<&Arc<WaveFile>> {
        match &self.shape {
            Shape::Waves(file) => Some(file),
            Shape::Formed { file, .. } => file.as_ref(),
            Shape::Random(_) | Shape::Map { .. } => None,
        }
    }
}
