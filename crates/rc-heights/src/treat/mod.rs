//! Treatments of a measured map before it is pressed.
//!
//! They are pure functions from map to map, with a record of what each of them changes.

mod crop;
mod despike;
mod error;
mod fill;
mod flip;
mod high_pass;
mod level;
mod low_pass;
mod moments;
mod periodic;
mod repeat;
mod resample;
mod stencil;
mod treatment;

use rc_core::Grid;

use crate::{BorderStep, HeightMap};

pub use crop::SAME_LENGTH;
use despike::Removed;
pub use error::TreatError;
use moments::rms_height;
pub(crate) use moments::{mean, rms_slope};
pub use periodic::hann;
pub use stencil::Edges;
pub use treatment::{Crop, Fill, Flip, Level, MOST_COPIES, Periodic, Repeat, Treatment};

/// The state of a map after a treatment.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// The treatment in words, and whether it ended early. It is "as read" before the first one.
    pub treatment: String,
    /// Numbers of points along x and y.
    pub grid: Grid,
    /// Sides of the rectangle.
    pub sides: Option<[f64; 2]>,
    /// Number of points that the treatment cut, replaced, filled or moved. Copies of points are none.
    pub changed: usize,
    /// The points that [`Treatment::Despike`] replaced: index, and height above the new one.
    pub removed: Vec<(usize, f64)>,
    /// Number of missing points.
    pub missing: usize,
    /// rms height about the mean of the measured points.
    pub rms_height: f64,
    /// rms gradient, from pairs of measured neighbours.
    pub rms_slope: f64,
    /// [`BorderStep::ratio`], or `None` if points are missing.
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
            changed: 0,
            removed: Vec::new(),
            missing,
            rms_height: rms_height(&map.heights),
            rms_slope: rms_slope(&map.heights, map.spacing()),
            border_step: (missing == 0).then(|| BorderStep::of(&map.heights).ratio()),
        }
    }
}

/// Applies treatments in the given order, and returns the state after each.
///
/// Filters and resampling assume that the map is mirrored at its borders. After [`Treatment::Periodic`] they assume
/// that it is periodic.
///
/// # Errors
/// [`TreatError`] of the first treatment that is not possible.
pub fn apply(map: HeightMap, treatments: &[Treatment]) -> Result<(HeightMap, Vec<Effect>), TreatError> {
    let (mut map, mut edges) = (map, Edges::Mirrored);
    let mut effects = Vec::with_capacity(treatments.len());
    for treatment in treatments {
        let (before, missing) = (map.heights.grid().len(), map.missing());
        let (note, removed);
        (map, note, removed) = one(map, *treatment, edges)?;
        if matches!(treatment, Treatment::Periodic(_)) {
            edges = Edges::Periodic;
        }
        let effect = Effect::of(&map, &format!("{treatment}{note}"));
        let changed = match treatment {
            Treatment::Crop(_) | Treatment::EverySecond => before - effect.grid.len(),
            Treatment::Despike { .. } => removed.len(),
            Treatment::Fill(_) => missing - effect.missing,
            Treatment::Periodic(Periodic::AsIs | Periodic::Mirror) | Treatment::Repeat(_) => 0,
            _ => effect.grid.len(),
        };
        effects.push(Effect { changed, removed, ..effect });
    }
    Ok((map, effects))
}

/// The grid of `map` after each treatment, without applying it.
///
/// A program can compare it with its memory first. No treatment needs a larger grid internally. For
/// [`Crop::Measured`], the grid is an upper bound: that of the whole map.
///
/// # Errors
/// [`TreatError`] of the first treatment whose part is not inside the map, or whose grid is not valid.
pub fn grids_after(map: &HeightMap, treatments: &[Treatment]) -> Result<Vec<Grid>, TreatError> {
    let (mut grid, mut spacing) = (map.heights.grid(), map.spacing());
    let next = |treatment: &Treatment| -> Result<Grid, TreatError> {
        let after = match *treatment {
            Treatment::Crop(crop) => crop::part(grid, spacing, crop)?.1,
            Treatment::Periodic(Periodic::Mirror) => periodic::mirrored(grid)?,
            Treatment::Resample(wanted) => {
                let ratio = |n: usize, wanted: usize| n as f64 / wanted as f64;
                spacing = [spacing[0] * ratio(grid.nx(), wanted.nx()), spacing[1] * ratio(grid.ny(), wanted.ny())];
                wanted
            }
            Treatment::EverySecond => {
                spacing = spacing.map(|length| 2.0 * length);
                crop::every_second(grid)?
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

/// A treated map, a remark about the result, and the spikes that were removed.
type Treated = (HeightMap, String, Vec<Removed>);

/// The map after `treatment`.
fn one(map: HeightMap, treatment: Treatment, edges: Edges) -> Result<Treated, TreatError> {
    let missing = map.missing();
    let complete = matches!(
        treatment,
        Treatment::Periodic(_) | Treatment::LowPass { .. } | Treatment::HighPass { .. } | Treatment::Resample(_)
    );
    if complete && missing > 0 {
        return Err(TreatError::Missing { treatment, missing });
    }
    let treated = match treatment {
        Treatment::Crop(crop) => crop::crop(&map, crop),
        Treatment::Flip(axis) => Ok(flip::flip(map, axis)),
        Treatment::Despike { sigma } => {
            let (map, removed) = despike::despike(map, sigma)?;
            return Ok((map, String::new(), removed));
        }
        Treatment::Fill(how) => {
            let (map, note) = fill::fill(map, how);
            return Ok((map, note, Vec::new()));
        }
        Treatment::Level(form) => level::level(map, form),
        Treatment::Periodic(how) => periodic::periodic(map, how),
        Treatment::LowPass { wavelength } => low_pass::low_pass(map, wavelength, edges),
        Treatment::HighPass { wavelength } => high_pass::high_pass(map, wavelength, edges),
        Treatment::Resample(grid) => Ok(resample::resample(map, grid, edges)),
        Treatment::EverySecond => crop::thin(&map),
        Treatment::Repeat(times) => repeat::repeat(&map, times),
    };
    treated.map(|map| (map, String::new(), Vec::new()))
}
