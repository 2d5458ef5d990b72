//! Conjugate gradients for the pressure, preconditioned with a multigrid cycle.

use rc_core::Grid;

use crate::multigrid::Multigrid;
use crate::network::{Axis, Network};
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
    pub(crate) values: Vec<f64>,
    pub(crate) iterations: usize,
    /// Largest difference of the flow through a section from the mean over all, relative to the latter.
    pub(crate) conservation: f64,
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
pub(crate) fn solve(network: &Network, multigrid: &mut Multigrid, target: Target) -> Pressure {
    let n = network.grid().len();
    let block = parallel::rows_per_block(network.grid().nx()) * network.grid().nx();
    let mut vectors =
        Vectors { values: vec![0.0; n], residual: vec![0.0; n], direction: vec![0.0; n], applied: vec![0.0; n], block };
    vectors.start(network, target);
    let mut next_check = f64::INFINITY;
    let (mut iterations, mut conservation) = (0, f64::INFINITY);
    let mut work_before = 0.0;
    let mut norm = vectors.write_residual(multigrid.right_mut());
    let enough = (norm * 1e-14).max(f64::MIN_POSITIVE);
    while iterations <= target.max_iterations {
        // Checks cost a pass; the residual says when another makes sense.
        if norm < next_check {
            conservation = deviation(&network.sections(&vectors.values, target.fall(), target.axis));
            if iterations > 0 && conservation <= target.conservation {
                break;
            }
            let ratio = 0.5 * target.conservation / conservation;
            next_check = norm * ratio.clamp(1e-3, 0.5);
        }
        if norm <= enough {
            break;
        }
        let step = multigrid.cycle();
        let work = vectors.dot_residual(step);
        if !(work > 0.0 && work.is_finite()) {
            break;
        }
        let beta = if work_before > 0.0 { work / work_before } else { 0.0 };
        work_before = work;
        vectors.turn(step, beta);
        let curvature = vectors.apply(network);
        if !(curvature > 0.0 && curvature.is_finite()) {
            break;
        }
        norm = vectors.step(work / curvature, multigrid.right_mut());
        iterations += 1;
    }
    conservation = deviation(&network.sections(&vectors.values, target.fall(), target.axis)).min(conservation);
    Pressure { values: vectors.values, iterations, conservation }
}

/// Largest difference from the mean, relative to it.
fn deviation(sections: &[f64]) -> f64 {
    let mean = sections.iter().sum::<f64>() / sections.len() as f64;
    let largest = sections.iter().map(|flow| (flow - mean).abs()).fold(0.0, f64::max);
    if mean > 0.0 { largest / mean } else { f64::INFINITY }
}

impl Vectors {
    /// The residual of no added pressure.
    fn start(&mut self, network: &Network, target: Target) {
        let (nx, values) = (network.grid().nx(), &self.values);
        let blocks = self.residual.chunks_mut(self.block).zip(network.blocks()).collect();
        parallel::for_each(blocks, |(residual, rows): (&mut [f64], [usize; 2])| {
            network.visit_fluxes(rows, values, target.fall(), &mut |row| {
                let out = &mut residual[(row.iy - rows[0]) * nx..][..nx];
                row.write_outflow(out);
                out.iter_mut().for_each(|out| *out = -*out);
            });
        });
    }

    /// Writes the residual in single precision, and gives its norm.
    fn write_residual(&self, right: &mut [f32]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(right.chunks_mut(self.block)).collect();
        parallel::sum(blocks, |(residual, right): (&[f64], &mut [f32])| {
            right.iter_mut().zip(residual).for_each(|(right, residual)| *right = *residual as f32);
            residual.iter().map(|r| r * r).sum()
        })
        .sqrt()
    }

    fn dot_residual(&self, step: &[f32]) -> f64 {
        let blocks = self.residual.chunks(self.block).zip(step.chunks(self.block)).collect();
        parallel::sum(blocks, |(residual, step): (&[f64], &[f32])| {
            residual.iter().zip(step).map(|(r, z)| r * f64::from(*z)).sum()
        })
    }

    /// The next direction, conjugate to the last.
    fn turn(&mut self, step: &[f32], beta: f64) {
        let blocks = self.direction.chunks_mut(self.block).zip(step.chunks(self.block)).collect();
        parallel::for_each(blocks, |(direction, step): (&mut [f64], &[f32])| {
            direction.iter_mut().zip(step).for_each(|(p, z)| *p = f64::from(*z) + beta * *p);
        });
    }

    /// Applies the network to the direction, and gives its curvature.
    fn apply(&mut self, network: &Network) -> f64 {
        let (nx, direction) = (network.grid().nx(), &self.direction);
        let blocks = self.applied.chunks_mut(self.block).zip(network.blocks()).collect();
        parallel::sum(blocks, |(applied, rows): (&mut [f64], [usize; 2])| {
            let mut curvature = 0.0;
            network.visit_fluxes(rows, direction, [0.0; 2], &mut |row| {
                let out = &mut applied[(row.iy - rows[0]) * nx..][..nx];
                row.write_outflow(out);
                let direction = &direction[row.iy * nx..(row.iy + 1) * nx];
                curvature += out.iter().zip(direction).map(|(a, p)| a * p).sum::<f64>();
            });
            curvature
        })
    }

    /// A step of `length` along the direction; writes the residual in single precision, and gives its norm.
    fn step(&mut self, length: f64, right: &mut [f32]) -> f64 {
        let block = self.block;
        let moved = self.values.chunks_mut(block).zip(self.direction.chunks(block));
        let left = self.residual.chunks_mut(block).zip(self.applied.chunks(block));
        let blocks = moved.zip(left).zip(right.chunks_mut(block)).collect();
        parallel::sum(blocks, |(((values, direction), (residual, applied)), right): StepBlock<'_>| {
            values.iter_mut().zip(direction).for_each(|(u, p)| *u += length * p);
            let mut sum = 0.0;
            for ((r, a), right) in residual.iter_mut().zip(applied).zip(right) {
                *r -= length * a;
                *right = *r as f32;
                sum += *r * *r;
            }
            sum
        })
        .sqrt()
    }
}

type StepBlock<'a> = (((&'a mut [f64], &'a [f64]), (&'a mut [f64], &'a [f64])), &'a mut [f32]);
