//! What a scene will cost, before any of it is solved.

use rc_core::{Boundary, Field};

use super::heights::Heights;
use super::memory::base_bytes;
use crate::Control;
use crate::problem::Problem;

/// Contact area relative to σ0/(E* · rms slope) at low loads; the literature has 1.6 to 2.5, and this solver 2.0
/// to 2.2.
const PROPORTIONALITY: f64 = 2.1;

/// Part of the cell that the tiles of a contact cover beyond the contact itself, measured at 1 % to 60 % contact, from
/// λ_min/32.
const TILES_PER_AREA: f64 = 1.9;

/// Bytes for each cell of a tile where contact is possible, at the peak.
const BYTES_PER_CELL: f64 = 80.0;

/// What each border level adds to the bytes of a cell, relative to those without any, for the larger cells that every
/// level reaches beyond its own: measured 75 to 150, 96 to 224 and 223 bytes for a cell of this estimate with one, two
/// and three levels (512² and 1024², 5 % and 26 % contact).
const MORE_BYTES_PER_BORDER_LEVEL: f64 = 0.9;

/// The same for the time: measured 2.3e-6 to 4.2e-6, 2.6e-6 to 5.5e-6 and 4.5e-6 seconds with one, two and three
/// levels.
const MORE_WORK_PER_BORDER_LEVEL: f64 = 0.8;

/// Cells of tiles with one more border level, relative to those without it: measured 3.1, 2.4 and 2.3 for the first
/// three levels at 32 elements per shortest wave; edges alone would give 2.
const GROWTH_PER_BORDER_LEVEL: f64 = 2.6;

/// Bytes for each place of the smallest elements, used or not: the tables that find tiles, of a few meshes at a time.
const BYTES_PER_PLACE: f64 = 0.02;

/// Load under which a flat patch with free borders goes a depth of 1 into the half-space, over its area: π times the
/// capacity of a square. Rough ones of the same depth bear less.
const LOAD_PER_DEPTH: f64 = 1.152;

/// An estimate of area, time and memory, from the surface and the load alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// Contact area relative to the nominal area.
    pub area_fraction: f64,
    /// Part of the cell in tiles where contact is possible, on the grid.
    pub tile_fraction: f64,
    /// Cells of these tiles, those of border levels included.
    pub cells: f64,
    /// Work on them, in units of that on a cell of a mesh without border levels.
    pub work: f64,
    /// Memory of the adaptive method, in bytes.
    pub adaptive_bytes: f64,
}

impl Estimate {
    /// Above this contact area the uniform grid is faster. Measured at 2048², N = 64: ratio of the times of the
    /// adaptive to the uniform method 0.19 at 1 %, 0.29 at 7 %, 0.9 at 29 %, 1.3 at 61 % and 1.9 at 89 %.
    pub(crate) const GREATEST_ADAPTIVE_AREA: f64 = 0.35;

    /// Above this fraction of the cell in tiles near contact, as the base grid finds it, the uniform grid is faster:
    /// measured on 27 scenes (docs/measurements-adaptive.md).
    pub(crate) const GREATEST_TILE_FRACTION: f64 = 0.35;

    /// `period` has the elements of the base grid that operators work on.
    pub(super) fn new(heights: &Heights<'_>, border_level: usize, problem: &Problem, period: [usize; 2]) -> Self {
        let (base, boundary) = (heights.base(), problem.support.boundary);
        let of_load = |pressure: f64| PROPORTIONALITY * pressure / rms_slope(base, boundary);
        let area = match problem.control {
            Control::MeanPressure(pressure) => of_load(pressure).max(pressure / problem.hardness),
            // Where the undeformed surfaces overlap is more than where they touch. A patch may be deeper than its heights.
            Control::Penetration(penetration) => {
                let overlap = overlap(base, heights.extremes().greatest - penetration);
                let is_free = boundary == Boundary::Free && problem.hardness.is_infinite();
                if is_free { overlap.min(of_load(LOAD_PER_DEPTH * penetration)) } else { overlap }
            }
        };
        // A flat surface, or one with a single element, touches everywhere.
        let area_fraction = if area.is_finite() { area.min(1.0) } else { 1.0 };
        // Contacts of a few cells take a whole tile each.
        let tile_fraction = (TILES_PER_AREA * area_fraction + 0.005).min(1.0);
        let n_finest = heights.ladder().finest().len() as f64;
        let n_cells = tile_fraction * n_finest * (0.25 * GROWTH_PER_BORDER_LEVEL).powi(border_level as i32);
        let with_borders = |more: f64| n_cells * (1.0 + more * border_level as f64);
        let cell_bytes = BYTES_PER_CELL * with_borders(MORE_BYTES_PER_BORDER_LEVEL);
        Self {
            area_fraction,
            tile_fraction,
            cells: n_cells,
            work: with_borders(MORE_WORK_PER_BORDER_LEVEL),
            adaptive_bytes: cell_bytes + BYTES_PER_PLACE * n_finest + base_bytes(period),
        }
    }
}

/// Isotropic rms slope by differences of neighbours, exact enough for an estimate.
fn rms_slope(heights: &Field, boundary: Boundary) -> f64 {
    let (nx, ny) = (heights.grid().nx(), heights.grid().ny());
    let (along_x, along_y) = (nx as f64, ny as f64 / heights.grid().cell_ratio());
    let mut sum = 0.0;
    // Opposite free borders are no neighbours.
    let [columns, rows] = match boundary {
        Boundary::Periodic => [nx, ny],
        Boundary::Free => [nx - 1, ny - 1],
    };
    for iy in 0..rows {
        let (row, next) = (heights.row(iy), heights.row((iy + 1) % ny));
        for ix in 0..columns {
            let (dx, dy) = (row[(ix + 1) % nx] - row[ix], next[ix] - row[ix]);
            sum += (dx * along_x).powi(2) + (dy * along_y).powi(2);
        }
    }
    (sum / heights.grid().len() as f64).sqrt()
}

/// Part of the surface above `level`.
fn overlap(heights: &Field, level: f64) -> f64 {
    heights.values().iter().filter(|&&h| h > level).count() as f64 / heights.grid().len() as f64
}
