//! The rough surface of a scene, generated or read from a file.
//!
//! Its heights on a grid are evaluated only where a method needs them.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use rc_core::quantity::digits;
use rc_core::{Boundary, Field, Grid, PeriodicCell};
use rc_fractal::{Amplitudes, Moments, SpectrumParams, Surface};
use rc_heights::{HeightMap, ReadParams, Scales};

use super::form::{Form, FormedSurface};
use super::heights::{self, CellOfMap};
use super::keys::SurfaceKeys;
use super::like::{self, Reference};
use super::loaded::{LoadedSurface, Shape, sampled};
use super::origin;
use super::other_body::OtherBody;
use super::psd_file::PsdFile;
use super::values::{GridSpec, HeightsLike};
use super::wave_file::WaveFile;
use crate::error::CliError;
use crate::files::names::HEIGHTS_FILE;
use crate::warnings;
use rc_sweep::Warning;
use rc_sweep::memory::Budget;

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
    /// The map of a twin, likewise.
    pub(crate) reference: Arc<Mutex<Option<Reference>>>,
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
    /// A twin of a height map.
    Twin {
        /// The map, or a folder with one.
        like: PathBuf,
        /// The keys that say how the map is read.
        of_map: Box<SurfaceKeys>,
        /// Height distribution of the twin.
        heights: HeightsLike,
        /// Seed of the twin.
        seed: u64,
        /// Its grid.
        grid: Grid,
    },
    /// A realisation of a tabulated spectrum.
    Spectrum {
        /// The file of the table, or of the profile that it is from.
        path: PathBuf,
        /// The table.
        table: Arc<PsdFile>,
        /// Amplitudes of the waves.
        amplitudes: Amplitudes,
        /// Seed of the realisation.
        seed: u64,
        /// The finest grid.
        grid: Grid,
    },
    /// A shape alone.
    Shape {
        /// The finest grid.
        grid: Grid,
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
            _ if self.line => self.cell_of_profile(sides.map(|[length, _]| length))?,
            Some(sides) => CellOfMap::of_sides(Path::new("heights"), sides, [self.cell, self.cell_y], points)?,
            None => CellOfMap::default().of_points(self.cell, self.cell_y, points),
        };
        Ok((Self { heights: Some(HEIGHTS_FILE.into()), cell, cell_y, ..self }, assumed))
    }

    /// The cell of a profile of this `length` (m), or of that in the keys.
    fn cell_of_profile(&self, length: Option<f64>) -> Result<CellOfMap, CliError> {
        let side = self.cell.or(length);
        match (side, length) {
            (Some(side), Some(length)) if !heights::same(side, length) => Err(CliError::input(format_args!(
                "cell: the profile is {length} m long, but cell says {side} m; omit cell"
            ))),
            _ => Ok(CellOfMap { cell: side, cell_y: side, assumed: Vec::new() }),
        }
    }
}

impl SurfaceSetup {
    /// A surface that is not flat, about which nothing was assumed.
    pub(crate) fn new(cell: PeriodicCell, source: Source, keys: SurfaceKeys) -> Self {
        Self {
            cell,
            source,
            form: None,
            may_be_flat: false,
            keys,
            assumed: Vec::new(),
            held: Arc::default(),
            reference: Arc::default(),
        }
    }

