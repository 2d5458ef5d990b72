//! Leakage: flow of a thin viscous film through the gap of a contact.
//!
//! The flow follows the Reynolds equation ∇·(g³ ∇P) = 0 with contact as walls. Lengths are in λ, the side of the cell
//! along x. [`leakage`] solves for the flow along x and along y on the periodic cell, under a pressure that falls by ΔP
//! across the cell. The permeance K of an axis gives the flow Q = K ΔP / (12 η), with the viscosity η. K is in λ³.
//! Between plates at a distance g, K = g³ Ly/Lx along x.
//!
//! ```
//! use rc_core::{Field, Grid};
//! use rc_leakage::{Axis, LeakageParams, leakage};
//!
//! // A slot along x of half the cell, of gap 0.01 λ.
//! let gap = Field::from_fn(Grid::square(32)?, |at| if at.y < 0.5 { 0.01 } else { 0.0 });
//! let leakage = leakage(&gap, &LeakageParams::default())?;
//! let [along_x, along_y] = &leakage.flows;
//! assert!((along_x.permeance / 0.5e-6 - 1.0).abs() < 1e-9);
//! assert!(along_x.percolates && !along_y.percolates && along_y.permeance == 0.0);
//! assert_eq!(leakage.flow_axis(), Some(Axis::X));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod aggregation;
mod bounds;
mod clusters;
mod constriction;
mod cost;
mod descent;
mod elimination;
mod error;
mod flow;
mod flow_state;
mod flux;
mod multigrid;
mod network;
mod parallel;
mod patch;
mod pools;
mod preconditioner;
mod products;
mod real;
mod step;
mod tree;
mod variants;

pub use constriction::Constriction;
pub use cost::{BYTES_PER_ELEMENT, SECONDS_PER_ELEMENT};
pub use error::LeakageError;
pub use flow::{Flow, FlowInfo, Leakage, LeakageParams, leakage, percolates};
pub use flux::Flux;
pub use network::Axis;
pub use patch::{images, leakage_of_patch, patch_percolates};
