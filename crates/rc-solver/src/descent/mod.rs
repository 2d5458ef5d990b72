//! Preconditioned projected conjugate gradients on one level, on any mesh ([`LevelOperators`]).
//!
//! One round takes a few conjugate-gradient steps on the active elements. It then chooses the next active elements:
//! those that press, and those outside that penetrate. It clips tensile pressures and restores the load.
//!
//! Directions survive a change of the active set. β makes the new direction L-orthogonal to the old one as it was
//! (Hestenes and Stiefel), and is kept non-negative. Clipping only in every second step saves its convolution. Clipping
//! less often costs more steps than it saves.
//!
//! Corrections are directions, their displacements and residuals. They are in single precision, while pressure and gap
//! are in double precision. Each correction is added to exact values, as in iterative refinement. A fresh application
//! of L in double precision then removes the errors of single precision. All corrections are relative to the height
//! range H, so no scene underflows.

mod directions;
mod extension;
mod gap;
mod inverse;
mod layout;
mod limited;
mod margin;
mod mean;
mod observed;
mod operators;
mod outcome;
mod passes;
mod response;
mod round;
mod rows;
mod run;
mod safe_round;
mod shares;
mod start;
mod state;
mod stop;
mod sums;
mod uniform;

pub(crate) use directions::{ConjugateDirections, Slope};
pub(crate) use extension::{Pyramid, set_shares};
pub(crate) use gap::{fresh_gap, mean_pressure, rescale, scale_to_load};
pub(crate) use layout::BlockLayout;
pub(crate) use limited::{is_plastic, limit_to_load};
pub(crate) use observed::ObservedMesh;
pub(crate) use operators::{BlockOperator, LevelOperators, PreconditionedOperator, read_blocks, write_blocks};
pub(crate) use outcome::Outcome;
pub(crate) use passes::{read_rows, write_rows};
pub(crate) use response::{GridResponse, padded_side, table_of_response};
pub(crate) use rows::ElementValues;
pub(crate) use run::{DescentObserver, Goal};
pub(crate) use state::{Descent, Start};
pub(crate) use sums::GapSums;
pub(crate) use uniform::{SymbolOperator, UniformCorrections, certifying_operators, uniform_operators};
