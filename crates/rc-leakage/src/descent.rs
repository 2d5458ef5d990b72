//! Conjugate gradients for the pressure, until the bounds of the permeance are close enough.

use crate::bounds::Bounds;
use crate::flow_state::FlowState;
use crate::network::{Axis, Network};
use crate::parallel;
use crate::preconditioner::Preconditioner;
use crate::products::dot;
use crate::real::Real;
use crate::tree::SpanningTree;

/// The flow to solve for: its axis and its accuracy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) axis: Axis,
    /// Maximum relative difference of the bounds.
    pub(crate) error: f64,
    /// Maximum relative difference of the flow through a section from the mean over all sections.
    pub(crate) conservation: f64,
}

/// A pressure with its flow and its bounds.
#[derive(Debug)]
pub(crate) struct Solved {
    /// Pressure of each element, without the mean fall of 1 per element along the axis.
    pub(crate) pressure: Vec<f64>,
    /// Flow from each element along the tree, after which the flow is conserved.
    ///
    /// It is empty before the bounds are first computed.
    pub(crate) correction: Vec<f64>,
    pub(crate) bounds: Bounds,
    pub(crate) iterations: usize,
}

impl Solved {
    /// The state before the first iteration, on `n` elements.
    ///
    /// The pressure has only its mean fall.
    pub(crate) fn start(n: usize) -> Self {
        let bounds = Bounds { upper: f64::INFINITY, lower: 0.0, flow: 0.0, conservation: f64::INFINITY };
        Self { pressure: parallel::zeros(n), correction: Vec::new(), bounds, iterations: 0 }
    }
}

impl Target {
    pub(crate) fn is_met(self, bounds: &Bounds) -> bool {
        bounds.relative() <= self.error && bounds.conservation <= self.conservation
    }
}

/// Estimated power left to gain at which the bounds are first computed.
///
/// The estimate is from the last two iterations. It is relative to the power, and the unit is the wanted difference of
/// the bounds.
const FIRST_LOOK: f64 = 0.03;

/// Reduction of the estimate before the bounds are computed again.
///
/// Its unit is the ratio of the wanted difference of the bounds to the one that was found.
const NEXT_LOOK: f64 = 0.3;

/// Range of the ratio of the gains of two successive iterations in the estimate.
///
/// A large gain in the first iteration, from a rough start, does not promise a small one in the third.
const RATIOS: [f64; 2] = [0.03, 0.5];

/// Maximum relative difference of the updated residual from the true one.
///
/// Beyond it, the iteration begins again from the true residual.
const DRIFT: f64 = 0.1;

/// Fraction of the power below which power and residual are computed again.
///
/// What is left of them is then rounding of the earlier values.
const CANCELLED: f64 = 1e-4;

/// Solves from the pressure of `solved` on, in at most `most` iterations.
pub(crate) fn solve<P: Preconditioner>(
    (network, tree): (&Network, &SpanningTree),
    solved: Solved,
    preconditioner: &mut P,
    target: Target,
    most: usize,
) -> Solved {
    let mut iteration = Iteration::new(network, solved, target, preconditioner);
    let mut look = FIRST_LOOK * target.error;
    let end = iteration.solved.iterations + most;
    loop {
        let left = iteration.advance(preconditioner);
        let is_last = left.is_none() || iteration.solved.iterations >= end;
        if is_last || left.is_some_and(|left| left <= look) {
            let bounds = iteration.look(tree, preconditioner);
            if is_last || target.is_met(&bounds) {
                return iteration.solved;
            }
            iteration.drawn = std::mem::take(&mut iteration.solved.correction);
            iteration.draw(preconditioner);
            look = left.unwrap_or(0.0).min(look) * (NEXT_LOOK * target.error / bounds.relative()).clamp(1e-6, 0.3);
        }
    }
}

/// The state of conjugate gradients.
///
/// Directions have the precision of the preconditioner. The residual is in double precision, since rounding that flows
/// into a pool can leave it only through its weakest bonds.
struct Iteration<'a, T> {
    network: &'a Network,
    target: Target,
    solved: Solved,
    residual: Vec<f64>,
    direction: Vec<T>,
    /// Flow out of each element under the direction.
    drawn: Vec<f64>,
    /// Power when it was last summed, and the gain since then.
    power: [f64; 2],
    /// Gain of power in the last iteration; 0 before the first.
    gain: f64,
    /// Product of the direction and `drawn`; 0 before the first iteration.
    curvature: f64,
    block: usize,
}

impl<'a, T: Real> Iteration<'a, T> {
    fn new<P: Preconditioner<Value = T>>(
        network: &'a Network,
        solved: Solved,
        target: Target,
        preconditioner: &mut P,
    ) -> Self {
        let (n, nx) = (network.grid().len(), network.grid().nx());
        let block = parallel::rows_per_block(nx) * nx;
        let [residual, drawn] = [(); 2].map(|()| vec![0.0; n]);
        let direction = parallel::zeros(n);
        let (power, gain, curvature) = ([0.0; 2], 0.0, 0.0);
        let mut this = Self { network, target, solved, residual, direction, drawn, power, gain, curvature, block };
        this.renew(preconditioner);
        this
    }

    /// Begins again, with residual and power of the current pressure.
    fn renew<P: Preconditioner<Value = T>>(&mut self, preconditioner: &mut P) {
        let mut residual = std::mem::take(&mut self.residual);
        self.power = [self.state().write_excess(&mut residual), 0.0];
        self.residual = residual;
        self.begin(preconditioner);
    }

