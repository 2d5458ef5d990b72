//! Errors of treatments that are not possible.

use rc_core::Grid;
use thiserror::Error;

use super::treatment::{Crop, Level, Treatment};

/// A treatment that is not possible.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TreatError {
    /// The words do not name a treatment.
    #[error("'{found}' is not {expected}")]
    Unknown {
        /// The words as written.
        found: String,
        /// Description of valid words.
        expected: &'static str,
    },
    /// A part is not inside the map.
    #[error("crop: {crop} is not inside the map of {grid} points")]
    Outside {
        /// The part.
        crop: Crop,
        /// The grid of the map.
        grid: Grid,
    },
    /// The distances of points along x and y are so different that no part is a square.
    #[error(
        "crop: no part of the map of {grid} points, {:e} apart along x and {:e} along y, is a square within 0.1 %; resample it first",
        spacing[0],
        spacing[1]
    )]
    NoSquare {
        /// The grid of the map.
        grid: Grid,
        /// Distances of points along x and y.
        spacing: [f64; 2],
    },
    /// The sides are such that no whole numbers of copies make a square.
    #[error(
        "repeat: up to 16 copies along a side of a map of {grid} points, {:.6e} by {:.6e}, never make a square with the same \
         spacing along x and y; crop or resample it first",
        sides[0],
        sides[1]
    )]
    NoSquareOfCopies {
        /// The grid of the map.
        grid: Grid,
        /// Sides along x and y.
        sides: [f64; 2],
    },
    /// A treatment needs every height, and points are missing.
    #[error("{treatment}: needs a map without missing points (this one has {missing}); fill them first (fill)")]
    Missing {
        /// The treatment.
        treatment: Treatment,
        /// Number of points without a height.
        missing: usize,
    },
    /// There are too few points for a form.
    #[error(
        "level: the {points} measured points do not determine a {form} form; choose a form with fewer coefficients, or fill first"
    )]
    Undetermined {
        /// The form.
        form: Level,
        /// Number of measured points.
        points: usize,
    },
    /// The wavelength is outside the range of the map.
    #[error("{filter}: must be from {least:e} (four points) to {most:e} (the shorter side), not {wavelength:e}")]
    Wavelength {
        /// The filter, `low_pass` or `high_pass`.
        filter: &'static str,
        /// The wavelength as given.
        wavelength: f64,
        /// Minimum wavelength, four points.
        least: f64,
        /// Maximum wavelength, the shorter side.
        most: f64,
    },
    /// So few deviations make no spike.
    #[error("despike: must be {least} or more robust standard deviations, not {sigma}; 8 is usual")]
    Sigma {
        /// The number of deviations as given.
        sigma: f64,
        /// The least number.
        least: f64,
    },
    /// The window leaves no part of the map unchanged.
    #[error(
        "taper: must be above 0 and at most 0.5, not {0}; it is the fraction of a side that fades at each of its two ends"
    )]
    Taper(f64),
    /// The number of points is not valid for a grid.
    #[error(transparent)]
    Grid(#[from] rc_core::GridError),
}
