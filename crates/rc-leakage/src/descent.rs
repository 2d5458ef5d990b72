//! Conjugate gradients for the pressure, until the bounds of the permeance are close enough.

use crate::bounds::Bounds;
use crate::flow_state::FlowState;
use crate::network::{Axis, Network};
use crate::parallel;
use crate::preconditioner::Preconditioner;
use crate::real::Real;
use crate::tree::SpanningTree;

/// The flow to solve for: its axis and its accuracy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) axis: Axis,
    /// Maximum relative difference of the bounds.
    pub(crate) error: f64,
    /// Maximum difference of the flow through two sections, relative to the flow.
    pub(crate) conservation: f64,
}

/// A pressure with its flow and its bounds.
#[derive(Debug)]
pub(crate) struct Solved {
    /// What is added to the mean fall, of 1 per element along the axis.
    pub(crate) pressure: Vec<f64>,
    /// Flow from each element along the tree, which makes the flow conserved.
    pub(crate) correction: Vec<f64>,
    pub(crate) bounds: Bounds,
    pub(crate) iterations: usize,
}

impl Solved {
    /// No pressure but the mean fall, on `n` elements.
    pub(crate) fn start(n: usize) -> Self {
        let bounds = Bounds { upper: f64::INFINITY, lower: 0.0, conservation: f64::INFINITY };
        Self { pressure: vec![0.0; n], correction: vec![0.0; n], bounds, iterations: 0 }
    }
}

impl Target {
    pub(crate) fn is_met(self, bounds: &Bounds) -> bool {
        bounds.relative() <= self.error && bounds.conservation <= self.conservation
    }
}

/// A gain of the last iteration below this part of the wanted error makes a look at the bounds worth its time.
const FIRST_LOOK: f64 = 0.1;

/// What the gain is to fall to after a look, as a part of what the difference of the bounds has to.
const NEXT_LOOK: f64 = 0.1;

/// A recurrence that differs from the true residual by more than this part of it begins anew.
const DRIFT: f64 = 0.1;

/// Part of the power below which what is left of it, and of the residual, is rounding of what was there before: both
/// are computed anew.
const CANCELLED: f64 = 1e-4;

/// Solves from the pressure of `solved` on, in at most `iterations`.
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
        let gain = iteration.advance(preconditioner);
        let is_last = gain.is_none() || iteration.solved.iterations >= end;
        if is_last || gain.is_some_and(|gain| gain <= look) {
            let bounds = iteration.look(tree, preconditioner);
            if is_last || target.is_met(&bounds) {
                return iteration.solved;
            }
            // The look took the place of what the direction was applied to.
            iteration.apply();
            look = gain.unwrap_or(0.0).min(look) * (NEXT_LOOK * target.error / bounds.relative()).clamp(1e-6, 0.3);
        }
    }
}

/// Conjugate gradients under way.
struct Iteration<'a> {
    network: &'a Network,
    target: Target,
    /// Its `correction` is scratch between looks.
    solved: Solved,
    residual: Vec<f64>,
    direction: Vec<f64>,
    /// Power at the start, or when it was last summed, and what was gained since.
    power: [f64; 2],
    /// Product of the direction and of what it was applied to; 0 before the first iteration.
    curvature: f64,
    block: usize,
}

impl<'a> Iteration<'a> {
    fn new<P: Preconditioner>(network: &'a Network, solved: Solved, target: Target, preconditioner: &mut P) -> Self {
        let (n, nx) = (network.grid().len(), network.grid().nx());
        let block = parallel::rows_per_block(nx) * nx;
        let [residual, direction] = [(); 2].map(|()| vec![0.0; n]);
        let mut this = Self { network, target, solved, residual, direction, power: [0.0; 2], curvature: 0.0, block };
        this.renew(preconditioner);
        this
    }

    /// Computes the residual and the power of the pressure so far, and begins anew from there.
    fn renew<P: Preconditioner>(&mut self, preconditioner: &mut P) {
        let state = FlowState::of(self.network, &self.solved.pressure, self.target.axis.unit());
        state.write_excess(&mut self.residual);
        self.power = [state.power_and_sections(self.target.axis).0, 0.0];
        self.write_right(preconditioner.right_mut());
        self.curvature = 0.0;
    }

