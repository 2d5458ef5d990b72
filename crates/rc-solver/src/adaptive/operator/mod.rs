//! The multilevel operator: L, or its approximate inverse, on the tiles of an adaptive mesh.
//!
//! Its cost is proportional to the number of tiles. Each level adds a short-range stencil. Short filters connect the
//! levels. The base grid has a Fourier transform ([`rc_kernel::ScaleSplit`] has the formulas). Everything is summed
//! target by target, so the result does not depend on the number of threads.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined into the dispatched function is compiled for the least of machines: seven times slower"
)]

mod base_part;
mod coarse;
mod corrections;
mod extension;
mod extension_values;
mod hierarchy;
mod interpolation;
mod passes;
mod real;
mod sizes;
mod stencil;
mod tables;
mod tile_operator;
mod tile_values;
mod transfer;
mod uneven;

pub(crate) use self::corrections::{TileCorrections, TileResponse};
pub(crate) use self::hierarchy::{Hierarchy, Reach};
pub(crate) use self::sizes::Real;
pub(crate) use self::tables::{Prepared, Tables};
pub(crate) use self::tile_operator::TileOperator;

#[cfg(test)]
mod free_tests;
#[cfg(test)]
mod tests;
