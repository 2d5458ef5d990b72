//! Why a treatment is not possible.

use rc_core::Grid;
use thiserror::Error;

use super::treatment::{Crop, Level, Treatment};

/// A treatment that is not possible.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TreatError {
    /// Words that are no treatment.
    #[error("'{found}' is not {expected}")]
    Unknown {
        /// As written.
        found: String,
        /// What can be written.
        expected: &'static str,
    },
    /// A part that is not inside the map.
    #[error("crop: {crop} is not inside the map of {grid} points")]
    Outside {
        /// The part.
        crop: Crop,
        /// The map.
        grid: Grid,
    },
    /// Points that are so far apart that no number of them is as long as another.
    #[error(
        "crop: no part of the map of {grid} points, {:e} apart along x and {:e} along y, is a square within 0.1 %",
        spacing[0],
        spacing[1]
    )]
    NoSquare {
        /// The map.
        grid: Grid,
        /// Distances of points along x and y.
        spacing: [f64; 2],
    },
    /// Sides of which no whole numbers are as long as each other.
    #[error(
        "repeat: no copies of {grid} points on {:.6e} by {:.6e}, 16 at most along a side, have square points and make a square; \
         crop or resample it first",
        sides[0],
        sides[1]
    )]
    NoSquareOfCopies {
        /// The map.
        grid: Grid,
        /// Sides along x and y.
        sides: [f64; 2],
    },
    /// A treatment that needs every height.
    #[error("{treatment}: {missing} points are missing; fill them first (fill)")]
    Missing {
        /// The treatment.
        treatment: Treatment,
        /// Points without a height.
        missing: usize,
    },
    /// Too few points for a form.
    #[error("level: the {points} measured points do not determine a {form} form; level less, or fill first")]
    Undetermined {
        /// The form.
        form: Level,
        /// Measured points.
        points: usize,
    },
    /// A wavelength that the map does not have.
    #[error("low_pass: must be from {least:e} (four points) to {most:e} (the shorter side), not {wavelength:e}")]
    Wavelength {
        /// As given.
        wavelength: f64,
        /// Four points.
        least: f64,
        /// The shorter side.
        most: f64,
    },
    /// A window that leaves nothing as it is.
    #[error("taper: must be above 0 and at most 0.5, the part of each side that is faded out at each end, not {0}")]
    Taper(f64),
    /// More points than a grid has.
    #[error(transparent)]
    Grid(#[from] rc_core::GridError),
}
