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
//! range H, so no scene underflows. On very many tiles with a loose tolerance, pressure and gap are in single precision
//! too ([`values::Values`]).

pub(crate) mod certificate;
pub(crate) mod contact_element;
pub(crate) mod contact_system;
pub(crate) mod descending_round;
pub(crate) mod directions;
pub(crate) mod gap;
pub(crate) mod gmres;
pub(crate) mod info;
pub(crate) mod layout;
pub(crate) mod load;
pub(crate) mod observed;
pub(crate) mod operators;
pub(crate) mod outcome;
pub(crate) mod penetration;
pub(crate) mod project;
pub(crate) mod round;
pub(crate) mod rows;
pub(crate) mod run;
pub(crate) mod shares;
pub(crate) mod start;
pub(crate) mod state;
pub(crate) mod stiffness;
pub(crate) mod stop;
pub(crate) mod sums;
pub(crate) mod values;
