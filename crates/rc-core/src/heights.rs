//! Rough surfaces, and the heights of a contact problem that come from them.

use std::borrow::Cow;

use crate::{DVec2, Field, Grid};

/// A rough surface, periodic on the square cell of side 1.
///
/// Implementations: a realised spectrum, a measured map, a sphere. [`crate::testing::check_height_field`]
/// checks the contract.
pub trait HeightField: Sync {
    /// Height at the point `at`, both in λ; periodic with period 1 along x and along y.
    fn height(&self, at: DVec2) -> f64;

    /// The largest wavenumber (waves per cell) in any direction, or `None` when the surface is not band-limited.
    fn band_limit(&self) -> Option<usize>;

    /// Heights at the element centres of `grid`. Equal to [`HeightField::height`] there up to rounding, so they are periodic on a square
    /// cell only; implementations that have a fast transform override it.
    fn sample(&self, grid: Grid) -> Field {
        Field::from_fn(grid, |at| self.height(at))
    }

    /// The surface as the heights of a contact problem on `grid`. Nothing is evaluated yet.
    fn on(&self, grid: Grid) -> HeightSource<'_>
    where
        Self: Sized,
    {
        HeightSource::Surface { surface: self, grid }
    }
}

/// The heights of a contact problem on its grid.
///
/// A surface is evaluated where a solver needs it, which is a small part of the grid for the adaptive method. A map is used as it is.
/// [`HeightField::on`] makes the first kind, `From<&Field>` the second.
#[derive(Clone, Copy)]
pub enum HeightSource<'a> {
    /// A surface, evaluated at the centres of elements.
    Surface {
        /// The surface.
        surface: &'a dyn HeightField,
        /// The grid it is wanted on.
        grid: Grid,
    },
    /// Heights (in λ) at the centres of all elements.
    Map(&'a Field),
}

impl<'a> HeightSource<'a> {
    /// The grid.
    #[must_use]
    pub fn grid(&self) -> Grid {
        match self {
            Self::Surface { grid, .. } => *grid,
            Self::Map(map) => map.grid(),
        }
    }

    /// Heights (in λ) on the whole grid: those of the map, or those of the surface, evaluated now.
    #[must_use]
    pub fn heights(&self) -> Cow<'a, Field> {
        match self {
            Self::Surface { surface, grid } => Cow::Owned(surface.sample(*grid)),
            Self::Map(map) => Cow::Borrowed(map),
        }
    }

    /// Elements along the shorter side of the grid for the shortest wave; `None` where the shortest wave is not known.
    #[must_use]
    pub fn elements_per_wave(&self) -> Option<f64> {
        match self {
            Self::Surface { surface, grid } => {
                let waves = surface.band_limit().filter(|&waves| waves > 0)?;
                Some(grid.nx().min(grid.ny()) as f64 / waves as f64)
            }
            Self::Map(_) => None,
        }
    }
}

impl<'a> From<&'a Field> for HeightSource<'a> {
    fn from(map: &'a Field) -> Self {
        Self::Map(map)
    }
}

impl std::fmt::Debug for HeightSource<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Surface { surface, grid } => {
                write!(f, "surface with band limit {:?} on {grid} elements", surface.band_limit())
            }
            Self::Map(map) => write!(f, "map of {} elements", map.grid()),
        }
    }
}
