//! The gap under a pressure, and the scaling of both.

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::descent::rows::ElementValues;
use crate::descent::sums::GapSums;
use crate::parallel;
use crate::problem::checked::Problem;
use crate::problem::steps::Step;

/// Computes the gap under the pressure from a fresh application of L.
pub(crate) fn fresh_gap(
    operator: &mut (impl BlockOperator<f64> + ?Sized),
    problem: &Problem,
    elements: ElementValues<'_>,
    empty: GapSums,
) -> GapSums {
    let _running = Step::FreshGaps.begin();
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
