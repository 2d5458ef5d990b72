//! Profiles, and the spectra of surfaces that have such profiles.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use rc_fractal::{LEAST_POINTS, MAX_WAVES, spectrum_of_profile};
use rc_heights::{HeightMap, Layout, ReadNote, ReadParams, has_profile};

use super::heights;
use super::keys::SurfaceKeys;
use crate::error::CliError;

/// A profile of equally spaced points, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    /// Heights (m); `NaN` where missing.
    pub(crate) heights: Vec<f64>,
    /// Step of the points (m).
    pub(crate) spacing: f64,
    /// What the reader did and assumed.
    pub(crate) notes: Vec<ReadNote>,
}

impl Profile {
    /// Reads a profile. `None` for any other file, which is that of a map.
    ///
    /// # Errors
    /// [`CliError::Input`] when points are not finite, not equally spaced along x, or without a step.
    pub(crate) fn read(path: &Path, keys: &SurfaceKeys) -> Result<Option<Self>, CliError> {
        let params = keys.read_params();
        if path.is_dir() || keys.layout == Some(Layout::Matrix) || !has_profile(path, &params).unwrap_or(false) {
            return Ok(None);
        }
        let params = ReadParams { is_profile: true, ..params };
        let map = heights::read(path, &params, keys.scales())?;
        let n = map.heights.values().len();
        let given = keys.cell.filter(|_| map.sides.is_none() || map.sides_are_assumed());
        let Some(length) = given.or(map.sides.map(|[length, _]| length)) else {
            return Err(CliError::in_file(path, "a profile without places; give cell (m), the length of the profile"));
        };
        Ok(Some(Self { heights: map.heights.into_values(), spacing: length / n as f64, notes: map.notes }))
    }

    /// The profile without missing points.
    ///
    /// # Errors
    /// [`CliError::Input`] with the first missing point, or when points are too few for a spectrum.
    pub(crate) fn complete(self, path: &Path) -> Result<Self, CliError> {
        check_number(path, self.heights.len())?;
        match self.heights.iter().position(|height| !height.is_finite()) {
            None => Ok(self),
            Some(i) => Err(CliError::in_file(
                path,
                format_args!("point {} of the profile is {}; heights must be finite", i + 1, self.heights[i]),
            )),
        }
    }

    /// Whether nothing names the unit of its numbers.
    pub(crate) fn is_assumed(&self) -> bool {
        self.notes.iter().any(ReadNote::is_assumption)
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
        let Some(sides) = map.sides else {
            let message = "a profile whose points have no distance; give a text of lines x z";
            return Err(CliError::in_file(path, message));
        };
        let side = if grid.ny() == 1 { sides[0] } else { sides[1] };
        let spacing = side / heights.len() as f64;
        Self { heights, spacing, notes: map.notes.clone() }.complete(path).map(Some)
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

/// Refuses profiles of too few points.
fn check_number(path: &Path, n: usize) -> Result<(), CliError> {
    if n >= LEAST_POINTS {
        return Ok(());
    }
    Err(CliError::in_file(path, format_args!("a profile of {n} points; give at least {LEAST_POINTS}")))
}
