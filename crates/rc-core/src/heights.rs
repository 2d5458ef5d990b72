//! Rough surfaces, and the heights of a contact problem.

use std::borrow::Cow;
use std::sync::Arc;

use crate::{DVec2, Field, Grid};

/// A rough surface, periodic on the square cell of side 1.
///
/// Implementations are, for example, a realised spectrum, a measured map and a sphere. A surface on a rectangular cell
/// is a [`Field`] instead, for example from [`Field::from_fn`]. [`crate::testing::check_height_field`] checks the
/// contract.
pub trait HeightField: Sync {
    /// Height at the point `at`, both in λ. Periodic with period 1 along x and along y.
    fn height(&self, at: DVec2) -> f64;

    /// Largest component of a wave vector, or `None` for a surface without a band limit.
    ///
    /// Its unit is waves per cell. No wave of the surface has |kx| or |ky| above this limit.
    fn band_limit(&self) -> Option<usize>;

    /// Heights at the element centres of `grid`, in λ.
    ///
    /// Samples equal [`HeightField::height`] up to rounding. The surface has period 1 along y, so samples on a
    /// rectangular cell are not periodic. Implementations that have a fast transform override this method.
    fn sample(&self, grid: Grid) -> Field {
        Field::from_fn(grid, |at| self.height(at))
    }

    /// The heights of a contact problem: this surface on `grid`. Nothing is evaluated yet.
    fn on(&self, grid: Grid) -> HeightSource<'_>
    where
        Self: Sized,
    {
        HeightSource::Surface { surface: self, grid }
    }
}

/// The heights of a contact problem on its grid.
///
/// A solver evaluates a surface only where it needs heights. For the adaptive method this is a small part of the grid.
/// A map is used as it is.
///
/// [`HeightField::on`] and `From<&Field>` make sources that borrow. [`HeightSource::shared`] and `From<Arc<Field>>`
/// make sources without a lifetime.
#[derive(Clone)]
pub enum HeightSource<'a> {
    /// A surface, evaluated at the centres of elements.
    Surface {
        /// The surface.
        surface: &'a dyn HeightField,
        /// The grid on which the heights are wanted.
        grid: Grid,
    },
    /// Heights (in λ) at the centres of all elements.
    Map(&'a Field),
    /// A surface with several owners.
    SharedSurface {
        /// The surface.
        surface: Arc<dyn HeightField + Send + Sync>,
        /// The grid on which the heights are wanted.
        grid: Grid,
    },
    /// A map with several owners.
    SharedMap(Arc<Field>),
}

impl HeightSource<'static> {
    /// The heights on `grid` of a surface that has several owners. Nothing is evaluated yet.
    #[must_use]
    pub fn shared(surface: Arc<dyn HeightField + Send + Sync>, grid: Grid) -> Self {
        Self::SharedSurface { surface, grid }
    }
}

impl HeightSource<'_> {
    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        match self {
            Self::Surface { grid, .. } | Self::SharedSurface { grid, .. } => *grid,
            Self::Map(map) => map.grid(),
            Self::SharedMap(map) => map.grid(),
        }
    }

    /// The surface, or `None` when the heights are a map.
    #[must_use]
    pub fn surface(&self) -> Option<&dyn HeightField> {
        match self {
            Self::Surface { surface, .. } => Some(*surface),
            Self::SharedSurface { surface, .. } => Some(surface.as_ref()),
            Self::Map(_) | Self::SharedMap(_) => None,
        }
    }

    /// The map, or `None` when the heights come from a surface.
    #[must_use]
    pub fn map(&self) -> Option<&Field> {
        match self {
            Self::Map(map) => Some(map),
            Self::SharedMap(map) => Some(map.as_ref()),
            Self::Surface { .. } | Self::SharedSurface { .. } => None,
        }
    }

    /// The same surface on another grid. A map stays as it is.
    #[must_use]
    pub fn on_grid(self, grid: Grid) -> Self {
        match self {
            Self::Surface { surface, .. } => Self::Surface { surface, grid },
            Self::SharedSurface { surface, .. } => Self::SharedSurface { surface, grid },
            map => map,
        }
    }

    /// Heights (in λ) on the whole grid. A surface is evaluated by this call.
    #[must_use]
    pub fn heights(&self) -> Cow<'_, Field> {
        match self {
            Self::Surface { surface, grid } => Cow::Owned(surface.sample(*grid)),
            Self::SharedSurface { surface, grid } => Cow::Owned(surface.sample(*grid)),
            Self::Map(map) => Cow::Borrowed(map),
            Self::SharedMap(map) => Cow::Borrowed(map),
        }
    }

    /// Number of elements per shortest wave. `None` for maps and for surfaces without a band limit.
    ///
    /// Elements are counted along the side of the grid that has fewer of them.
    #[must_use]
    pub fn elements_per_wave(&self) -> Option<f64> {
        let waves = self.surface()?.band_limit().filter(|&waves| waves > 0)?;
        let grid = self.grid();
        Some(grid.nx().min(grid.ny()) as f64 / waves as f64)
    }
}

impl<'a> From<&'a Field> for HeightSource<'a> {
    fn from(map: &'a Field) -> Self {
        Self::Map(map)
    }
}

impl From<Arc<Field>> for HeightSource<'static> {
    fn from(map: Arc<Field>) -> Self {
        Self::SharedMap(map)
    }
}

impl std::fmt::Debug for HeightSource<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.surface() {
            Some(surface) => {
                write!(f, "surface with band limit {:?} on {} elements", surface.band_limit(), self.grid())
            }
            None => write!(f, "map of {} elements", self.grid()),
        }
    }
}
