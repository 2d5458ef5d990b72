//! What is asked: bodies, surface, load, bounds of the pressure, tolerance, method, and what is refused.

pub(crate) mod adaptive_error;
pub(crate) mod bounds;
pub(crate) mod capabilities;
pub(crate) mod checked;
pub(crate) mod checkpoint;
pub(crate) mod contact_problem;
pub(crate) mod contract;
pub(crate) mod control;
pub(crate) mod error;
pub(crate) mod kernel;
pub(crate) mod method;
pub(crate) mod method_reason;
pub(crate) mod params;
pub(crate) mod steps;
pub(crate) mod summit;
pub(crate) mod support;
pub(crate) mod tolerance;
