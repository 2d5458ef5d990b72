//! The paper's own procedure, as written in its Section 2: penetration in increments, contact on an adaptive mesh,
//! Gauss-Seidel on the elements in contact, and the double check.
//!
//! For each increment of Δ:
//!
//! - (i) fix Δ;
//! - (ii) first guess of the contact: the deformed layer of the increment before, lowered to the new Δ, meets the surface;
//! - (iii) prescribe `v_i = h_i - h_max + Δ` on the elements in contact;
//! - (iv) solve Eq. 4 on them, by Gauss-Seidel;
//! - (v) find the displacement out of contact;
//! - (vi) remove elements under tension, add those that penetrate, and mesh the new contact, until neither changes it.
//!
//! One departure: step (v) evaluates `Σ_j L_ij σ_j` on all points of the finest grid by FFT. An element of the mesh is a
//! patch of finest elements under one pressure, so this is the same sum to rounding (test
//! `displacement_by_fft_is_the_direct_sum`), without its O(n·N) cost.
//!
//! On a mesh of unequal elements collocation makes L non-symmetric: Gauss-Seidel tolerates that, conjugate gradients do
//! not. The cost is that of a dense matrix, n² coefficients a sweep, so there is a budget, and a clear error when a scene
//! needs more.

mod coefficients;
mod error;
mod params;
mod procedure;
mod sweep;

pub use coefficients::Coefficient;
pub use error::GaussSeidelError;
pub use params::GaussSeidelParams;
pub use procedure::solve_gauss_seidel;
