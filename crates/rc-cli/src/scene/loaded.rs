//! A surface whose heights can be evaluated, generated or read from a file.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use rc_core::{Boundary, Field, Grid, HeightField as _, HeightSource};
use rc_fractal::{Moments, Surface, height_and_slope_of_grid, height_and_slope_of_patch, moments_of_grid};
use rc_heights::Bicubic;
use rc_sweep::{MapOrigin, Warning};

use super::as_read::AsRead;
use super::form::{Form, FormedSurface};
use super::keys::SurfaceKeys;
use super::wave_file::WaveFile;
use crate::error::CliError;

/// Elements per side from which statistics of a shape are exact enough.
const ELEMENTS_OF_STATISTICS: usize = 512;

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
    /// The shape that is added to the heights, or is the surface.
    pub(crate) form: Option<Form>,
    /// rms height (λ) and rms slope of a map, with periodic and with free borders, after their first use.
    pub(super) of_map: [OnceLock<[f64; 2]>; 2],
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

/// The heights (λ) of waves on a grid that resolves them.
pub(super) fn sampled(waves: &Surface, grid: Grid) -> Result<Field, CliError> {
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

    /// The heights of a contact problem on the finest grid, whose borders are divided `border_level` times.
    ///
    /// Those of a sum of waves are not evaluated yet. Heights between the points of a square map are bicubic.
    #[must_use]
    pub fn source(&self, border_level: usize, boundary: Boundary) -> HeightSource<'static> {
        if let (Shape::Map { heights, .. }, 1..) = (&self.shape, border_level)
            && let Some(surface) = Bicubic::new(Arc::clone(heights), boundary)
        {
            return HeightSource::shared(Arc::new(surface), self.grid);
        }
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
