//! Friction of a surface that slides, in SI units.

use rc_core::Units;
use rc_solver::{Friction, Solution};
use serde::{Deserialize, Serialize};

/// Keys of a summary for a surface that slides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionSummary {
    /// Friction coefficient: the force against the velocity, relative to the load.
    pub friction: f64,
    /// Estimated error of `friction`, of the mesh and the iteration.
    pub friction_error: f64,
    /// Proven bound of the error of `friction` that the iteration leaves on this grid.
    pub friction_bound: f64,
    /// Force on the solid to the left of the velocity, relative to the load. That on the surface is to the right.
    pub lateral_friction: f64,
    /// Power that the solid dissipates, per nominal area (W/m²).
    pub dissipated_power: f64,
    /// Maximum loss tangent of the waves of the grid at this speed.
    pub max_loss_tangent: f64,
    /// Number of directions of GMRES on the finest grid.
    pub gmres_iterations: usize,
    /// Number of rounds with the storage modulus on the finest grid.
    pub monotone_steps: usize,
}

impl FrictionSummary {
    /// The friction of `solution` for these units and times in seconds. It is 0 at rest.
    #[must_use]
    pub fn of(solution: &Solution<'_>, units: Units) -> Self {
        let of = |friction: Friction| Self {
            friction: friction.coefficient,
            friction_error: friction.error,
            friction_bound: friction.bound,
            lateral_friction: friction.lateral,
            dissipated_power: units.metres(units.pascals(friction.power)),
            max_loss_tangent: friction.max_loss_tangent,
            gmres_iterations: friction.gmres_iterations,
            monotone_steps: friction.storage_rounds,
        };
        solution.info().friction.map_or_else(Self::default, of)
    }
}
