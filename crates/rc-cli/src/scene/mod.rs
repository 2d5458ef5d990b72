//! The scene: its keys, which are also flags, its file, and the checked problem.

pub mod as_read;
pub(crate) mod features;
pub mod file;
pub mod fluid;
pub mod form;
pub mod keys;
pub(crate) mod like;
pub mod loaded;
pub mod material;
pub(crate) mod origin;
pub mod resolve;
pub mod surface;
pub mod time_limit;
pub mod values;
pub mod wave_file;

pub mod heights;
pub mod history;
mod names;
mod other_body;
pub(crate) mod profile;
mod prony_file;
pub mod psd_file;
pub(crate) mod quantity;
pub(crate) mod written;
