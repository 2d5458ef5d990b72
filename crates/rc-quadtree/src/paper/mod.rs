//! The mesh of the paper (text at Fig. 3) and the two meshes that it is compared with, as a periodic linear quadtree.
//!
//! 1. A [`Mask`] says which cells of the finest uniform grid are in contact.
//! 2. A plan decides, purely, which squares become elements ([`MeshKind`], [`MeshParams`]). [`count`] stops here.
//! 3. [`Mesh::from_mask`] builds the [`Mesh`], a sorted list of [`Key`]s. [`transfer`] brings a pressure to another
//!    mesh and keeps the load; [`Mesh::to_field`] brings it to a uniform grid.
//!
//! ```
//! use rc_core::Grid;
//! use rc_quadtree::paper::{Mask, Mesh, MeshKind, MeshParams, transfer};
//!
//! let grid = Grid::square(256)?;
//! let disc = |i: usize| (i % 256).abs_diff(128).pow(2) + (i / 256).abs_diff(128).pow(2) < 70 * 70;
//! let mask = Mask::new(256, (0..grid.len()).map(disc).collect())?;
//! let mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &MeshParams::default())?;
//! assert!(4 * mesh.len() < mask.count(), "{} elements for {} cells", mesh.len(), mask.count());
//!
//! let pressure: Vec<f64> = mesh.elements().map(|element| 1.0 - element.centre.x).collect();
//! let uniform = Mesh::from_mask(&mask, MeshKind::AdaptiveUniform, &MeshParams::default())?;
//! let moved = transfer(&mesh, &uniform, &pressure)?;
//! let difference = uniform.to_field(&moved.values, grid)?.mean() - mesh.to_field(&pressure, grid)?.mean();
//! assert!(difference.abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Lengths are in λ, the side of the cell. Everything that is not an element is out of contact. Coordinates of masks
//! and fields: see [`rc_core`].

mod build;
mod check;
mod error;
mod key;
mod mark;
mod mask;
mod mesh;
mod raster;
#[cfg(test)]
mod tests;
mod transfer;

pub use self::error::MeshError;
pub use self::key::{Key, MAX_BASE, MAX_LEVEL};
pub use self::mark::{MeshKind, MeshParams, count};
pub use self::mask::Mask;
pub use self::mesh::{Mesh, Square};
pub use self::transfer::{Transferred, transfer};
