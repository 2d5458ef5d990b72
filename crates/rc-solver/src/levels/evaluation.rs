//! The gap on all elements where contact is possible, and the certificate that follows from it.

use std::ops::Range;

use rc_core::Grid;
use rc_quadtree::{BLOCK_CELLS, CELLS};

use crate::descent::load::{has_drifted, project_to_load};
use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::outcome::Outcome;
use crate::descent::rows::ElementValues;
use crate::descent::sums::GapSums;
use crate::levels::operator_error::{OperatorError, PressureScale};
use crate::levels::tiles::TileLevels;
use crate::parallel;
use crate::problem::steps::Step;
use crate::tiles::element_heights::block_heights;
use crate::tiles::gap_operator::{GapTables, PreparedGap};
use crate::tiles::mesh::Mesh;
use crate::tiles::prolongation::MeshStart;

/// The gap on all candidates, and the certificate that follows from it.
pub(super) struct Evaluation {
    /// The pressure, if it is not the one that was given.
    pub(super) pressed: Option<MeshStart>,
    pub(super) gap: Vec<f64>,
    /// Outcome with a certificate that includes the error of the certifying operator.
    pub(super) outcome: Outcome,
    pub(super) scale: PressureScale,
    pub(super) error: OperatorError,
    /// Factor by which pressure and gap were scaled after the application of the operator.
    pub(super) scaling: f64,
}

/// What an evaluation is made of.
///
/// Of its vectors, only the gap has a value for each candidate. Pressures and heights are put together block by block.
pub(super) struct Evaluated<'e, 'a> {
    pub(super) levels: &'e TileLevels<'a>,
    pub(super) grid: Grid,
    /// The candidates.
    pub(super) elements: &'e Mesh,
    pub(super) current: &'e MeshStart,
}

