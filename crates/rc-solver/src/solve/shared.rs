//! Data that the plans of all loads on one surface share.

use std::sync::{Arc, OnceLock};

use rc_core::{Field, HeightSource, Kernel, SplitByScale};

use crate::levels::params::AdaptiveParams;
use crate::levels::tiles::prepare;
use crate::parallel::made;
use crate::problem::adaptive_error::AdaptiveError;
use crate::tiles::data::TileData;

/// Heights as the methods need them. They are evaluated when the first load needs them.
#[derive(Default)]
pub(crate) struct Shared<'a> {
    /// Heights of the adaptive method.
    tiles: OnceLock<Arc<TileData<'a>>>,
    /// Heights on the whole grid.
    heights: OnceLock<Field>,
}

impl<'a> Shared<'a> {
    /// The heights of `source` as the adaptive method needs them, on the solid of `kernel` with its `split`.
    pub(crate) fn tiles(
        &self,
        source: &HeightSource<'a>,
        kernel: &dyn Kernel,
        split: &dyn SplitByScale,
        params: &AdaptiveParams,
    ) -> Result<&Arc<TileData<'a>>, AdaptiveError> {
        if self.tiles.get().is_none() {
            // Another load may have been faster. Its data are the same.
            let _ = self.tiles.set(Arc::new(prepare(source.clone(), kernel, split, params)?));
        }
        Ok(self.tiles.get().expect("it was set"))
    }

    /// Whether the heights of the adaptive method are prepared.
    pub(crate) fn has_tiles(&self) -> bool {
        self.tiles.get().is_some()
    }

    /// Frees the heights of the adaptive method.
    pub(crate) fn forget_tiles(&mut self) {
        self.tiles.take();
    }

    /// The heights of `source` on its whole grid.
    pub(crate) fn heights<'s>(&'s self, source: &'s HeightSource<'a>) -> &'s Field {
        if let Some(map) = source.map() {
            return map;
        }
        made(&self.heights, || source.heights().into_owned())
    }
}
