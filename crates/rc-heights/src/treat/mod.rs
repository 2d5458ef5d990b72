//! What is done to a measured map before it is pressed: pure functions from map to map, and what each of them changes.

mod crop;
mod fill;
mod flip;
mod level;
mod low_pass;
mod periodic;
mod repeat;
mod resample;
mod stencil;

use std::fmt;

use rc_core::{Field, Grid};
use thiserror::Error;

use crate::{BorderStep, HeightMap};

pub use crop::{Crop, SAME_LENGTH};
pub use fill::Fill;
pub use flip::Flip;
pub use level::Level;
pub use periodic::{Periodic, hann};
pub use repeat::{MOST_COPIES, Repeat};
pub use stencil::Edges;

/// One treatment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Treatment {
    /// Keep a part.
    Crop(Crop),
    /// Mirror.
    Flip(Flip),
    /// Give missing points heights.
    Fill(Fill),
    /// Take a form away.
    Level(Level),
    /// Make opposite borders meet.
    Periodic(Periodic),
    /// Take short waves away with a Gaussian filter that halves waves of this length (ISO 16610-61), which must be four points or
    /// more: weights at points cannot tell shorter waves from longer ones.
    LowPass {
        /// In the unit of the sides.
        wavelength: f64,
    },
    /// Other numbers of points on the same rectangle.
    Resample(Grid),
    /// Copies beside each other.
    Repeat(Repeat),
}

impl fmt::Display for Treatment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Crop(crop) => write!(f, "crop {crop}"),
            Self::Flip(axis) => write!(f, "flip {axis}"),
            Self::Fill(how) => write!(f, "fill {how}"),
            Self::Level(form) => write!(f, "level {form}"),
            Self::Periodic(how) => write!(f, "periodic {how}"),
            Self::LowPass { wavelength } => write!(f, "low-pass {wavelength:e}"),
            Self::Resample(grid) => write!(f, "resample {grid}"),
            Self::Repeat(repeat) => write!(f, "repeat {repeat}"),
        }
    }
}

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

/// What a map is like after a treatment.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The treatment, in words, and whether it ended early; "as read" before the first.
    pub treatment: String,
    /// Points along x and y.
    pub grid: Grid,
    /// Sides of the rectangle.
    pub sides: Option<[f64; 2]>,
    /// Missing points.
    pub missing: usize,
    /// Rms height about the mean of the measured points.
    pub rms_height: f64,
    /// Rms gradient, from neighbours that are both measured.
    pub rms_slope: f64,
    /// [`BorderStep::ratio`]; `None` while points are missing.
    pub border_step: Option<f64>,
}

impl Effect {
    /// The state of `map` after `treatment`.
    #[must_use]
    pub fn of(map: &HeightMap, treatment: &(impl ToString + ?Sized)) -> Self {
        let missing = map.missing();
        Self {
            treatment: treatment.to_string(),
            grid: map.heights.grid(),
            sides: map.sides,
            missing,
            rms_height: rms_height(&map.heights),
            rms_slope: rms_slope(&map.heights, map.spacing()),
            border_step: (missing == 0).then(|| BorderStep::of(&map.heights).ratio()),
        }
    }
}

/// Applies treatments in the order given. The second result has the state after each.
///
/// Filters and resampling take the map for mirrored at its borders; after [`Treatment::Periodic`], for periodic.
///
/// # Errors
/// [`TreatError`] of the first treatment that is not possible.
pub fn apply(map: HeightMap, treatments: &[Treatment]) -> Result<(HeightMap, Vec<Effect>), TreatError> {
    let (mut map, mut edges) = (map, Edges::Mirrored);
    let mut effects = Vec::with_capacity(treatments.len());
    for treatment in treatments {
        let note;
        (map, note) = one(map, *treatment, edges)?;
        if matches!(treatment, Treatment::Periodic(_)) {
            edges = Edges::Periodic;
        }
        effects.push(Effect::of(&map, &format!("{treatment}{note}")));
    }
    Ok((map, effects))
}

