//! Rounds that lower the energy, whatever a step may do.
//!
//! Clipping and the restored load may undo what a step has gained, for instance in long cells, where a small change of
//! the load of one place displaces everything. Such rounds would repeat each other endlessly.

use rc_core::Observer;

use crate::descent::state::{Descent, Follows};
use crate::descent::stop::Stopped;
use crate::descent::sums::GapSums;
use crate::descent::values::Values;
use crate::parallel;

/// Increase of the energy that counts, relative to the work. Single precision may cause a smaller one.
///
/// The second number is for a descent whose pressure is in single precision. On 1e8 elements with loose tolerances, the
/// quick operator alone lets the energy drift by more than the first.
const RISE: [f64; 2] = [1e-7, 1e-5];

/// Part of a round from which its step is not too long.
///
/// Between two rounds no element reaches a bound. Long steps of which only small parts lower the energy would therefore
/// never find the elements at the bounds.
const ENOUGH: f64 = 0.5;

/// Factor of the next steps after a round of which a small part lowers the energy, and after one that lowers it.
const SHORTER: f64 = 0.25;
const LONGER: f64 = 2.0;

/// Rounds without the approximate inverse after a direction that clipping turns uphill: at first, and at most.
///
/// The residual itself leads down even if some of its step is clipped. An inverse that mixes far elements, as that of a
/// solid whose modulus changes much with the direction of waves, may not.
const PLAIN: [u32; 2] = [8, 64];

impl Descent<'_> {
    /// Whether the energy has risen from one round to the next.
    pub(crate) fn has_risen(&self, before: &GapSums, after: &GapSums) -> bool {
        let rise = RISE[usize::from(self.pressure.is_single())];
        after.energy() - before.energy() > rise * after.work().abs().max(before.work().abs())
    }

    /// Takes a round of one step, or the part of it that lowers the energy most.
    ///
    /// The pressures before and after a round both meet the bounds of the pressure, and the load if it is given. So
    /// does every pressure between them. The energy ½⟨p, L p⟩ - ⟨p, h⟩ is a parabola there. Its slope and its curvature
    /// follow from the two gaps, and the minimum needs no application of L.
    ///
    /// *Memory*: a copy of pressure and gap.
    ///
    /// # Errors
    /// [`Stopped`] when the observer wants to stop. Pressure and gap are then those from before the round.
    pub(crate) fn descending_round(&mut self, sums: &GapSums, observer: &dyn Observer) -> Result<GapSums, Stopped> {
        let before = (self.pressure.clone(), self.gap.clone());
        let zero_gap = self.zero_gap;
        if self.step_factor < 1.0 {
            // Directions are conjugate only after a step to the minimum.
            self.start_afresh();
        }
        let is_plain = self.plain.rounds > 0;
        let Ok(after) = self.round(1, sums, observer) else {
            (self.pressure, self.gap) = before;
            return Err(Stopped);
        };
        // The work of a gap that follows changes only is not that of its pressure, and tells no energy.
        let (mut part, mut has_risen) = (1.0, self.follows == Follows::Pressure && self.has_risen(sums, &after));
        if has_risen || self.follows == Follows::Changes {
            part = self.best_part(&before.0, &before.1, zero_gap);
            has_risen |= part < ENOUGH;
        }
        self.plain.rounds = self.plain.rounds.saturating_sub(1);
        if !has_risen {
            self.step_factor = (LONGER * self.step_factor).min(1.0);
            return Ok(after);
        }
        self.shorten(part, is_plain);
        self.pressure.go_back(&before.0, part);
        self.gap.go_back(&before.1, part);
        // The last direction does not lead here, and the active elements were chosen elsewhere.
        self.start_afresh();
        let sums = self.rescale(1.0);
        Ok(self.meet_penetration(sums))
    }

    /// What follows a round of which this part lowers the energy most.
    fn shorten(&mut self, part: f64, is_plain: bool) {
        if part == 0.0 && !is_plain {
            self.plain.next = (2 * self.plain.next).clamp(PLAIN[0], PLAIN[1]);
            self.plain.rounds = self.plain.next;
            self.step_factor = 1.0;
        } else if part < ENOUGH {
            self.step_factor *= SHORTER;
        }
    }

    /// Forgets the last direction and the choice of active elements.
    pub(crate) fn start_afresh(&mut self) {
        self.curvature = f64::INFINITY;
        self.is_chosen = false;
    }

    /// The part of a round that lowers the energy most, from 0 to 1.
    ///
    /// The round began with `pressure` and `gap`, where elements in contact had the gap `zero_gap`. It has ended with
    /// those of the descent.
    fn best_part(&self, pressure: &Values, gap: &Values, zero_gap: f64) -> f64 {
        let (new_pressure, new_gap) = (&self.pressure, &self.gap);
        let sums = parallel::map(self.layout.ranges(pressure.len()), |block| {
            let [p0, p1, g0, g1] = [pressure, new_pressure, gap, new_gap].map(|values| values.part(block.clone()));
            let elements = p0.iter().zip(&*p1).zip(g0.iter().zip(&*g1));
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
