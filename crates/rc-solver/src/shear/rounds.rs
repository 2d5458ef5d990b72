//! Corrections of tangential tractions by an accelerated projected gradient.
//!
//! The traction minimises ½⟨t·`L_T` t⟩ - d·⟨t⟩ over discs |t| ≤ μp, with a given d or a given mean. Each round applies
//! `L_T` once (Beck & Teboulle, SIAM J. Imaging Sci. 2, 2009, with the restart of O'Donoghue & Candès, Found. Comput.
//! Math. 15, 2015).

use rc_core::{DVec2, Observer};

use crate::shear::certificate::Bound;
use crate::shear::discs;
use crate::shear::operator::TangentialOperator;
use crate::shear::problem::{Contact, Prescribed};

/// Maximum number of rounds.
const MOST_ROUNDS: usize = 3000;

/// Rounds between two looks at the certificate.
const BETWEEN_BOUNDS: usize = 4;

/// Part of the tolerance to which the iteration goes, as that of the pressure.
const AIM: f64 = 0.3;

/// Rounds of the estimate of the largest eigenvalue.
const POWER_ROUNDS: usize = 6;

/// Tractions with their displacements and the bound on their error.
pub(super) struct Tractions {
    /// t of each element in contact, in E*.
    pub(super) vectors: Vec<DVec2>,
    /// `L_T` t, in λ.
    pub(super) displacements: Vec<DVec2>,
    pub(super) bound: Bound,
    pub(super) rounds: usize,
}

/// A sheared contact: its operator, its elements, what is prescribed.
pub(super) struct Rounds<'a> {
    pub(super) operator: &'a TangentialOperator,
    pub(super) contact: &'a Contact,
    pub(super) prescribed: Prescribed,
}

impl Rounds<'_> {
    /// The tractions `start` with their bound. `displacement` is a guess of d.
    pub(super) fn certified(&self, start: Vec<DVec2>, displacement: DVec2) -> Tractions {
        let displacements = self.apply(&start);
        let bound = self.bound(&start, &displacements, displacement);
        Tractions { vectors: start, displacements, bound, rounds: 0 }
    }

    /// Moves the tractions to the nearest ones that are possible.
    pub(super) fn project(&self, tractions: &mut [DVec2]) {
        match self.prescribed {
            Prescribed::Total(total) => discs::project(tractions, &self.contact.limits, total),
            Prescribed::Displacement(_) => {
                for (traction, &limit) in tractions.iter_mut().zip(&self.contact.limits) {
                    *traction = discs::clipped(*traction, limit);
                }
            }
        }
    }

    /// Corrects the tractions until their error is well below `tolerance`, or for as many rounds as are allowed.
    pub(super) fn correct(&self, start: Tractions, tolerance: f64, observer: &dyn Observer) -> Tractions {
        let mut best = start;
        let (mut now, mut displaced) = (best.vectors.clone(), best.displacements.clone());
        let (mut ahead, mut ahead_displaced) = (now.clone(), displaced.clone());
        let (mut momentum, mut largest) = (1.0_f64, self.largest_eigenvalue(&now));
        for round in 1..=MOST_ROUNDS {
            if observer.should_stop() {
                break;
            }
            let (next, next_displaced) = self.step(&ahead, &ahead_displaced, &mut largest);
            let turned: f64 =
                next.iter().zip(&ahead).zip(&now).map(|((next, ahead), now)| (*ahead - *next).dot(*next - *now)).sum();
            let following = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
            let part = if turned > 0.0 { 0.0 } else { (momentum - 1.0) / following };
            momentum = if turned > 0.0 { 1.0 } else { following };
            let beyond = |next: &[DVec2], now: &[DVec2]| -> Vec<DVec2> {
                next.iter().zip(now).map(|(next, now)| *next + part * (*next - *now)).collect()
            };
            (ahead, ahead_displaced) = (beyond(&next, &now), beyond(&next_displaced, &displaced));
            (now, displaced) = (next, next_displaced);
            if round % BETWEEN_BOUNDS == 0 {
                let bound = self.bound(&now, &displaced, best.bound.displacement);
                if bound.gap < best.bound.gap {
                    best = Tractions { vectors: now.clone(), displacements: displaced.clone(), bound, rounds: round };
                }
                best.rounds = round;
                if best.bound.error() <= AIM * tolerance {
                    break;
                }
            }
        }
        // The displacements of a fresh application, without the rounding of sums.
        let rounds = best.rounds;
        Tractions { rounds, ..self.certified(best.vectors, best.bound.displacement) }
    }

    /// A step against the gradient, and its displacements. `largest` grows if it is not above all eigenvalues.
    fn step(&self, from: &[DVec2], displaced: &[DVec2], largest: &mut f64) -> (Vec<DVec2>, Vec<DVec2>) {
        let given = match self.prescribed {
            Prescribed::Total(_) => DVec2::ZERO,
            Prescribed::Displacement(given) => given,
        };
        loop {
            let mut next: Vec<DVec2> = from.iter().zip(displaced).map(|(t, v)| *t - (*v - given) / *largest).collect();
            self.project(&mut next);
            let next_displaced = self.apply(&next);
            let (mut squares, mut work) = (0.0, 0.0);
            for ((next, from), (after, before)) in next.iter().zip(from).zip(next_displaced.iter().zip(displaced)) {
                squares += (*next - *from).length_squared();
                work += (*next - *from).dot(*after - *before);
            }
            if work <= *largest * squares * (1.0 + 1e-9) {
                return (next, next_displaced);
            }
            *largest = (1.5 * *largest).max(work / squares);
        }
    }

    /// About the largest eigenvalue of `L_T` on the elements in contact.
    fn largest_eigenvalue(&self, start: &[DVec2]) -> f64 {
        let mut vector = start.to_vec();
        let mut value = f64::MIN_POSITIVE;
        for _ in 0..POWER_ROUNDS {
            let next = self.apply(&vector);
            let length = |vector: &[DVec2]| vector.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
            let (before, after) = (length(&vector), length(&next));
            if before == 0.0 || after == 0.0 {
                break;
            }
            value = after / before;
            vector = next.into_iter().map(|v| v / after).collect();
        }
        value
    }

    fn apply(&self, tractions: &[DVec2]) -> Vec<DVec2> {
        self.contact.vectors(&self.operator.apply(&self.contact.on_part(tractions)))
    }

    fn bound(&self, tractions: &[DVec2], displacements: &[DVec2], guess: DVec2) -> Bound {
        match self.prescribed {
            Prescribed::Total(_) => Bound::smallest(self.contact, tractions, displacements, guess),
            Prescribed::Displacement(given) => Bound::at(self.contact, tractions, displacements, given),
        }
    }
}
