//! The lines of `data/bench/scale.csv`.

use serde::{Deserialize, Serialize};

/// One solve of one scene by one program with some threads.
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
    /// Part of the cells whose gap was computed.
    pub(in crate::bench) cells_evaluated: Option<f64>,
    /// By counting, the same for every program.
    pub(in crate::bench) area_counted: f64,
    pub(in crate::bench) repeats: usize,
    /// With ours, the evaluation of the observables: median, fastest, slowest.
    pub(in crate::bench) seconds: f64,
    pub(in crate::bench) seconds_min: f64,
    pub(in crate::bench) seconds_max: f64,
    pub(in crate::bench) memory_mb: Option<f64>,
}

/// What a line is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(in crate::bench) enum Part {
    /// Grids of several sizes, and numbers of threads.
    Grids,
    /// Loads on one grid.
    Contact,
}
