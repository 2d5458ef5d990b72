//! The iteration on tiles: a descent, or Newton's method under a sliding surface.

use std::sync::Arc;

use crate::descent::info::LevelInfo;
use crate::descent::operators::PreconditionedOperator;
use crate::descent::outcome::Outcome;
use crate::descent::run::{DescentObserver, Goal};
use crate::descent::state::Descent;
use crate::sliding::newton::{SlidingDescent, Work};
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::tables::Tables;

/// A descent on tiles.
pub(super) enum TileDescent<'a> {
    AtRest(Box<Descent<'a>>),
    Sliding(Box<SlidingDescent<'a>>),
}

/// Tables of the solid with the storage modulus of each wave: of L, and of its approximate inverse.
pub(super) struct StorageTables {
    quick: Tables<f32>,
    preconditioner: Tables<f32>,
}

impl StorageTables {
    /// Tables of L, and a copy of those of its approximate inverse, which also preconditions the sliding contact.
    pub(super) fn new(quick: Tables<f32>, preconditioner: &Tables<f32>) -> Self {
        Self { quick, preconditioner: preconditioner.clone() }
    }

    /// Its operator for corrections.
    pub(super) fn corrections(&mut self, hierarchy: Arc<Hierarchy>) -> Box<dyn PreconditionedOperator + '_> {
        Box::new(TileCorrections::new(hierarchy, &self.quick, &mut self.preconditioner))
    }
}

impl<'a> TileDescent<'a> {
    /// The iteration of `descent`. Under a sliding surface there is a solid with the storage modulus of each wave.
    pub(super) fn new(descent: Descent<'a>, storage: Option<Box<dyn PreconditionedOperator + 'a>>) -> Self {
        match storage {
            None => Self::AtRest(Box::new(descent)),
            Some(storage) => Self::Sliding(Box::new(SlidingDescent::new(descent, storage))),
        }
    }

    /// Iterates until the goal is reached, or cannot be reached.
    pub(super) fn run(&mut self, goal: Goal, watch: &DescentObserver<'_>) -> Outcome {
        match self {
            Self::AtRest(descent) => descent.run(goal, watch),
            Self::Sliding(sliding) => sliding.run(goal, watch),
        }
    }

    /// Computes the gap afresh.
    pub(super) fn refresh(&mut self) {
        match self {
            Self::AtRest(descent) => descent.refresh(),
            Self::Sliding(sliding) => sliding.descent.refresh(),
        };
    }

    pub(super) fn info(&self) -> LevelInfo {
        match self {
            Self::AtRest(descent) => descent.info(),
            Self::Sliding(sliding) => sliding.descent.info(),
        }
    }

    /// The work of Newton's method.
    pub(super) fn work(&self) -> Work {
        match self {
            Self::AtRest(_) => Work::default(),
            Self::Sliding(sliding) => sliding.work,
        }
    }

    pub(super) fn into_descent(self) -> Descent<'a> {
        match self {
            Self::AtRest(descent) => *descent,
            Self::Sliding(sliding) => sliding.descent,
        }
    }
}
