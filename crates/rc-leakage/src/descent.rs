//! Conjugate gradients for the pressure, preconditioned with a multigrid cycle.

use rc_core::Grid;

use crate::multigrid::{Multigrid, Real};
use crate::network::{Axis, Network, Potential};
use crate::parallel;

/// What is solved for: the flow along an axis, and how exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target {
    pub(crate) axis: Axis,
    /// Largest difference of the flow through two sections, relative to the flow.
    pub(crate) conservation: f64,
    pub(crate) max_iterations: usize,
}

/// The pressure of the solved flow.
#[derive(Debug)]
pub(crate) struct Pressure {
    /// What is added to the mean fall, of 1 per element along the axis.
    values: Vec<f64>,
    /// What is added to them, where their own digits are not enough.
    rest: Option<Vec<f32>>,
    pub(crate) iterations: usize,
    /// Largest difference of the flow through a section from the mean over all, relative to the latter.
    pub(crate) conservation: f64,
}

impl Pressure {
    pub(crate) fn potential(&self) -> Potential<'_> {
        Potential { values: &self.values, rest: self.rest.as_deref() }
    }

    /// Adds `values`, and keeps what is rounded away.
    fn add(&mut self, values: &mut [f64], block: usize) {
        let rest = self.rest.get_or_insert_with(|| vec![0.0; values.len()]);
        let sums = self.values.chunks_mut(block).zip(rest.chunks_mut(block));
        let blocks = sums.zip(values.chunks_mut(block)).collect();
        parallel::for_each(blocks, |((sums, rest), values): ((&mut [f64], &mut [f32]), &mut [f64])| {
            for ((sum, rest), value) in sums.iter_mut().zip(rest).zip(values) {
                let first = *sum + *value;
                let back = first - *sum;
                let lost = (*sum - (first - back)) + (*value - back) + f64::from(*rest);
                *sum = first + lost;
                *rest = (lost - (*sum - first)) as f32;
                *value = 0.0;
            }
        });
    }
}

impl Target {
    /// Fall of the pressure per element.
    pub(crate) fn fall(self) -> [f64; 2] {
        match self.axis {
            Axis::X => [1.0, 0.0],
            Axis::Y => [0.0, 1.0],
        }
    }
}

/// Elements along `axis`.
pub(crate) fn elements_along(grid: Grid, axis: Axis) -> usize {
    match axis {
        Axis::X => grid.nx(),
        Axis::Y => grid.ny(),
    }
}

struct Vectors {
    values: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    applied: Vec<f64>,
    block: usize,
}

/// Solves for the pressure that conserves the flow.
///
/// Where the film is much wider in some places than in others, the pressure in wide places differs by less than its last digit. Iterations
/// then go on with what is missing, added to the pressure in twice the precision.
pub(crate) fn solve<T: Real>(network: &Network, multigrid: &mut Multigrid<T>, target: Target) -> Pressure {
    let mut iteration = Iteration::new(network, target);
    let mut pressure = Pressure { values: Vec::new(), rest: None, iterations: 0, conservation: f64::INFINITY };
    let mut norm = iteration.vectors.write_residual(multigrid.right_mut());
    let largest = GROWTH * norm;
    let mut expected = f64::INFINITY;
    let mut next_check = f64::INFINITY;
    loop {
        // Checks cost a pass; the residual says when another makes sense.
        if norm <= next_check || pressure.iterations >= target.max_iterations {
            let conservation = iteration.check(&mut pressure);
            if conservation <= target.conservation || pressure.iterations >= target.max_iterations {
                break;
            }
            if conservation > STAGNATION * expected {
                iteration.refine(&mut pressure);
                norm = iteration.vectors.write_residual(multigrid.right_mut());
            }
            let ratio = (SAFETY * target.conservation / conservation).clamp(1e-4, SAFETY);
            (next_check, expected) = (norm * ratio, conservation * ratio);
        }
        match iteration.advance(multigrid) {
            Some(next) if next <= largest => norm = next,
            _ => break,
        }
        pressure.iterations += 1;
    }
    iteration.finish(pressure)
}

/// Part of the tolerance that the next check is to find.
const SAFETY: f64 = 0.4;

/// A residual that has grown by this factor is that of rounding.
const GROWTH: f64 = 1e10;

/// A check that finds this much more than expected says that the pressure has run out of digits.
const STAGNATION: f64 = 10.0;

/// Conjugate gradients under way.
struct Iteration<'a> {
    network: &'a Network,
    target: Target,
    vectors: Vectors,
    /// ⟨residual, step⟩ of the last iteration; 0 before the first.
    work: f64,
}

impl<'a> Iteration<'a> {
    fn new(network: &'a Network, target: Target) -> Self {
        let (n, nx) = (network.grid().len(), network.grid().nx());
        let [values, residual, direction, applied] = [(); 4].map(|()| vec![0.0; n]);
        let mut vectors = Vectors { values, residual, direction, applied, block: parallel::rows_per_block(nx) * nx };
        let mut fluxes = std::mem::take(&mut vectors.residual);
        let start = Potential { values: &vectors.values, rest: None };
        write_residual_of(network, start, target.fall(), (&mut fluxes, vectors.block));
        vectors.residual = fluxes;
        Self { network, target, vectors, work: 0.0 }
    }

    /// Measures how well the flow so far is conserved.
    fn check(&mut self, pressure: &mut Pressure) -> f64 {
        if !pressure.values.is_empty() {
            pressure.add(&mut self.vectors.values, self.vectors.block);
        }
        let so_far = Potential { values: &self.vectors.values, rest: None };
        let so_far = if pressure.values.is_empty() { so_far } else { pressure.potential() };
        let sections = self.network.sections(so_far, self.target.fall(), self.target.axis);
        pressure.conservation = deviation(&sections);
        pressure.conservation
    }