    /// The setup without the map that was read for its size, for programs with many maps.
    pub(crate) fn without_map(mut self) -> Self {
        self.held = Arc::default();
        self.reference = Arc::default();
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
            Source::Random { grid, .. }
            | Source::Waves { grid, .. }
            | Source::Spectrum { grid, .. }
            | Source::Twin { grid, .. }
            | Source::Shape { grid } => grid.len() as f64,
            // A useful map has at least two bytes per height.
            Source::File { path, .. } => path.metadata().map_or(0.0, |file| file.len() as f64 / 2.0),
        }
    }

    /// Reads the map or generates the random surface.
    ///
    /// Heights of a sum of waves are not evaluated yet. Those that are evaluated must fit into the memory of the machine.
    ///
    /// # Errors
    /// [`CliError::Input`] when the file is not a height map, is on another grid than the scene says, or is flat, and
    /// when the heights do not fit.
    pub fn load(&self) -> Result<LoadedSurface, CliError> {
        self.load_within(Budget::new(None))
    }

    /// As [`SurfaceSetup::load`], with the memory of `budget`.
    ///
    /// # Errors
    /// As [`SurfaceSetup::load`].
    pub(crate) fn load_within(&self, budget: Budget) -> Result<LoadedSurface, CliError> {
        if let Some((what, grid)) = self.evaluated() {
            budget.check_grid(what, grid)?;
        }
        let mut surface = self.read_or_made()?;
        surface.origin = origin::with_added(surface.origin, &self.keys);
        Ok(surface)
    }

    /// The surface with what is added to it, which its origin does not tell yet.
    fn read_or_made(&self) -> Result<LoadedSurface, CliError> {
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
                let surface = Arc::new(Surface::new(spectrum).map_err(CliError::input)?);
                self.generated(Some((surface, None)), *grid)
            }
            Source::Waves { waves, grid, .. } => {
                self.generated(Some((Arc::clone(waves.surface()), Some(Arc::clone(waves)))), *grid)
            }
            Source::Twin { like, of_map, heights, seed, grid } => {
                let held = self.reference.lock().unwrap_or_else(PoisonError::into_inner).take();
                let reference = held.map_or_else(|| Reference::read(like, of_map), Ok)?;
                let tilted = warnings::surface::tilted(&reference.map);
                let twin = reference.twin((*grid, self.cell.sides()), *seed, *heights)?;
                let mut surface = self.of_map(like, twin, None)?;
                surface.warnings.extend(tilted);
                surface.notes.push(like::note(like, *seed, *heights));
                let mut origin = origin::of(&like::file_of(like), of_map.channel.as_deref());
                origin.treatments.push(format!("twin, seed {seed}"));
                surface.origin = Some(origin);
                Ok(surface)
            }
            Source::Spectrum { path, table, amplitudes, seed, grid } => {
                let waves = Arc::new(table.realisation(*amplitudes, *seed)?);
                let mut surface = self.generated(Some((Arc::clone(waves.surface()), Some(waves))), *grid)?;
                let channel = self.keys.channel.as_deref();
                surface.origin = Some(origin::of_spectrum(path, channel, (*seed, self.keys.like.is_some())));
                Ok(surface)
            }
            Source::Shape { grid } => self.generated(None, *grid),
        }
    }

    /// What has heights on a whole grid once it is loaded, and that grid. That of a file is its own.
    fn evaluated(&self) -> Option<(&'static str, Grid)> {
        match &self.source {
            Source::Twin { grid, .. } => Some(("the twin", *grid)),
            Source::File { .. } => None,
            Source::Random { grid, .. }
            | Source::Waves { grid, .. }
            | Source::Spectrum { grid, .. }
            | Source::Shape { grid } => self.keys.add.as_ref().map(|_| ("the sum of both bodies", *grid)),
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
        let keys = self.keys.clone();
        let keys = file.as_ref().map_or(keys.clone(), |file| file.keys(keys));
        let base = waves.map(|(surface, _)| surface);
        let mut warnings: Vec<_> = warnings::surface::assumed(&self.assumed).into_iter().collect();
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
        Ok(LoadedSurface { shape, grid, keys, warnings, notes, origin: None, form, of_map: Default::default() })
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
            warnings.extend(warnings::surface::of_file(path, &map));
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
        let SurfaceKeys { cell, cell_y, line, read_limit, .. } = self.keys;
        let (path, spec) = (Some(HEIGHTS_FILE.into()), Some(GridSpec { nx, ny }));
        let keys = SurfaceKeys { heights: path, cell, cell_y, line, grid: spec, read_limit, ..SurfaceKeys::default() };
        let shape = Shape::Map { heights: Arc::new(heights), as_read };
        let form = self.form;
        Ok(LoadedSurface { shape, grid, keys, warnings, notes, origin: None, form, of_map: Default::default() })
    }

    /// Adds shape and other body to the `heights` (m) of a map, and returns the doubts about the parts.
    fn add_to(&self, heights: &mut Field) -> Result<Vec<Warning>, CliError> {
        let mut doubts = Vec::new();
        if let Some(form) = self.form {
            if matches!(self.source, Source::File { .. } | Source::Twin { .. }) {
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
