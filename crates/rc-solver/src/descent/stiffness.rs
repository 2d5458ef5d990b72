//! The incremental contact stiffness, on any mesh.

use std::borrow::Cow;

use crate::descent::directions::{ConjugateDirections, Slope};
use crate::descent::gmres::{self, ActiveElements, LinearSystem};
use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, PreconditionedOperator, read_blocks, write_blocks};
use crate::parallel;
use crate::problem::checked::power_of_two_near;

/// The iteration ends when a step adds less than this fraction.
///
/// The sum of all later steps is of the same order.
const SMALLEST_GAIN: f64 = 3e-4;

/// The same for a pressure that did not converge, whose stiffness is a few percent off in any case.
///
/// Who stops a solve does not want to wait for as many applications of L again.
const ROUGH_GAIN: f64 = 3e-2;

/// The same for a pressure whose minimum is wanted.
const GAIN_OF_RISE: f64 = 1e-6;

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

/// The smallest dp/dσ0 of the contact set {p > 0}, as the set is held fixed: min x/⟨x⟩ for the x of [`stiffness_of`].
///
/// A half-space has at least 1. With u = L x, the pressure is x = u'/2 + ⟨x⟩ for the operator u' = ∫ (u(r) - u(s))/|r - s|³ ds
/// (up to a factor), which is negative out of contact. So u has its maximum in contact, where u' is therefore positive.
pub(crate) fn least_rise(pressure: &[f64], n: f64, operator: &mut dyn PreconditionedOperator) -> f64 {
    let mut x = vec![0.0_f32; pressure.len()];
    search(pressure, (n, GAIN_OF_RISE), operator, |length, directions| directions.add_to(&mut x, length));
    let layout = operator.layout();
    let sums = parallel::map(layout.chunks(&x), |x| [x.iter().copied().map(f64::from).sum::<f64>()]);
    let [sum] = layout.total(sums);
    let in_contact = x.iter().zip(pressure).filter(|(_, p)| **p > 0.0).map(|(&x, _)| f64::from(x) * n / sum);
    layout.minimum(&in_contact.collect::<Vec<f64>>())
}

pub(crate) fn gain(converged: bool) -> f64 {
    if converged { SMALLEST_GAIN } else { ROUGH_GAIN }
}

/// [`stiffness_of`] by one application of a better operator.
///
/// x may be a few percent off. The result is ⟨x⟩²/⟨x L x⟩. The stiffness is the maximum of this over all x, so the
/// error of x enters squared.
pub(crate) fn stiffness_under(x: &[f32], n: f64, operator: &mut dyn BlockOperator<f32>) -> f64 {
    let layout = operator.layout();
    let means = write_blocks(operator, layout.chunks(x), |x, written| {
        written.copy_from_slice(x);
        [x.iter().copied().map(f64::from).sum::<f64>()]
    });
    operator.apply();
    let works = read_blocks(operator, layout.chunks(x), |x, displacement| {
        [x.iter().zip(displacement).map(|(&x, &v)| f64::from(x) * f64::from(v)).sum::<f64>()]
    });
    let ([mean], [work]) = (layout.total(means), layout.total(works));
    if work > 0.0 { mean * mean / (work * n) } else { 0.0 }
}

/// [`stiffness_of`] for an operator that is not symmetric, by GMRES.
///
/// ⟨x⟩ has no extremum then, so its error is that of x.
pub(crate) fn stiffness_by_gmres(
    pressure: &[f64],
    (n, converged): (f64, bool),
    operator: &mut dyn PreconditionedOperator,
) -> f64 {
    let layout = operator.layout();
    let active: Vec<bool> = pressure.iter().map(|&p| p > 0.0).collect();
    let first: Vec<f32> = against(pressure, &layout);
    operator.set_active(&active);
    let secant = stiffness_under(&first, n, operator);
    operator.set_mean(secant);
    let elements = ActiveElements::new(active, layout.len());
    let one = vec![1.0; elements.len()];
    let goal = gmres::Goal {
        reduction: 0.1 * gain(converged),
        directions: 2 * gmres::directions(elements.len(), pressure.len()),
    };
    let mut system = LinearSystem { operator, elements: &elements, fixed_mean: false };
    let Ok((x, _)) = system.solve(one, goal, &rc_core::Silent) else { return f64::NAN };
    let sums = parallel::map(x.chunks(layout.len()), |x| x.iter().copied().map(f64::from).sum::<f64>());
    sums.into_iter().sum::<f64>() / n
}

/// Iterates for x until a step adds less than `smallest_gain`, and returns its mean.
///
/// `take` gets each step along a direction.
pub(crate) fn search(
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
        take_step(length, &mut directions, &mut residual);
        beta = directions.precondition(Some(&mut *operator), &layout).with_displacement / sums.curvature;
    }
    stiffness
}

/// Part of the cell in contact from which the first direction is the preconditioned residual.
///
/// `docs/constants.md` compares it with the pressure.
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
        parallel::map(layout.chunks(&active), |active| [active.iter().filter(|&&active| active).count() as f64]);
    let [n_contact] = layout.total(counts);
    if n_contact <= HEAVY_CONTACT * n {
        return ConjugateDirections::along(active, against(pressure, &layout));
    }
    let mut directions = ConjugateDirections::along(active, residual.to_vec());
    operator.set_mean(1.0);
    directions.precondition(Some(operator), &layout);
    directions
}

/// Minus the pressure, in units of about its maximum. No multiple of it underflows.
fn against(pressure: &[f64], layout: &BlockLayout) -> Vec<f32> {
    let size = power_of_two_near(layout.maximum(pressure, 0.0));
    pressure.iter().map(|&p| -((p / size) as f32)).collect()
}

/// Takes a step of this `length` along the direction: writes the residual and keeps it.
fn take_step(length: f32, directions: &mut ConjugateDirections, residual: &mut [f32]) {
    const BLOCK: usize = 4096;
    let (steps, written) = directions.steps_and_residuals(BLOCK);
    let blocks = residual.chunks_mut(BLOCK).zip(steps.zip(written));
    parallel::for_each(blocks, |(residual, (step, written))| step.update_residual(length, residual, written));
}
