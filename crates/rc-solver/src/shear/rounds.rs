//! Corrections of tangential tractions by projected conjugate gradients.
//!
//! The traction minimises ½⟨t·`L_T` t⟩ - d·⟨t⟩ over discs |t| ≤ μp, with a given d or a given mean. Elements that stick
//! move freely, those that slip along the border of their disc. Directions are those of conjugate gradients with the
//! inverse response of each wave as preconditioner. A step goes to the projection of its end, or as far towards it as the
//! energy falls, and applies `L_T` once.

use rc_core::{DVec2, Observer};

use crate::shear::certificate::Bound;
use crate::shear::discs;
use crate::shear::free::Free;
use crate::shear::operator::TangentialOperator;
use crate::shear::problem::{Contact, Prescribed};

/// Maximum number of rounds.
const MOST_ROUNDS: usize = 1000;

/// Rounds between two looks at the certificate.
const BETWEEN_BOUNDS: usize = 2;

/// Part of the tolerance to which the iteration goes, as that of the pressure.
const AIM: f64 = 0.3;

/// Bounds of the length of a step relative to its direction.
const SHORTEST: f64 = 0.1;
const LONGEST: f64 = 10.0;

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

/// The last direction, with what conjugates the next one to it.
struct Last {
    direction: Vec<DVec2>,
    residual: Vec<DVec2>,
    /// Product of the residual and the preconditioned one.
    product: f64,
}

/// A change of all tractions, to the end of a step.
struct Change {
    vectors: Vec<DVec2>,
    /// How fast the energy falls at first.
    slope: f64,
    /// Length of the step.
    length: f64,
    /// Whether it is against the gradient, so that directions begin anew.
    restarts: bool,
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
        let (mut last, mut length) = (None, 1.0);
        for round in 1..=MOST_ROUNDS {
            if observer.should_stop() {
                break;
            }
            let (free, residual) = self.free(&now, &displaced, best.bound.displacement);
            let direction = self.direction(&free, residual, &mut last);
            let Some(change) = self.change(&free, &now, &direction, length) else { break };
            if change.restarts {
                last = None;
            }
            let part = self.advance((&mut now, &mut displaced), &change);
            if !change.restarts {
                length = (change.length * part).clamp(SHORTEST, LONGEST);
            }
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

    /// How each element may move, and the residual of these motions. `guess` is one of d.
    fn free(&self, tractions: &[DVec2], displacements: &[DVec2], guess: DVec2) -> (Free, Vec<DVec2>) {
        let limits = &self.contact.limits;
        match self.prescribed {
            Prescribed::Displacement(given) => {
                let free = Free::new((tractions, limits), displacements, given, self.operator.own);
                let residual = free.residual();
                (free, residual)
            }
            Prescribed::Total(_) => {
                // The elements that stick tell d, which tells the elements that stick.
                let first = Free::new((tractions, limits), displacements, guess, self.operator.own);
                let given = guess + first.mean_gradient();
                let free = Free::new((tractions, limits), displacements, given, self.operator.own);
                let mut residual = free.residual();
                free.balance(&mut residual);
                (free, residual)
            }
        }
    }

    /// The direction of conjugate gradients for `residual`.
    fn direction(&self, free: &Free, residual: Vec<DVec2>, last: &mut Option<Last>) -> Vec<DVec2> {
        let mut scaled = residual.clone();
        free.scale(&mut scaled);
        let fields = self.operator.approximate_inverse(&self.contact.on_part(&scaled));
        let mut preconditioned = self.contact.vectors(&fields);
        free.scale(&mut preconditioned);
        free.confine(&mut preconditioned);
        if matches!(self.prescribed, Prescribed::Total(_)) {
            free.balance(&mut preconditioned);
        }
        let product = dot(&residual, &preconditioned);
        let mut direction = preconditioned;
        if let Some(last) = last {
            let change = product - dot(&direction, &last.residual);
            let part = (change / last.product).max(0.0);
            free.confine(&mut last.direction);
            for (now, before) in direction.iter_mut().zip(&last.direction) {
                *now += part * *before;
            }
            if matches!(self.prescribed, Prescribed::Total(_)) {
                free.balance(&mut direction);
            }
        }
        *last = Some(Last { direction: direction.clone(), residual, product });
        direction
    }

    /// A change of the tractions `now` that lowers the energy at first: to the discs from the end of a step of `length`
    /// along the direction, of a shorter one, or of one against the gradient. `None` at the minimum.
    fn change(&self, free: &Free, now: &[DVec2], direction: &[DVec2], length: f64) -> Option<Change> {
        let down = || free.gradient.iter().map(|g| -*g / self.operator.own).collect::<Vec<_>>();
        let to = |direction: &[DVec2], length: f64, to_border: bool| {
            let mut end: Vec<DVec2> = now.iter().zip(direction).map(|(t, p)| *t + length * *p).collect();
            if to_border {
                free.to_border(&mut end, &self.contact.limits);
            }
            self.project(&mut end);
            end.iter_mut().zip(now).for_each(|(end, t)| *end -= *t);
            let slope = -dot(&free.gradient, &end);
            (slope > 0.0).then_some(Change { vectors: end, slope, length, restarts: false })
        };
        let lengths = [1.0, 0.25, 0.0625].map(|part| part * length);
        let found = lengths.iter().find_map(|&length| to(direction, length, true));
        let found = found.or_else(|| to(direction, length, false));
        found.or_else(|| Some(Change { restarts: true, ..to(&down(), 1.0, false)? }))
    }

    /// Makes the change, or the part of it at which the energy is lowest. The result is that part, which may be above 1.
    fn advance(&self, (now, displaced): (&mut [DVec2], &mut [DVec2]), change: &Change) -> f64 {
        let displacements = self.apply(&change.vectors);
        let part = change.slope / dot(&change.vectors, &displacements);
        let taken = part.min(1.0);
        for ((t, v), (dt, dv)) in now.iter_mut().zip(displaced).zip(change.vectors.iter().zip(&displacements)) {
            *t += taken * *dt;
            *v += taken * *dv;
        }
        part
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

/// Σ a·b.
fn dot(a: &[DVec2], b: &[DVec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
}
