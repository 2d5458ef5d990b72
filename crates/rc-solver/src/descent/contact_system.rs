//! L y = b on the elements in contact, as exact as double precision allows.

use rc_core::Silent;

use crate::descent::gmres::{self, ActiveElements, LinearSystem};
use crate::descent::operators::{LevelOperators, read_blocks, write_blocks};
use crate::descent::stiffness::stiffness_under;
use crate::parallel;

/// The residual at which refinement ends, relative to b.
const GOAL: f64 = 1e-11;

/// The residual that is still accepted when rounding prevents progress.
const ACCEPTED: f64 = 1e-7;

/// Reduction of the residual by GMRES in single precision.
const OF_CYCLE: f64 = 1e-4;

/// Maximum number of cycles of GMRES. Four are enough, unless contact is so large that a cycle has few directions.
const MAX_CYCLES: usize = 40;

/// Values that are summed at once.
const PIECE: usize = 4096;

/// The pressure y with L y = b on the contact {p > 0}, and zero elsewhere.
///
/// If it `is_balanced`, y has the mean zero, and L y = b up to a constant. Iterative refinement: GMRES finds corrections
/// in single precision, and residuals are in double precision.
///
/// # Errors
/// The residual relative to b, if it stays above [`ACCEPTED`].
pub(crate) fn solve_on_contact(
    pressure: &[f64],
    b: &[f64],
    is_balanced: bool,
    operators: &mut LevelOperators<'_>,
) -> Result<Vec<f64>, f64> {
    let block = operators.fresh.layout().len();
    let active: Vec<bool> = pressure.iter().map(|&p| p > 0.0).collect();
    let b: Vec<f64> = b.iter().zip(&active).map(|(&b, &active)| if active { b } else { 0.0 }).collect();
    let (mut y, size) = (vec![0.0; b.len()], norm(&b));
    if size == 0.0 {
        return Ok(y);
    }
    let largest = parallel::maximum(pressure, 0.0);
    let scaled: Vec<f32> = pressure.iter().map(|&p| (p / largest) as f32).collect();
    let corrections = &mut *operators.corrections;
    corrections.set_active(&active);
    let secant = stiffness_under(&scaled, b.len() as f64, corrections);
    corrections.set_mean(secant);
    let elements = ActiveElements::new(active, block);
    let goal = gmres::Goal { reduction: OF_CYCLE, directions: gmres::directions(elements.len(), b.len()) };
    let (mut relative, mut correction) = (f64::INFINITY, vec![0.0_f32; b.len()]);
    for _ in 0..MAX_CYCLES {
        let residual = residual(&y, &b, (&elements, is_balanced), operators);
        let (before, now) = (relative, norm(&residual));
        relative = now / size;
        if relative <= GOAL || relative > 0.9 * before {
            break;
        }
        let residual: Vec<f32> = residual.iter().map(|value| (value / now) as f32).collect();
        let operator = &mut *operators.corrections;
        let mut system = LinearSystem { operator, elements: &elements, fixed_mean: is_balanced };
        let Ok((step, _)) = system.solve(elements.gather(&residual), goal, &Silent) else { break };
        elements.scatter(&step, &mut correction);
        parallel::for_each(y.chunks_mut(PIECE).zip(correction.chunks(PIECE)), |(y, step)| {
            y.iter_mut().zip(step).for_each(|(y, &step)| *y += now * f64::from(step));
        });
        if is_balanced {
            balance(&mut y, &elements);
        }
    }
    if relative <= ACCEPTED { Ok(y) } else { Err(relative) }
}

/// b - L y in contact, and zero elsewhere.
fn residual(
    y: &[f64],
    b: &[f64],
    (elements, is_balanced): (&ActiveElements, bool),
    operators: &mut LevelOperators<'_>,
) -> Vec<f64> {
    let operator = &mut *operators.fresh;
    let block = operator.layout().len();
    write_blocks(operator, y.chunks(block), |y, values| values.copy_from_slice(y));
    operator.apply();
    let mut residual = vec![0.0; b.len()];
    let blocks = residual.chunks_mut(block).zip(b.chunks(block)).zip(elements.active.chunks(block));
    read_blocks(&*operator, blocks, |((residual, b), active), displacement| {
        for (((residual, b), active), v) in residual.iter_mut().zip(b).zip(active).zip(displacement) {
            *residual = if *active { b - v } else { 0.0 };
        }
    });
    if is_balanced {
        balance(&mut residual, elements);
    }
    residual
}

/// Subtracts the mean over the contact. The values are zero elsewhere.
fn balance(values: &mut [f64], elements: &ActiveElements) {
    let sums = parallel::map(values.chunks(PIECE), |piece| piece.iter().sum::<f64>());
    let mean = sums.into_iter().sum::<f64>() / elements.len() as f64;
    parallel::for_each(values.chunks_mut(PIECE).zip(elements.active.chunks(PIECE)), |(values, active)| {
        values.iter_mut().zip(active).filter(|(_, active)| **active).for_each(|(value, _)| *value -= mean);
    });
}

fn norm(values: &[f64]) -> f64 {
    parallel::rms(values, PIECE) * (values.len() as f64).sqrt()
}