    fn state(&self) -> FlowState<'_> {
        FlowState::of(self.network, &self.solved.pressure, self.target.axis.unit())
    }

    /// Bounds of the pressure so far.
    fn look<P: Preconditioner>(&mut self, tree: &SpanningTree, preconditioner: &mut P) -> Bounds {
        let mut excess = std::mem::take(&mut self.solved.correction);
        self.state().write_excess(&mut excess);
        if self.drift(&excess) > DRIFT {
            self.residual.copy_from_slice(&excess);
            self.write_right(preconditioner.right_mut());
            self.curvature = 0.0;
        }
        self.solved.bounds = Bounds::of(self.state(), tree, self.target.axis, &mut excess);
        self.solved.correction = excess;
        self.power = [self.solved.bounds.upper, 0.0];
        self.solved.bounds
    }

    /// Difference of the residual from `excess`, the true one, relative to it.
    fn drift(&self, excess: &[f64]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(excess.chunks(self.block)).collect();
        let sums = parallel::map(blocks, |(residual, excess): (&[f64], &[f64])| {
            let pairs = residual.iter().zip(excess);
            pairs.fold([0.0; 2], |[off, all], (r, e)| [off + (r - e) * (r - e), all + e * e])
        });
        let [off, all] = sums.into_iter().fold([0.0; 2], |[a, b], [off, all]| [a + off, b + all]);
        if all > 0.0 { (off / all).sqrt() } else { 0.0 }
    }

    /// One iteration; what it gained of the power, relative to it, or `None` where nothing is left to descend along.
    fn advance<P: Preconditioner>(&mut self, preconditioner: &mut P) -> Option<f64> {
        let step = preconditioner.apply();
        self.turn(step);
        let [slope, curvature] = self.apply();
        self.curvature = curvature;
        if !(slope > 0.0 && curvature > 0.0 && curvature.is_finite()) {
            return None;
        }
        let length = slope / curvature;
        self.step(length, preconditioner.right_mut());
        self.solved.iterations += 1;
        self.power[1] += length * slope;
        if self.power[0] - self.power[1] < CANCELLED * self.power[0] {
            self.renew(preconditioner);
        }
        Some(length * slope / (self.power[0] - self.power[1]))
    }

    /// Writes the residual as the right side of the preconditioner.
    fn write_right<T: Real>(&self, right: &mut [T]) {
        let blocks = self.residual.chunks(self.block).zip(right.chunks_mut(self.block)).collect();
        parallel::for_each(blocks, |(residual, right): (&[f64], &mut [T])| {
            right.iter_mut().zip(residual).for_each(|(right, residual)| *right = T::of(*residual));
        });
    }

    /// The next direction: what the preconditioner found, made conjugate to the last. It need not be linear for that.
    fn turn<T: Real>(&mut self, step: &[T]) {
        let block = self.block;
        let mut along = 0.0;
        if self.curvature > 0.0 {
            let blocks = self.solved.correction.chunks(block).zip(step.chunks(block)).collect();
            let dot = parallel::sum(blocks, |(applied, step): (&[f64], &[T])| {
                applied.iter().zip(step).map(|(a, z)| a * z.to_f64()).sum()
            });
            along = -dot / self.curvature;
        }
        let blocks = self.direction.chunks_mut(block).zip(step.chunks(block)).collect();
        parallel::for_each(blocks, |(direction, step): (&mut [f64], &[T])| {
            direction.iter_mut().zip(step).for_each(|(p, z)| *p = z.to_f64() + along * *p);
        });
    }

    /// Applies the network to the direction: products of it with the residual and with what it was applied to.
    fn apply(&mut self) -> [f64; 2] {
        let (nx, direction, residual) = (self.network.grid().nx(), &self.direction, &self.residual);
        let state = FlowState::of(self.network, direction, [0.0; 2]);
        let blocks = self.solved.correction.chunks_mut(self.block).zip(self.network.blocks()).collect();
        let sums = parallel::map(blocks, |(applied, rows): (&mut [f64], [usize; 2])| {
            let mut sums = [0.0; 2];
            state.visit(rows, &mut |row| {
                let out = &mut applied[(row.iy - rows[0]) * nx..][..nx];
                row.write_outflow(out);
                let range = row.iy * nx..(row.iy + 1) * nx;
                sums[0] +=
                    residual[range.clone()].iter().zip(&direction[range.clone()]).map(|(r, p)| r * p).sum::<f64>();
                sums[1] += out.iter().zip(&direction[range]).map(|(a, p)| a * p).sum::<f64>();
            });
            sums
        });
        sums.into_iter().fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y])
    }

    /// A step of `length` along the direction; writes the residual as the right side of the preconditioner.
    fn step<T: Real>(&mut self, length: f64, right: &mut [T]) {
        let block = self.block;
        let moved = self.solved.pressure.chunks_mut(block).zip(self.direction.chunks(block));
        let left = self.residual.chunks_mut(block).zip(self.solved.correction.chunks(block));
        let blocks = moved.zip(left).zip(right.chunks_mut(block)).collect();
        parallel::for_each(blocks, |(((values, direction), (residual, applied)), right): StepBlock<'_, T>| {
            values.iter_mut().zip(direction).for_each(|(u, p)| *u += length * p);
            for ((r, a), right) in residual.iter_mut().zip(applied).zip(right) {
                *r -= length * a;
                *right = T::of(*r);
            }
        });
    }
}

type StepBlock<'a, T> = (((&'a mut [f64], &'a [f64]), (&'a mut [f64], &'a [f64])), &'a mut [T]);
