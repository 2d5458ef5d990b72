//! From the elements that are iterated on to the whole grid, smoothly: what makes the approximate inverse of L a good
//! one for many contacts.
//!
//! |q|/2 is the inverse of L on the whole grid. The inverse of L among the active elements alone is its Schur complement S: ⟨r, S r⟩ is the
//! least ⟨u, |q|/2 u⟩ of all u that are r on the active elements. Any linear extension u = F r therefore gives an
//! approximate inverse Fᵀ |q|/2 F that is at least S, and the nearer to it the smoother u is. With zeros between
//! contacts u jumps at the edge of each; a residual that is smooth over many contacts, as one is that comes from a
//! coarser grid, then looks as rough as the contacts are small, and the iterations grow with the number of scales. Here
//! u between contacts is interpolated from means over squares of 2, 4, 8, … elements, each as far as its elements are
//! active.
//!
//! `docs/measurements-uniform.md` has what it gives.

mod finest;
mod pyramid;
mod rows;

pub(crate) use self::finest::GridExtension;
pub(crate) use self::pyramid::{Pyramid, set_shares};
