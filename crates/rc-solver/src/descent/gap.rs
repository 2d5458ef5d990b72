//! The gap under a pressure, and the scaling of both.

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::descent::rows::ElementValues;
use crate::descent::sums::GapSums;
use crate::parallel;
use crate::problem::checked::Problem;
use crate::problem::control::Control;

/// Computes the gap under the pressure from a fresh application of L.
pub(crate) fn fresh_gap(
    operator: &mut (impl BlockOperator<f64> + ?Sized),
    problem: &Problem,
    elements: ElementValues<'_>,
    empty: GapSums,
) -> GapSums {
    let (layout, offset) = (operator.layout(), problem.offset());
    write_blocks(operator, elements.pressure.chunks(layout.len()), |p, values| values.copy_from_slice(p));
    operator.apply();
    let sums = read_blocks(operator, elements.blocks(layout.len()), |block, displacement| {
        block.fresh_gap(displacement, offset, empty)
    });
    GapSums::total(&layout, sums)
}

/// Multiplies the pressure by `scale`. The gap follows, since v is linear in p.
pub(crate) fn rescale(
    scale: f64,
    layout: &BlockLayout,
    problem: &Problem,
    elements: ElementValues<'_>,
    empty: GapSums,
) -> GapSums {
    let offset = problem.offset();
    GapSums::total(layout, parallel::map(elements.blocks(layout.len()), |block| block.rescale(scale, offset, empty)))
}

/// Mean of the pressure over a cell with room for `n_cell` of the smallest elements.
pub(crate) fn mean_pressure(n_cell: f64, layout: &BlockLayout, pressure: &[f64]) -> f64 {
    let [sum] = layout.total(parallel::map(pressure.chunks(layout.len()), |block| [block.iter().sum()]));
    sum / n_cell
}

/// Scales the pressure to the prescribed mean, if one is prescribed and anything presses.
///
/// The mean is over a cell with room for `n_cell` of the smallest elements.
pub(crate) fn scale_to_load(problem: &Problem, n_cell: f64, layout: &BlockLayout, pressure: &mut [f64]) {
    if let Control::MeanPressure(wanted) = problem.control {
        let mean = mean_pressure(n_cell, layout, pressure);
        if mean > 0.0 {
            let factor = wanted / mean;
            parallel::update(pressure, |value| *value *= factor);
        }
    }
}
