//! The lines of `data/bench/scale.csv`.

use serde::{Deserialize, Serialize};

/// One solve of one scene by one program with a given number of threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::bench) struct ScaleRow {
    pub(in crate::bench) part: Part,
    pub(in crate::bench) waves: usize,
    /// σ0/E*.
    pub(in crate::bench) load: f64,
    /// Elements along a side of the cell.
    pub(in crate::bench) side: usize,
    pub(in crate::bench) program: String,
    pub(in crate::bench) method: String,
    pub(in crate::bench) threads: usize,
    pub(in crate::bench) tolerance: String,
    pub(in crate::bench) status: String,
    pub(in crate::bench) iterations: Option<u64>,
    pub(in crate::bench) applications: Option<u64>,
    /// Fraction of the cells whose gap was computed.
    pub(in crate::bench) cells_evaluated: Option<f64>,
    /// Area by counting, which is the same for every program.
    pub(in crate::bench) area_counted: f64,
    pub(in crate::bench) repeats: usize,
    /// Median seconds; then the fastest and the slowest. Our times include the evaluation of the observables.
    pub(in crate::bench) seconds: f64,
    pub(in crate::bench) seconds_min: f64,
    pub(in crate::bench) seconds_max: f64,
    pub(in crate::bench) memory_mb: Option<f64>,
}

/// The purpose of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::bench) enum Part {
    /// Grids of several sizes, with several numbers of threads.
    Grids,
    /// Several loads on one grid.
    Contact,
}
