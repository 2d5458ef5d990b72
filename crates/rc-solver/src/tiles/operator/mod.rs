//! The multilevel operator: L, or its approximate inverse, on the tiles of an adaptive mesh.
//!
//! Its cost is proportional to the number of tiles. Each level adds a short-range stencil. Short filters connect the
//! levels. The base grid has a Fourier transform ([`rc_kernel::ScaleSplit`] has the formulas). Everything is summed
//! target by target, so the result does not depend on the number of threads.

#![allow(
    clippy::inline_always,
    reason = "what is not inlined into the dispatched function is compiled for the least of machines: seven times slower"
)]

pub(crate) mod base_part;
pub(crate) mod coarse;
pub(crate) mod corrections;
pub(crate) mod extension;
pub(crate) mod extension_values;
#[cfg(test)]
mod free_tests;
pub(crate) mod hierarchy;
pub(crate) mod interpolation;
pub(crate) mod passes;
pub(crate) mod real;
pub(crate) mod sizes;
pub(crate) mod stencil;
pub(crate) mod tables;
#[cfg(test)]
mod tail_tests;
pub(crate) mod tails;
#[cfg(test)]
mod tests;
pub(crate) mod tile_operator;
pub(crate) mod tile_values;
pub(crate) mod transfer;
pub(crate) mod uneven;
