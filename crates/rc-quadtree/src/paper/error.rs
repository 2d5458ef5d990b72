//! What can be wrong with a request to this crate.

use rc_core::{Grid, GridError};
use thiserror::Error;

use super::key::{MAX_BASE, MAX_LEVEL};

/// A mesh, a mask or a field that cannot be used as asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MeshError {
    /// The number of root squares per side is 0 or above [`MAX_BASE`].
    #[error("a mesh needs 1 to {MAX_BASE} root squares per side, not {base}")]
    Base {
        /// Root squares per side, as given.
        base: usize,
    },
    /// The side of a mask or grid is not the base doubled some number of times.
    #[error("a side of {side} cells is not {base} (the root squares per side) times a power of two")]
    Side {
        /// Cells per side.
        side: usize,
        /// Root squares per side.
        base: usize,
    },
    /// The side of a mask is not a side of any grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// A field on a grid of rectangles: elements are squares.
    #[error("the mesh has square elements, but the field is on {grid} elements")]
    NotSquare {
        /// The grid of the field.
        grid: Grid,
    },
    /// The mesh would be deeper than its keys allow.
    #[error("level {level} is deeper than the {MAX_LEVEL} that a key can hold")]
    TooDeep {
        /// The level asked for.
        level: u32,
    },
    /// A ring of no blocks would allow coarse elements on the contact border.
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
    /// Two meshes whose squares are not nested.
    #[error("meshes with {from} and {to} root squares per side have no common squares")]
    DifferentBase {
        /// Root squares per side of the mesh that has the values.
        from: usize,
        /// Root squares per side of the mesh that receives them.
        to: usize,
    },
}

/// `Ok` when `actual == expected`.
pub(super) fn check_length(expected: usize, actual: usize) -> Result<(), MeshError> {
    if actual == expected { Ok(()) } else { Err(MeshError::Length { expected, actual }) }
}

/// The number of levels below the roots of a grid of `side` cells, log2(side / base).
pub(super) fn depth_of(side: usize, base: usize) -> Result<u32, MeshError> {
    check_base(base)?;
    let depth = (side / base).checked_ilog2().ok_or(MeshError::Side { side, base })?;
    if depth > MAX_LEVEL {
        return Err(MeshError::TooDeep { level: depth });
    }
    if base << depth == side { Ok(depth) } else { Err(MeshError::Side { side, base }) }
}

/// `Ok` when `base` root squares per side can be keyed.
pub(super) fn check_base(base: usize) -> Result<(), MeshError> {
    if (1..=MAX_BASE).contains(&base) { Ok(()) } else { Err(MeshError::Base { base }) }
}
