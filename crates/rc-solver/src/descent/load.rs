//! The projection of a pressure to its bounds and its load.
//!
//! Pressures change along p (1 - p/H), which is a scaling if there is no hardness H. If elements between the bounds
//! cannot take the whole load, others do, in the order of their gaps.

use crate::descent::layout::BlockLayout;
use crate::parallel;
use crate::problem::bounds::Bounds;
use crate::problem::checked::Problem;

/// Part of the hardness from which a pressure is plastic.
const NEARLY: f64 = 1.0 - 1e-9;

/// Relative error that a mean pressure may have, from rounding of its sum.
const ROUNDING: f64 = 1e-12;

/// Maximum number of steps along p (1 - p/H).
///
/// If elements between the bounds cannot take the whole load in these steps, other elements take the rest.
const MAX_STEPS: usize = 2;

/// First range of gaps or heights in which elements are looked for.
///
/// It is relative to the range of depths. The two numbers below say how often it is doubled at most, and how often it
/// is halved then.
const FIRST_RANGE: f64 = 1e-3;
const MAX_DOUBLINGS: usize = 14;
const MAX_HALVINGS: usize = 40;

/// Whether a pressure has reached the hardness.
pub(crate) fn is_plastic(pressure: &[f64], bounds: Bounds) -> bool {
    bounds.is_limited() && parallel::maximum(pressure, 0.0) >= NEARLY * bounds.hardness
}

/// Whether single precision has moved a pressure with a hardness away from its bounds or its load.
///
/// It is never so without a hardness, because scaling sets the load after each step then. A hardness that nothing
/// reaches must not change a digit.
pub(crate) fn has_drifted(bounds: Bounds, n_cell: f64, layout: &BlockLayout, pressure: &[f64]) -> bool {
    let is_off = |mean: f64| (mean_pressure(n_cell, layout, pressure) / mean - 1.0).abs() > ROUNDING;
    bounds.is_limited() && (is_plastic(pressure, bounds) || bounds.mean().is_some_and(is_off))
}

/// Mean of the pressure over a cell with room for `n_cell` of the smallest elements.
pub(crate) fn mean_pressure(n_cell: f64, layout: &BlockLayout, pressure: &[f64]) -> f64 {
    let [sum] = layout.total(parallel::map(pressure.chunks(layout.len()), |block| [block.iter().sum()]));
    sum / n_cell
}

/// Brings the pressure between its bounds and, if a mean is prescribed, to that mean.
///
/// The cell has room for `n_cell` of the smallest elements. Elements between the bounds take the load, as far as they
/// can. Others take the rest if their `order`, a gap, is known. If load is missing, they are those with the smallest
/// gap. If there is too much load, they are those with the largest gap.
pub(crate) fn project_to_load(
    problem: &Problem,
    n_cell: f64,
    layout: &BlockLayout,
    pressure: &mut [f64],
    order: Option<&[f64]>,
) {
    let bounds = problem.bounds;
    if bounds.is_limited() {
        parallel::update(pressure, |p| *p = bounds.clip(*p));
    }
    let Some(mean) = bounds.mean() else { return };
    let present = mean_pressure(n_cell, layout, pressure);
    let scale = mean / present;
    let may_scale = || scale.max(1.0) * parallel::maximum(pressure, 0.0) < NEARLY * bounds.hardness;
    if present > 0.0 && (!bounds.is_limited() || may_scale()) {
        parallel::update(pressure, |p| *p *= scale);
        return;
    }
    if bounds.is_limited() {
        let missing = move_along(bounds, mean * n_cell, layout, pressure);
        match order {
            Some(order) => Filling { problem, layout, order, missing }.fill(pressure),
            None if missing < 0.0 => {
                let scale = mean * n_cell / (mean * n_cell - missing);
                parallel::update(pressure, |p| *p *= scale);
            }
            None => {}
        }
    }
}

