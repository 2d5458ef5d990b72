//! The scene: its keys, which are flags as well, its file, and the checked problem that it becomes.

pub mod as_read;
pub mod file;
pub mod keys;
pub mod resolve;
pub mod surface;
pub mod time_limit;
pub mod values;
pub mod wave_file;

pub mod heights;
mod names;
