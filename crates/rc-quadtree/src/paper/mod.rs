//! The mesh of the paper (text at Fig. 3) as a periodic linear quadtree.
//!
//! The module also has the two meshes that the paper compares with it.
//!
//! 1. A [`Mask`] says which cells of the finest uniform grid are in contact.
//! 2. A plan selects the squares that become elements ([`MeshKind`], [`MeshParams`]). It depends only on these
//!    arguments. [`count`] stops here.
//! 3. [`Mesh::from_mask`] builds the [`Mesh`], a sorted list of [`Key`]s. [`transfer`] takes a pressure to another mesh
//!    and conserves the load. [`Mesh::to_field`] takes it to a uniform grid.
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
//! Lengths are in λ, the side of the cell. All points outside elements are out of contact. Coordinates of masks and
//! fields are those of [`rc_core`].

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