impl Evaluated<'_, '_> {
    /// The evaluation, and the displacement of the base grid ([`GapOperator::base_displacement`]).
    ///
    /// [`GapOperator::base_displacement`]: crate::tiles::gap_operator::GapOperator::base_displacement
    pub(super) fn evaluate(&self, (prepared, tables): (&PreparedGap, &GapTables)) -> (Evaluation, Vec<f64>) {
        let Self { levels, elements, current, .. } = *self;
        let (problem, offset) = (&levels.problem, levels.problem.offset());
        let mut operator = levels.operator(levels.hierarchy(elements, prepared.reach()), tables, current);
        let mut pressed = self.on_all_elements();
        let given = pressed.as_ref().unwrap_or(current);
        let (layout, mut gap) = (elements.layout(), vec![0.0; elements.n_own()]);
        let running = Step::FreshGaps.begin();
        write_blocks(&mut *operator, layout.ranges(gap.len()), |block, cells| {
            set_pressure(elements, block, given, cells);
        });
        operator.apply();
        let empty = GapSums::empty(f64::INFINITY, problem.bounds.hardness);
        let blocks = layout.ranges(gap.len()).zip(layout.chunks_mut(&mut gap));
        let read = read_blocks(&*operator, blocks, |block, displacement| {
            self.pass(given, block, offset, |values| values.fresh_gap(displacement, offset, empty))
        });
        drop(running);
        let base = operator.base_displacement();
        drop(operator);
        let again = |gap: &mut [f64], shift: f64, change: &(dyn Fn(ElementValues<'_>) -> GapSums + Sync)| {
            let blocks = layout.ranges(gap.len()).zip(layout.chunks_mut(gap));
            self.total(parallel::map(blocks, |block| self.pass(given, block, shift, change)))
        };
        let (mut sums, mut size) = self.total(read);
        let scaling = sums.scale_to_penetration(problem);
        if let Some(scale) = scaling {
            (sums, size) = again(&mut gap, offset, &|values| values.rescale(scale, offset, empty));
        }
        let mut outcome = Outcome::new(problem, &sums, self.grid.len() as f64, true);
        let uniform = problem.uniform_displacement(outcome.mean_pressure);
        if uniform.abs() > 0.0 {
            (_, size) = again(&mut gap, offset + uniform, &|_| empty);
        }
        if let Some(scale) = scaling {
            let MeshStart { elements, mut pressure } = pressed.unwrap_or_else(|| current.clone());
            parallel::update(&mut pressure, |p| *p *= scale);
            pressed = Some(MeshStart { elements, pressure });
        }
        let MeshStart { elements: mesh, pressure } = pressed.as_ref().unwrap_or(current);
        let n_levels = (levels.n_levels(self.grid), levels.data.kernels.unresolved());
        let scale = PressureScale::new((mesh, pressure), n_levels, size, outcome.energy_length(problem));
        // Descents leave room for the error of the certifying operator.
        let error = OperatorError::of(levels.certified().split(), &scale, problem.bounds.control);
        outcome.iteration_error = outcome.certificate.energy;
        outcome.certificate = error.added_to(outcome.certificate, problem.h_range);
        (Evaluation { pressed, gap, outcome, scale, error, scaling: scaling.unwrap_or(1.0) }, base)
    }

    /// The pressure on all candidates, brought to its bounds and load, if one of these is needed.
    ///
    /// Elements that are of several sizes may have been divided. Over ranks, pressures may be those of another rank.
    fn on_all_elements(&self) -> Option<MeshStart> {
        let Self { levels, elements, current, .. } = *self;
        let (bounds, n_cell) = (levels.problem.bounds, self.grid.len() as f64);
        if elements.levels().len() == 1 && elements.ranks().size() == 1 && !bounds.is_limited() {
            return None;
        }
        let mut pressure = current.elements.moved(elements, &current.pressure, 0.0);
        let layout = elements.layout();
        if has_drifted(bounds, n_cell, &layout, &pressure) {
            project_to_load(&levels.problem, n_cell, &layout, &mut pressure, None);
        }
        Some(MeshStart { elements: elements.clone(), pressure })
    }

    /// Changes a block of the gap. Returns its sums, and the maximum of |g + h - `shift`|.
    fn pass(
        &self,
        given: &MeshStart,
        (block, gap): (Range<usize>, &mut [f64]),
        shift: f64,
        change: impl Fn(ElementValues<'_>) -> GapSums,
    ) -> (GapSums, f64) {
        let Self { levels, elements, .. } = *self;
        let mut room = [[0.0; BLOCK_CELLS]; 2];
        let [heights, pressure] = room.each_mut().map(|room| &mut room[..gap.len()]);
        heights.fill(out_of_reach(levels, elements));
        block_heights(&levels.data.heights, (elements, block.clone()), heights);
        set_pressure(elements, block, given, pressure);
        let sums = change(ElementValues { heights, pressure, gap: &mut *gap });
        let sizes = heights.iter().zip(gap).map(|(h, g)| (*g + (h - shift)).abs());
        (sums, sizes.fold(0.0, f64::max))
    }

    /// The sums over all blocks, and the maximum of their second values.
    fn total(&self, blocks: Vec<(GapSums, f64)>) -> (GapSums, f64) {
        let (sums, sizes): (Vec<GapSums>, Vec<f64>) = blocks.into_iter().unzip();
        let size = sizes.into_iter().fold(0.0, f64::max);
        (GapSums::total(&self.elements.layout(), sums), self.elements.ranks().maximum(size, 0.0))
    }
}

/// Writes a block of the pressure, which is zero where none is `given`.
fn set_pressure(elements: &Mesh, block: Range<usize>, given: &MeshStart, cells: &mut [f64]) {
    cells.fill(0.0);
    let (coarser, _, places) = elements.tiles_of(block);
    for (cells, &place) in cells.as_chunks_mut::<CELLS>().0.iter_mut().zip(places) {
        if let Some(values) = given.elements.tile(coarser, place, &given.pressure) {
            *cells = *values;
        }
    }
}

/// The height of values that stand for no element.
pub(super) fn out_of_reach(levels: &TileLevels<'_>, elements: &Mesh) -> f64 {
    levels.problem.out_of_reach(elements.finest().sides().into_iter().product())
}
