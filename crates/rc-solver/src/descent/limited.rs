//! Load and penetration where a hardness H limits pressures.
//!
//! Scaling would move the pressures of plastic elements away from the hardness, or others beyond it. So pressures p
//! change along p (1 - p/H) instead. Elements at 0 and at H keep their pressure. Others stay between these bounds for
//! multiples from -1 to 1. Where p is far below H, the change is a scaling.

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::rows;
use crate::descent::rows::{ElementValues, Gradient};
use crate::descent::shares::{Load, Shares};
use crate::descent::state::Descent;
use crate::descent::sums::GapSums;
use crate::parallel;
use crate::problem::checked::Problem;
use crate::problem::control::Control;

/// Relative distance below the hardness within which pressures count as the hardness: prolongation rounds.
const SNAP: f64 = 1e-12;

/// Part of the hardness from which pressures of a start are plastic.
const NEARLY: f64 = 1.0 - 1e-9;

/// Relative error that a mean pressure may have, from rounding of its sum.
const ROUNDING: f64 = 1e-12;

/// Maximum number of steps along p (1 - p/H).
///
/// If elements between the bounds cannot take the whole load in these steps, other elements take the rest.
const MAX_STEPS: usize = 2;

/// Limits of the change of the pressure in one step, relative to p (1 - p/H).
const STEPS: [f64; 2] = [-0.5, 1.0];

/// First range of gaps or heights in which elements are looked for.
///
/// It is relative to the range of depths. The two numbers below say how often it is doubled at most, and how often it
/// is halved then.
const FIRST_RANGE: f64 = 1e-3;
const MAX_DOUBLINGS: usize = 14;
const MAX_HALVINGS: usize = 40;

/// Margin on the factor by which the present projection multiplies pressures.
///
/// If even this multiple stays below the hardness, the hardness is not considered.
const MARGIN: f64 = 2.0;

/// Whether a start has reached the hardness.
pub(crate) fn is_plastic(pressure: &[f64], hardness: f64) -> bool {
    hardness.is_finite() && parallel::maximum(pressure, 0.0) >= NEARLY * hardness
}

/// Limits the pressure by the hardness and, under load control, restores the load.
///
/// The cell has room for `n_cell` of the smallest elements. If elements between the bounds cannot restore the load,
/// others do. If load is missing, they are those with the smallest `order`, a gap. If there is too much load, they are
/// those with the largest `order`.
pub(crate) fn limit_to_load(
    problem: &Problem,
    n_cell: f64,
    layout: &BlockLayout,
    pressure: &mut [f64],
    order: Option<&[f64]>,
) {
    let hardness = problem.hardness;
    let bound = hardness * (1.0 - SNAP);
    parallel::update(pressure, |p| *p = if *p >= bound { hardness } else { p.max(0.0) });
    let Control::MeanPressure(mean) = problem.control else { return };
    let wanted = mean * n_cell;
    for _ in 0..MAX_STEPS {
        let [load, room] = sums_of(layout, pressure, hardness);
        let missing = wanted - load;
        if missing.abs() <= ROUNDING * wanted {
            return;
        }
        if room <= 0.0 {
            break;
        }
        // If less is missing than the bounds allow, the factor takes all of it.
        let factor = (missing / room).clamp(-1.0, 1.0);
        parallel::update(pressure, |p| *p = along(*p, factor, hardness));
    }
    let [load, _] = sums_of(layout, pressure, hardness);
    match order {
        Some(order) => fill(problem, wanted - load, layout, (pressure, order)),
        None if load > wanted => parallel::update(pressure, |p| *p *= wanted / load),
        None => {}
    }
}

/// The pressure `p` after a step of `factor` along p (1 - p/H).
fn along(p: f64, factor: f64, hardness: f64) -> f64 {
    (p + factor * direction(p, hardness)).clamp(0.0, hardness)
}

/// The direction p (1 - p/H).
fn direction(p: f64, hardness: f64) -> f64 {
    p * (1.0 - p / hardness)
}

/// Σ p and Σ p (1 - p/H).
fn sums_of(layout: &BlockLayout, pressure: &[f64], hardness: f64) -> [f64; 2] {
    layout.total(parallel::map(pressure.chunks(layout.len()), |block| {
        block.iter().fold([0.0; 2], |[load, room], &p| [load + p, room + direction(p, hardness)])
    }))
}

