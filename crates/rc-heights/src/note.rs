//! What a reader did with a file beyond copying numbers.

use rc_core::quantity::{count, digits};
use thiserror::Error;

use crate::LengthUnit;

/// A note of a reader, one line each.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReadNote {
    /// No unit of heights is named, so they were taken as metres.
    #[error(
        "the file names no unit of heights, so they are taken as metres; --unit, --height-unit or --height-scale says otherwise"
    )]
    HeightsAssumedMetres,
    /// No unit of the sides is named, so they were taken as metres.
    #[error("the file names no unit of its sides, so they are taken as metres; --unit says otherwise")]
    SidesAssumedMetres,
    /// Several arrays without a unit may be the heights, and the first was taken.
    #[error("'{name}', the first of {of} arrays without a unit, has the heights; --channel names another")]
    FirstOfSeveral {
        /// Name of the array.
        name: String,
        /// Number of arrays that may be the heights.
        of: usize,
    },
    /// Other lines divide the rows into blocks of equal sizes.
    #[error(
        "the text has {blocks} blocks of {rows} rows, divided by other lines, which make one map; if not, give one block"
    )]
    Blocks {
        /// Number of blocks.
        blocks: usize,
        /// Number of rows of each.
        rows: usize,
    },
    /// Only the sides have a unit, so that it was taken for the heights too.
    #[error(
        "the file names a unit of its sides only, so the heights are in it too ({unit}); if not, name theirs in the file: \
         # Value units: nm"
    )]
    HeightsLikeSides {
        /// The unit.
        unit: LengthUnit,
    },
    /// Places of a profile decrease, and its points were reversed.
    #[error("x decreases along the profile, so its points are reversed")]
    PointsReversed,
    /// The first row of the file is the top of the picture, and rows were reversed.
    #[error("the first row of the file is the top, so rows are reversed: y points up")]
    RowsReversed,
    /// Masked points were made missing.
    #[error("{} masked, so missing; --mask ignore keeps them", are(*points))]
    Masked {
        /// Number of masked points.
        points: usize,
    },
    /// The measurement ended before all rows were there.
    #[error("{rows} of {all} rows are measured; the others are missing")]
    Unfinished {
        /// Number of measured rows.
        rows: usize,
        /// Number of rows of the whole map.
        all: usize,
    },
    /// The points were moved onto a regular grid.
    #[error("the points are moved onto a regular grid, by at most {} spacings", digits(*largest, 2))]
    Moved {
        /// Largest shift, in spacings.
        largest: f64,
    },
    /// No point has a mark of missing points that the user gives.
    #[error("no point has a value that --missing names; give it as the number that the file has")]
    NoMark,
    /// The first column or row has line numbers, not heights, and was omitted.
    #[error("the first {what} counts lines, so it is omitted")]
    Counter {
        /// `column` or `row`.
        what: &'static str,
    },
}

impl ReadNote {
    /// Whether the note is an assumption that the user should confirm.
    #[must_use]
    pub fn is_assumption(&self) -> bool {
        let is_of_metres = matches!(self, Self::HeightsAssumedMetres | Self::SidesAssumedMetres);
        is_of_metres || matches!(self, Self::FirstOfSeveral { .. } | Self::Blocks { .. })
    }
}

fn are(points: usize) -> String {
    count(points, "point") + if points == 1 { " is" } else { " are" }
}