/// The grid of `map` after each treatment, without treating it: what a program compares with its memory first. No treatment has
/// a larger one on its way.
///
/// # Errors
/// [`TreatError`] of the first treatment whose part is not inside the map, or whose grid is none.
pub fn grids_after(map: &HeightMap, treatments: &[Treatment]) -> Result<Vec<Grid>, TreatError> {
    let (mut grid, mut spacing) = (map.heights.grid(), map.spacing());
    let next = |treatment: &Treatment| -> Result<Grid, TreatError> {
        let after = match *treatment {
            Treatment::Crop(crop) => crop::part(grid, spacing, crop)?.1,
            Treatment::Periodic(Periodic::Mirror) => Grid::new(2 * grid.nx(), 2 * grid.ny())?,
            Treatment::Resample(wanted) => {
                let ratio = |n: usize, wanted: usize| n as f64 / wanted as f64;
                spacing = [spacing[0] * ratio(grid.nx(), wanted.nx()), spacing[1] * ratio(grid.ny(), wanted.ny())];
                wanted
            }
            Treatment::Repeat(repeat) => {
                let sides = [spacing[0] * grid.nx() as f64, spacing[1] * grid.ny() as f64];
                repeat::copies(grid, sides, repeat)?.1
            }
            _ => grid,
        };
        grid = after;
        Ok(after)
    };
    treatments.iter().map(next).collect()
}

/// The map after `treatment`, and what is to be said of it.
fn one(map: HeightMap, treatment: Treatment, edges: Edges) -> Result<(HeightMap, String), TreatError> {
    let missing = map.missing();
    let complete = matches!(treatment, Treatment::Periodic(_) | Treatment::LowPass { .. } | Treatment::Resample(_));
    if complete && missing > 0 {
        return Err(TreatError::Missing { treatment, missing });
    }
    let treated = match treatment {
        Treatment::Crop(crop) => crop::crop(&map, crop),
        Treatment::Flip(axis) => Ok(flip::flip(map, axis)),
        Treatment::Fill(how) => return Ok(fill::fill(map, how)),
        Treatment::Level(form) => level::level(map, form),
        Treatment::Periodic(how) => periodic::periodic(map, how),
        Treatment::LowPass { wavelength } => low_pass::low_pass(map, wavelength, edges),
        Treatment::Resample(grid) => Ok(resample::resample(map, grid, edges)),
        Treatment::Repeat(times) => repeat::repeat(&map, times),
    };
    treated.map(|map| (map, String::new()))
}

/// Root mean square about the mean of the values that are there; `NaN` without any.
fn rms_height(heights: &Field) -> f64 {
    let (mean, n) = mean(heights);
    let squares = sum_rows(heights, |height| (height - mean) * (height - mean));
    (squares / n as f64).sqrt()
}

/// Mean of the values that are there, and their number.
fn mean(heights: &Field) -> (f64, usize) {
    let n = heights.values().iter().filter(|height| !height.is_nan()).count();
    (sum_rows(heights, |height| height) / n as f64, n)
}

/// Sum over the values that are there, row by row.
fn sum_rows(heights: &Field, term: impl Fn(f64) -> f64) -> f64 {
    let rows = heights.values().chunks_exact(heights.grid().nx());
    rows.map(|row| row.iter().filter(|height| !height.is_nan()).map(|height| term(*height)).sum::<f64>()).sum()
}

/// √(⟨(∂h/∂x)²⟩ + ⟨(∂h/∂y)²⟩) from differences of neighbours that are there.
pub(crate) fn rms_slope(heights: &Field, [dx, dy]: [f64; 2]) -> f64 {
    let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
    let mean_square = |differences: &mut dyn Iterator<Item = f64>| {
        let there = differences.filter(|difference| !difference.is_nan());
        let (sum, n) = there.fold((0.0, 0_usize), |(sum, n), difference| (sum + difference * difference, n + 1));
        if n > 0 { sum / n as f64 } else { 0.0 }
    };
    let along_x = (0..ny).flat_map(|iy| heights.row(iy).windows(2).map(move |pair| (pair[1] - pair[0]) / dx));
    let along_y = (1..ny)
        .flat_map(|iy| (0..nx).map(move |ix| (iy, ix)))
        .map(|(iy, ix)| (heights.at(ix, iy) - heights.at(ix, iy - 1)) / dy);
    (mean_square(&mut { along_x }) + mean_square(&mut { along_y })).sqrt()
}
