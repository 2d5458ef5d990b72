//! Estimates of memory and time of a flow.

/// Bytes of memory per element of the grid, with the gap.
///
/// Whole processes, which also hold the solution, took 105 to 122 bytes on 2048² to 6144² elements. Close to
/// percolation, where coarser grids do not represent the film, it is up to 200.
pub const BYTES_PER_ELEMENT: f64 = 104.0;

/// Processor seconds per element of the grid, for both axes and the error bar.
///
/// On 2048² elements, 0.72e-6 to 0.79e-6 were measured.
pub const SECONDS_PER_ELEMENT: f64 = 0.8e-6;
