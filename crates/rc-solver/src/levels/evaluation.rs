//! The gap on all elements where contact is possible, and the certificate that follows from it.

use std::ops::Range;

use rc_core::Grid;
use rc_quadtree::{BLOCK_CELLS, BLOCK_TILES, CELLS};

use crate::descent::load::{has_drifted, project_to_load};
use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::outcome::Outcome;
use crate::descent::rows::ElementValues;
use crate::descent::sums::GapSums;
use crate::descent::values::Values;
use crate::levels::operator_error::{OperatorError, PressureScale};
use crate::levels::tiles::TileLevels;
use crate::parallel;
use crate::problem::steps::Step;
use crate::tiles::element_heights::block_heights;
use crate::tiles::gap_operator::{GapOperator, GapTables, PreparedGap};
use crate::tiles::mesh::Mesh;
use crate::tiles::prolongation::MeshStart;

/// Margin for the choice of candidates for contact, in units of the penetration.
///
/// Small changes of the pressure then do not add others.
pub(super) const CANDIDATE_MARGIN: f64 = 7e-3;

/// Part of the margin of elements near contact, where memory is spared.
///
/// It saves 5 to 10 % of these elements. One of seven surfaces (H = 0.3) then took another round, and 1.2 times as long.
const SPARED_MARGIN: f64 = 0.25;

/// The gap on the candidates, and the certificate that follows from it.
pub(super) struct Evaluation {
    /// The pressure, if it is not the one that was given.
    pub(super) pressed: Option<MeshStart>,
    /// The candidates at contact, if only their gap is kept.
    pub(super) kept: Option<Mesh>,
    pub(super) gap: Values,
    /// Outcome with a certificate that includes the error of the certifying operator.
    pub(super) outcome: Outcome,
    pub(super) scale: PressureScale,
    pub(super) error: OperatorError,
    /// Factor by which pressure and gap were scaled after the application of the operator.
    pub(super) scaling: f64,
}

/// What an evaluation is made of.
///
/// Of its vectors, only the gap has a value for each candidate, or for those at contact if there are very many. Pressures
/// and heights are put together block by block.
pub(super) struct Evaluated<'e, 'a> {
    pub(super) levels: &'e TileLevels<'a>,
    pub(super) grid: Grid,
    /// The candidates.
    pub(super) elements: &'e Mesh,
    pub(super) current: &'e MeshStart,
}

