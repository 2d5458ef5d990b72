//! The iteration on one grid: Newton's method on the active elements, and steps that always converge.
//!
//! A Newton step solves L d = -(g - gap of contact) on the active elements by GMRES, roughly. It is taken if it lowers
//! the energy error. Otherwise a round of the descent lowers the energy of an elastic solid that has the storage modulus
//! of each wave, B = 1/Re(1/L), under the heights h - (L - B) p. Repeated, this alone contracts by the sine of the
//! maximum loss angle.

use rc_core::Observer;

use crate::descent::gmres::{self, ActiveElements, LinearSystem};
use crate::descent::operators::PreconditionedOperator;
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::Descent;
use crate::descent::stop::Stopped;
use crate::descent::sums::GapSums;

/// Range of the residual that GMRES leaves of the system of a Newton step, relative to its right side.
const REDUCTIONS: [f64; 2] = [0.1, 0.4];

/// Maximum number of directions of GMRES, whose vectors have values of the active elements only.
const DIRECTIONS: usize = 40;

/// Parts of a Newton step that are tried.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// A part s of a step is taken if it lowers the energy error by this times s.
const PROGRESS: f64 = 0.1;

/// Failed Newton steps in a row after which steps with the storage modulus are solved well.
const FAILURES: usize = 3;

/// Such steps, and the rounds of each. They are doubled up to [`LONGEST`] where the error has not fallen to [`GAIN`] of
/// that at the last such steps.
const LONG: [usize; 2] = [4, 4];
const LONGEST: [usize; 2] = [128, 32];
const GAIN: f64 = 0.7;

/// Part of its first error to which such a step is solved.
const INNER: f64 = 0.1;

/// Rounds without progress after which the iteration gives up.
const PATIENCE: usize = 200;

/// Work of an iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Work {
    pub(crate) gmres_iterations: usize,
    pub(crate) storage_rounds: usize,
}

/// A descent whose operator is not symmetric.
pub(crate) struct SlidingDescent<'a> {
    pub(crate) descent: Descent<'a>,
    /// The elastic solid with the storage modulus of each wave.
    pub(crate) storage: Box<dyn PreconditionedOperator + 'a>,
    pub(crate) work: Work,
    /// Ratio of the energy errors after and before the last Newton step.
    last_ratio: f64,
}

impl<'a> SlidingDescent<'a> {
    /// `storage` is the solid with the storage modulus of each wave.
    pub(crate) fn new(descent: Descent<'a>, storage: Box<dyn PreconditionedOperator + 'a>) -> Self {
        Self { descent, storage, work: Work::default(), last_ratio: 1.0 }
    }

    /// Iterates until the goal is reached, or cannot be reached.
    pub(crate) fn run(&mut self, goal: Goal, watch: &DescentObserver<'_>) -> Outcome {
        let mut sums = self.descent.start();
        let mut fallback = Fallback::new();
        let (mut smallest, mut rounds) = (f64::INFINITY, 0);
        loop {
            let mut error = self.descent.error(&sums);
            self.descent.tell(watch, [error, goal.tolerance], &sums);
            if error <= goal.tolerance {
                if goal.certify.is_none() {
                    return self.descent.outcome(&sums, true);
                }
                sums = self.descent.refresh();
                error = self.descent.error(&sums);
                let outcome = self.descent.outcome(&sums, true);
                if error <= goal.tolerance && goal.certify.is_some_and(|bound| outcome.certificate.meets(bound)) {
                    return outcome;
                }
            }
            (smallest, rounds) = if error < 0.9 * smallest { (error, 0) } else { (smallest, rounds + 1) };
            if self.descent.info.iterations >= goal.max_iterations || rounds > PATIENCE {
                sums = self.descent.refresh();
                return self.descent.unfinished(goal, &sums);
            }
            let next = match self.newton_step(&sums, watch.observer) {
                Ok(None) => self.storage_rounds(&sums, &mut fallback, watch.observer),
                Ok(Some(next)) => {
                    fallback.failures = 0;
                    Ok(next)
                }
                Err(stopped) => Err(stopped),
            };
            let Ok(next) = next else {
                self.descent.admit();
                return self.descent.stopped(goal, sums);
            };
            sums = next;
        }
    }

    /// √(G/U) of the present pressure.
    fn energy_error(&self, sums: &GapSums) -> f64 {
        self.descent.outcome(sums, false).certificate.energy
    }

