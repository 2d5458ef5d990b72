//! A second certificate of a solution, from another operator than the one of the solve.

use anyhow::Result;
use rc_core::{Field, Grid, Operator};
use rc_solver::{Control, DirectSum, MultilevelOperator, UniformOperator};

use super::solved::{Method, Solved};

/// Maximum number of elements for a direct sum, which then takes half a second.
const MOST_DIRECT: usize = 64 * 64;

/// Error of the multilevel operator in an audit, relative to the rms displacement.
const OPERATOR_ERROR: f64 = 1e-9;

/// Cells per side of a tile of the multilevel operator.
const TILE: usize = 8;

/// Fraction of the maximum pressure above which an element is well inside contact.
///
/// The gap of such an element is closed.
const PRESSED: f64 = 0.1;

/// Errors of a pressure as the solution of a contact problem.
///
/// In the formulas g is the gap, v the displacement, h the height, and H the peak-to-valley height.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Audit {
    /// Number of pressures that are NaN, infinite or negative.
    pub(crate) n_bad: usize,
    /// |mean p - σ0| / σ0 under a prescribed load, |Δ found - Δ| / Δ under a prescribed penetration.
    pub(crate) load: f64,
    /// max(-g) / H, with the pressure-weighted mean of g at zero.
    pub(crate) penetration: f64,
    /// max |g| / H over elements with at least [`PRESSED`] of the maximum pressure.
    pub(crate) open: f64,
    /// √(G/U), an upper bound of the pressure's error in the energy norm.
    ///
    /// G is the mean of p (g - min g), plus the mean of p times the error of Δ under a prescribed penetration. U is the
    /// mean of p v / 2.
    pub(crate) energy: f64,
    /// H times the mean pressure, divided by U.
    range_per_work: f64,
}

impl Audit {
    /// The audit of a solution. It does not use the solution's own certificate.
    pub(crate) fn of(heights: &Field, solved: &Solved, method: Method, control: Control) -> Result<Self> {
        let displacement = displacement(&solved.pressure, method)?;
        Ok(Self::of_gaps(heights, &solved.pressure, &gaps(heights, &displacement), control))
    }

    /// The energy error that gaps of the size `gap` times H can cause.
    pub(crate) fn energy_of(&self, gap: f64) -> f64 {
        (gap * self.range_per_work).sqrt()
    }

    /// The audit of a pressure and its gap v - h + max h.
    pub(crate) fn of_gaps(heights: &Field, pressure: &Field, gaps: &[f64], control: Control) -> Self {
        let p = pressure.values();
        // The height range of a flat surface is zero, so its lengths are relative to the cell's side.
        let (top, greatest) = (heights.max(), pressure.max());
        let range = Some(top - heights.min()).filter(|range| *range > 0.0).unwrap_or(1.0);
        let total: f64 = p.iter().sum();
        // Weights come first, since products of tiny pressures and gaps underflow.
        let mean_of = |values: &mut dyn Iterator<Item = f64>| p.iter().zip(values).map(|(p, v)| p / total * v).sum();
        let approach: f64 = mean_of(&mut gaps.iter().copied());
        let displacement: f64 = mean_of(&mut gaps.iter().zip(heights.values()).map(|(g, h)| g - (top - h)));
        let min_gap = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let (load, off) = match control {
            Control::MeanPressure(wanted) => ((total / p.len() as f64 / wanted - 1.0).abs(), 0.0),
            Control::Penetration(wanted) => ((approach / wanted - 1.0).abs(), (approach - wanted).abs()),
        };
        let pressed = p.iter().zip(gaps).filter(|(p, _)| **p > PRESSED * greatest);
        // Both are divided by the total pressure.
        let (gap, work) = ((approach - min_gap).max(0.0) + off, 0.5 * displacement);
        Self {
            n_bad: p.iter().filter(|p| !(p.is_finite() && **p >= 0.0)).count(),
            load,
            penetration: (approach - min_gap) / range,
            open: pressed.map(|(_, g)| (g - approach).abs()).fold(0.0, f64::max) / range,
            // Under a flat surface the displacement is zero.
            energy: if gap > 0.0 { (gap / work).sqrt() } else { 0.0 },
            range_per_work: if range > 0.0 && work > 0.0 { range / work } else { 0.0 },
        }
    }
}

