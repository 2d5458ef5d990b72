//! The symbol of the paper's element on a uniform grid, fast: a few aliases and a smooth rest.
//!
//! The aliases nearest to the wave are summed as they are. The rest of the alias sum ([`crate::alias_sum`]) is a smooth
//! and even function of θx and θy, singular only at the nearest alias that is left out. It is a Chebyshev interpolant
//! in θx² and θy², fitted to the alias sum, and as accurate as that sum. But for the unit of length it depends on the
//! shape of elements alone, so all grids of a process whose elements are alike have one fit: fitted for each grid, it
//! took a quarter of a solve on 256² elements.
//!
//! Which aliases are near depends on the shape of the elements. Let r ≥ 1 be long side over short side, m count aliases
//! along the long side and n along the short one.
//!
//! - Up to r = 2, a block of 3, 5 or 7 aliases along by 3 across is enough.
//! - Beyond, the row n = 0 is singular at distances of order 1/r from real θ, for ever more m. This row is summed
//!   whole, with the weights of the alternating sum, and all other rows are smooth.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, Mutex, PoisonError};

use rc_core::Grid;

use crate::alias_sum::{AliasSum, Damping, TERMS, alias_range, alternating_weights, phase};
use crate::chebyshev;

/// Chebyshev nodes per direction: the interpolant converges like 14^-nodes or faster (for squares like 38^-nodes).
const NODES: usize = 14;

/// Weighted terms on each side of the row n = 0: 5.8^-18 = 2e-14 is a bound, the error measured is below 2e-15.
const ROW_TERMS: usize = 18;

/// Largest aspect ratio of elements for which a block of aliases is the shorter sum.
const LARGEST_BLOCK_ASPECT: f64 = 2.0;

/// Evaluates λ(kx, ky) on one grid.
pub(crate) struct LoveSymbol {
    /// Whether the long side of the elements is along y.
    swapped: bool,
    /// Aliases along the long side, two at a time, since a processor takes two square roots at once.
    long: Axis<2>,
    short: Axis<1>,
    /// For each wavenumber along the long side, the Chebyshev coefficients of the rest in θ² of the short side.
    rest: Vec<[f64; NODES]>,
}

impl LoveSymbol {
    /// Fits the rest, if no fit for elements of this shape is kept, in 1.6 ms, and tabulates what depends on one
    /// component of the wave: 0.3 µs for each element of a side.
    pub(crate) fn new(grid: Grid) -> Self {
        // Number of elements, and how many of them are as long as the unit.
        let [x, y] = [(grid.nx(), grid.nx() as f64), (grid.ny(), grid.ny() as f64 / grid.cell_ratio())];
        let swapped = x.1 > y.1;
        let ((n_long, per_long), (n_short, per_short)) = if swapped { (y, x) } else { (x, y) };
        let aspect = per_short / per_long;
        let (long, short) = match reach(aspect) {
            Some((along, across)) => {
                (Axis::new(n_long, per_long, &block(along)), Axis::new(n_short, per_short, &block(across)))
            }
            None => (Axis::new(n_long, per_long, &weighted_row()), Axis::new(n_short, per_short, &block(0))),
        };
        let table = rest_of_shape(aspect);
        let collapse = |&mapped: &f64| std::array::from_fn(|j| chebyshev::sum(&table[j], mapped) / per_long);
        let rest = long.mapped.iter().map(collapse).collect();
        Self { swapped, long, short, rest }
    }

    /// λ for 0 ≤ kx ≤ nx/2, 0 ≤ ky ≤ ny/2, in λ/E*; zero at k = 0 (Eq. 3).
    pub(crate) fn eigenvalue(&self, kx: usize, ky: usize) -> f64 {
        if kx == 0 && ky == 0 {
            return 0.0;
        }
        let (k_long, k_short) = if self.swapped { (ky, kx) } else { (kx, ky) };
        let mut sums = [chebyshev::sum(&self.rest[k_long], self.short.mapped[k_short]), 0.0];
        for short in self.short.near(k_short) {
            let ([damping], [squared]) = (short.damping, short.squared);
            for long in self.long.near(k_long) {
                for (lane, sum) in sums.iter_mut().enumerate() {
                    *sum += damping * long.damping[lane] / (squared + long.squared[lane]).sqrt();
                }
            }
        }
        sums[0] + sums[1]
    }
}

