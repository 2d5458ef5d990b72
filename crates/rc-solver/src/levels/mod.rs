//! Nested iteration: from the coarsest level to the finest, each of which starts the next.

pub(crate) mod adaptive;
pub(crate) mod agreed_stop;
pub(crate) mod base_grid;
pub(crate) mod checkpoint;
pub(crate) mod checks;
pub(crate) mod coarse_level;
pub(crate) mod estimate;
mod evaluation;
pub(crate) mod finest_level;
pub(crate) mod gap_cycle;
pub(crate) mod gap_levels;
pub(crate) mod gap_prolongation;
pub(crate) mod gap_side;
pub(crate) mod gap_sweeps;
pub(crate) mod grids;
pub(crate) mod nested;
pub(crate) mod operator_error;
pub(crate) mod params;
pub(crate) mod sliding;
pub(crate) mod split;
mod tile_descent;
pub(crate) mod tiles;
pub(crate) mod uniform;
