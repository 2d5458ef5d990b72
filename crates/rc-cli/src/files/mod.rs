//! Files of results: fields averaged for them, and the folder read back.

pub(crate) mod coarsen;
pub(crate) mod flow;
pub mod result;
