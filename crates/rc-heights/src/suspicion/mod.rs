//! Facts about a map that make it doubtful: spikes, marks of missing points, counters, and too few columns.
//!
//! These are facts, not judgements: a caller decides what to say about them.

mod borders;
mod map;
mod medians;
mod near;
mod spikes;
mod values;

use rc_core::{Field, Grid};

pub use near::SPIKE;
pub use spikes::{Spikes, border_outliers, spike_points, spikes};
pub use values::{Counter, Mark, counter, marks};

/// Most columns or rows of a map that looks like a table of something else.
///
/// Tables of coordinates, or of a few profiles, have two to four columns. Maps with so few are not measured.
pub const MOST_THIN: usize = 4;

/// All doubts about a map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Suspicions {
    /// Isolated points far from their neighbours.
    pub spikes: Option<Spikes>,
    /// A value that usually marks missing points.
    pub marks: Option<Mark>,
    /// A row or column that counts.
    pub counter: Option<Counter>,
    /// Whether the map has two to four columns or rows.
    pub thin: bool,
}

impl Suspicions {
    /// The doubts about a map. `NaN` is a missing point.
    ///
    /// Marks of missing points are no spikes, so that one fault is one doubt.
    #[must_use]
    pub fn of(heights: &Field) -> Self {
        let (marks, thin) = (marks(heights), is_thin(heights.grid()));
        let spikes = if marks.is_some() || thin { None } else { spikes(heights, false) };
        Self { spikes, marks, counter: counter(heights), thin }
    }

    /// Whether there is no doubt.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Whether a grid has two to four columns or rows, so that the map may be a table of something else.
#[must_use]
pub fn is_thin(grid: Grid) -> bool {
    let sides = [grid.nx(), grid.ny()];
    // A single row or column is a profile.
    sides.iter().all(|n| *n > 1) && sides.iter().any(|n| *n <= MOST_THIN)
}
