//! Profiles, and the spectra of surfaces that have such profiles.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use rc_fractal::{LEAST_POINTS, MAX_WAVES, spectrum_of_profile};
use rc_heights::{HeightMap, Layout, LengthUnit, ReadNote, pairs};

use super::keys::SurfaceKeys;
use crate::error::CliError;

/// Relative difference of spacings that are equal.
const EQUAL: f64 = 0.01;

/// A profile of equally spaced points, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    heights: Vec<f64>,
    spacing: f64,
    /// Whether nothing names the unit of its numbers.
    pub(crate) is_assumed: bool,
}

impl Profile {
    /// Reads a text of two columns, x and z. `None` for any other file, which is that of a map.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are too few, not finite, or not equally spaced along x.
    pub(crate) fn read(path: &Path, keys: &SurfaceKeys) -> Result<Option<Self>, CliError> {
        if path.is_dir() || keys.layout == Some(Layout::Matrix) {
            return Ok(None);
        }
        let Ok(points) = pairs::read_within(path, keys.read_params().max_bytes, "x and z") else { return Ok(None) };
        let fail = |message: std::fmt::Arguments<'_>| CliError::in_file(path, message);
        check_heights(path, points.iter().map(|point| point[1]))?;
        let spacing = (points[points.len() - 1][0] - points[0][0]) / (points.len() - 1) as f64;
        let is_equal = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0] - spacing).abs() <= EQUAL * spacing;
        if !(spacing > 0.0 && points.windows(2).all(is_equal)) {
            return Err(fail(format_args!(
                "the points of the profile are not equally spaced along x; give lines x z with equal steps of x"
            )));
        }
        let unit = keys.unit.map_or(1.0, LengthUnit::metres);
        let of_heights = keys.height_unit.map_or(unit, LengthUnit::metres);
        let of_heights = keys.height_scale.unwrap_or(of_heights);
        Ok(Some(Self {
            heights: points.iter().map(|point| point[1] * of_heights).collect(),
            spacing: spacing * unit,
            is_assumed: keys.unit.is_none(),
        }))
    }

    /// The profile in a map of one row, in metres. `None` for any other map.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are too few or missing, or when their distance is not known.
    pub(crate) fn of_map(path: &Path, map: &HeightMap) -> Result<Option<Self>, CliError> {
        let grid = map.heights.grid();
        if grid.nx().min(grid.ny()) > 1 {
            return Ok(None);
        }
        let heights = map.heights.values().to_vec();
        check_heights(path, heights.iter().copied())?;
        let Some(sides) = map.sides else {
            let message = "a profile whose points have no distance; give a text of lines x z";
            return Err(CliError::in_file(path, message));
        };
        let side = if grid.ny() == 1 { sides[0] } else { sides[1] };
        let spacing = side / heights.len() as f64;
        let is_assumed = map.notes.iter().any(ReadNote::is_assumption);
        Ok(Some(Self { heights, spacing, is_assumed }))
    }

    /// Length of the profile (m).
    pub(crate) fn length(&self) -> f64 {
        self.heights.len() as f64 * self.spacing
    }

    /// The table q (rad/m), C (m⁴) of the surface, for a cell of side `side` (m) with at most `waves` waves.
    pub(crate) fn spectrum(&self, side: f64, waves: usize) -> Vec<[f64; 2]> {
        let cut_off = (TAU * waves.min(MAX_WAVES) as f64 / side).min(PI / self.spacing);
        let rows = spectrum_of_profile(&self.heights, self.spacing);
        let n_inside = rows.partition_point(|row| row[0] <= cut_off);
        let mut table = rows[..n_inside].to_vec();
        if let (Some(&[q0, c0]), Some(&[q1, c1])) = (table.last(), rows.get(n_inside)) {
            // The table ends at the cut-off, on the power law between its rows.
            let part = (cut_off / q0).ln() / (q1 / q0).ln();
            if cut_off > q0 && c0 > 0.0 && c1 > 0.0 {
                table.push([cut_off, c0 * (c1 / c0).powf(part)]);
            }
        }
        table
    }
}

/// Refuses profiles of too few points, and of points that are not finite.
fn check_heights(path: &Path, heights: impl ExactSizeIterator<Item = f64>) -> Result<(), CliError> {
    let fail = |message: std::fmt::Arguments<'_>| Err(CliError::in_file(path, message));
    let n = heights.len();
    if n < LEAST_POINTS {
        return fail(format_args!("a profile of {n} points; give at least {LEAST_POINTS}"));
    }
    match heights.enumerate().find(|(_, height)| !height.is_finite()) {
        Some((i, height)) => fail(format_args!("point {} of the profile is {height}; heights must be finite", i + 1)),
        None => Ok(()),
    }
}
