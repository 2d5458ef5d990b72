//! The entry point: it takes a contact problem, chooses the method, and returns the solution.

mod area_error;
mod choice;
mod cost;
mod door;
mod elements;
mod error;
mod fields;
mod kernel;
mod memory;
mod params;
mod plan;
mod problem;
mod response;
mod shared;
mod solution;

pub use self::cost::Cost;
pub use self::door::{solve, solve_with_operator};
pub use self::error::SolveError;
pub use self::params::SolveParams;
pub use self::plan::Plan;
pub use self::problem::ContactProblem;
pub use self::solution::Solution;
