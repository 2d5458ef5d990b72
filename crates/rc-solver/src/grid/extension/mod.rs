//! Smooth extension of values on the active elements to the whole grid.
//!
//! With it, the approximate inverse of L is a good one for many contacts. |q|/2 is the inverse of L on the whole grid.
//! The inverse of L among the active elements alone is its Schur complement S. Over all functions u that equal r on the
//! active elements, the minimum of ⟨u, |q|/2 u⟩ is ⟨r, S r⟩. Any linear extension u = F r therefore gives an
//! approximate inverse Fᵀ |q|/2 F that is at least S. It is the closer to S the smoother u is.
//!
//! With zeros between contacts, u jumps at the edge of each contact. A residual from a coarser grid is smooth over many
//! contacts. With zeros between them it looks as rough as the contacts are small, and the iterations grow with the
//! number of scales. Here u between contacts is interpolated from means over squares of 2, 4, 8, … elements. A square
//! counts as far as its elements are active.
//!
//! `docs/constants.md` has the iterations with and without the extension.

pub(crate) mod pyramid;
pub(crate) mod rows;
