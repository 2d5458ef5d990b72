//! Types that all crates share, and traits for your own surfaces, kernels and operators.
//!
//! # Conventions of all crates of this workspace
//!
//! - **Units.** Libraries compute in `f64` with cell side λ = 1 and E* = E/(1-ν²) = 1. On a rectangular cell, λ is the
//!   side along x. Lengths are multiples of λ, pressures multiples of E*. SI units occur only at the outer interfaces,
//!   for example in `rc-cli`. [`Units`] converts.
//! - **Signs.** Pressure p ≥ 0 is compression. h is the height of the rigid surface, positive towards the half-space.
//!   Gap g ≥ 0. The displacement v of the surface of a half-space has zero mean over the periodic cell. The gap is `g =
//!   v - (h - h_max + Δ)`, with maximum height h_max and penetration Δ.
//! - **Points**, offsets and wave vectors in floating point are [`DVec2`] of `glam`.
//! - **Layout.** Fields are row-major, `index = iy * nx + ix`. The origin of the cell is its corner. Point (ix, iy) is
//!   the **centre** of its element, ((ix + ½)/nx, (iy + ½)/ny) on a square cell ([`Grid::centre`]).
//! - **Fourier.** The integers kx and ky are the numbers of periods of a wave along the sides of the cell. On a square
//!   cell, its wave vector is k = (kx, ky), in waves per λ. [`Grid::waves`] computes |k| on any cell. The angular
//!   wavenumber is q = 2π|k|. A forward transform carries no factor, the inverse carries 1/(nx·ny). The symbol of an
//!   operator is its eigenvalue for the wave exp(2πi k·x): the ratio of displacement to pressure.
//! - **Means** are over the whole cell (nominal area A0) unless a name says "contact".
//! - **rms slope** is the isotropic one, √⟨|∇h|²⟩.
//!
//! # Example: a surface of your own
//!
//! ```
//! use rc_core::{DVec2, Elasticity, Grid, HeightField, PeriodicCell};
//!
//! /// A sphere of radius 1 λ in the middle of the cell, as the paraboloid of Hertz.
//! struct Sphere;
//!
//! impl HeightField for Sphere {
//!     fn height(&self, at: DVec2) -> f64 {
//!         let from_middle = at - at.floor() - 0.5;
//!         -from_middle.length_squared() / 2.0
//!     }
//!     fn band_limit(&self) -> Option<usize> {
//!         None
//!     }
//! }
//!
//! // A solver takes heights in λ at the centres of elements ...
//! let heights = Sphere.sample(Grid::square(64)?);
//! assert_eq!(heights.at(32, 31), -2.0 * (0.5_f64 / 64.0).powi(2) / 2.0);
//!
//! // ... and pressures in E*. A cell of 10 mm, steel, 1 MPa:
//! let (cell, steel) = (PeriodicCell::new(10e-3)?, Elasticity::from_young_poisson(210e9, 0.3)?);
//! let (highest, pressure) = (heights.max() * cell.side(), 1e6 / steel.e_star());
//! assert!(highest < 0.0 && (pressure / 4.333e-6 - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! - `serde`: [`Grid`], [`PeriodicCell`], [`Elasticity`] and [`Units`] can be serialised. Deserialised values are
//!   validated.
//! - `ndarray`: a [`Field`] converts to `ndarray::Array2<f64>` without a copy. The way back needs none if the array is
//!   contiguous and row-major.
//!
//! # Further
//!
//! Module [`testing`] has checks for [`HeightField`], [`Kernel`] and [`Operator`]. More examples are in
//! `tests/examples/` of the repository.
//!
//! The paper is Putignano, Afferrante, Carbone, Demelio, *A new efficient numerical method for contact mechanics of
//! rough surfaces*, Int. J. Solids Struct. 49 (2012) 338-343. A mention such as "Eq. 4" without another source means
//! equation 4 of this paper. Only the function that evaluates an equation writes the number in parentheses. `grep -rn
//! "Eq. (n)" crates`, with the number for n, therefore finds this function.

#[cfg(feature = "ndarray")]
mod array;
mod dimension;
mod field;
mod grid;
mod heights;
mod histogram;
mod progress;
mod sliding;
mod split;
mod traits;
mod units;

pub mod quantity;

pub mod testing;

pub use glam::DVec2;

pub use dimension::Dimension;
pub use field::{Field, ShapeError};
pub use grid::{Grid, GridError};
pub use heights::{HeightField, HeightSource};
pub use histogram::Histogram;
pub use num_complex::Complex64;
pub use progress::{Event, Observer, Rows, Silent, Snapshot};
pub use sliding::{Compliance, Sliding, SlidingCompliance, SlidingModes};
pub use split::SplitByScale;
pub use traits::{Boundary, ComplexSymbol, EdgeBias, Kernel, Operator, Symbol};
pub use units::{Elasticity, PeriodicCell, UnitError, Units};