/// Aliases of the block along and across elements of this aspect ratio; none where the row n = 0 is summed whole.
fn reach(aspect: f64) -> Option<(usize, usize)> {
    // With this reach, the singularities of the rest are nowhere closer than for squares and 3 x 3 aliases.
    (aspect <= LARGEST_BLOCK_ASPECT).then(|| ((1.5 * aspect - 0.5).ceil() as usize, 1))
}

/// Chebyshev coefficients of the rest, as [`interpolate`] gives them.
type Table = [[f64; NODES]; NODES];

/// Fits that are kept. A process that uses more shapes makes the first ones again.
const KEPT: usize = 16;

/// Fits by aspect ratio, the last one used at the end.
static FITS: Mutex<Vec<(f64, Arc<Table>)>> = Mutex::new(Vec::new());

/// The rest for elements of this aspect ratio, whose long side is the unit of length.
fn rest_of_shape(aspect: f64) -> Arc<Table> {
    let fits = || FITS.lock().unwrap_or_else(PoisonError::into_inner);
    let is_this = |(other, _): &(f64, Arc<Table>)| other.to_bits() == aspect.to_bits();
    let found = fits().iter().find(|fit| is_this(fit)).map(|(_, table)| Arc::clone(table));
    // Without the lock: others need not wait, and who fits the same finds the same.
    let table = found.unwrap_or_else(|| Arc::new(fit(aspect)));
    let mut fits = fits();
    fits.retain(|fit| !is_this(fit));
    if fits.len() == KEPT {
        fits.remove(0);
    }
    fits.push((aspect, Arc::clone(&table)));
    table
}

fn fit(aspect: f64) -> Table {
    let sum = AliasSum::<TERMS>::new((1.0, 1.0 / aspect));
    match reach(aspect) {
        Some(reach) => interpolate(|theta| sum.outside_block(theta, reach)),
        None => interpolate(|theta| sum.outside_row(theta)),
    }
}

/// Tables over one component of the wave, with `L` aliases side by side.
struct Axis<const L: usize> {
    /// The near aliases of each wavenumber up to half the grid.
    near: Vec<Aliases<L>>,
    /// Entries of `near` for each wavenumber.
    stride: usize,
    /// θ² mapped to [-1, 1], for each wavenumber.
    mapped: Vec<f64>,
}

/// `L` aliases of one wavenumber.
struct Aliases<const L: usize> {
    /// T_m, times the weight of the alias in the sum.
    damping: [f64; L],
    /// ((θ + πm)/h)².
    squared: [f64; L],
}

impl<const L: usize> Axis<L> {
    /// For `n` elements, of which `per_unit` are as long as the unit; `aliases`: (m, weight in the sum).
    fn new(n: usize, per_unit: f64, aliases: &[(f64, f64)]) -> Self {
        // Where the aliases do not fill the last entry, alias 2 with weight 0 does: its denominator is never 0.
        let alias = |entry: usize, lane: usize| aliases.get(entry * L + lane).copied().unwrap_or((2.0, 0.0));
        let stride = aliases.len().div_ceil(L);
        let mut near = Vec::with_capacity((n / 2 + 1) * stride);
        for k in 0..=n / 2 {
            let theta = phase(k, n);
            let damping = Damping::new(theta);
            near.extend((0..stride).map(|entry| Aliases {
                damping: std::array::from_fn(|lane| alias(entry, lane).1 * damping.at(alias(entry, lane).0)),
                squared: std::array::from_fn(|lane| ((theta + PI * alias(entry, lane).0) * per_unit).powi(2)),
            }));
        }
        let mapped = (0..=n / 2).map(|k| 2.0 * (phase(k, n) / FRAC_PI_2).powi(2) - 1.0).collect();
        Self { near, stride, mapped }
    }

    fn near(&self, k: usize) -> &[Aliases<L>] {
        &self.near[k * self.stride..(k + 1) * self.stride]
    }
}

/// Aliases -reach..=reach with weight 1.
fn block(reach: usize) -> Vec<(f64, f64)> {
    alias_range(reach).map(|m| (m, 1.0)).collect()
}

