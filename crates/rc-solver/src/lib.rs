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

mod descent;
mod grid;
mod levels;
mod paper;
mod parallel;
mod problem;
mod shear;
mod sliding;
mod solution;
mod solve;
mod tiles;

pub use crate::descent::certificate::Certificate;
pub use crate::descent::contact_element::ContactElement;
pub use crate::descent::info::{Friction, LevelInfo, LevelValues, SolveInfo, Status};
pub use crate::grid::dense::{solve_dense, solve_dense_with_hardness};
pub use crate::grid::direct_sum::DirectSum;
pub use crate::grid::uniform_operator::UniformOperator;
pub use crate::levels::uniform::UNIFORM_BYTES_PER_ELEMENT;
pub use crate::paper::error::GaussSeidelError;
pub use crate::paper::params::GaussSeidelParams;
pub use crate::problem::adaptive_error::AdaptiveError;
pub use crate::problem::capabilities::{Feature, Refusal, Subject, markdown as capabilities_as_markdown, refusal};
pub use crate::problem::checkpoint::Checkpoint;
pub use crate::problem::contact_problem::ContactProblem;
pub use crate::problem::control::Control;
pub use crate::problem::error::{OperatorFault, ProblemError};
pub use crate::problem::method::Method;
pub use crate::problem::method_reason::MethodReason;
pub use crate::problem::tolerance::{ErrorBound, Tolerance};
pub use crate::shear::error::ShearError;
pub use crate::shear::params::{ShearControl, ShearParams};
pub use crate::shear::solution::{ShearInfo, ShearSolution};
pub use crate::solution::contact_area::area::ContactArea;
pub use crate::solution::contact_area::plastic::PlasticContact;
pub use crate::solution::contact_spots::{ContactSpot, connected_elements};
pub use crate::solution::gap_distribution::GapDistribution;
pub use crate::solution::gradient::{Held, Quantity};
pub use crate::solution::gradient_error::GradientError;
pub use crate::solution::observables::Observables;
pub use crate::solution::pressure_statistics::PressureStatistics;
pub use crate::solution::stress_distribution::StressDistribution;
pub use crate::solution::whole::Solution;
pub use crate::solve::cost::Cost;
pub use crate::solve::door::{solve, solve_with_operator};
pub use crate::solve::error::SolveError;
pub use crate::solve::fluid::{FluidProblem, UnderFluid};
pub use crate::solve::history::History;
pub use crate::solve::params::SolveParams;
pub use crate::solve::plan::Plan;
pub use crate::tiles::multilevel::MultilevelOperator;
