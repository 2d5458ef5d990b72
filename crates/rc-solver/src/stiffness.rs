//! The incremental contact stiffness.

use rayon::prelude::*;
use rc_core::{Field, Kernel};
use rc_fft::{Convolution, SymbolTable};

use crate::descent::Engine;
use crate::problem::power_of_two_near;

/// The iteration ends when a step adds less than this fraction; what later steps would add is of the same order.
const SMALLEST_GAIN: f64 = 3e-4;

/// Enough for the worst scenes at [`SMALLEST_GAIN`]; reached only when rounding prevents progress.
const MOST_STEPS: usize = 50;

/// dσ0/dΔ, in E*/λ, on a uniform grid; see [`stiffness_of`].
pub(crate) fn contact_stiffness(pressure: &Field, kernel: &dyn Kernel) -> f64 {
    let grid = pressure.grid();
    if pressure.values().par_iter().all(|&p| p > 0.0) {
        return f64::INFINITY;
    }
    let response = SymbolTable::<f64>::new(grid, kernel.symbol(grid));
    let mut preconditioner = response.inverse(grid).map(|value| value as f32);
    let response = response.map(|value| value as f32);
    let mut convolution = Convolution::<f32>::new(grid);
    stiffness_of(pressure.values(), grid.len() as f64, &mut convolution, &response, &mut preconditioner)
}

/// dσ0/dΔ, in E*/λ, for the contact set {p > 0}: the mean over a cell of `n` of the smallest elements of the pressure x that displaces every
/// element in contact by 1, `L x = 1` there. The set may be held fixed, since pressure and gap vanish at its edge, so that
/// moving it is of second order.
///
/// The mean of x is the maximum of 2⟨x⟩ - ⟨x L x⟩, so its error is the square of that of x, and conjugate gradients in
/// single precision reach 1e-3 in about five steps.
pub(crate) fn stiffness_of<C: Engine<f32>>(
    pressure: &[f64],
    n: f64,
    engine: &mut C,
    response: &C::Table,
    preconditioner: &mut C::Table,
) -> f64 {
    let blocks = engine.blocks();
    let block = blocks.len();
    let in_contact: Vec<bool> = pressure.par_iter().map(|&p| p > 0.0).collect();
    let zeros = || vec![0.0_f32; pressure.len()];
    let (mut residual, mut z, mut t, mut u) = (zeros(), zeros(), zeros(), zeros());
    // The first direction is the pressure itself: its best multiple has the secant stiffness σ0²/mean(p v).
    // Its size is taken away: no multiple of it underflows.
    let size = power_of_two_near(pressure.iter().copied().fold(0.0, f64::max));
    for (t, &p) in t.iter_mut().zip(pressure) {
        *t = (p / size) as f32;
    }
    for (residual, &c) in residual.iter_mut().zip(&in_contact) {
        *residual = f32::from(u8::from(c));
    }
    let mut stiffness = 0.0;
    for step in 0..MOST_STEPS {
        let sinks = (t.par_chunks(block), residual.par_chunks(block), u.par_chunks_mut(block));
        engine.fill(t.par_chunks(block), |t, rows| rows.copy_from_slice(t));
        engine.multiply(response);
        let sums = engine.take(response, sinks.into_par_iter(), |(t, residual, u), rows| {
            u.copy_from_slice(rows);
            [dot(t, rows), dot(t, residual)]
        });
        let [curvature, slope] = blocks.total(sums);
        if curvature <= 0.0 || !curvature.is_finite() {
            break;
        }
        let gain = slope * slope / (curvature * n);
        stiffness += gain;
        if step > 0 && gain < SMALLEST_GAIN * stiffness {
            break;
        }
        if step == 0 {
            engine.set_mean(preconditioner, stiffness);
        }
        let length = (slope / curvature) as f32;
        let sources = (residual.par_chunks_mut(block), u.par_chunks(block), in_contact.par_chunks(block));
        let sinks = (u.par_chunks(block), in_contact.par_chunks(block), z.par_chunks_mut(block));
        engine.fill(sources.into_par_iter(), |(residual, u, in_contact), rows| {
            for (((r, &u), &c), row) in residual.iter_mut().zip(u).zip(in_contact).zip(rows) {
                *r = if c { *r - length * u } else { 0.0 };
                *row = *r;
            }
        });
        engine.multiply(preconditioner);
        let sums = engine.take(preconditioner, sinks.into_par_iter(), |(u, in_contact, z), rows| {
            for ((z, &row), &c) in z.iter_mut().zip(rows).zip(in_contact) {
                *z = if c { row } else { 0.0 };
            }
            [dot(z, u)]
        });
        let [zu] = blocks.total(sums);
        let beta = (zu / curvature) as f32;
        t.par_iter_mut().zip(&z).for_each(|(t, &z)| *t = z - beta * *t);
    }
    stiffness
}

/// Scalar product of one block, in double precision.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum()
}
