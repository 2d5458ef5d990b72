//! Any operator of the caller, in the form that the iteration needs.

use std::f64::consts::{PI, TAU};

use rc_core::Operator;

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{BlockOperator, LevelOperators, PreconditionedOperator};
use crate::parallel;

/// Values in a block.
const BLOCK: usize = 4096;

/// Eigenvalue of the approximate inverse for one wave along the second axis.
///
/// This wave is about the longest. The eigenvalue is π on a half-space of E* = 1. Only its ratio to the eigenvalue of
/// the mean matters. An operator whose answer is not usable therefore gets the value of the half-space.
fn inverse_of_longest_wave(operator: &dyn Operator) -> f64 {
    let n = operator.n_elements();
    let wave: Vec<f64> = (0..n).map(|i| (TAU * i as f64 / n as f64).cos()).collect();
    let (mut displacement, mut scratch) = (vec![0.0; n], vec![0.0; operator.scratch_len()]);
    operator.apply(&wave, &mut displacement, &mut scratch);
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let inverse = product(&wave, &wave) / product(&wave, &displacement);
    if inverse > 0.0 && inverse.is_finite() { inverse } else { PI }
}

/// L for corrections and for fresh gaps, both in double precision.
///
/// The rounding of an operator in single precision is not known.
pub(super) fn operators_of(operator: &dyn Operator) -> LevelOperators<'_> {
    let inverse = inverse_of_longest_wave(operator);
    LevelOperators {
        corrections: Box::new(AnyCorrections { vectors: AnyOperator::new(operator), inverse, mean: inverse }),
        fresh: Box::new(AnyOperator::new(operator)),
    }
}

/// An operator with its vectors.
struct AnyOperator<'a> {
    operator: &'a dyn Operator,
    source: Vec<f64>,
    result: Vec<f64>,
    scratch: Vec<f64>,
}

impl<'a> AnyOperator<'a> {
    fn new(operator: &'a dyn Operator) -> Self {
        let zeros = || vec![0.0; operator.n_elements()];
        Self { operator, source: zeros(), result: zeros(), scratch: vec![0.0; operator.scratch_len()] }
    }
}

impl BlockOperator<f64> for AnyOperator<'_> {
    fn layout(&self) -> BlockLayout {
        BlockLayout::of(BLOCK)
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f64]) + Sync)) {
        parallel::for_each(self.source.chunks_mut(BLOCK).enumerate(), |(i, values)| write(i, values));
    }

    fn apply(&mut self) {
        self.operator.apply(&self.source, &mut self.result, &mut self.scratch);
    }

    fn read(&self, read: &(dyn Fn(usize, &[f64]) + Sync)) {
        parallel::for_each(self.result.chunks(BLOCK).enumerate(), |(i, values)| read(i, values));
    }
}

/// An operator for corrections.
///
/// Its approximate inverse is a multiple of the identity, except for the mean.
struct AnyCorrections<'a> {
    vectors: AnyOperator<'a>,
    /// Eigenvalue of the approximate inverse for all vectors of zero mean.
    inverse: f64,
    /// Eigenvalue of the approximate inverse for constant vectors.
    mean: f64,
}

impl BlockOperator<f32> for AnyCorrections<'_> {
    fn layout(&self) -> BlockLayout {
        self.vectors.layout()
    }

    fn write(&mut self, write: &(dyn Fn(usize, &mut [f32]) + Sync)) {
        self.vectors.write(&|i, values| {
            let mut rounded = [0.0_f32; BLOCK];
            let rounded = &mut rounded[..values.len()];
            write(i, rounded);
            for (value, &rounded) in values.iter_mut().zip(&*rounded) {
                *value = f64::from(rounded);
            }
        });
    }

    fn apply(&mut self) {
        self.vectors.apply();
    }

    fn read(&self, read: &(dyn Fn(usize, &[f32]) + Sync)) {
        self.vectors.read(&|i, values| {
            let mut rounded = [0.0_f32; BLOCK];
            for (rounded, &value) in rounded.iter_mut().zip(values) {
                *rounded = value as f32;
            }
            read(i, &rounded[..values.len()]);
        });
    }
}

impl PreconditionedOperator for AnyCorrections<'_> {
    fn extends(&self) -> bool {
        false
    }

    fn set_active(&mut self, _active: &[bool]) {}

    fn precondition(&mut self, _active: &[bool], values: &mut [f32]) {
        let sums = parallel::map(values.chunks(BLOCK), |block| [block.iter().copied().map(f64::from).sum()]);
        let [sum] = BlockLayout::of(BLOCK).total(sums);
        let shift = (self.mean - self.inverse) * sum / values.len() as f64;
        parallel::for_each(values.chunks_mut(BLOCK), |block| {
            for value in block {
                *value = (self.inverse * f64::from(*value) + shift) as f32;
            }
        });
    }

    fn set_mean(&mut self, eigenvalue: f64) {
        self.mean = eigenvalue;
    }
}
