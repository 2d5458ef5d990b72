//! The paper's own procedure, as written in its Section 2.
//!
//! The procedure increases the penetration Δ in increments. It uses an adaptive mesh, Gauss-Seidel on the elements in
//! contact, and a double check: tension and overlap in step (vi). For each increment:
//!
//! - (i) fix Δ;
//! - (ii) guess the contact: the places where the deformed layer of the previous increment, lowered to the new Δ,
//!   overlaps the surface;
//! - (iii) prescribe `v_i = h_i - h_max + Δ` on the elements in contact;
//! - (iv) solve Eq. 4 on them, by Gauss-Seidel;
//! - (v) find the displacement out of contact;
//! - (vi) remove elements under tension, add those that penetrate, and mesh the new contact, until neither changes it.
//!
//! There is one difference from the paper. Step (v) evaluates `Σ_j L_ij σ_j` on all points of the finest grid by FFT.
//! An element of the mesh is a patch of finest elements under one pressure. The result is therefore the same sum to
//! rounding (test `displacement_by_fft_is_the_direct_sum`), without its O(n·N) cost.
//!
//! On a mesh of unequal elements, collocation makes L non-symmetric. Gauss-Seidel converges nevertheless, but conjugate
//! gradients do not. As for a dense matrix, a sweep costs n² coefficients. There is therefore a budget, and an error
//! when a scene needs more.

use rc_core::{Field, Observer};

use crate::descent::info::GridSolution;
use crate::paper::error::GaussSeidelError;
use crate::paper::estimate::{self, Estimate};
use crate::paper::half_space::HalfSpace;
use crate::paper::params::GaussSeidelParams;
use crate::paper::procedure::Procedure;
use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::params::IterationParams;
use crate::problem::tolerance::{ErrorBound, Tolerance};

/// Solves the contact problem by the paper's procedure (Sec. 2, steps (i)-(vi)), to a tolerance.
///
/// The finest elements of the adaptive mesh are those of the grid of `heights`. The procedure controls the penetration,
/// so a secant search over it finds a given mean pressure. The result is bitwise the same for any number of threads.
pub(crate) fn solve_gauss_seidel(
    heights: &Field,
    half_space: HalfSpace<'_>,
    control: Control,
    (bound, params): (ErrorBound, &GaussSeidelParams),
    observer: &dyn Observer,
) -> Result<GridSolution, GaussSeidelError> {
    estimate::check(params)?;
    let problem = Problem::check(heights, control, &IterationParams { bound, max_iterations: params.max_checks })?;
    let Estimate { penetration: expected, length } = estimate::estimate(heights, half_space, control, params)?;
    let tolerance = match bound {
        ErrorBound::Relative(tolerance) => tolerance,
        // The factor is a half, since the length comes from a coarse grid.
        ErrorBound::Energy(_) => (0.5 * bound.aim() * length / problem.h_range).max(Tolerance::SMALLEST),
    };
    let mut procedure = Procedure::new(heights, half_space, &problem, (tolerance, params), observer)?;
    match control {
        Control::Penetration(penetration) => procedure.increase_to(penetration)?,
        Control::MeanPressure(mean) => procedure.search(mean, expected)?,
    }
    procedure.finish(bound)
}
