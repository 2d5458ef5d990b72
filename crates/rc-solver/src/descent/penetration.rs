//! The mean pressure under penetration control.
//!
//! It is free, like any other wave of the pressure.

use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::rows;
use crate::descent::state::{Descent, Follows};
use crate::descent::sums::GapSums;
use crate::descent::values::ElementVectors;
use crate::parallel;
use crate::problem::control::Control;

/// Part of the cell in contact from which the uniform pressure's stiffness is computed.
///
/// Below it, the application of L gained nothing on rough surfaces.
const LARGE_CONTACT: f64 = 0.7;

/// Limits of the change of the pressure in one step, relative to p (1 - p/H).
pub(crate) const STEPS: [f64; 2] = [-0.5, 1.0];

impl Descent<'_> {
    /// Brings the pressure to the prescribed penetration, if one is prescribed, or nearer to it.
    ///
    /// It scales the pressure so that its weighted mean gap is zero, if that meets the bounds. Otherwise it moves along
    /// p (1 - p/H) to the minimum energy.
    ///
    /// The exception is a solid that nothing holds, if all elements press although the penetration is below full
    /// contact. The mean pressure is then too large, by at least the minimum pressure. Subtracting the minimum from all
    /// pressures displaces nothing and lowers the energy. Scaling would undo the part of the pressure that already fits
    /// the heights.
    pub(crate) fn meet_penetration(&mut self, sums: GapSums) -> GapSums {
        if self.problem.bounds.mean().is_some() {
            return self.settle(sums);
        }
        match sums.scale_to_penetration(self.problem) {
            _ if self.follows == Follows::Changes => self.follow_penetration(sums),
            None if !sums.may_scale() => self.follow_penetration(sums),
            None => self.settle(sums),
            Some(_) if self.problem.support.is_none() && sums.n_contact >= self.n_cell() => {
                let less = self.too_much_everywhere();
                self.pressure.update(|p| *p -= less);
                let sums = self.rescale(1.0);
                self.within_bounds(sums)
            }
            Some(scale) => self.rescale(scale),
        }
    }

    /// The pressure to subtract from all elements where all of them press.
    ///
    /// It is the minimum pressure. It is negative where the penetration is beyond full contact and the hardness limits
    /// the pressure.
    fn too_much_everywhere(&self) -> f64 {
        match self.problem.bounds.control {
            Control::Penetration(penetration) if penetration >= self.problem.h_max - self.problem.h_mean => {
                parallel::maximum(&self.pressure.all(), 0.0) - self.problem.bounds.hardness
            }
            _ => self.layout.minimum(&self.pressure.all()),
        }
    }

    /// Moves the pressure along d = p (1 - p/H) to the minimum energy.
    ///
    /// The stiffness of this direction preconditions the mean.
    fn follow_penetration(&mut self, sums: GapSums) -> GapSums {
        let (len, bounds) = (self.layout.len(), self.problem.bounds);
        let (unit, range) = (self.problem.unit().recip(), self.problem.unit());
        self.info.operator_applications += 1;
        let corrections = &mut *self.operators.corrections;
        let (pressure, gap, n) = (&self.pressure, &self.gap, self.pressure.len());
        write_blocks(corrections, self.layout.ranges(n), |block, values| {
            for (&p, value) in pressure.part(block).iter().zip(values) {
                *value = (bounds.direction(p) * unit) as f32;
            }
        });
        corrections.apply();
        let kept = self.directions.displacements_mut(len);
        let products = read_blocks(corrections, self.layout.ranges(n).zip(kept), |(block, kept), displacement| {
            kept.copy_from_slice(displacement);
            rows::products(&pressure.part(block.clone()), &gap.part(block), displacement, |p| bounds.direction(p))
        });
        let [whole, with_gap, with_displacement] = self.layout.total(products);
        let curvature = range * with_displacement;
        let stiffness = whole * whole / (self.info.grid.len() as f64 * curvature);
        self.stiffness = (curvature > 0.0 && stiffness.is_finite() && stiffness > 0.0).then_some(stiffness);
        if self.stiffness.is_none() {
            return self.settle(sums);
        }
        let factor = (-with_gap / curvature).clamp(STEPS[0], STEPS[1]);
        let (offset, empty) = (self.problem.offset(), GapSums::empty(self.pressed, bounds.hardness));
        let elements = ElementVectors { heights: self.heights, pressure: &mut self.pressure, gap: &mut self.gap };
        let blocks = elements.blocks(len).zip(self.directions.added().chunks(len));
        let sums = parallel::map(blocks, |(block, displacement)| {
            block.with_heights(|values| {
                for ((p, g), u) in values.pressure.iter_mut().zip(values.gap.iter_mut()).zip(displacement) {
                    *p = bounds.along(*p, factor);
                    *g += factor * range * f64::from(*u);
                }
                values.rescale(1.0, offset, empty)
            })
        });
        let sums = GapSums::total(&self.layout, sums);
        self.pressed = sums.next_pressed();
        self.settle(sums)
    }

    /// Preconditions the mean by the contact stiffness dσ0/dΔ = max ⟨x⟩²/⟨x L x⟩.
    ///
    /// The maximum is over pressures x on the contact, so each x gives a lower bound. The present pressure gives
    /// σ0²/mean(p v). This stays finite towards full contact, where the true stiffness grows without bound. The bound
    /// of a uniform pressure grows too, because the uniform pressure displaces less when less is out of contact.
    ///
    /// Where elements are plastic, the last step along p (1 - p/H) has found a stiffness. If nothing lies between the
    /// bounds, it is that of a uniform pressure on the `n_active` active elements.
    pub(crate) fn precondition_mean(&mut self, sums: &GapSums, n_active: f64) {
        let Control::Penetration(_) = self.problem.bounds.control else { return };
        let n_cell = self.n_cell();
        let secant = sums.pressure * sums.pressure / (n_cell * sums.work());
        let stiffness = match (sums.has_plastic(), self.stiffness) {
            (true, Some(stiffness)) => stiffness,
            (true, None) => self.stiffness_of_uniform(n_active, |_, active| active),
            _ if sums.n_contact > LARGE_CONTACT * n_cell => {
                self.stiffness_of_uniform(sums.n_contact, |p, _| p > 0.0).max(secant)
            }
            _ => secant,
        };
        if stiffness.is_finite() && stiffness > 0.0 {
            self.operators.corrections.set_mean(stiffness);
        }
    }

    /// ⟨x⟩²/⟨x L x⟩ for x = 1 on the `n` elements that are `chosen`, and 0 elsewhere.
    fn stiffness_of_uniform(&mut self, n: f64, chosen: impl Fn(f64, bool) -> bool + Sync) -> f64 {
        let len = self.layout.len();
        self.info.operator_applications += 1;
        let corrections = &mut *self.operators.corrections;
        let (all, layout) = (&self.pressure, &self.layout);
        let elements = || layout.ranges(all.len()).zip(self.directions.active.chunks(len));
        write_blocks(corrections, elements(), |(block, active), values| {
            for ((&p, &active), value) in all.part(block).iter().zip(active).zip(values) {
                *value = if chosen(p, active) { 1.0 } else { 0.0 };
            }
        });
        corrections.apply();
        let sums = read_blocks(corrections, elements(), |(block, active), displacement| {
            let pressure = all.part(block);
            let of_chosen =
                pressure.iter().zip(active).zip(displacement).filter(|((p, active), _)| chosen(**p, **active));
            [of_chosen.map(|(_, &v)| f64::from(v)).sum()]
        });
        let [displaced] = self.layout.total(sums);
        n * n / (self.n_cell() * displaced)
    }
}
