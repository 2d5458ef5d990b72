//! The procedure of the paper: Gauss-Seidel on an adaptive mesh.

pub(crate) mod coefficients;
pub(crate) mod error;
pub(crate) mod estimate;
pub(crate) mod finish;
pub(crate) mod half_space;
pub(crate) mod params;
pub(crate) mod procedure;
pub(crate) mod solve;
pub(crate) mod sweep;
