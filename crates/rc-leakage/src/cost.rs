//! What a flow takes.

/// Memory for each element of the grid, the gap included: measured 99 bytes on 6144² elements, and 103
/// on 2048². Where coarser grids do not represent the film, close to percolation, it is up to 200.
pub const BYTES_PER_ELEMENT: f64 = 103.0;

/// Processor seconds for each element of the grid, for both axes and the error of the grid: measured 0.63e-6 on
/// 6144² elements.
pub const SECONDS_PER_ELEMENT: f64 = 0.65e-6;
