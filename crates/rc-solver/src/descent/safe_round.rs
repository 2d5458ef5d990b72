//! Rounds that cannot raise the energy, for descents that stray.
//!
//! Clipping and restored load may undo what a step has gained, for instance in long cells, where a small change of the
//! load of one place displaces everything. Such rounds repeat each other endlessly.

use rc_core::Observer;

use crate::descent::state::Descent;
use crate::descent::stop::Stopped;
use crate::descent::sums::GapSums;
use crate::parallel;

/// Factor of all later steps, if no part of a round lowers the energy.
///
/// `docs/measurements-uniform.md` compares it with other rules.
const SHORTER: f64 = 0.25;

impl Descent<'_> {
    /// Takes the part of a round of one step that lowers the energy most.
    ///
    /// The pressures before and after a round both meet the bounds of the pressure, and the load if it is given. So
    /// does every pressure between them. The energy ½⟨p, L p⟩ - ⟨p, h⟩ is a parabola there. Its slope and its curvature
    /// follow from the two gaps, and the minimum needs no application of L.
    ///
    /// *Memory*: a copy of pressure and gap.
    ///
    /// # Errors
    /// [`Stopped`] when the observer wants to stop. Pressure and gap are then those from before the round.
    pub(super) fn safe_round(&mut self, sums: &GapSums, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        let (pressure, gap) = (self.pressure.clone(), self.gap.clone());
        let zero_gap = self.zero_gap;
        let Ok(sums) = self.round(1, sums, observer) else {
            (self.pressure, self.gap) = (pressure, gap);
            return Err(Stopped);
        };
        let part = self.best_part(&pressure, &gap, zero_gap);
        if part >= 1.0 {
            return Ok(sums);
        }
        if part <= 0.0 {
            self.step_factor *= SHORTER;
        }
        for (new, old) in [(&mut self.pressure, &pressure), (&mut self.gap, &gap)] {
            let len = self.layout.len();
            parallel::for_each(new.chunks_mut(len).zip(old.chunks(len)), |(new, old)| {
                for (new, old) in new.iter_mut().zip(old) {
                    *new = old + part * (*new - old);
                }
            });
        }
        // The last direction does not lead here, and the active elements were chosen elsewhere.
        self.curvature = f64::INFINITY;
        self.is_chosen = false;
        let sums = self.rescale(1.0);
        Ok(self.meet_penetration(sums))
    }

    /// The part of a round that lowers the energy most, from 0 to 1.
    ///
    /// The round began with `pressure` and `gap`, where elements in contact had the gap `zero_gap`. It has ended with
    /// those of the descent.
    fn best_part(&self, pressure: &[f64], gap: &[f64], zero_gap: f64) -> f64 {
        let len = self.layout.len();
        let before = pressure.chunks(len).zip(gap.chunks(len));
        let after = self.pressure.chunks(len).zip(self.gap.chunks(len));
        let sums = parallel::map(before.zip(after), |((p0, g0), (p1, g1))| {
            let elements = p0.iter().zip(p1).zip(g0.iter().zip(g1));
            elements.fold([0.0; 2], |[slope, curvature], ((p0, p1), (g0, g1))| {
                let change = p1 - p0;
                [slope + change * (g0 - zero_gap), curvature + change * (g1 - g0)]
            })
        });
        let [slope, curvature] = self.layout.total(sums);
        match -slope / curvature {
            _ if slope >= 0.0 => 0.0,
            part if curvature > 0.0 => part.min(1.0),
            _ => 1.0,
        }
    }
}
