//! The features of a problem that the table of capabilities knows.

use rc_core::{Boundary, DVec2};

use crate::levels::base_grid::base_sides;
use crate::problem::capabilities::{Feature, Refusal, refusal};
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::problem::method::Method;
use crate::problem::method_reason::MethodReason;
use crate::solve::error::SolveError;
use crate::solve::params::SolveParams;
use crate::tiles::ladder::{Ladder, has_squares};

/// The features of a problem that are known before its heights are evaluated.
pub(crate) fn features(problem: &ContactProblem<'_>, params: &SolveParams) -> Vec<Feature> {
    let (heights, kernel) = (&problem.heights, problem.kernel.get());
    let is_layer = kernel.uniform_displacement().is_some();
    let is_sliding = kernel.sliding_velocity().is_some();
    let has_tails = || kernel.split().is_some() && kernel.sliding_modes().is_some() && !is_uneven(problem, params);
    let (has_border, has_ranks) = (params.border_level > 0, problem.is_shared());
    let all = [
        (Feature::Line, heights.grid().ny() == 1 && problem.boundary() == Boundary::Periodic),
        (Feature::Layer, is_layer),
        (Feature::Sliding, is_sliding),
        (Feature::LagOnGrid, is_sliding && !has_tails()),
        (Feature::OwnKernel, kernel.split().is_none() && !is_sliding),
        (Feature::OtherSolid, !is_layer && kernel.split().is_some_and(|split| split.deviates_below(0.0) > 0.0)),
        (Feature::FreeBorders, problem.boundary() == Boundary::Free),
        (Feature::Penetration, matches!(problem.control, Control::Penetration(_))),
        (Feature::Hardness, problem.hardness.is_finite()),
        (Feature::HeightMap, heights.map().is_some()),
        (Feature::OblongGrid, !heights.grid().is_square()),
        (Feature::OblongElements, !has_squares(heights.grid())),
        (Feature::UnevenGrid, (has_border || has_ranks) && is_uneven(problem, params)),
        (Feature::BorderLevel, has_border),
        (Feature::Ranks, has_ranks),
        (Feature::Checkpoint, problem.checkpoint.is_some()),
    ];
    all.into_iter().filter_map(|(feature, is_there)| is_there.then_some(feature)).collect()
}

/// Whether the levels of the adaptive method do not all halve each other.
fn is_uneven(problem: &ContactProblem<'_>, params: &SolveParams) -> bool {
    let base = base_sides(&problem.heights, params.base_side, problem.boundary());
    base.is_ok_and(|base| !Ladder::new(base, problem.heights.grid()).is_even())
}

/// [`refusal`] with the numbers of this problem.
pub(super) fn refusal_of(
    problem: &ContactProblem<'_>,
    features: &[Feature],
    method: Option<Method>,
) -> Option<Refusal> {
    let refused = refusal(features, method)?;
    let grid = problem.heights.grid();
    Some(match refused.object {
        Feature::OwnKernel => refused.noted(problem.kernel.get().name()),
        Feature::OblongElements => {
            let DVec2 { x, y } = grid.spacing();
            refused.noted(format_args!("those of {grid} are {x:.3e} by {y:.3e}"))
        }
        _ => refused,
    })
}

/// Refuses several ranks for a problem that the uniform method solves for this reason.
///
/// Ranks do not change the method, because results must not depend on their number.
pub(super) fn check_ranks(problem: &ContactProblem<'_>, reason: &MethodReason) -> Result<(), SolveError> {
    match refusal(&[Feature::Ranks], Some(Method::Uniform)) {
        Some(refused) if problem.is_shared() => Err(refused.noted(reason).into()),
        _ => Ok(()),
    }
}
