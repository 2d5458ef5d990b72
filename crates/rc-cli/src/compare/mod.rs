//! `rc compare`: two results beside each other.
//!
//! [`numbers`] compares summaries, [`scenes`] what was solved, and [`fields`] pressure and gap on the grid that both
//! have. [`command`] makes a record of these, text and files.

pub(crate) mod args;
pub(crate) mod command;

mod fields;
mod numbers;
mod picture;
mod scenes;