/// The gap v - h + max h.
///
/// The heights are subtracted first, since a large constant in them would drown the displacement.
pub(crate) fn gaps(heights: &Field, displacement: &[f64]) -> Vec<f64> {
    let top = heights.max();
    displacement.iter().zip(heights.values()).map(|(v, h)| v + (top - h)).collect()
}

/// The mean pressure Δ/(n L_ii) when only one element is in contact.
///
/// `None` if the penetration brings other elements into contact too.
pub(crate) fn load_of_one_element(heights: &Field, method: Method, penetration: f64) -> Option<f64> {
    let (grid, top) = (heights.grid(), heights.max());
    let highest = heights.values().iter().position(|&h| h >= top)?;
    let mut unit = vec![0.0; grid.len()];
    unit[highest] = 1.0;
    let mut v = vec![0.0; grid.len()];
    UniformOperator::new(grid, method.kernel()).apply(&unit, &mut v, &mut []);
    let pressure = penetration / v[highest];
    let gap = |(i, h): (usize, &f64)| pressure * v[i] + (top - h) - penetration;
    let touched = heights.values().iter().enumerate().any(|(i, h)| i != highest && gap((i, h)) < 0.0);
    (!touched).then(|| pressure / grid.len() as f64)
}

/// L p by another way than the method's own.
///
/// It is the multilevel operator for the uniform grid if the grid allows it. Otherwise it is a direct sum on small
/// grids, and a Fourier transform on others.
fn displacement(pressure: &Field, method: Method) -> Result<Vec<f64>> {
    // A constant pressure displaces nothing. The rounding of a large one would drown the displacement of the rest.
    let (grid, mean) = (pressure.grid(), pressure.mean());
    let p: Vec<f64> = pressure.values().iter().map(|p| p - mean).collect();
    let mut v = vec![0.0; p.len()];
    if method == Method::Uniform && can_be_multilevel(grid) {
        v = multilevel(grid, &p, grid.nx() / 2)?;
    } else if grid.len() <= MOST_DIRECT {
        DirectSum::new(grid, method.kernel()).apply(&p, &mut v, &mut []);
    } else {
        UniformOperator::new(grid, method.kernel()).apply(&p, &mut v, &mut []);
    }
    Ok(v)
}

/// L p on a square grid by the multilevel operator.
///
/// The base grid has `base` elements per side. All elements are on the finest level.
fn multilevel(grid: Grid, p: &[f64], base: usize) -> Result<Vec<f64>> {
    let side = grid.nx();
    let per_side = (side / TILE) as u32;
    let places = (0..per_side).flat_map(|row| (0..per_side).map(move |column| [column, row])).collect();
    let operator = MultilevelOperator::new(base, side, places, OPERATOR_ERROR)?;
    let index = |i: usize| {
        let ([column, row], cell) = (operator.places()[i / (TILE * TILE)], i % (TILE * TILE));
        (row as usize * TILE + cell / TILE) * side + column as usize * TILE + cell % TILE
    };
    let tiles: Vec<f64> = (0..p.len()).map(|i| p[index(i)]).collect();
    let (mut displaced, mut v) = (vec![0.0; p.len()], vec![0.0; p.len()]);
    operator.apply(&tiles, &mut displaced, &mut []);
    for (i, value) in displaced.into_iter().enumerate() {
        v[index(i)] = value;
    }
    Ok(v)
}

fn can_be_multilevel(grid: Grid) -> bool {
    grid.is_square() && grid.nx().is_multiple_of(2 * TILE)
}
