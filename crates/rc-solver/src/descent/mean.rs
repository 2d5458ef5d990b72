//! The mean pressure under penetration control.
//!
//! It is free, like any other wave of the pressure.

use crate::descent::operators::{read_blocks, write_blocks};
use crate::descent::state::Descent;
use crate::descent::sums::GapSums;
use crate::parallel;
use crate::problem::control::Control;

/// Part of the cell in contact from which the uniform pressure's stiffness is computed.
///
/// Below it, the application of L gained nothing on rough surfaces.
const LARGE_CONTACT: f64 = 0.7;

impl Descent<'_> {
    /// Brings the pressure to the prescribed penetration, if one is prescribed, or nearer to it.
    ///
    /// It scales the pressure so that its weighted mean gap is zero.
    ///
    /// The exception is a solid that nothing holds, if all elements press although the penetration is below full
    /// contact. The mean pressure is then too large, by at least the minimum pressure. Subtracting the minimum from all
    /// pressures displaces nothing and lowers the energy. Scaling would undo the part of the pressure that already fits
    /// the heights.
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

    /// The pressure to subtract from all elements where all of them press.
    ///
    /// It is the minimum pressure. It is negative where the penetration is beyond full contact and the hardness limits
    /// the pressure.
    fn too_much_everywhere(&self) -> f64 {
        match self.problem.control {
            Control::Penetration(penetration) if penetration >= self.problem.h_max - self.problem.h_mean => {
                parallel::maximum(&self.pressure, 0.0) - self.problem.hardness
            }
            _ => self.layout.minimum(&self.pressure),
        }
    }

    /// Preconditions the mean by the contact stiffness dσ0/dΔ = max ⟨x⟩²/⟨x L x⟩.
    ///
    /// The maximum is over pressures x on the contact, so each x gives a lower bound. The present pressure gives
    /// σ0²/mean(p v). This stays finite towards full contact, where the true stiffness grows without bound. The bound
    /// of a uniform pressure grows too, because the uniform pressure displaces less when less is out of contact.
    pub(super) fn precondition_mean(&mut self, sums: &GapSums) {
        let Control::Penetration(_) = self.problem.control else { return };
        // Where elements are plastic, the last projection has found their stiffness.
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
