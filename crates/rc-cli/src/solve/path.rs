//! What the steps of a history change.

use rc_core::Field;
use rc_fractal::height_and_slope_of_grid;
use rc_solver::History;
use rc_sweep::PathDifference;

/// The results in `steps` steps to each load against those in one, on the surface with these `heights`.
pub(super) fn difference(steps: usize, heights: &Field, [one, stepped]: [&History<'_>; 2]) -> PathDifference {
    let relative = |of: &dyn Fn(&History<'_>) -> f64| {
        let [before, after] = [of(one), of(stepped)];
        // Without flow in both there is no difference.
        let difference = after - before;
        if difference.abs() > 0.0 { difference / before } else { 0.0 }
    };
    PathDifference {
        steps,
        area_fraction: relative(&|found| found.solution.area().fraction),
        removed_volume: relative(&|found| heights.mean() - found.residual.mean()),
        residual_rms_height: relative(&|found| height_and_slope_of_grid(&found.residual)[0]),
    }
}
