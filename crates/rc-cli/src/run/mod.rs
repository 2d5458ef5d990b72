//! Running solves: threads, progress, and what ends a solve early.

pub(crate) mod progress;
pub(crate) mod stop;
pub mod threads;
pub(crate) mod together;
pub(crate) mod watch;
