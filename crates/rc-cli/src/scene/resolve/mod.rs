//! The step from scene file and flags to a checked problem.
//!
//! The problem is in the units of the libraries (λ = 1, E* = 1).

mod checks;
mod contact;
pub(crate) mod elastic_layer;
mod form;
mod layers;
mod like;
mod map;
mod realisation;
pub(crate) mod shear;
pub(crate) mod sliding;
mod surface;

pub use checks::checked_grid;
pub(crate) use contact::mean_pressure;
pub use contact::{ContactSetup, Place, contact, kernel};
pub(crate) use elastic_layer::check_thickness;
pub use layers::layers;
pub use map::{check_cell_and_material, check_size, check_size_and_material};
pub use shear::ShearSetup;
pub use sliding::SlidingSolid;
pub use surface::{surface, surface_in_cell};