    /// A part of a Newton step that lowers the energy error. `None` if no part does, and then nothing has changed.
    fn newton_step(&mut self, sums: &GapSums, observer: &dyn Observer) -> Result<Option<GapSums>, Stopped> {
        let error = self.energy_error(sums);
        let Some(elements) = self.direction(sums, observer)? else { return Ok(None) };
        let descent = &self.descent;
        let before = (descent.pressure.clone(), descent.gap.clone());
        let (zero_gap, pressed, unit) = (descent.zero_gap, descent.pressed, descent.problem.unit());
        for part in PARTS {
            let next = self.descent.leap(part * unit, observer)?;
            let energy_error = self.energy_error(&next);
            if energy_error < (1.0 - PROGRESS * part) * error {
                self.last_ratio = energy_error / error;
                return Ok(Some(next));
            }
            let descent = &mut self.descent;
            (descent.pressure.copy_from_slice(&before.0), descent.gap.copy_from_slice(&before.1));
            (descent.zero_gap, descent.pressed) = (zero_gap, pressed);
            descent.directions.active.copy_from_slice(&elements.active);
        }
        Ok(None)
    }

    /// Solves for a Newton direction and its displacement. `None` if no element is active.
    fn direction(&mut self, sums: &GapSums, observer: &dyn Observer) -> Result<Option<ActiveElements>, Stopped> {
        let descent = &mut self.descent;
        descent.is_chosen = false;
        let set = descent.begin_round();
        if set.n == 0.0 {
            return Ok(None);
        }
        descent.precondition_mean(sums, set.n);
        let elements = ActiveElements::new(descent.directions.active.clone(), descent.layout.len());
        let mut residual = elements.gather(&descent.directions.preconditioned);
        residual.iter_mut().for_each(|value| *value = -*value);
        let operator = &mut *descent.operators.corrections;
        let mut system = LinearSystem { operator, elements: &elements, fixed_mean: set.fixed_mean };
        // A step that gains little is limited by the choice of active elements, not by its accuracy.
        let reduction = (0.5 * self.last_ratio).clamp(REDUCTIONS[0], REDUCTIONS[1]);
        let (step, iterations) = system.solve(residual, gmres::Goal { reduction, directions: DIRECTIONS }, observer)?;
        elements.scatter(&step, &mut descent.directions.direction);
        self.work.gmres_iterations += iterations;
        descent.info.iterations += iterations.max(1);
        descent.info.preconditioner_applications += iterations;
        descent.info.operator_applications += iterations;
        Ok(Some(elements))
    }

    /// Steps with the storage modulus.
    ///
    /// A step solves the contact of the elastic solid under heights that make up for what the operators differ in. Its
    /// gap is that of the present pressure, and follows the elastic solid. The first step after a Newton step takes one
    /// round. Newton steps that fail again and again are followed by more and more steps, solved more and more exactly.
    fn storage_rounds(
        &mut self,
        sums: &GapSums,
        fallback: &mut Fallback,
        observer: &dyn Observer,
    ) -> Result<GapSums, Stopped> {
        fallback.fail(self.energy_error(sums));
        let mut sums = *sums;
        for _ in 0..fallback.steps {
            let wanted = INNER * self.descent.error(&sums);
            self.exchange();
            for _ in 0..fallback.rounds {
                self.work.storage_rounds += 1;
                let round = self.descent.round(1, &sums, observer);
                if round.is_err() {
                    self.exchange();
                }
                sums = round?;
                if self.descent.error(&sums) <= wanted {
                    break;
                }
            }
            self.exchange();
            // The gap has followed the other operator.
            sums = self.descent.refresh();
        }
        Ok(sums)
    }

    /// Exchanges the operator for that with the storage modulus, or back.
    fn exchange(&mut self) {
        std::mem::swap(&mut self.descent.operators.corrections, &mut self.storage);
        self.descent.start_afresh();
    }
}

/// What follows a failed Newton step.
struct Fallback {
    /// Failed Newton steps in a row.
    failures: usize,
    /// Steps with the storage modulus, and the rounds that each of them may take.
    steps: usize,
    rounds: usize,
    /// The energy error at the last long sequence of steps.
    error: f64,
}

impl Fallback {
    fn new() -> Self {
        Self { failures: 0, steps: 1, rounds: 1, error: f64::INFINITY }
    }

    /// Notes a failed step at this energy error.
    fn fail(&mut self, error: f64) {
        self.failures += 1;
        if self.failures < FAILURES {
            (self.steps, self.rounds) = (1, 1);
            return;
        }
        let has_gained = error < GAIN * self.error;
        let [steps, rounds] =
            if has_gained { LONG } else { [self.steps.max(LONG[0] / 2) * 2, self.rounds.max(LONG[1] / 2) * 2] };
        (self.steps, self.rounds) = (steps.min(LONGEST[0]), rounds.min(LONGEST[1]));
        self.error = self.error.min(error);
    }
}
