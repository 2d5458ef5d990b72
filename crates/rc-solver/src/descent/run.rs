//! Rounds, until the error is within the tolerance or no longer falls.

use rc_core::{Event, Observer};

use crate::descent::load::has_drifted;
use crate::descent::observed::ObservedMesh;
use crate::descent::outcome::Outcome;
use crate::descent::state::Descent;
use crate::descent::sums::GapSums;
use crate::problem::tolerance::ErrorBound;

/// Conjugate-gradient steps between two clippings.
///
/// `docs/constants.md` compares one to three steps.
const STEPS_PER_ROUND: usize = 2;

/// Rounds without progress after which the iteration gives up.
const PATIENCE: usize = 60;

/// Rounds without progress after which the number of steps is not kept any longer.
const LONG_PATIENCE: usize = 20;

/// An error below this part of the smallest error so far is progress.
const PROGRESS: f64 = 0.9;

/// The condition at which a descent ends.
#[derive(Clone, Copy)]
pub(crate) struct Goal {
    /// The error to be reached, in units of the problem's length.
    ///
    /// It is the deepest overlap, or a tenth of the largest gap well inside contact.
    pub(crate) tolerance: f64,
    pub(crate) max_iterations: usize,
    /// The bound that a fresh application of L must confirm, if any.
    pub(crate) certify: Option<ErrorBound>,
}

/// The observer of a descent, and how the mesh is shown to it.
#[derive(Clone, Copy)]
pub(crate) struct DescentObserver<'a> {
    pub(crate) observer: &'a dyn Observer,
    pub(crate) mesh: &'a dyn ObservedMesh,
}

/// The course of the error so far.
struct ErrorHistory {
    smallest_error: f64,
    /// Number of rounds since the smallest error.
    rounds: usize,
    /// Number of conjugate-gradient steps in the next round.
    ///
    /// From the first round without progress on, it is 1. Where pressures are smooth over many contacts, steps are
    /// large and contacts change under them. Two steps between clippings then lead astray.
    steps: usize,
    /// Whether [`ErrorHistory::steps`] stays as it is (`PreconditionedOperator::keeps_steps`).
    keeps_steps: bool,
    /// Whether a round has raised the energy. From then on, no round may.
    has_strayed: bool,
}

impl ErrorHistory {
    fn new(keeps_steps: bool) -> Self {
        Self { smallest_error: f64::INFINITY, rounds: 0, steps: STEPS_PER_ROUND, keeps_steps, has_strayed: false }
    }

    fn note(&mut self, error: f64) {
        if error < PROGRESS * self.smallest_error {
            (self.smallest_error, self.rounds) = (error, 0);
        } else {
            self.rounds += 1;
            self.keeps_steps &= self.rounds < LONG_PATIENCE;
            if !self.keeps_steps {
                self.steps = 1;
            }
        }
    }
}

impl Descent<'_> {
    /// Iterates until the goal is reached, or cannot be reached.
    pub(crate) fn run(&mut self, goal: Goal, watch: &DescentObserver<'_>) -> Outcome {
        let mut sums = self.start();
        let mut history = ErrorHistory::new(self.operators.corrections.keeps_steps());
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
            if self.info.iterations >= goal.max_iterations || history.rounds > PATIENCE {
                sums = self.refresh();
                return self.unfinished(goal, &sums);
            }
            if watch.observer.should_stop() {
                return self.stopped(goal, sums);
            }
            let next = if history.has_strayed && !history.keeps_steps {
                self.descending_round(&sums, watch.observer)
            } else {
                self.round(history.steps, &sums, watch.observer)
            };
            let Ok(next) = next else {
                self.admit();
                return self.stopped(goal, sums);
            };
            history.has_strayed |= self.has_risen(&sums, &next);
            sums = next;
        }
    }

    /// The outcome of the start, without a step, for a solve that was stopped before.
    pub(crate) fn certify_start(&mut self, goal: Goal, watch: &DescentObserver<'_>) -> Outcome {
        let sums = self.start();
        self.tell(watch, [sums.error(self.problem, self.n_cell()), goal.tolerance], &sums);
        self.unfinished(goal, &sums)
    }

    /// The outcome of a start that has the gap and the load that it should, without a step.
    ///
    /// `bound` is a bound on ⟨p - p*, L (p - p*)⟩ with the exact pressure p*, which is known by other means. The start,
    /// of which the `sums` are, has converged if its energy error is at most `tolerance`.
    pub(crate) fn check_start(
        &mut self,
        sums: GapSums,
        bound: f64,
        tolerance: f64,
        watch: &DescentObserver<'_>,
    ) -> Outcome {
        let sums = self.settle(sums);
        let outcome = self.outcome(&sums, false).with_energy_bound(self.problem, bound);
        self.tell(watch, [outcome.certificate.energy, tolerance].map(|error| error * error), &sums);
        Outcome { converged: outcome.certificate.energy <= tolerance, ..outcome }
    }

    /// The outcome when the observer wants to stop.
    ///
    /// `sums` are those of the last finished round. The gap is computed afresh only for a certificate, and only if it
    /// is not fresh already.
    pub(crate) fn stopped(&mut self, goal: Goal, mut sums: GapSums) -> Outcome {
        let is_fresh = self.info.iterations == 0 && !self.has_gap;
        if goal.certify.is_some() && !is_fresh {
            sums = self.refresh();
        }
        self.unfinished(goal, &sums)
    }

    pub(crate) fn unfinished(&self, goal: Goal, sums: &GapSums) -> Outcome {
        let mut outcome = self.outcome(sums, false);
        // The goal may be smaller than the bound to certify.
        outcome.converged = goal.certify.is_some_and(|bound| outcome.certificate.meets(bound));
        outcome
    }

    /// The error of the pressure with these sums, in units of the problem's length.
    pub(crate) fn error(&self, sums: &GapSums) -> f64 {
        sums.error(self.problem, self.n_cell())
    }

    /// Computes the gap from a fresh application of L, in double precision.
    ///
    /// Scales the pressure to the prescribed load or penetration. The gap follows the scaling to rounding, since v is
    /// linear in p.
    pub(crate) fn refresh(&mut self) -> GapSums {
        let bounds = self.problem.bounds;
        if bounds.is_limited() && has_drifted(bounds, self.n_cell(), &self.layout, &self.pressure.all()) {
            self.project_to_load();
        }
        let sums = self.fresh_gap();
        self.meet_penetration(sums)
    }

    pub(crate) fn tell(&self, watch: &DescentObserver<'_>, overlaps: [f64; 2], sums: &GapSums) {
        let [error, tolerance] = overlaps.map(|overlap| self.problem.measure.shown(overlap));
        let (iteration, n_contact) = (self.info.iterations, sums.n_in_contact() as usize);
        watch.observer.notify(&Event::Iteration { iteration, error, tolerance, n_contact });
        watch.mesh.show_pressure(&self.pressure, watch.observer);
    }
}
