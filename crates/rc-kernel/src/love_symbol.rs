//! The symbol of the paper's element on a uniform grid.
//!
//! It is the sum of a few aliases and a smooth rest. The aliases nearest to the wave are summed directly. The rest of
//! the alias sum ([`crate::alias_sum`]) is a smooth and even function of θx and θy. It is singular only at the nearest
//! of its aliases. A Chebyshev interpolant in θx² and θy², fitted to the alias sum, represents it with the accuracy of
//! that sum.
//!
//! Except for the unit of length, the rest depends only on the shape of the elements. So a process has one fit for all
//! grids with elements of the same shape. A fit for each grid would take a quarter of a solve on 256² elements.
//!
//! The set of near aliases depends on the shape of the elements. Let r ≥ 1 be the ratio of the long to the short side.
//! Let m count aliases along the long side and n along the short side.
//!
//! - Up to r = 2, a block of 3, 5 or 7 aliases along by 3 across is enough.
//! - For larger r, the row n = 0 is singular at distances of order 1/r from real θ, for more and more m. This row is
//!   summed completely, with the weights of the alternating sum, and all other rows are smooth.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::{Arc, Mutex, PoisonError};

use rc_core::Grid;

use crate::alias_sum::{AliasSum, Damping, TERMS, alias_range, alternating_weights, phase};
use crate::chebyshev;

/// Chebyshev nodes per direction.
///
/// The interpolant converges like 14^-nodes or faster, for squares like 38^-nodes.
const NODES: usize = 14;

/// Weighted terms on each side of the row n = 0.
///
/// A bound of the error is 5.8^-18 = 2e-14. The measured error is below 2e-15.
const ROW_TERMS: usize = 18;

/// Maximum aspect ratio of elements for which a block of aliases is the shorter sum.
const LARGEST_BLOCK_ASPECT: f64 = 2.0;

/// Evaluates λ(kx, ky) on one grid.
pub(crate) struct LoveSymbol {
    /// Whether the long side of the elements is along y.
    swapped: bool,
    /// Aliases along the long side, in pairs, because a processor computes two square roots at once.
    long: Axis<2>,
    short: Axis<1>,
    /// For each wavenumber along the long side, the Chebyshev coefficients of the rest in θ² of the short side.
    rest: Vec<[f64; NODES]>,
}

impl LoveSymbol {
    /// Fits the rest, and tabulates what depends on one component of the wave.
    ///
    /// The fit takes 1.6 ms, unless a fit for elements of this shape is kept. The tables take 0.3 µs for each element
    /// of a side.
    pub(crate) fn new(grid: Grid) -> Self {
        // For each axis, the number of elements, and how many of them are as long as the unit.
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

/// Aliases of the block along and across elements of this aspect ratio.
///
/// `None` where the row n = 0 is summed completely.
fn reach(aspect: f64) -> Option<(usize, usize)> {
    // With this reach, the singularities of the rest are at least as far away as for squares and 3 x 3 aliases.
    (aspect <= LARGEST_BLOCK_ASPECT).then(|| ((1.5 * aspect - 0.5).ceil() as usize, 1))
}

/// Chebyshev coefficients of the rest, as [`interpolate`] returns them.
type Table = [[f64; NODES]; NODES];

/// Number of fits that are kept. A process with more shapes repeats the fits that it used longest ago.
const KEPT: usize = 16;

/// Fits by aspect ratio. The last one used is at the end.
static FITS: Mutex<Vec<(f64, Arc<Table>)>> = Mutex::new(Vec::new());

/// The rest for elements of this aspect ratio.
///
/// Their long side is the unit of length.
fn rest_of_shape(aspect: f64) -> Arc<Table> {
    let fits = || FITS.lock().unwrap_or_else(PoisonError::into_inner);
    let is_this = |(other, _): &(f64, Arc<Table>)| other.to_bits() == aspect.to_bits();
    let found = fits().iter().find(|fit| is_this(fit)).map(|(_, table)| Arc::clone(table));
    // The fit runs without the lock, so that other threads need not wait. Two threads that fit the same shape get the
    // same result.
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

/// Tables for one component of the wave, with `L` aliases side by side.
struct Axis<const L: usize> {
    /// The near aliases of each wavenumber up to half the grid.
    near: Vec<Aliases<L>>,
    /// Number of entries of `near` for each wavenumber.
    stride: usize,
    /// θ² mapped to [-1, 1], for each wavenumber.
    mapped: Vec<f64>,
}

/// `L` aliases of one wavenumber.
struct Aliases<const L: usize> {
    /// T_m times the weight of the alias in the sum.
    damping: [f64; L],
    /// ((θ + πm)/h)².
    squared: [f64; L],
}

impl<const L: usize> Axis<L> {
    /// Tables for `n` elements, of which `per_unit` are as long as the unit.
    ///
    /// `aliases` has pairs of m and the weight in the sum.
    fn new(n: usize, per_unit: f64, aliases: &[(f64, f64)]) -> Self {
        // Lanes of the last entry without an alias get alias 2 with weight 0. Its denominator is never 0.
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

/// All aliases, with the weights of the alternating sum.
fn weighted_row() -> Vec<(f64, f64)> {
    let weights = alternating_weights::<ROW_TERMS>();
    let both_sides = weights.iter().enumerate().flat_map(|(i, &weight)| {
        let m = (i + 1) as f64;
        [(m, weight), (-m, weight)]
    });
    std::iter::once((0.0, 1.0)).chain(both_sides).collect()
}

/// Chebyshev coefficients of the interpolant of `value((θ long, θ short))` on [0, π/2]².
///
/// The variables are θ² of the short side and θ² of the long side.
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

    /// Every wave of a small grid, and about 33 × 33 waves of a large one.
    ///
    /// The longest waves are included.
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
        // Squares, odd sides, both orientations, both sides of the switch at aspect 2, very thin elements.
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
