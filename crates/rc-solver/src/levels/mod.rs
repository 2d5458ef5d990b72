//! Nested iteration: from the coarsest level to the finest, each of which starts the next.

pub(crate) mod adaptive;
pub(crate) mod agreed_stop;
pub(crate) mod base_grid;
pub(crate) mod checkpoint;
pub(crate) mod checks;
pub(crate) mod estimate;
pub(crate) mod finest_level;
pub(crate) mod ground;
pub(crate) mod level;
pub(crate) mod nested_grids;
pub(crate) mod nested_iteration;
pub(crate) mod operator_error;
pub(crate) mod params;
pub(crate) mod setup;
pub(crate) mod solved;
pub(crate) mod split;
pub(crate) mod uniform;
