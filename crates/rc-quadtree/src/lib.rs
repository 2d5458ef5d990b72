//! The periodic adaptive mesh of squares: fine along every contact border, coarse inside, nothing outside contact.
//!
//! The mesh of the paper (text at Fig. 3) and the two it is compared with, as geometry only; no physics. It is used
//! in three steps:
//!
//! 1. A [`Mask`] says which cells of the finest uniform grid are in contact.
//! 2. [`plan()`] decides, purely, which squares shall be elements ([`MeshKind`], [`MeshParams`]); [`count`] stops here.
//! 3. [`Mesh::from_plan`] builds the [`Mesh`], a sorted list of [`Key`]s. It answers where elements are, which is
//!    where, and what lies across an edge; it can be split and merged; [`transfer`] brings a pressure to another mesh
//!    with the load kept; [`Mesh::border`] walks along the edge of a set of elements.
//!
//! ```
//! use rc_core::DVec2;
//! use rc_quadtree::{Mask, Mesh, MeshKind, MeshParams, Reconstruction, transfer};
//!
//! let mask = Mask::from_predicate(256, |at| at.distance(DVec2::splat(0.5)) < 0.3)?;
//! let mesh = Mesh::from_mask(&mask, MeshKind::Adaptive, &MeshParams::default())?;
//! assert!(4 * mesh.len() < mask.count(), "{} elements for {} cells", mesh.len(), mask.count());
//!
//! let pressure: Vec<f64> = mesh.elements().map(|e| 1.0 - e.x).collect();
//! let finer = mesh.split(&[mesh.locate(DVec2::splat(0.5)).expect("the centre is in contact")])?;
//! let moved = transfer(&mesh, &finer, &pressure, Reconstruction::Limited)?;
//! assert!((finer.load(&moved.values)? - mesh.load(&pressure)?).abs() < 1e-15);
//! # Ok::<(), rc_quadtree::MeshError>(())
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
mod perimeter;
mod raster;
mod refine;
mod transfer;

pub use error::MeshError;
pub use key::{Key, MAX_BASE, MAX_LEVEL, morton_code};
pub use mark::{Mark, MeshKind, MeshParams, RefinementPlan, count, plan};
pub use mask::Mask;
pub use mesh::{Edge, Element, Mesh, Neighbour};
pub use perimeter::{BorderEdge, Perimeter};
pub use transfer::{Reconstruction, Transferred, transfer};
