//! The incremental contact stiffness.

use std::borrow::Cow;

use rc_core::{Boundary, Field, Kernel};

use crate::descent::directions::{ConjugateDirections, Slope};
use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, PreconditionedOperator, read_blocks, write_blocks};
use crate::grid::operators::UniformCorrections;
use crate::grid::response::GridResponse;
use crate::parallel;
use crate::problem::checked::power_of_two_near;
use crate::problem::support::Support;

/// The iteration ends when a step adds less than this fraction.
///
/// The sum of all later steps is of the same order.
const SMALLEST_GAIN: f64 = 3e-4;

/// The same for a pressure that did not converge, whose stiffness is a few percent off in any case.
///
/// Who stops a solve does not want to wait for as many applications of L again.
const ROUGH_GAIN: f64 = 3e-2;

/// Maximum number of steps, enough for the worst scenes at [`SMALLEST_GAIN`].
///
/// It is reached only when rounding prevents progress.
const MAX_STEPS: usize = 50;

/// The pressure of elements that are not plastic.
///
/// The pressure of plastic elements stays the `hardness` when the load grows.
pub(crate) fn elastic_part(pressure: &[f64], hardness: f64) -> Cow<'_, [f64]> {
    if hardness.is_infinite() {
        return Cow::Borrowed(pressure);
    }
    pressure.iter().map(|&p| if p < hardness { p } else { 0.0 }).collect()
}

/// dσ0/dΔ, in E*/λ, on a uniform grid, as [`stiffness_of`].
///
/// It is to a few percent unless the pressure has `converged`.
pub(crate) fn contact_stiffness(pressure: &Field, hardness: f64, kernel: &dyn Kernel, converged: bool) -> f64 {
    let grid = pressure.grid();
    let (pressure, support) = (elastic_part(pressure.values(), hardness), Support::of(kernel, grid));
    if support.boundary == Boundary::Periodic && pressure.iter().all(|&p| p > 0.0) {
        return support.compliance.recip();
    }
    let mut operator = UniformCorrections::new(grid, kernel, &GridResponse::of(grid, kernel));
    search(&pressure, (grid.len() as f64, gain(converged)), &mut operator, |_, _| {})
}

/// dσ0/dΔ, in E*/λ, for the contact set {p > 0}.
///
/// It is the mean of the pressure x that displaces every element in contact by 1: `L x = 1` there. The mean is over a
/// cell of `n` of the smallest elements. The set may be held fixed: pressure and gap vanish at its edge, so moving it
/// is of second order.
///
/// The mean of x is the maximum of 2⟨x⟩ - ⟨x L x⟩, so its error is the square of the error of x. Conjugate gradients in
/// single precision therefore reach 1e-3 in about five steps.
pub(crate) fn stiffness_of(pressure: &[f64], n: f64, operator: &mut dyn PreconditionedOperator) -> f64 {
    search(pressure, (n, SMALLEST_GAIN), operator, |_, _| {})
}

/// The pressure x of [`stiffness_of`], as exact as the operator, or roughly unless `pressure` has `converged`.
pub(crate) fn stiffness_pressure(
    pressure: &[f64],
    n: f64,
    operator: &mut dyn PreconditionedOperator,
    converged: bool,
) -> Vec<f32> {
    let mut x = vec![0.0_f32; pressure.len()];
    search(pressure, (n, gain(converged)), operator, |length, directions| directions.add_to(&mut x, length));
    x
}

fn gain(converged: bool) -> f64 {
    if converged { SMALLEST_GAIN } else { ROUGH_GAIN }
}

/// [`stiffness_of`] by one application of a better operator.
///
/// x may be a few percent off. The result is ⟨x⟩²/⟨x L x⟩. The stiffness is the maximum of this over all x, so the
/// error of x enters squared.
pub(crate) fn stiffness_under(x: &[f32], n: f64, operator: &mut dyn BlockOperator<f32>) -> f64 {
    let layout = operator.layout();
    let len = layout.len();
    let means = write_blocks(operator, x.chunks(len), |x, written| {
        written.copy_from_slice(x);
        [x.iter().copied().map(f64::from).sum::<f64>()]
    });
    operator.apply();
    let works = read_blocks(operator, x.chunks(len), |x, displacement| {
        [x.iter().zip(displacement).map(|(&x, &v)| f64::from(x) * f64::from(v)).sum::<f64>()]
    });
    let ([mean], [work]) = (layout.total(means), layout.total(works));
    if work > 0.0 { mean * mean / (work * n) } else { 0.0 }
}

