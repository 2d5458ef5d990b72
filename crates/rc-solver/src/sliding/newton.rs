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
use crate::descent::state::{Descent, Follows, PlainRounds};
use crate::descent::stop::Stopped;
use crate::descent::sums::GapSums;

/// Range of the residual that GMRES leaves of the system of a Newton step, relative to its right side.
const REDUCTIONS: [f64; 2] = [0.1, 0.4];

/// Parts of a Newton step that are tried.
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];

/// A part s of a step is taken if it lowers the energy error by this times s.
const PROGRESS: f64 = 0.1;

/// Failed Newton steps, without a new smallest error, after which steps with the storage modulus are solved well.
const FAILURES: u32 = 6;

/// Such steps, and the rounds of each. Both are doubled at each further failure, up to [`LONGEST`].
const LONG: [usize; 2] = [4, 8];
const LONGEST: [usize; 2] = [256, 32];

/// Ratio to the smallest error so far below which an error is a new smallest one.
const GAIN: f64 = 0.9;

/// Part of its first error to which such a step is solved.
const INNER: f64 = 0.1;

/// Factor of the maximum number of iterations. Steps with the storage modulus are many and small where the material
/// loses much, and they converge.
const ITERATIONS: usize = 10;

/// Rounds without progress after which the iteration gives up.
const PATIENCE: usize = 200;

/// Work of an iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Work {
    pub(crate) gmres_iterations: usize,
    pub(crate) storage_rounds: usize,
}

impl Work {
    /// This work and more.
    pub(crate) fn plus(self, more: Self) -> Self {
        Self {
            gmres_iterations: self.gmres_iterations + more.gmres_iterations,
            storage_rounds: self.storage_rounds + more.storage_rounds,
        }
    }
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
        let mut fallback = Fallback::default();
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
            (smallest, rounds) = if error < GAIN * smallest { (error, 0) } else { (smallest, rounds + 1) };
            if rounds == 0 {
                fallback.failures = 0;
            }
            let most = ITERATIONS * goal.max_iterations;
            if self.descent.info.iterations >= most || rounds > PATIENCE || error.is_nan() {
                sums = self.descent.refresh();
                return self.descent.unfinished(goal, &sums);
            }
            let next = match self.newton_step(&sums, watch.observer) {
                Ok(None) => self.storage_rounds(&sums, &mut fallback, (most, watch.observer)),
                Ok(Some(next)) => Ok(next),
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
            descent.pressure.clone_from(&before.0);
            descent.gap.clone_from(&before.1);
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
        for value in &mut residual {
            *value = -*value;
        }
        let operator = &mut *descent.operators.corrections;
        let mut system = LinearSystem { operator, elements: &elements, fixed_mean: set.fixed_mean };
        // A step that gains little is limited by the choice of active elements, not by its accuracy.
        let reduction = (0.5 * self.last_ratio).clamp(REDUCTIONS[0], REDUCTIONS[1]);
        let directions = gmres::directions(elements.len(), descent.pressure.len());
        let (step, iterations) = system.solve(residual, gmres::Goal { reduction, directions }, observer)?;
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
    /// gap is that of the present pressure, and follows the elastic solid. The first of them take one round each, which
    /// mostly is enough for the next Newton step. Newton steps that fail again and again are followed by more and more
    /// steps, solved well.
    fn storage_rounds(
        &mut self,
        sums: &GapSums,
        fallback: &mut Fallback,
        (most_iterations, observer): (usize, &dyn Observer),
    ) -> Result<GapSums, Stopped> {
        let ([steps, rounds], mut sums) = (fallback.next(), *sums);
        for _ in 0..steps {
            if self.descent.info.iterations >= most_iterations {
                break;
            }
            let wanted = INNER * self.descent.error(&sums);
            self.exchange();
            // What rounds did under other heights does not count.
            (self.descent.step_factor, self.descent.plain) = (1.0, PlainRounds::default());
            for _ in 0..rounds {
                self.work.storage_rounds += 1;
                let round = self.descent.descending_round(&sums, observer);
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
    ///
    /// What the operators differ in is a part of the gap that stays.
    fn exchange(&mut self) {
        std::mem::swap(&mut self.descent.operators.corrections, &mut self.storage);
        self.descent.follows = match self.descent.follows {
            Follows::Pressure => Follows::Changes,
            Follows::Changes => Follows::Pressure,
        };
        self.descent.start_afresh();
    }
}

/// What follows a failed Newton step.
#[derive(Default)]
struct Fallback {
    /// Failed Newton steps since the error last was the smallest.
    failures: u32,
}

impl Fallback {
    /// Number of steps with the storage modulus, and of the rounds that each of them may take.
    fn next(&mut self) -> [usize; 2] {
        self.failures += 1;
        match self.failures.checked_sub(FAILURES) {
            None => [1, 1],
            Some(more) => [0, 1].map(|i| (LONG[i] << more.min(8)).min(LONGEST[i])),
        }
    }
}
