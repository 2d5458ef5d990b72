//! The gap under a pressure, and the scaling of both.

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::descent::sums::GapSums;
use crate::descent::values::ElementVectors;
use crate::parallel;
use crate::problem::checked::Problem;
use crate::problem::steps::Step;

/// Computes the gap under the pressure from a fresh application of L.
pub(crate) fn fresh_gap(
    operator: &mut (impl BlockOperator<f64> + ?Sized),
    problem: &Problem,
    elements: ElementVectors<'_>,
    empty: GapSums,
) -> GapSums {
    let _running = Step::FreshGaps.begin();
    let (layout, offset) = (operator.layout(), problem.offset());
    let (pressure, n) = (&*elements.pressure, elements.pressure.len());
    write_blocks(operator, layout.ranges(n), |block, values| values.copy_from_slice(&pressure.part(block)));
    operator.apply();
    let sums = read_blocks(operator, elements.blocks(layout.len()), |block, displacement| {
        block.with_heights(|values| values.fresh_gap(displacement, offset, empty))
    });
    GapSums::total(&layout, sums)
}

/// Multiplies the pressure by `scale`. The gap follows, since v is linear in p.
pub(crate) fn rescale(
    scale: f64,
    layout: &BlockLayout,
    problem: &Problem,
    elements: ElementVectors<'_>,
    empty: GapSums,
) -> GapSums {
    let offset = problem.offset();
    let sums = parallel::map(elements.blocks(layout.len()), |block| {
        block.with_heights(|values| values.rescale(scale, offset, empty))
    });
    GapSums::total(layout, sums)
}
