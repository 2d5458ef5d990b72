//! Steady sliding over a solid that relaxes: contact with an operator that is monotone, not symmetric.
//!
//! Find p ≥ 0 of the given mean with ⟨L p - h, q - p⟩ ≥ 0 for all such q. The symmetric part of L is positive, so there
//! is one solution, and the certificate of the elastic contact holds with the same formula: ⟨p - p*, L (p - p*)⟩ ≤
//! ⟨p (g - min g)⟩ uses no symmetry. `docs/sliding.md` describes the iteration.

pub(crate) mod friction;
pub(crate) mod newton;
