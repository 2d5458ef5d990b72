//! `rc study`: one contact under varied treatments of a measured map.

pub(crate) mod args;
pub(crate) mod command;
pub(crate) mod ranges;
pub(crate) mod record;

mod rows;
mod variants;
