//! The conditions of all warnings, for every command, the Python package and rc-mpi.
//!
//! A warning doubts an input or a result that can be computed, but is probably not what the user means. What cannot be
//! computed is an error. [`surface`] doubts a surface, `contact` a contact before its solve, and `result` a solved
//! one. [`shown`] prints warnings and makes errors of them.

pub(crate) mod contact;
pub(crate) mod result;
pub mod shown;
pub mod surface;

mod single_spots;
