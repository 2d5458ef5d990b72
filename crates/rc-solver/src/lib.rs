//! The adhesionless contact problem on a periodic half-space.
//!
//! Find p ≥ 0 on the cell with gap `g = v - (h - h_max + Δ) ≥ 0`, `p·g = 0` and `v = L p` (Eq. 3-4), for a given mean
//! pressure σ0 (Δ is then the multiplier) or a given penetration Δ (σ0 is then a result). [`solve_adaptive`] does it on
//! an adaptive mesh whose elements follow the contact, [`solve_uniform`] on uniform grids, [`solve_gauss_seidel`] by the paper's own procedure on an adaptive mesh, and
//! [`solve_dense`], slowly, by elimination: what the other two are tested against. Conventions and units: see [`rc_core`].

mod adaptive;
mod certificate;
mod contact_area;
mod contact_spots;
mod control;
mod dense;
mod descent;
mod error;
mod fft;
mod gap_distribution;
mod gauss_seidel;
mod observables;
mod operator;
mod params;
mod problem;
mod solution;
mod stiffness;
mod stress_distribution;
mod uniform;

pub use adaptive::{
    AdaptiveError, AdaptiveParams, AdaptiveProblem, AdaptiveSolution, ContactElement, Estimate, HeightSource,
    MultilevelOperator, solve_adaptive,
};
pub use certificate::Certificate;
pub use contact_area::ContactArea;
pub use contact_spots::ContactSpot;
pub use control::Control;
pub use dense::solve_dense;
pub use error::SolveError;
pub use gap_distribution::GapDistribution;
pub use gauss_seidel::{Coefficient, GaussSeidelError, GaussSeidelParams, solve_gauss_seidel};
pub use observables::Observables;
pub use operator::{DirectSum, UniformOperator};
pub use params::SolveParams;
pub use solution::{LevelInfo, LevelValues, MeshPressure, Solution, SolveInfo, Status};
pub use stress_distribution::StressDistribution;
pub use uniform::{UNIFORM_BYTES_PER_ELEMENT, solve_uniform};