/// Moves pressures along p (1 - p/H) towards the load `wanted`. Returns the load that is still missing.
fn move_along(bounds: Bounds, wanted: f64, layout: &BlockLayout, pressure: &mut [f64]) -> f64 {
    let sums_of = |pressure: &[f64]| {
        layout.total(parallel::map(pressure.chunks(layout.len()), |block| {
            block.iter().fold([0.0; 2], |[load, room], &p| [load + p, room + bounds.direction(p)])
        }))
    };
    for _ in 0..MAX_STEPS {
        let [load, room] = sums_of(pressure);
        let missing = wanted - load;
        if missing.abs() <= ROUNDING * wanted {
            return 0.0;
        }
        if room <= 0.0 {
            return missing;
        }
        // If less is missing than the bounds allow, the factor takes all of it.
        let factor = (missing / room).clamp(-1.0, 1.0);
        parallel::update(pressure, |p| *p = bounds.along(*p, factor));
    }
    let [load, _] = sums_of(pressure);
    wanted - load
}

/// The load `missing`, which may be negative, for elements in the `order` of their gaps.
struct Filling<'a> {
    problem: &'a Problem,
    layout: &'a BlockLayout,
    order: &'a [f64],
    missing: f64,
}

impl Filling<'_> {
    /// Adds the load that is missing.
    ///
    /// If it is positive, elements get the hardness one after the other, from the smallest gap on. If it is negative,
    /// elements lose their pressure, from the largest gap on. The last ones get or lose a part.
    fn fill(&self, pressure: &mut [f64]) {
        let Some([low, high]) = self.limits(pressure) else { return };
        let (below, within) = (self.room(pressure, low), self.room(pressure, high));
        let part = if within > below { ((self.missing.abs() - below) / (within - below)).min(1.0) } else { 0.0 };
        let (len, bounds) = (self.layout.len(), self.problem.bounds);
        // The pressure of an element that is filled or emptied.
        let end = if self.missing > 0.0 { bounds.hardness } else { 0.0 };
        parallel::for_each(pressure.chunks_mut(len).zip(self.order.chunks(len)), |(p, order)| {
            for (p, at) in p.iter_mut().zip(order) {
                match self.key(*at) {
                    at if at <= low => *p = end,
                    at if at <= high => *p = if part >= 1.0 { end } else { bounds.clip(*p + part * (end - *p)) },
                    _ => {}
                }
            }
        });
    }

    /// Keys between which elements are filled in part. Below the first they are filled whole.
    fn limits(&self, pressure: &[f64]) -> Option<[f64; 2]> {
        let len = self.layout.len();
        let least = parallel::map(pressure.chunks(len).zip(self.order.chunks(len)), |(p, order)| {
            let keys = p.iter().zip(order).filter(|(p, _)| self.room_of(**p) > 0.0).map(|(_, at)| self.key(*at));
            keys.fold(f64::INFINITY, f64::min)
        });
        let least = least.into_iter().fold(f64::INFINITY, f64::min);
        let (problem, wanted) = (self.problem, self.missing.abs());
        if !least.is_finite() || wanted == 0.0 {
            return None;
        }
        // A flat patch has no range of depths.
        let mut width = FIRST_RANGE * if problem.h_range > 0.0 { problem.depth_range() } else { problem.unit() };
        for _ in 0..MAX_DOUBLINGS {
            if self.room(pressure, least + width) >= wanted {
                break;
            }
            width *= 2.0;
        }
        let (mut low, mut high) = (f64::NEG_INFINITY, least + width);
        for _ in 0..MAX_HALVINGS {
            let middle = 0.5 * (low.max(least) + high);
            if self.room(pressure, middle) >= wanted { high = middle } else { low = middle }
        }
        Some([low, high])
    }

    /// The place of an element in the order in which elements take load.
    fn key(&self, gap: f64) -> f64 {
        if self.missing > 0.0 { gap } else { -gap }
    }

    /// The load that an element of this pressure may take.
    fn room_of(&self, p: f64) -> f64 {
        if self.missing > 0.0 { self.problem.bounds.hardness - p } else { p }
    }

    /// The load that all elements up to the key `limit` may take.
    fn room(&self, pressure: &[f64], limit: f64) -> f64 {
        let len = self.layout.len();
        let sums = parallel::map(pressure.chunks(len).zip(self.order.chunks(len)), |(p, order)| {
            [p.iter().zip(order).filter(|(_, at)| self.key(**at) <= limit).map(|(p, _)| self.room_of(*p)).sum()]
        });
        let [sum] = self.layout.total(sums);
        sum
    }
}
