//! `rc study`: one contact under varied treatments of a measured map.

pub(crate) mod args;
pub(crate) mod command;

mod ranges;
mod record;
mod rows;
mod variants;
