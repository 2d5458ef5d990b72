//! Conjugate directions, with which the descent and the contact stiffness iterate.

use crate::descent::layout::BlockLayout;
use crate::descent::operators::{PreconditionedOperator, read_blocks, write_blocks};
use crate::descent::rows;
use crate::descent::rows::{ClippedStep, ConjugateStep};
use crate::descent::values::Values;
use crate::parallel;
use crate::problem::steps::Step;

/// Directions of preconditioned conjugate gradients on the elements of one mesh, in single precision.
pub(crate) struct ConjugateDirections {
    /// Elements that the iteration changes.
    pub(crate) active: Vec<bool>,
    /// The present direction t. It is zero on elements that are not active.
    pub(crate) direction: Vec<f32>,
    /// The displacement u = L t of the present direction.
    pub(crate) displacement: Vec<f32>,
    /// The residual, and later the preconditioned residual z.
    ///
    /// Between a clipped step and the next round, it has the pressures that clipping has added.
    pub(crate) preconditioned: Vec<f32>,
}

/// Sums of the preconditioned residual z over the active elements.
pub(crate) struct PreconditionedSums {
    /// Σ z
    pub(crate) preconditioned: f64,
    /// Σ z u, with the displacement u of the last direction.
    pub(crate) with_displacement: f64,
    /// Σ u
    pub(crate) displacement: f64,
}

/// Sums of a direction t and its displacement u over the active elements.
pub(crate) struct DirectionSums {
    /// Σ t u
    pub(crate) curvature: f64,
    /// Σ t (gradient of the energy)
    pub(crate) slope: f64,
    /// Σ u
    pub(crate) displacement: f64,
}

/// The gradient of the energy, from which slopes follow.
pub(crate) enum Slope<'a> {
    /// The gap minus the gap of elements in contact.
    Gap { gap: &'a Values, zero_gap: f64 },
    /// The residual itself.
    Residual(&'a [f32]),
}

impl ConjugateDirections {
    /// Directions on `n` elements. None of the elements is active.
    pub(crate) fn new(n: usize) -> Self {
        let zeros = || parallel::zeros(n);
        Self { active: vec![false; n], direction: zeros(), displacement: zeros(), preconditioned: zeros() }
    }

    /// Directions on the elements of `active`.
    ///
    /// [`ConjugateDirections::advance`] starts along `-preconditioned`.
    pub(crate) fn along(active: Vec<bool>, preconditioned: Vec<f32>) -> Self {
        let zeros = || parallel::zeros(active.len());
        Self { direction: zeros(), displacement: zeros(), active, preconditioned }
    }

    /// Adds the present direction times `length` to `values`.
    pub(crate) fn add_to(&self, values: &mut [f32], length: f32) {
        const BLOCK: usize = 4096;
        parallel::for_each(values.chunks_mut(BLOCK).zip(self.direction.chunks(BLOCK)), |(values, direction)| {
            for (value, t) in values.iter_mut().zip(direction) {
                *value += length * t;
            }
        });
    }

    /// The present direction for a step that is clipped, with room for added pressures.
    ///
    /// Clipping adds these pressures. They take the room of the residual, which is lost.
    pub(crate) fn clipped_steps(&mut self, len: usize) -> impl Iterator<Item = ClippedStep<'_>> {
        let Self { active, direction, displacement, preconditioned } = self;
        let along = direction.chunks(len).zip(displacement.chunks(len));
        let changed = active.chunks_mut(len).zip(preconditioned.chunks_mut(len));
        along.zip(changed).map(|((direction, displacement), (active, added))| ClippedStep {
            direction,
            displacement,
            active,
            added,
        })
    }

    /// Room for displacements, in blocks.
    ///
    /// They take the room of the pressures that clipping has added, which are lost.
    pub(crate) fn displacements_mut(&mut self, len: usize) -> impl Iterator<Item = &mut [f32]> {
        self.preconditioned.chunks_mut(len)
    }

    /// The pressures that clipping has added, or the displacements that were put there.
    pub(crate) fn added(&self) -> &[f32] {
        &self.preconditioned
    }

    /// The present direction, and the pressures that clipping has added.
    pub(crate) fn direction_and_added(&mut self) -> (&[f32], &mut [f32]) {
        (&self.direction, &mut self.preconditioned)
    }

    /// The present direction, its displacement and its elements, and the place of the next residual.
    pub(crate) fn steps_and_residuals(
        &mut self,
        len: usize,
    ) -> (impl Iterator<Item = ConjugateStep<'_>>, impl Iterator<Item = &mut [f32]>) {
        let Self { active, direction, displacement, preconditioned } = self;
        let along = direction.chunks(len).zip(displacement.chunks(len)).zip(active.chunks(len));
        let steps = along.map(|((direction, displacement), active)| ConjugateStep { direction, displacement, active });
        (steps, preconditioned.chunks_mut(len))
    }

    /// Applies the preconditioner, if there is one, to the residual that was written.
    pub(crate) fn precondition(
        &mut self,
        operator: Option<&mut (dyn PreconditionedOperator + '_)>,
        layout: &BlockLayout,
    ) -> PreconditionedSums {
        let _running = Step::Preconditioner.begin();
        if let Some(operator) = operator {
            operator.precondition(&self.active, &mut self.preconditioned);
        }
        let blocks = layout.chunks(&self.displacement).zip(layout.chunks(&self.active));
        let blocks = blocks.zip(layout.chunks(&self.preconditioned));
        let sums = parallel::map(blocks, |((displacement, active), preconditioned)| {
            rows::sums_of_preconditioned(preconditioned, displacement, active)
        });
        let [preconditioned, with_displacement, displacement] = layout.total(sums);
        PreconditionedSums { preconditioned, with_displacement, displacement }
    }

    /// Moves on to the next direction, `t = -z + β t + shift`, and computes its displacement.
    pub(crate) fn advance(
        &mut self,
        operator: &mut dyn PreconditionedOperator,
        layout: &BlockLayout,
        [beta, shift]: [f64; 2],
        slope: &Slope<'_>,
    ) -> DirectionSums {
        let _running = Step::Directions.begin();
        let factors = [beta as f32, shift as f32];
        let blocks = layout.chunks(&self.preconditioned).zip(layout.chunks(&self.active));
        let blocks = blocks.zip(layout.chunks_mut(&mut self.direction));
        write_blocks(operator, blocks, |((preconditioned, active), direction), written| {
            rows::next_direction(preconditioned, factors, active, direction, written);
        });
        operator.apply();
        let ranges = layout.ranges(self.direction.len());
        let blocks = ranges.zip(layout.chunks_mut(&mut self.displacement));
        let (direction, active) = (&self.direction, &self.active);
        let sums = read_blocks(operator, blocks, |(here, kept), read| {
            let (direction, active) = (&direction[here.clone()], &active[here.clone()]);
            match slope {
                Slope::Gap { gap, zero_gap } => {
                    let gap = gap.part(here);
                    let gradient = gap.iter().map(|g| g - zero_gap);
                    rows::keep_displacement(read, direction, gradient, active, kept)
                }
                Slope::Residual(residual) => {
                    let gradient = residual[here].iter().map(|&r| f64::from(r));
                    rows::keep_displacement(read, direction, gradient, active, kept)
                }
            }
        });
        let [curvature, slope, displacement] = layout.total(sums);
        DirectionSums { curvature, slope, displacement }
    }
}
