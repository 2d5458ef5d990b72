//! The adhesionless contact problem on a periodic half-space.
//!
//! Find a pressure p ≥ 0 with the displacement `v = L p` (Eq. 3-4). The gap `g = v - (h - h_max + Δ)` must satisfy g ≥
//! 0 and `p·g = 0`. h_max is the maximum height. Either the mean pressure σ0 is given, and the penetration Δ is a
//! result, or Δ is given, and σ0 is a result.
//!
//! [`solve`] solves this problem. It chooses between an adaptive mesh, whose elements follow the contact, and the
//! uniform grid. [`Method`] names these two and the paper's own procedure. [`ContactProblem`] also takes other kernels
//! and observers, and can make a plan without solving. [`rc_core`] has the conventions and units.
//!
//! A solve uses the thread pool of rayon that is current: the global one, or the pool in whose `install` it is called.
//!
//! ```
//! use std::f64::consts::{PI, TAU};
//!
//! use rc_core::{Field, Grid};
//! use rc_solver::{Control, SolveParams, solve};
//!
//! // The load of full contact of Westergaard's wave is π E* a/λ. At half this load, half of the wave touches.
//! let amplitude = 1e-3;
//! let heights = Field::from_fn(Grid::square(128)?, |at| amplitude * (TAU * at.x).cos());
//! let solution = solve(&heights, Control::MeanPressure(0.5 * PI * amplitude), &SolveParams::default())?;
//! assert!((solution.area().fraction - 0.5).abs() < 5e-3);
//! assert!(solution.certificate().meets(solution.bound()));
//!
//! // The same contact, now with the penetration given instead of the load.
//! let depth = Control::Penetration(solution.info().penetration);
//! let again = solve(&heights, depth, &SolveParams::default())?;
//! assert!((again.info().mean_pressure / solution.info().mean_pressure - 1.0).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adaptive;
mod certificate;
mod contact_area;
mod contact_element;
mod contact_spots;
mod contract;
mod control;
mod dense;
mod descent;
mod error;
mod factors;
mod gap_distribution;
mod gap_part;
mod gauss_seidel;
mod method;
mod observables;
mod once;
mod operator;
mod parallel;
mod params;
mod pressure_statistics;
mod problem;
mod solution;
mod solve;
mod stiffness;
mod stress_distribution;
mod support;
mod tolerance;
mod uniform;

use adaptive::Estimate;
pub use adaptive::{AdaptiveError, Checkpoint, MultilevelOperator};
pub use certificate::Certificate;
pub use contact_area::{ContactArea, PlasticContact};
pub use contact_element::ContactElement;
pub use contact_spots::{ContactSpot, connected_elements};
pub use control::Control;
pub use dense::{solve_dense, solve_dense_with_hardness};
pub use error::{OperatorFault, ProblemError};
pub use gap_distribution::GapDistribution;
pub use gauss_seidel::{GaussSeidelError, GaussSeidelParams};
pub use method::{Method, MethodReason};
pub use observables::Observables;
pub use operator::{DirectSum, UniformOperator};
use params::IterationParams;
pub use pressure_statistics::PressureStatistics;
pub use solution::{LevelInfo, LevelValues, SolveInfo, Status};
pub use solve::{ContactProblem, Cost, Plan, Solution, SolveError, SolveParams, solve, solve_with_operator};
pub use stress_distribution::StressDistribution;
pub use tolerance::{ErrorBound, Tolerance};
pub use uniform::UNIFORM_BYTES_PER_ELEMENT;