    /// Begins again from the residual.
    fn begin<P: Preconditioner<Value = T>>(&mut self, preconditioner: &mut P) {
        let blocks = self.residual.chunks(self.block).zip(preconditioner.right_mut().chunks_mut(self.block)).collect();
        parallel::for_each(blocks, |(residual, right): (&[f64], &mut [T])| {
            right.iter_mut().zip(residual).for_each(|(right, residual)| *right = T::of(*residual));
        });
        self.curvature = 0.0;
    }

    fn state(&self) -> FlowState<'_> {
        FlowState::of(self.network, &self.solved.pressure, self.target.axis.unit())
    }

    /// Computes the bounds of the current pressure.
    fn look<P: Preconditioner<Value = T>>(&mut self, tree: &SpanningTree, preconditioner: &mut P) -> Bounds {
        // This is when most memory is in use, so the flow takes the place of `drawn`.
        let mut excess = std::mem::take(&mut self.drawn);
        let power = self.state().write_excess(&mut excess);
        if self.drift(&excess) > DRIFT {
            self.residual.copy_from_slice(&excess);
            self.begin(preconditioner);
        }
        self.solved.bounds = Bounds::of((self.state(), power), tree, self.target.axis, &mut excess);
        self.solved.correction = excess;
        self.power = [power, 0.0];
        self.solved.bounds
    }

    /// Relative difference of the residual from `excess`, the true residual.
    fn drift(&self, excess: &[f64]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(excess.chunks(self.block)).collect();
        let sums = parallel::map(blocks, |(residual, excess): (&[f64], &[f64])| {
            let pairs = residual.iter().zip(excess);
            pairs.fold([0.0; 2], |[off, all], (r, e)| [off + (r - e) * (r - e), all + e * e])
        });
        let [off, all] = sums.into_iter().fold([0.0; 2], |[a, b], [off, all]| [a + off, b + all]);
        if all > 0.0 { (off / all).sqrt() } else { 0.0 }
    }

    /// Advances by one iteration, and estimates the relative power that is still to be gained.
    ///
    /// `None` if there is no direction left.
    fn advance<P: Preconditioner<Value = T>>(&mut self, preconditioner: &mut P) -> Option<f64> {
        let step = preconditioner.apply();
        self.turn(step);
        let [slope, curvature] = self.draw(preconditioner);
        self.curvature = curvature;
        if !(slope > 0.0 && curvature > 0.0 && curvature.is_finite()) {
            return None;
        }
        let length = slope / curvature;
        self.step(length, preconditioner.right_mut());
        self.solved.iterations += 1;
        let (gain, before) = (length * slope, std::mem::replace(&mut self.gain, length * slope));
        self.power[1] += gain;
        if self.power[0] - self.power[1] < CANCELLED * self.power[0] {
            self.renew(preconditioner);
        }
        let ratio = if before > 0.0 { (gain / before).clamp(RATIOS[0], RATIOS[1]) } else { RATIOS[1] };
        Some(gain * ratio / (1.0 - ratio) / (self.power[0] - self.power[1]))
    }

    /// Computes the next direction: the step of the preconditioner, made conjugate to the last direction.
    ///
    /// This does not need a linear preconditioner.
    fn turn(&mut self, step: &[T]) {
        let block = self.block;
        let mut along = T::ZERO;
        if self.curvature > 0.0 {
            let blocks = self.drawn.chunks(block).zip(step.chunks(block)).collect();
            let product = parallel::sum(blocks, |(drawn, step): (&[f64], &[T])| dot(drawn, step));
            along = T::of(-product / self.curvature);
        }
        let blocks = self.direction.chunks_mut(block).zip(step.chunks(block)).collect();
        parallel::for_each(blocks, |(direction, step): (&mut [T], &[T])| {
            direction.iter_mut().zip(step).for_each(|(p, z)| *p = *z + along * *p);
        });
    }

    /// Computes the flow under the direction, `drawn`.
    ///
    /// Returns the products of the direction with the residual and with `drawn`.
    fn draw<P: Preconditioner<Value = T>>(&mut self, preconditioner: &P) -> [f64; 2] {
        let (network, direction, nx) = (self.network, &self.direction, self.network.grid().nx());
        let blocks = self.drawn.chunks_mut(self.block).zip(self.residual.chunks(self.block)).zip(network.blocks());
        let sums = parallel::map(blocks.collect(), |((drawn, residual), rows): DrawBlock<'_>| {
            let mut sums = [0.0; 2];
            for (iy, (drawn, residual)) in (rows[0]..).zip(drawn.chunks_mut(nx).zip(residual.chunks(nx))) {
                preconditioner.draw(network, direction, iy, drawn);
                let here = &direction[iy * nx..][..nx];
                sums = [sums[0] + dot(residual, here), sums[1] + dot(drawn, here)];
            }
            sums
        });
        sums.into_iter().fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y])
    }

    /// Takes a step of `length` along the direction.
    ///
    /// It writes the residual as the right-hand side of the preconditioner.
    fn step(&mut self, length: f64, right: &mut [T]) {
        let block = self.block;
        let moved = self.solved.pressure.chunks_mut(block).zip(self.direction.chunks(block));
        let left = self.residual.chunks_mut(block).zip(self.drawn.chunks(block));
        let blocks = moved.zip(left).zip(right.chunks_mut(block)).collect();
        parallel::for_each(blocks, |(((values, direction), (residual, drawn)), right): StepBlock<'_, T>| {
            values.iter_mut().zip(direction).for_each(|(u, p)| *u += length * p.to_f64());
            for ((r, drawn), right) in residual.iter_mut().zip(drawn).zip(right) {
                *r -= length * drawn;
                *right = T::of(*r);
            }
        });
    }
}

type DrawBlock<'a> = ((&'a mut [f64], &'a [f64]), [usize; 2]);
type StepBlock<'a, T> = (((&'a mut [f64], &'a [T]), (&'a mut [f64], &'a [f64])), &'a mut [T]);
