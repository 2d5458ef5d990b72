//! Files of results, and reading them back.

pub(crate) mod beside;
pub mod checkpoint;
pub(crate) mod coarsen;
pub(crate) mod flow;
pub mod kind;
pub(crate) mod names;
pub mod result;