/// Adds the load `missing`, which may be negative.
///
/// If it is positive, elements get the hardness one after the other, from the smallest `order`, a gap, on. If it is
/// negative, elements lose their pressure, from the largest `order` on. The last ones get or lose a part.
fn fill(problem: &Problem, missing: f64, layout: &BlockLayout, (pressure, order): (&mut [f64], &[f64])) {
    let (hardness, adds) = (problem.hardness, missing > 0.0);
    let key = |at: f64| if adds { at } else { -at };
    let room = |p: f64| if adds { hardness - p } else { p };
    let blocks = || pressure.chunks(layout.len()).zip(order.chunks(layout.len()));
    let rooms = |limit: f64| {
        let sums = parallel::map(blocks(), |(p, order)| {
            [p.iter().zip(order).filter(|(_, at)| key(**at) <= limit).map(|(p, _)| room(*p)).sum()]
        });
        let [sum] = layout.total(sums);
        sum
    };
    let least = parallel::map(blocks(), |(p, order)| {
        let keys = p.iter().zip(order).filter(|(p, _)| room(**p) > 0.0).map(|(_, at)| key(*at));
        keys.fold(f64::INFINITY, f64::min)
    });
    let least = least.into_iter().fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return;
    }
    let wanted = missing.abs();
    // A flat patch has no range of depths.
    let depths = if problem.h_range > 0.0 { problem.depth_range() } else { problem.unit() };
    let mut width = FIRST_RANGE * depths;
    for _ in 0..MAX_DOUBLINGS {
        if rooms(least + width) >= wanted {
            break;
        }
        width *= 2.0;
    }
    // All elements below `low` are filled, and a part of those between `low` and `high`.
    let (mut low, mut high) = (f64::NEG_INFINITY, least + width);
    for _ in 0..MAX_HALVINGS {
        let middle = 0.5 * (low.max(least) + high);
        if rooms(middle) >= wanted { high = middle } else { low = middle }
    }
    let (below, within) = (rooms(low), rooms(high));
    let part = if within > below { ((wanted - below) / (within - below)).min(1.0) } else { 0.0 };
    parallel::for_each(pressure.chunks_mut(layout.len()).zip(order.chunks(layout.len())), |(p, order)| {
        for (p, at) in p.iter_mut().zip(order) {
            let part = match key(*at) {
                at if at <= low => 1.0,
                at if at <= high => part,
                _ => continue,
            };
            *p = match (adds, part >= 1.0) {
                (true, true) => hardness,
                (false, true) => 0.0,
                (true, false) => (*p + part * (hardness - *p)).min(hardness),
                (false, false) => *p * (1.0 - part),
            };
        }
    });
}

