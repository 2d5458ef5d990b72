//! Files of results, and reading them back.

pub(crate) mod beside;
pub mod checkpoint;
pub(crate) mod coarsen;
pub(crate) mod flow;
pub(crate) mod names;
pub mod result;
