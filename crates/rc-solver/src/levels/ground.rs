//! Data that all loads on one surface share.

use std::sync::Arc;

use rc_core::{Boundary, HeightSource, Kernel, SplitByScale};

use crate::levels::base_grid::base_sides;
use crate::levels::checks::{check_memory, first_split, with_border_level};
use crate::levels::params::AdaptiveParams;
use crate::levels::split::check_split;
use crate::problem::adaptive_error::AdaptiveError;
use crate::problem::support::Support;
use crate::tiles::base::Base;
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::kernels::Kernels;
use crate::tiles::ladder::Ladder;
use crate::tiles::memory::base_bytes;
use crate::tiles::solid::Solid;

/// Heights with their bounds, and the split kernels of the base grid.
pub(crate) struct Ground<'a> {
    pub(crate) heights: Heights<'a>,
    pub(crate) kernels: Kernels,
    /// Bytes of heights that are sampled on the whole grid.
    pub(crate) sampled_bytes: f64,
}

impl<'a> Ground<'a> {
    /// Checks the `split` of the `kernel`, and samples the heights. Tables are made when they are needed.
    ///
    /// # Errors
    /// [`AdaptiveError`].
    pub(crate) fn new(
        source: HeightSource<'a>,
        kernel: &dyn Kernel,
        split: &dyn SplitByScale,
        params: &AdaptiveParams,
    ) -> Result<Self, AdaptiveError> {
        let grid = source.grid();
        let boundary = Support::of(kernel, grid).boundary;
        // This check comes before any work.
        first_split(params)?;
        let base = base_sides(&source, params.base_side, boundary)?;
        let source = with_border_level(source, params.border_level)?;
        let ladder = Ladder::new(base, source.grid());
        let solid = Solid::new(kernel, split, Base::new(ladder, boundary))?;
        check_split(kernel, split, grid)?;
        let sampled_bytes = Heights::sampled_bytes(&source, ladder);
        let kernels = Kernels::new(solid, params.border_level);
        check_memory(grid, params.memory_limit, base_bytes(kernels.base().period()) + sampled_bytes, None)?;
        let heights = Heights::with_borders(source, base, boundary)?;
        Ok(Self { heights, kernels, sampled_bytes })
    }

    /// The boundary of the heights.
    pub(crate) fn boundary(&self) -> Boundary {
        if self.kernels.base().is_free() { Boundary::Free } else { Boundary::Periodic }
    }

    /// The same data without a borrow. A borrowed map is copied.
    pub(crate) fn into_owned(shared: Arc<Self>) -> Ground<'static> {
        let Self { heights, kernels, sampled_bytes } = Arc::try_unwrap(shared).unwrap_or_else(|shared| Self {
            heights: shared.heights.clone(),
            kernels: shared.kernels.empty(),
            sampled_bytes: shared.sampled_bytes,
        });
        Ground { heights: heights.into_owned(), kernels, sampled_bytes }
    }
}
