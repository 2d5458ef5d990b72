//! Data of the tiles that all loads on one surface share.

use std::sync::Arc;

use rc_core::Boundary;

use crate::tiles::heights::on_demand::Heights;
use crate::tiles::kernels::Kernels;

/// Heights with their bounds, and the split kernels of the base grid.
pub(crate) struct TileData<'a> {
    pub(crate) heights: Heights<'a>,
    pub(crate) kernels: Kernels,
    /// The split kernels of the half-space through which current spreads, if the solid is another one.
    pub(crate) half_space: Option<Kernels>,
    /// Bytes of heights that are sampled on the whole grid.
    pub(crate) sampled_bytes: f64,
}

impl TileData<'_> {
    /// The boundary of the heights.
    pub(crate) fn boundary(&self) -> Boundary {
        if self.kernels.base().is_free() { Boundary::Free } else { Boundary::Periodic }
    }

    /// The same data without a borrow. A borrowed map is copied.
    pub(crate) fn into_owned(shared: Arc<Self>) -> TileData<'static> {
        let Self { heights, kernels, half_space, sampled_bytes } =
            Arc::try_unwrap(shared).unwrap_or_else(|shared| Self {
                heights: shared.heights.clone(),
                kernels: shared.kernels.empty(),
                half_space: shared.half_space.as_ref().map(Kernels::empty),
                sampled_bytes: shared.sampled_bytes,
            });
        TileData { heights: heights.into_owned(), kernels, half_space, sampled_bytes }
    }
}
