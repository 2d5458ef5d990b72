//! `rc study`: one contact under varied treatments of a measured map.

pub(crate) mod args;
pub(crate) mod command;
pub(crate) mod pictures;
pub(crate) mod ranges;
pub(crate) mod record;

mod distinct;
mod rows;
mod solved;
mod variants;

pub use solved::{StudyOutcome, of_words};
