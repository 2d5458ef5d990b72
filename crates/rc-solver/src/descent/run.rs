//! Rounds until the error is within the tolerance, or no longer falls.

use rc_core::{Event, Observer};

use super::observed::ObservedMesh;
use super::outcome::Outcome;
use super::state::Descent;
use super::sums::GapSums;
use crate::ErrorBound;

/// Conjugate-gradient steps between two clippings. Measured without extended residuals at 1024², N = 64, σ0/E* = 8.9e-4
/// to 1e-6: 1, 2, 3 steps need 37, 36, 36 convolutions, but only 2 does it everywhere from 0.1 % to 86 % contact.
const STEPS_PER_ROUND: usize = 2;

/// Rounds without progress before directions are forgotten, and three times as many before the iteration gives up. From
/// the first of them on tensile pressures are clipped after every step: where pressures are smooth over many contacts,
/// steps are large, contacts change under them, and two steps between clippings lead astray. Before residuals were
/// extended, in cells 50 and 100 times as long as wide, 15 of 144 loads did not converge without this rule, and 1 with
/// it, in half the iterations; N = 1024 on 2304² needs 29 instead of 36, and other scenes are as before.
const PATIENCE: usize = 20;

/// An error below this part of the smallest one so far is progress.
const PROGRESS: f64 = 0.9;

/// When a descent ends.
#[derive(Clone, Copy)]
pub(crate) struct Goal {
    /// The deepest overlap to be reached, or a tenth of the greatest gap well inside contact, in units of the problem's
    /// length.
    pub(crate) tolerance: f64,
    pub(crate) max_iterations: usize,
    /// What a fresh application of L must confirm, if anything.
    pub(crate) certify: Option<ErrorBound>,
}

/// Who is told about a descent, and how the mesh is shown.
#[derive(Clone, Copy)]
pub(crate) struct DescentObserver<'a> {
    pub(crate) observer: &'a dyn Observer,
    pub(crate) mesh: &'a dyn ObservedMesh,
}

/// How the error has fallen so far.
struct ErrorHistory {
    smallest_error: f64,
    /// Rounds since it was reached.
    rounds: usize,
    /// Conjugate-gradient steps in the next round.
    steps: usize,
}

impl ErrorHistory {
    fn new() -> Self {
        Self { smallest_error: f64::INFINITY, rounds: 0, steps: STEPS_PER_ROUND }
    }

    fn note(&mut self, error: f64) {
        if error < PROGRESS * self.smallest_error {
            (self.smallest_error, self.rounds) = (error, 0);
        } else {
            self.rounds += 1;
            self.steps = 1;
        }
    }
}

impl Descent<'_> {
    /// Iterates until the goal is reached, or cannot be.
    pub(crate) fn run(&mut self, goal: Goal, watch: &DescentObserver<'_>) -> Outcome {
        let mut sums = self.start();
        let mut history = ErrorHistory::new();
        loop {
            let mut error = sums.error(self.problem, self.n_cell());
            self.tell(watch, [error, goal.tolerance], &sums);
            if error <= goal.tolerance {
                if goal.certify.is_none() {
                    return self.outcome(&sums, true);
                }
                sums = self.refresh();
                error = sums.error(self.problem, self.n_cell());
                let outcome = self.outcome(&sums, true);
                let is_certified = goal.certify.is_some_and(|bound| outcome.certificate.meets(bound));
                if error <= goal.tolerance && is_certified {
                    return outcome;
                }
            }
            history.note(error);
            if history.rounds == PATIENCE {
                self.curvature = f64::INFINITY;
            }
            let is_stuck = self.info.iterations >= goal.max_iterations || history.rounds > 3 * PATIENCE;
            if is_stuck || watch.observer.should_stop() {
                let sums = self.refresh();
                let mut outcome = self.outcome(&sums, false);
                // The goal may be below what has to be certified.
                outcome.converged = goal.certify.is_some_and(|bound| outcome.certificate.meets(bound));
                return outcome;
            }
            sums = self.round(history.steps, &sums);
        }
    }

    /// The gap from a fresh application of L, in double precision, and the pressure at the prescribed load or
    /// penetration: the gap follows scaling to rounding, since v is linear in p.
    pub(crate) fn refresh(&mut self) -> GapSums {
        if self.problem.hardness.is_finite() {
            self.limit_pressure();
        }
        let sums = self.fresh_gap();
        self.meet_penetration(sums)
    }

    fn tell(&self, watch: &DescentObserver<'_>, overlaps: [f64; 2], sums: &GapSums) {
        let [error, tolerance] = overlaps.map(|overlap| self.problem.measure.shown(overlap));
        let (iteration, n_contact) = (self.info.iterations, sums.n_in_contact() as usize);
        watch.observer.notify(&Event::Iteration { iteration, error, tolerance, n_contact });
        watch.mesh.show_pressure(&self.pressure, watch.observer);
    }
}
