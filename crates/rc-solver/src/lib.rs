//! The adhesionless contact problem on a periodic half-space.
//!
//! Find p ≥ 0 on the cell with gap `g = v - (h - h_max + Δ) ≥ 0`, `p·g = 0` and `v = L p` (Eq. 3-4), for a given mean
//! pressure σ0 (Δ is then the multiplier) or a given penetration Δ (σ0 is then a result). [`solve_adaptive`] does it on
//! an adaptive mesh whose elements follow the contact, [`solve_uniform`] on uniform grids, [`solve_gauss_seidel`] by the paper's own procedure on an adaptive mesh, and
//! [`solve_dense`], slowly, by elimination: what the other two are tested against. Conventions and units: see [`rc_core`].
//!
//! ```
//! use std::f64::consts::{PI, TAU};
//!
//! use rc_core::{Field, Grid, Silent};
//! use rc_kernel::Love;
//! use rc_solver::{AdaptiveParams, Control, Observables, IterationParams, solve_adaptive, solve_uniform};
//!
//! // Westergaard's wave at half the load of full contact, π E* a/λ: half of it touches.
//! let amplitude = 1e-3;
//! let heights = Field::from_fn(Grid::square(128)?, |at| amplitude * (TAU * at.x).cos());
//! let load = Control::MeanPressure(0.5 * PI * amplitude);
//! let solution = solve_uniform(&heights, &Love, load, &IterationParams::certified(), &Silent)?;
//! let found = Observables::of(&solution, &Love);
//! assert!((found.area.fraction - 0.5).abs() < 0.01, "A/A0 = {}", found.area.fraction);
//!
//! // Work that follows the contact; the same pressure, at a penetration that is given now.
//! let depth = Control::Penetration(solution.info.penetration);
//! let adaptive = solve_adaptive((&heights).into(), depth, &AdaptiveParams::certified(), &Silent)?;
//! assert!((adaptive.info.mean_pressure / solution.info.mean_pressure - 1.0).abs() < 1e-4);
//! assert!(adaptive.info.certificate.penetration <= 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod certificate;
mod contact_area;
mod contact_spots;
mod control;
mod dense;
mod descent;
mod error;
mod gap_distribution;
mod gauss_seidel;
mod method;
mod observables;
mod operator;
mod params;
mod pressure_statistics;
mod problem;
mod solution;
mod solve;
mod stiffness;
mod stress_distribution;
mod tolerance;
mod uniform;

pub use adaptive::{
    AdaptiveError, AdaptiveParams, AdaptiveProblem, AdaptiveSolution, ContactElement, Estimate, MultilevelOperator,
    solve_adaptive,
};
pub use certificate::Certificate;
pub use contact_area::ContactArea;
pub use contact_spots::{ContactSpot, connected_elements};
pub use control::Control;
pub use dense::solve_dense;
pub use error::IterationError;
pub use gap_distribution::GapDistribution;
pub use gauss_seidel::{Coefficient, GaussSeidelError, GaussSeidelParams, solve_gauss_seidel};
pub use method::{Method, MethodReason};
pub use observables::Observables;
pub use operator::{DirectSum, UniformOperator};
pub use params::IterationParams;
pub use pressure_statistics::PressureStatistics;
pub use solution::{GridSolution, LevelInfo, LevelValues, MeshPressure, SolveInfo, Status};
pub use solve::{ContactProblem, Cost, Plan, Solution, SolveError, SolveParams, solve};
pub use stress_distribution::StressDistribution;
pub use tolerance::Tolerance;
pub use uniform::{UNIFORM_BYTES_PER_ELEMENT, solve_uniform};
