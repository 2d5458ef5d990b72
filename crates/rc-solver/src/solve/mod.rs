//! The entry point: it takes a contact problem, chooses the method, and returns the solution.

pub(crate) mod area_error;
pub(crate) mod choice;
pub(crate) mod cost;
pub(crate) mod door;
pub(crate) mod error;
pub(crate) mod features;
pub(crate) mod fluid;
pub(crate) mod history;
pub(crate) mod memory;
pub(crate) mod params;
pub(crate) mod plan;
pub(crate) mod shared;
