//! Files of results: fields averaged for them, and the folder read back.

pub mod checkpoint;
pub(crate) mod coarsen;
pub(crate) mod flow;
pub mod result;