/// Iterates for x until a step adds less than `smallest_gain`, and returns its mean.
///
/// `take` gets each step along a direction.
fn search(
    pressure: &[f64],
    (n, smallest_gain): (f64, f64),
    operator: &mut dyn PreconditionedOperator,
    mut take: impl FnMut(f32, &ConjugateDirections),
) -> f64 {
    let layout = operator.layout();
    let active: Vec<bool> = pressure.iter().map(|&p| p > 0.0).collect();
    // L x - 1 in contact, for x = 0.
    let mut residual: Vec<f32> = active.iter().map(|&active| if active { -1.0 } else { 0.0 }).collect();
    operator.set_active(&active);
    let mut directions = first_direction(active, pressure, n, operator, &residual);
    let (mut stiffness, mut beta) = (0.0, 0.0);
    for step in 0..MAX_STEPS {
        let sums = directions.advance(operator, &layout, [beta, 0.0], &Slope::Residual(&residual));
        if sums.curvature <= 0.0 || !sums.curvature.is_finite() {
            break;
        }
        let gain = sums.slope * sums.slope / (sums.curvature * n);
        let length = (-sums.slope / sums.curvature) as f32;
        take(length, &directions);
        stiffness += gain;
        if step > 0 && gain < smallest_gain * stiffness {
            break;
        }
        if step == 0 {
            operator.set_mean(stiffness);
        }
        take_step(length, &mut directions, &mut residual, &layout);
        beta = directions.precondition(operator, &layout).with_displacement / sums.curvature;
    }
    stiffness
}

/// Part of the cell in contact from which the first direction is the preconditioned residual.
///
/// `docs/measurements-uniform.md` compares it with the pressure.
const HEAVY_CONTACT: f64 = 0.5;

/// Directions that begin with the pressure, or with the preconditioned residual in heavy contact.
///
/// The best multiple of the pressure has the secant stiffness σ0²/mean(p v). The preconditioned residual is a uniform
/// pressure. Its part out of contact is moved to the elements beside it.
fn first_direction(
    active: Vec<bool>,
    pressure: &[f64],
    n: f64,
    operator: &mut dyn PreconditionedOperator,
    residual: &[f32],
) -> ConjugateDirections {
    let layout = operator.layout();
    let counts =
        parallel::map(active.chunks(layout.len()), |active| [active.iter().filter(|&&active| active).count() as f64]);
    let [n_contact] = layout.total(counts);
    if n_contact <= HEAVY_CONTACT * n {
        return ConjugateDirections::along(active, against(pressure, &layout));
    }
    let mut directions = ConjugateDirections::along(active, residual.to_vec());
    operator.set_mean(1.0);
    directions.precondition(operator, &layout);
    directions
}

/// Minus the pressure, in units of about its maximum. No multiple of it underflows.
fn against(pressure: &[f64], layout: &BlockLayout) -> Vec<f32> {
    let size = power_of_two_near(layout.maximum(pressure, 0.0));
    pressure.iter().map(|&p| -((p / size) as f32)).collect()
}

/// Takes a step of this `length` along the direction: writes the residual and keeps it.
fn take_step(length: f32, directions: &mut ConjugateDirections, residual: &mut [f32], layout: &BlockLayout) {
    let (steps, written) = directions.steps_and_residuals(layout.len());
    let blocks = residual.chunks_mut(layout.len()).zip(steps.zip(written));
    parallel::for_each(blocks, |(residual, (step, written))| step.update_residual(length, residual, written));
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;
    use rc_core::testing::quasi_random;
    use rc_kernel::Love;

    use super::*;
    use crate::grid::dense::eliminate;
    use crate::grid::direct_sum::DirectSum;

    /// Mean of the x that displaces every element in contact by 1, by elimination.
    fn eliminated(pressure: &Field) -> f64 {
        let operator = DirectSum::new(pressure.grid(), &Love);
        let contact: Vec<usize> = (0..pressure.grid().len()).filter(|&i| pressure.values()[i] > 0.0).collect();
        let row = |&i: &usize| contact.iter().map(|&j| operator.coefficient(i, j)).collect();
        let x = eliminate(contact.iter().map(row).collect(), vec![1.0; contact.len()]);
        x.iter().sum::<f64>() / pressure.grid().len() as f64
    }

    #[test]
    fn the_stiffness_of_many_contacts_is_that_of_elimination_to_a_thousandth() {
        let grid = Grid::square(24).expect("a grid");
        let check = |pressure: &Field, what: &str| {
            let (found, exact) = (contact_stiffness(pressure, f64::INFINITY, &Love, true), eliminated(pressure));
            assert!((found / exact - 1.0).abs() < 1e-3, "{what}: {found} for {exact}");
        };
        // Contacts of several sizes, with pressures that are not a multiple of those of a rigid punch.
        let wave = |t: f64| (std::f64::consts::TAU * t).cos();
        for (threshold, waves) in [(0.9, 1.0), (0.3, 2.0), (1.2, 3.0), (-0.6, 1.0), (-1.5, 2.0), (-2.2, 3.0)] {
            let pressure = Field::from_fn(grid, |at| {
                (wave(waves * at.x + 0.1) + wave(waves * at.y - at.x) + 0.5 * wave(5.0 * at.x) - threshold).max(0.0)
            });
            check(&pressure, &format!("{waves} waves above {threshold}"));
        }
        // Contacts of one element, with pressures of all sizes. They are dense on one side of the cell.
        let pressure = (0..grid.len()).map(|i| {
            let threshold = 0.3 + 0.6 * (i % 24) as f64 / 24.0;
            (quasi_random(i) - threshold).max(0.0).powi(4)
        });
        check(&Field::new(grid, pressure.collect()).expect("a value for each element"), "single elements");
    }
}
