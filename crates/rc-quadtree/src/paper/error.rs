//! Errors of requests to module `paper`.

use rc_core::{Grid, GridError};
use thiserror::Error;

use super::key::{MAX_BASE, MAX_LEVEL};

/// An invalid mesh, mask or field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MeshError {
    /// The number of root squares per side is 0 or above [`MAX_BASE`].
    #[error("a mesh needs 1 to {MAX_BASE} root squares per side, not {base}")]
    Base {
        /// Root squares per side, as given.
        base: usize,
    },
    /// A side of a mask or grid is not base times a power of two.
    #[error("a side of {side} cells is not {base} (the root squares per side) times a power of two")]
    Side {
        /// Number of cells per side.
        side: usize,
        /// Number of root squares per side.
        base: usize,
    },
    /// The side of a mask is not a valid side of a grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// The elements of a field are rectangles, but the mesh has squares.
    #[error("the mesh has square elements, but the field is on {grid} elements")]
    NotSquare {
        /// The grid of the field.
        grid: Grid,
    },
    /// The mesh would be deeper than its keys allow.
    #[error("level {level} is deeper than the {MAX_LEVEL} that a key can hold")]
    TooDeep {
        /// The requested level.
        level: u32,
    },
    /// The ring has no blocks, so coarse elements could touch the contact border.
    #[error("the ring must be at least 1 block: with 0, coarse elements would touch the contact border")]
    ZeroRing,
    /// The number of values does not match the number of elements or cells.
    #[error("{expected} values are needed, one for each element or cell, not {actual}")]
    Length {
        /// Number of elements or cells.
        expected: usize,
        /// Number of values given.
        actual: usize,
    },
    /// The squares of two meshes are not nested.
    #[error("meshes with {from} and {to} root squares per side have no common squares")]
    DifferentBase {
        /// Root squares per side of the mesh with the values.
        from: usize,
        /// Root squares per side of the mesh that is to receive the values.
        to: usize,
    },
}

/// `Ok` when `actual == expected`.
pub(super) fn check_length(expected: usize, actual: usize) -> Result<(), MeshError> {
    if actual == expected { Ok(()) } else { Err(MeshError::Length { expected, actual }) }
}

/// Number of levels below the roots of a grid of `side` cells, log2(side / base).
pub(super) fn depth_of(side: usize, base: usize) -> Result<u32, MeshError> {
    check_base(base)?;
    let depth = (side / base).checked_ilog2().ok_or(MeshError::Side { side, base })?;
    if depth > MAX_LEVEL {
        return Err(MeshError::TooDeep { level: depth });
    }
    if base << depth == side { Ok(depth) } else { Err(MeshError::Side { side, base }) }
}

/// `Ok` when a key can represent `base` root squares per side.
pub(super) fn check_base(base: usize) -> Result<(), MeshError> {
    if (1..=MAX_BASE).contains(&base) { Ok(()) } else { Err(MeshError::Base { base }) }
}