impl Descent<'_> {
    /// Whether the hardness may limit pressures when the loads of squares are shared out.
    ///
    /// This is never so without a hardness.
    pub(crate) fn is_limited(&self, shares: &Shares) -> bool {
        let hardness = self.problem.hardness;
        hardness.is_finite() && MARGIN * shares.maximum() * parallel::maximum(&self.pressure, 0.0) >= hardness
    }

    /// Limits the pressure and restores the load, in the order of gaps.
    ///
    /// Before gaps are known, depths are in their place.
    pub(crate) fn limit_pressure(&mut self) {
        let (n_cell, layout) = (self.n_cell(), self.layout.clone());
        limit_to_load(self.problem, n_cell, &layout, &mut self.pressure, Some(&self.gap));
    }

    /// Limits the pressure of a start and restores its load. No gap is known.
    ///
    /// The gap comes from a fresh application of L.
    pub(crate) fn limit_start(&mut self) -> GapSums {
        for (g, h) in self.gap.iter_mut().zip(self.heights) {
            *g = -h;
        }
        self.limit_pressure();
        let sums = self.fresh_gap();
        self.settle(sums)
    }

    /// Limits a start that has pressures beyond the hardness, as [`Descent::limit_start`].
    pub(crate) fn limited(&mut self, sums: GapSums) -> GapSums {
        if sums.max_pressure > self.problem.hardness { self.limit_start() } else { sums }
    }

    /// Ends a step that was clipped: restores the load, or follows the penetration.
    ///
    /// Each part of the load is restored where it was.
    pub(crate) fn project_limited(
        &mut self,
        n_clipped: u64,
        (loads, shares): (&[Load], &Shares),
        gradient: &Gradient,
    ) -> GapSums {
        if n_clipped == 0 {
            // Single precision changes the load a little. This waits for a fresh gap.
            let sums = self.rescale(1.0);
            return self.follow_penetration(sums);
        }
        let before = self.pressure.clone();
        self.share_limited(loads, shares);
        self.limit_pressure();
        let (len, offset, range) = (self.layout.len(), self.problem.offset(), self.problem.unit());
        let blocks = self.pressure.chunks(len).zip(before.chunks(len)).zip(self.directions.added().chunks(len));
        write_blocks(&mut *self.operators.corrections, blocks, |((pressure, before), added), written| {
            for (((p, before), added), written) in pressure.iter().zip(before).zip(added).zip(written) {
                *written = ((p - before) * gradient.unit) as f32 + added;
            }
        });
        self.info.operator_applications += 1;
        self.operators.corrections.apply();
        let empty = GapSums::empty(self.pressed, self.problem.hardness);
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let sums = read_blocks(&*self.operators.corrections, elements.blocks(len), |block, displacement| {
            block.add_clipped(displacement, range, 1.0, offset, empty)
        });
        let sums = GapSums::total(&self.layout, sums);
        self.pressed = sums.next_pressed();
        self.follow_penetration(sums)
    }

    /// Brings the loads of squares to the wanted ones, as far as pressures allow.
    ///
    /// Only pressures between the bounds change.
    fn share_limited(&mut self, loads: &[Load], shares: &Shares) {
        let (len, squares, layout) = (self.layout.len(), self.squares(), &self.layout);
        let hardness = self.problem.hardness;
        let of_blocks = parallel::map(self.pressure.chunks(len).enumerate(), |(i, block)| {
            let mut rooms: Vec<(usize, f64)> = Vec::new();
            layout.for_each_run(i, block.len(), |run, place| {
                let room: f64 = block[run].iter().map(|&p| direction(p, hardness)).sum();
                match rooms.last_mut() {
                    Some((square, sum)) if *square == squares.at(place) => *sum += room,
                    _ => rooms.push((squares.at(place), room)),
                }
            });
            rooms
        });
        let mut rooms = vec![0.0; loads.len()];
        for (i, block) in of_blocks.into_iter().enumerate() {
            for (square, room) in block {
                rooms[square] += layout.area(i) * room;
            }
        }
        let changes = shares.changes(&rooms);
        parallel::for_each(self.pressure.chunks_mut(len).enumerate(), |(i, block)| {
            layout.for_each_run(i, block.len(), |run, place| {
                let factor = changes.at(place).clamp(STEPS[0], STEPS[1]);
                block[run].iter_mut().for_each(|p| *p = along(*p, factor, hardness));
            });
        });
    }

    /// Brings the pressure nearer to the prescribed penetration, if one is prescribed.
    ///
    /// It scales the pressure if that meets no bound. Otherwise it moves along p (1 - p/H) to the minimum energy. The
    /// stiffness of that direction preconditions the mean.
    fn follow_penetration(&mut self, sums: GapSums) -> GapSums {
        if !matches!(self.problem.control, Control::Penetration(_)) || sums.may_scale() {
            return self.meet_penetration(sums);
        }
        let (len, hardness) = (self.layout.len(), self.problem.hardness);
        let (unit, range) = (self.problem.unit().recip(), self.problem.unit());
        self.info.operator_applications += 1;
        let corrections = &mut *self.operators.corrections;
        write_blocks(corrections, self.pressure.chunks(len), |pressure, values| {
            for (&p, value) in pressure.iter().zip(values) {
                *value = (direction(p, hardness) * unit) as f32;
            }
        });
        corrections.apply();
        let kept = self.directions.displacements_mut(len);
        let blocks = self.pressure.chunks(len).zip(self.gap.chunks(len)).zip(kept);
        let products = read_blocks(corrections, blocks, |((pressure, gap), kept), displacement| {
            kept.copy_from_slice(displacement);
            rows::products(pressure, gap, displacement, |p| direction(p, hardness))
        });
        let [whole, with_gap, with_displacement] = self.layout.total(products);
        let curvature = range * with_displacement;
        let stiffness = whole * whole / (self.info.grid.len() as f64 * curvature);
        if !(curvature > 0.0 && stiffness.is_finite() && stiffness > 0.0) {
            return self.settle(sums);
        }
        corrections.set_mean(stiffness);
        let factor = (-with_gap / curvature).clamp(STEPS[0], STEPS[1]);
        let (offset, empty) = (self.problem.offset(), GapSums::empty(self.pressed, hardness));
        let elements = ElementValues { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let blocks = elements.blocks(len).zip(self.directions.added().chunks(len));
        let sums = parallel::map(blocks, |(block, displacement)| {
            for ((p, g), u) in block.pressure.iter_mut().zip(block.gap.iter_mut()).zip(displacement) {
                *p = along(*p, factor, hardness);
                *g += factor * range * f64::from(*u);
            }
            block.rescale(1.0, offset, empty)
        });
        let sums = GapSums::total(&self.layout, sums);
        self.pressed = sums.next_pressed();
        self.settle(sums)
    }
}
