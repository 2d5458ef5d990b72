//! Heights of the rigid surface, tile by tile, without the finest grid.
//!
//! A band-limited surface is sampled once, on a grid with at least four elements for its shortest wave. From there it
//! is interpolated to nine digits on tiles of any finer level. A map is kept as it is. Both give coarser levels, and
//! upper bounds of the heights in any square, which say where the surface cannot touch.

pub(crate) mod bounds;
pub(crate) mod extremes;
pub(crate) mod interpolation;
pub(crate) mod on_demand;
pub(crate) mod pyramid;
pub(crate) mod stencil;
#[cfg(test)]
mod tests;
pub(crate) mod window;
