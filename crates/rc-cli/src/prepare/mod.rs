//! `rc prepare`: the usual treatments of a measured map, with a record and pictures of what they did.

pub(crate) mod args;
pub(crate) mod command;

mod pictures;
mod record;
