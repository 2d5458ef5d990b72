//! The mean pressure under penetration control, which is free like any other wave of the pressure.

use super::operators::{read_blocks, write_blocks};
use super::state::Descent;
use super::sums::GapSums;
use crate::Control;
use crate::parallel;

/// The part of the cell in contact from which a uniform pressure is looked at: below it the present one is the stiffer,
/// or as good as, and the application of L would gain nothing.
const LARGE_CONTACT: f64 = 0.7;

impl Descent<'_> {
    /// Brings the pressure to the prescribed penetration, if one is: scales it, so that its weighted mean gap is zero,
    /// or nearer to it.
    ///
    /// Where nothing holds the solid and all elements press although the penetration is less than that of full contact,
    /// the mean pressure is too large by the minimum, at least. Taken off all of them it displaces nothing and lowers
    /// the energy, while scaling would undo what already fits the heights.
    pub(super) fn meet_penetration(&mut self, sums: GapSums) -> GapSums {
        match sums.scale_to_penetration(self.problem) {
            None => self.settle(sums),
            Some(_) if self.problem.support.is_none() && sums.n_contact >= self.n_cell() => {
                let less = self.too_much_everywhere();
                parallel::update(&mut self.pressure, |p| *p -= less);
                let sums = self.rescale(1.0);
                self.limited(sums)
            }
            Some(scale) => self.rescale(scale),
        }
    }

    /// What to take off the mean where all elements press: the minimum, or less than nothing where the penetration is
    /// beyond that of full contact and the hardness limits the pressure.
    fn too_much_everywhere(&self) -> f64 {
        match self.problem.control {
            Control::Penetration(penetration) if penetration >= self.problem.h_max - self.problem.h_mean => {
                parallel::maximum(&self.pressure, 0.0) - self.problem.hardness
            }
            _ => self.layout.minimum(&self.pressure),
        }
    }

    /// Preconditions the mean by the contact stiffness dσ0/dΔ = max ⟨x⟩²/⟨x L x⟩ over pressures x on the contact, of
    /// which each gives a lower bound. The present pressure gives σ0²/mean(p v), which stays finite towards full
    /// contact, where the true one grows without bound; so does that of a uniform pressure, which displaces less the
    /// less is out of contact.
    pub(super) fn precondition_mean(&mut self, sums: &GapSums) {
        let Control::Penetration(_) = self.problem.control else { return };
        // Where elements are plastic, their stiffness was found by the last projection.
        if sums.has_plastic() {
            return;
        }
        let n_cell = self.n_cell();
        let secant = sums.pressure * sums.pressure / (n_cell * sums.work());
        let large = sums.n_contact > LARGE_CONTACT * n_cell;
        let stiffness = if large { self.stiffness_of_uniform(sums.n_contact).max(secant) } else { secant };
        if stiffness.is_finite() && stiffness > 0.0 {
            self.operators.corrections.set_mean(stiffness);
        }
    }

    /// ⟨x⟩²/⟨x L x⟩ for x = 1 on the `n_contact` elements in contact.
    fn stiffness_of_uniform(&mut self, n_contact: f64) -> f64 {
        let len = self.layout.len();
        self.info.operator_applications += 1;
        let corrections = &mut *self.operators.corrections;
        write_blocks(corrections, self.pressure.chunks(len), |pressure, values| {
            for (&p, value) in pressure.iter().zip(values) {
                *value = if p > 0.0 { 1.0 } else { 0.0 };
            }
        });
        corrections.apply();
        let sums = read_blocks(corrections, self.pressure.chunks(len), |pressure, displacement| {
            [pressure.iter().zip(displacement).filter(|&(&p, _)| p > 0.0).map(|(_, &v)| f64::from(v)).sum()]
        });
        let [displaced] = self.layout.total(sums);
        n_contact * n_contact / (self.n_cell() * displaced)
    }
}
