//! A running solve: its threads, what is seen of it, and what ends it early.

pub(crate) mod progress;
pub(crate) mod stop;
pub mod threads;
pub(crate) mod together;
pub(crate) mod watch;