    /// Starts anew with what is missing of the pressure.
    fn refine(&mut self, pressure: &mut Pressure) {
        if pressure.values.is_empty() {
            pressure.values = std::mem::replace(&mut self.vectors.values, vec![0.0; self.network.grid().len()]);
        }
        let out = (&mut self.vectors.residual[..], self.vectors.block);
        write_residual_of(self.network, pressure.potential(), self.target.fall(), out);
        self.work = 0.0;
    }

    /// One iteration; the norm of the residual after it, or `None` where none is left to descend along.
    fn advance<T: Real>(&mut self, multigrid: &mut Multigrid<T>) -> Option<f64> {
        let step = multigrid.cycle();
        let work = self.vectors.dot_residual(step);
        if !(work > 0.0 && work.is_finite()) {
            return None;
        }
        let beta = if self.work > 0.0 { work / self.work } else { 0.0 };
        self.work = work;
        self.vectors.turn(step, beta);
        let curvature = self.vectors.apply(self.network);
        if !(curvature > 0.0 && curvature.is_finite()) {
            return None;
        }
        Some(self.vectors.step(work / curvature, multigrid.right_mut()))
    }

    /// The pressure, with how well it conserves the flow.
    fn finish(mut self, mut pressure: Pressure) -> Pressure {
        self.check(&mut pressure);
        if pressure.values.is_empty() {
            pressure.values = self.vectors.values;
        }
        pressure
    }
}

/// Writes what flows into elements in excess of what flows out, in blocks of `block` elements.
fn write_residual_of(network: &Network, pressure: Potential<'_>, fall: [f64; 2], (out, block): (&mut [f64], usize)) {
    let nx = network.grid().nx();
    let blocks = out.chunks_mut(block).zip(network.blocks()).collect();
    parallel::for_each(blocks, |(residual, rows): (&mut [f64], [usize; 2])| {
        network.visit_fluxes(rows, pressure, fall, &mut |row| {
            let out = &mut residual[(row.iy - rows[0]) * nx..][..nx];
            row.write_outflow(out);
            for out in out {
                *out = -*out;
            }
        });
    });
}

/// Largest difference from the mean, relative to it.
fn deviation(sections: &[f64]) -> f64 {
    let mean = sections.iter().sum::<f64>() / sections.len() as f64;
    let largest = sections.iter().map(|flow| (flow - mean).abs()).fold(0.0, f64::max);
    if mean > 0.0 { largest / mean } else { f64::INFINITY }
}

impl Vectors {
    /// Writes the residual in single precision, and gives its norm.
    fn write_residual<T: Real>(&self, right: &mut [T]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(right.chunks_mut(self.block)).collect();
        parallel::sum(blocks, |(residual, right): (&[f64], &mut [T])| {
            right.iter_mut().zip(residual).for_each(|(right, residual)| *right = T::of(*residual));
            residual.iter().map(|r| r * r).sum()
        })
        .sqrt()
    }

    fn dot_residual<T: Real>(&self, step: &[T]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(step.chunks(self.block)).collect();
        parallel::sum(blocks, |(residual, step): (&[f64], &[T])| {
            residual.iter().zip(step).map(|(r, z)| r * z.to_f64()).sum()
        })
    }

    /// The next direction, conjugate to the last.
    fn turn<T: Real>(&mut self, step: &[T], beta: f64) {
        let blocks = self.direction.chunks_mut(self.block).zip(step.chunks(self.block)).collect();
        parallel::for_each(blocks, |(direction, step): (&mut [f64], &[T])| {
            direction.iter_mut().zip(step).for_each(|(p, z)| *p = z.to_f64() + beta * *p);
        });
    }

    /// Applies the network to the direction, and gives its curvature.
    fn apply(&mut self, network: &Network) -> f64 {
        let (nx, direction) = (network.grid().nx(), &self.direction);
        let blocks = self.applied.chunks_mut(self.block).zip(network.blocks()).collect();
        parallel::sum(blocks, |(applied, rows): (&mut [f64], [usize; 2])| {
            let mut curvature = 0.0;
            network.visit_fluxes(rows, Potential { values: direction, rest: None }, [0.0; 2], &mut |row| {
                let out = &mut applied[(row.iy - rows[0]) * nx..][..nx];
                row.write_outflow(out);
                let direction = &direction[row.iy * nx..(row.iy + 1) * nx];
                curvature += out.iter().zip(direction).map(|(a, p)| a * p).sum::<f64>();
            });
            curvature
        })
    }

    /// A step of `length` along the direction; writes the residual in the precision of the cycle, and gives its norm.
    fn step<T: Real>(&mut self, length: f64, right: &mut [T]) -> f64 {
        let block = self.block;
        let moved = self.values.chunks_mut(block).zip(self.direction.chunks(block));
        let left = self.residual.chunks_mut(block).zip(self.applied.chunks(block));
        let blocks = moved.zip(left).zip(right.chunks_mut(block)).collect();
        parallel::sum(blocks, |(((values, direction), (residual, applied)), right): StepBlock<'_, T>| {
            values.iter_mut().zip(direction).for_each(|(u, p)| *u += length * p);
            let mut sum = 0.0;
            for ((r, a), right) in residual.iter_mut().zip(applied).zip(right) {
                *r -= length * a;
                *right = T::of(*r);
                sum += *r * *r;
            }
            sum
        })
        .sqrt()
    }
}

type StepBlock<'a, T> = (((&'a mut [f64], &'a [f64]), (&'a mut [f64], &'a [f64])), &'a mut [T]);
