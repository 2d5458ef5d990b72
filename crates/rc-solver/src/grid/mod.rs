//! Uniform grids: L and its approximate inverse by Fourier transforms, full contact, operators of the caller.

pub(crate) mod any_operator;
pub(crate) mod coarser;
pub(crate) mod dense;
pub(crate) mod direct_sum;
pub(crate) mod extension;
pub(crate) mod factors;
pub(crate) mod full_contact;
pub(crate) mod interpolation;
pub(crate) mod inverse;
pub(crate) mod line;
pub(crate) mod margin;
pub(crate) mod operators;
pub(crate) mod passes;
pub(crate) mod prolongation;
pub(crate) mod response;
pub(crate) mod solve_with_operator;
pub(crate) mod solved;
pub(crate) mod stiffness;
pub(crate) mod uniform_operator;
