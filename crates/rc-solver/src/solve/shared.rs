//! Data that the plans of all loads on one surface share.

use std::sync::{Arc, OnceLock};

use rc_core::{Field, HeightSource, Kernel, SplitByScale};

use crate::levels::ground::Ground;
use crate::levels::params::AdaptiveParams;
use crate::parallel::made;
use crate::problem::adaptive_error::AdaptiveError;

/// Heights as the methods need them. They are evaluated when the first load needs them.
#[derive(Default)]
pub(crate) struct Shared<'a> {
    /// Heights of the adaptive method.
    ground: OnceLock<Arc<Ground<'a>>>,
    /// Heights on the whole grid.
    heights: OnceLock<Field>,
}

impl<'a> Shared<'a> {
    /// The heights of `source` as the adaptive method needs them, on the solid of `kernel` with its `split`.
    pub(crate) fn ground(
        &self,
        source: &HeightSource<'a>,
        kernel: &dyn Kernel,
        split: &dyn SplitByScale,
        params: &AdaptiveParams,
    ) -> Result<&Arc<Ground<'a>>, AdaptiveError> {
        if self.ground.get().is_none() {
            let ground = Arc::new(Ground::new(source.clone(), kernel, split, params)?);
            // Another load may have been faster. Its ground is the same.
            let _ = self.ground.set(ground);
        }
        Ok(self.ground.get().expect("it was set"))
    }

    /// Frees the heights of the adaptive method.
    pub(crate) fn forget_ground(&mut self) {
        self.ground.take();
    }

    /// The heights of `source` on its whole grid.
    pub(crate) fn heights<'s>(&'s self, source: &'s HeightSource<'a>) -> &'s Field {
        if let Some(map) = source.map() {
            return map;
        }
        made(&self.heights, || source.heights().into_owned())
    }
}
