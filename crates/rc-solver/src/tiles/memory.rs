//! Bytes of data whose size is known before any work.

/// Bytes for each sample of a surface on its whole grid, including coarser grids.
pub(crate) const BYTES_PER_SAMPLE: f64 = 8.0 * 4.0 / 3.0;

/// Bytes for each element of the base grid.
const BYTES_PER_BASE_ELEMENT: f64 = 130.0;

/// Memory of the base grid, in bytes, which is the minimum of the adaptive method.
pub(crate) fn base_bytes([nx, ny]: [usize; 2]) -> f64 {
    BYTES_PER_BASE_ELEMENT * (nx as f64 * ny as f64)
}
