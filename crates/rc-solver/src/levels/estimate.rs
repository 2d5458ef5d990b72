//! The expected cost of a scene, before it is solved.

use rc_core::{Boundary, Field};

use crate::problem::checked::Problem;
use crate::problem::control::Control;
use crate::problem::support::Support;
use crate::tiles::heights::on_demand::Heights;
use crate::tiles::memory::base_bytes;

/// Ratio of the contact area to σ0/(E* · rms slope) at low loads.
///
/// The literature has 1.6 to 2.5, and this solver 2.0 to 2.2.
const PROPORTIONALITY: f64 = 2.1;

/// Ratio of the area of the tiles of a contact to the contact area.
///
/// Measured at 1 % to 60 % contact, from λ_min/32.
const TILES_PER_AREA: f64 = 1.9;

/// Bytes for each cell of a tile where contact is possible, at the peak.
///
/// The second number is for meshes so large that descents spare memory.
const BYTES_PER_CELL: [f64; 2] = [55.0, 28.0];

/// Bytes that a sliding surface adds for each of these cells, at the peak.
///
/// Forty directions of GMRES take 320 for each active element, which are up to half of the cells. The second operator,
/// and tails, take about 60. On 1e6 cells with 28 directions in several steps, 75 were measured.
pub(crate) const MORE_BYTES_OF_SLIDING: f64 = 220.0;

/// Bytes that each border level adds to a cell, relative to one without.
///
/// They are for the larger cells that every level reaches beyond its own. `docs/constants.md` has the measured bytes.
const MORE_BYTES_PER_BORDER_LEVEL: f64 = 0.9;

/// Time that each border level adds to a cell, relative to one without.
///
/// `docs/constants.md` has the measured times.
const MORE_WORK_PER_BORDER_LEVEL: f64 = 0.8;

/// Factor by which one more border level multiplies the cells of tiles.
///
/// Edges alone would give 2. `docs/constants.md` has the measured factors.
const GROWTH_PER_BORDER_LEVEL: f64 = 2.6;

/// Bytes for each place of the smallest elements, used or not.
///
/// They are for the tables that find tiles, of a few meshes at a time.
const BYTES_PER_PLACE: f64 = 0.02;

/// Time of the adaptive method, in the time of the uniform method on as many elements: for any problem (elements), for each
/// element of the base grid, and for the contact area.
///
/// Fitted to 80 scenes of 192² to 1536² with two threads, love at 8 and 16 elements for the shortest wave, 1.2 to 50 %
/// contact. The method that these choose takes at most 1.11 times as long as the better one, and 1.003 times in the mean;
/// with eight threads 1.5 and 1.03.
const FIXED_TIME: f64 = 8e4;
const TIME_OF_BASE: f64 = 1.6;
const TIME_OF_AREA: f64 = 5.0;

/// Mean pressure of a flat patch with free borders at a penetration of 1, in E*/λ.
///
/// It is π times the capacity of a square. Rough patches of the same penetration bear less.
const LOAD_PER_DEPTH: f64 = 1.152;

/// An estimate of area, time and memory, from only the surface and the load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Estimate {
    /// Contact area relative to the nominal area.
    pub area_fraction: f64,
    /// Part of the cell in tiles where contact is possible, on the grid.
    pub tile_fraction: f64,
    /// Number of cells of these tiles, including those of border levels.
    pub cells: f64,
    /// Work on these cells. Its unit is the work on a cell of a mesh without border levels.
    pub work: f64,
    /// Memory of the adaptive method, in bytes.
    pub adaptive_bytes: f64,
    /// Time of the adaptive method without border levels, in the time of the uniform method.
    pub relative_time: f64,
}

impl Estimate {
    /// Contact area above which the uniform grid is faster on any grid.
    pub(crate) const GREATEST_ADAPTIVE_AREA: f64 = 1.0 / TIME_OF_AREA;

    /// Maximum fraction of the cell in tiles near contact for the adaptive method.
    ///
    /// Above it the uniform grid is faster. The base grid finds this fraction. The limit was measured on 27 scenes
    /// (docs/constants.md).
    pub(crate) const GREATEST_TILE_FRACTION: f64 = 0.35;

    /// The contact area under a mean pressure, from the slopes of coarse heights. It may be above 1.
    pub(crate) fn area_under(pressure: f64, (heights, boundary): (&Field, Boundary), hardness: f64) -> f64 {
        (PROPORTIONALITY * pressure / rms_slope(heights, boundary)).max(pressure / hardness)
    }

    /// Time of the adaptive method without border levels, in the time of the uniform method.
    pub(crate) fn relative_time(area_fraction: f64, n_base: f64, n_finest: f64) -> f64 {
        (FIXED_TIME + TIME_OF_BASE * n_base) / n_finest + TIME_OF_AREA * area_fraction
    }

    /// `period` has the elements of the base grid that operators work on. `spares` says whether a number of cells is so
    /// large that descents spare memory.
    pub(crate) fn new(
        heights: &Heights<'_>,
        border_level: usize,
        problem: &Problem,
        (period, spares): ([usize; 2], impl Fn(usize) -> bool),
    ) -> Self {
        let (base, boundary) = (heights.base(), problem.support.boundary);
        let of_load = |pressure: f64| PROPORTIONALITY * pressure / rms_slope(base, boundary);
        let area = match problem.bounds.control {
            Control::MeanPressure(pressure) => Self::area_under(pressure, (base, boundary), problem.bounds.hardness),
            // The undeformed surfaces overlap on a larger area than they touch on. The penetration of a patch or a layer
            // may be larger than all heights.
            Control::Penetration(penetration) => {
                let overlap = overlap(base, heights.extremes().greatest - penetration);
                // A base bears at least the part of the load that compresses the layer.
                let most = match problem.support {
                    _ if problem.bounds.hardness.is_finite() => f64::INFINITY,
                    Support { boundary: Boundary::Free, .. } => LOAD_PER_DEPTH * penetration,
                    Support { compliance, .. } => penetration / compliance,
                };
                overlap.min(of_load(most))
            }
        };
        // A flat surface, or one with a single element, touches everywhere.
        let area_fraction = if area.is_finite() { area.min(1.0) } else { 1.0 };
        // Contacts of a few cells take a whole tile each.
        let tile_fraction = (TILES_PER_AREA * area_fraction + 0.005).min(1.0);
        let n_finest = heights.ladder().finest().len() as f64;
        let n_cells = tile_fraction * n_finest * (0.25 * GROWTH_PER_BORDER_LEVEL).powi(border_level as i32);
        let with_borders = |more: f64| n_cells * (1.0 + more * border_level as f64);
        // Half of these cells are near contact, which is what descents count, and heights are kept up to twice the number.
        let spares = spares((0.5 * n_cells) as usize);
        let cell_bytes = BYTES_PER_CELL[usize::from(spares)] * with_borders(MORE_BYTES_PER_BORDER_LEVEL);
        Self {
            area_fraction,
            tile_fraction,
            cells: n_cells,
            work: with_borders(MORE_WORK_PER_BORDER_LEVEL),
            relative_time: Self::relative_time(area_fraction, base.grid().len() as f64, n_finest),
            adaptive_bytes: cell_bytes + BYTES_PER_PLACE * n_finest + base_bytes(period),
        }
    }
}

/// Isotropic rms slope from differences of neighbours, accurate enough for an estimate.
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