/// All aliases, by the weights of the alternating sum.
fn weighted_row() -> Vec<(f64, f64)> {
    let weights = alternating_weights::<ROW_TERMS>();
    let both_sides = weights.iter().enumerate().flat_map(|(i, &weight)| {
        let m = (i + 1) as f64;
        [(m, weight), (-m, weight)]
    });
    std::iter::once((0.0, 1.0)).chain(both_sides).collect()
}

/// Chebyshev coefficients in (θ² of the short side, θ² of the long side) of the interpolant of `value((θ long, θ
/// short))` on [0, π/2]².
fn interpolate(value: impl Fn((f64, f64)) -> f64) -> Table {
    let theta = |node: usize| FRAC_PI_2 * f64::midpoint(1.0, chebyshev::node(node, NODES)).sqrt();
    let over_short: Table = std::array::from_fn(|i| coefficients(std::array::from_fn(|j| value((theta(i), theta(j))))));
    std::array::from_fn(|j| coefficients(std::array::from_fn(|i| over_short[i][j])))
}

/// Chebyshev coefficients of the interpolant of values at the nodes.
fn coefficients(values: [f64; NODES]) -> [f64; NODES] {
    let coefficients = chebyshev::coefficients(&values);
    std::array::from_fn(|k| coefficients[k])
}

#[cfg(test)]
mod tests {
    use crate::alias_sum::love_alias_sum;

    use super::*;

    /// Every wave of a small grid, and about 33 × 33 of a large one, the longest included.
    fn waves(n: usize) -> Vec<usize> {
        let half = n / 2;
        let mut waves: Vec<usize> = (0..=32).map(|i| i * half / 32).chain((1..4).filter(|&k| k <= half)).collect();
        waves.sort_unstable();
        waves.dedup();
        waves
    }

    #[test]
    fn more_shapes_than_are_kept_have_their_own_fits() {
        let grid = |i: usize| Grid::new(32, 32 + 2 * (i % (KEPT + 5))).expect("grid");
        let values: Vec<u64> =
            (0..2 * (KEPT + 5)).map(|i| LoveSymbol::new(grid(i)).eigenvalue(3, 5).to_bits()).collect();
        assert_eq!(values[..KEPT + 5], values[KEPT + 5..]);
        for (i, value) in values.iter().enumerate().take(KEPT + 5) {
            let reference = love_alias_sum(grid(i), 3, 5);
            assert!((f64::from_bits(*value) / reference - 1.0).abs() < 4e-15, "{}", grid(i));
        }
    }

    #[test]
    fn fast_symbol_matches_the_alias_sum() {
        // Squares, odd sides, both orientations, both sides of the switch at aspect 2, slivers.
        let sizes = [
            (16, 16),
            (64, 64),
            (15, 15),
            (4096, 4096),
            (9, 7),
            (50, 60),
            (60, 50),
            (60, 40),
            (60, 33),
            (60, 30),
            (60, 29),
            (12, 30),
            (64, 8),
            (8, 64),
            (3, 100),
            (1000, 2),
            (1, 7),
            (1, 1024),
            (1 << 15, 1),
        ];
        let square = sizes.map(|(nx, ny)| Grid::new(nx, ny).expect("grid"));
        let rectangles =
            [(48, 16, 1.0 / 3.0), (16, 48, 3.0), (20, 24, 2.5), (24, 20, 0.1), (9, 64, 40.0), (64, 9, 0.02)];
        let rectangles = rectangles.map(|(nx, ny, ratio)| Grid::in_cell(nx, ny, ratio).expect("grid"));
        for grid in square.into_iter().chain(rectangles) {
            let (nx, ny) = (grid.nx(), grid.ny());
            let symbol = LoveSymbol::new(grid);
            for kx in waves(nx) {
                for ky in waves(ny).into_iter().skip(usize::from(kx == 0)) {
                    let (value, reference) = (symbol.eigenvalue(kx, ky), love_alias_sum(grid, kx, ky));
                    let error = (value / reference - 1.0).abs();
                    assert!(
                        error <= 4e-15,
                        "({kx}, {ky}) on {grid}: {value:e}, alias sum {reference:e}, off by {error:.1e}"
                    );
                }
            }
        }
    }
}