/// What a pass over a block of candidates has found.
struct Pass {
    sums: GapSums,
    /// Maximum of |g + h - shift|.
    size: f64,
    /// The least gap of each tile.
    lows: [f32; BLOCK_TILES],
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
        let (layout, n, spares) = (elements.layout(), elements.n_own(), levels.spares(elements.n_cells()));
        let mut gap = vec![0.0; if spares { 0 } else { n }];
        let running = Step::FreshGaps.begin();
        write_blocks(&mut *operator, layout.ranges(n), |block, cells| {
            set_pressure(elements, block, given, cells);
        });
        operator.apply();
        let empty = GapSums::empty(f64::INFINITY, problem.bounds.hardness);
        let blocks = layout.ranges(n).zip(layout.chunks_mut(&mut gap).chain(std::iter::repeat_with(Default::default)));
        let read = read_blocks(&*operator, blocks, |block, displacement| {
            self.pass(given, block, offset, |values| values.fresh_gap(displacement, offset, empty))
        });
        drop(running);
        let base = operator.base_displacement();
        let operator = spares.then_some(operator);
        let again = |gap: &mut [f64], shift: f64, change: &(dyn Fn(ElementValues<'_>) -> GapSums + Sync)| {
            let blocks = layout.ranges(gap.len()).zip(layout.chunks_mut(gap));
            self.total(&parallel::map(blocks, |block| self.pass(given, block, shift, change)))
        };
        let (mut sums, mut size) = self.total(&read);
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
        let (mut kept, mut gap) = (None, Values::Double(gap));
        if let Some(mut operator) = operator {
            operator.end();
            let lows: Vec<f32> = read.iter().flat_map(|block| block.lows).collect();
            let mesh = self.at_contact(&lows, near_contact(&outcome, levels, true));
            gap = self.gap_on(&mesh, &*operator, outcome.contact_gap);
            kept = Some(mesh);
        }
        (Evaluation { pressed, kept, gap, outcome, scale, error, scaling: scaling.unwrap_or(1.0) }, base)
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

    /// The candidates whose gap is less than `near`, and those of the last descent with the tiles around them.
    ///
    /// `lows` are the least gaps of tiles.
    fn at_contact(&self, lows: &[f32], near: f64) -> Mesh {
        let around = self.current.elements.finest().around(1);
        let is_around = |[column, row]: [u32; 2]| around.find(column.into(), row.into()).is_some();
        self.elements.chosen(|_, place, cells| f64::from(lows[cells.start / CELLS]) < near || is_around(place))
    }

    /// The gap on some of the candidates, whose displacement is computed again.
    ///
    /// Differences from the gap of contact are kept.
    fn gap_on(&self, kept: &Mesh, operator: &dyn GapOperator, origin: f64) -> Values {
        let _running = Step::FreshGaps.begin();
        let Self { levels, elements, .. } = *self;
        let (layout, offset) = (elements.layout(), levels.problem.offset());
        let mut gap = vec![0.0_f32; kept.n_own()];
        let mut rest = &mut *gap;
        let is_kept = |&[column, row]: &[u32; 2]| kept.finest().find(column.into(), row.into()).is_some();
        // Tiles of both meshes have the same order.
        let blocks = layout.ranges(elements.n_own()).map(|block| {
            let n = elements.tiles_of(block.clone()).2.iter().filter(|place| is_kept(place)).count();
            (block, rest.split_off_mut(..n * CELLS).unwrap_or_default())
        });
        read_blocks(operator, blocks.collect::<Vec<_>>().into_iter(), |(block, gap), displacement| {
            let mut room = [0.0; BLOCK_CELLS];
            let heights = &mut room[..displacement.len()];
            heights.fill(out_of_reach(levels, elements));
            block_heights(&levels.data.heights, (elements, block.clone()), heights);
            let tiles = heights.as_chunks::<CELLS>().0.iter().zip(displacement.as_chunks::<CELLS>().0);
            let places = elements.tiles_of(block).2.iter();
            let of_kept = places.zip(tiles).filter(|(place, _)| is_kept(place));
            for (gap, (_, (heights, displacement))) in gap.as_chunks_mut::<CELLS>().0.iter_mut().zip(of_kept) {
                for ((g, h), v) in gap.iter_mut().zip(heights).zip(displacement) {
                    *g = (v - (h - offset) - origin) as f32;
                }
            }
        });
        Values::Single { origin, differences: gap }
    }

    /// Changes a block of the gap, which is not kept if it has no room.
    ///
    /// `shift` is that of [`Pass::size`].
    fn pass(
        &self,
        given: &MeshStart,
        (block, gap): (Range<usize>, &mut [f64]),
        shift: f64,
        change: impl Fn(ElementValues<'_>) -> GapSums,
    ) -> Pass {
        let Self { levels, elements, .. } = *self;
        let (mut room, mut streamed) = ([[0.0; BLOCK_CELLS]; 2], [0.0; BLOCK_CELLS]);
        let [heights, pressure] = room.each_mut().map(|room| &mut room[..block.len()]);
        let gap = if gap.is_empty() { &mut streamed[..block.len()] } else { gap };
        heights.fill(out_of_reach(levels, elements));
        block_heights(&levels.data.heights, (elements, block.clone()), heights);
        set_pressure(elements, block, given, pressure);
        let sums = change(ElementValues { heights, pressure, gap: &mut *gap });
        let mut lows = [f32::INFINITY; BLOCK_TILES];
        for (low, gap) in lows.iter_mut().zip(gap.as_chunks::<CELLS>().0) {
            *low = gap.iter().fold(f32::INFINITY, |low, &g| low.min(g as f32));
        }
        let sizes = heights.iter().zip(gap).map(|(h, g)| (*g + (h - shift)).abs());
        Pass { sums, size: sizes.fold(0.0, f64::max), lows }
    }

    /// The sums over all blocks, and the maximum of their sizes.
    fn total(&self, blocks: &[Pass]) -> (GapSums, f64) {
        let sums = blocks.iter().map(|block| block.sums).collect();
        let size = blocks.iter().map(|block| block.size).fold(0.0, f64::max);
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

/// The gap below which elements are near contact, which are fewer if memory `is_spared`.
pub(super) fn near_contact(outcome: &Outcome, levels: &TileLevels<'_>, is_spared: bool) -> f64 {
    // Elements that are nearer to contact than the error may still come into contact.
    let part = if is_spared { SPARED_MARGIN } else { 1.0 };
    let error = match outcome.mean_pressure {
        // If coarser levels have lost a contact that they hardly resolve, there is no pressure. The contact begins
        // anew.
        0.0 => CANDIDATE_MARGIN * (levels.problem.h_max - levels.problem.h_mean),
        _ => part * outcome.certificate.penetration * levels.problem.h_range,
    };
    outcome.contact_gap + error
}

/// The height of values that stand for no element.
pub(super) fn out_of_reach(levels: &TileLevels<'_>, elements: &Mesh) -> f64 {
    levels.problem.out_of_reach(elements.finest().sides().into_iter().product())
}
