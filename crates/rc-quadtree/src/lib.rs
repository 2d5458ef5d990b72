//! The adaptive mesh of squares on the periodic cell.
//!
//! The crate has only the geometry, without physics. The mesh has elements near contacts only. They have one size, or
//! are smaller along the edges of contacts. The adaptive method of rc-solver runs on this mesh:
//!
//! | item | what it is or does |
//! |---|---|
//! | [`TileSet`] | the tiles of one level (grid of one element size); a tile is a square of 8 × 8 elements. In names of items, such an element is a cell |
//! | [`Elements`] | elements of several sizes, as disjoint tiles of several levels; defines the layout of vectors and moves values to another mesh |
//! | [`divide`] | divides the elements of chosen tiles into quarters, and keeps neighbours within a factor of 2 |
//! | [`ContactFields`] | the refinement rule, which selects the elements to divide |
//! | [`prolong`], [`prolong_onto`] | interpolate a function that is positive in contact to elements half as large |
//! | [`Patch`], [`gather`] | a tile with its neighbourhood, for stencils and filters |
//!
//! Module [`paper`] has the meshes that the paper compares in Fig. 3.
//!
//! ```
//! use rc_quadtree::{Elements, TileSet, divide};
//!
//! // 64 × 64 elements; those of the tile in the corner are divided into quarters.
//! let elements = Elements::uniform(TileSet::full([64, 64]));
//! let chosen = elements.finest().places().iter().map(|&place| place == [0, 0]).collect();
//! let refined = divide(&elements, vec![chosen], true, 8);
//! assert_eq!(refined.n_cells(), 64 * 64 + 3 * 64);
//!
//! // Each quarter takes the value of the element it came from.
//! let values: Vec<f64> = (0..elements.len()).map(|i| i as f64).collect();
//! let moved = elements.moved(&refined, &values, 0.0);
//! assert_eq!(moved[refined.cells(0)][..2], [values[0]; 2]);
//! ```
//!
//! Lengths are in λ, the side of the periodic cell. The index `coarser` of a level is its distance from the finest
//! level, which has 0. Places are columns and rows of tiles, counted from the lower left corner of the periodic cell.

mod division;
mod elements;
mod morton;
pub mod paper;
mod patch;
mod prolongation;
mod refinement;
mod tile_index;
mod tiles;
mod transfer;

pub use self::division::divide;
pub use self::elements::{BLOCK_CELLS, BLOCK_TILES, Elements};
pub use self::patch::{Patch, gather};
pub use self::prolongation::{prolong, prolong_onto};
pub use self::refinement::{ContactFields, RING};
pub use self::tiles::{CELLS, TILE, TileSet, cell_over, means_of_quarter, put_tile, quarters};
