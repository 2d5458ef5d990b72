//! Heights on nested coarser grids.

use rc_core::{Boundary, Field, Grid};

use crate::grid::interpolation::interpolate;
use crate::parallel;
use rc_fft::has_small_factors;

/// Minimum number of elements across a long cell on its coarsest grid.
const SMALLEST_WIDTH: usize = 8;

/// Factors of the side that follows an odd side.
///
/// The next side has 2^k times one of these numbers of elements. FFTs of such lengths are fast, and k halvings follow.
const MULTIPLES: [usize; 6] = [8, 9, 10, 12, 14, 15];

/// Maximum prime factor of a side that is halved to an odd side.
const GREATEST_FACTOR: usize = 13;

/// Whether heights below the [`floor`] are kept or count as the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pits {
    Kept,
    Filled,
}

/// The heights on coarser grids of the same cell, each sampled from the one before.
///
/// Starts on finer grids come from heights with filled pits.
pub(crate) fn coarsen(
    heights: &Field,
    boundary: Boundary,
    pits: Pits,
    coarser: impl IntoIterator<Item = Grid>,
) -> Vec<Field> {
    let floor = if pits == Pits::Kept { f64::NEG_INFINITY } else { floor(heights) };
    let mut levels: Vec<Field> = Vec::new();
    for grid in coarser {
        let next = sample(levels.last().unwrap_or(heights), grid, (floor, boundary));
        levels.push(next);
    }
    levels
}

/// The nested grids below `finest`, finest first, each with half the elements per side.
///
/// The grids end where halving does not leave whole elements, or leaves less than `smallest_side` of them along the
/// larger side. A long cell needs coarser grids too.
pub(crate) fn halved(finest: Grid, smallest_side: usize) -> impl Iterator<Item = Grid> {
    nested(finest, smallest_side, half)
}

/// The nested grids below a grid of any size, as [`halved`].
///
/// The next grid has half the elements of an even side, and about half the elements of an odd one.
pub(crate) fn about_halved(finest: Grid, smallest_side: usize) -> impl Iterator<Item = Grid> {
    nested(finest, smallest_side, |side| Some(about_half(side)))
}

fn nested(finest: Grid, smallest_side: usize, next_side: fn(usize) -> Option<usize>) -> impl Iterator<Item = Grid> {
    let next = move |finer: &Grid| {
        let (nx, ny) = (finer.nx(), finer.ny());
        // A profile has one row on every grid.
        let is_wide = ny == 1 || nx.min(ny) >= 2 * SMALLEST_WIDTH.min(smallest_side);
        let next_ny = if ny == 1 { Some(1) } else { next_side(ny) };
        let is_large = nx.max(ny) >= 2 * smallest_side && is_wide;
        if is_large { finer.with_elements(next_side(nx)?, next_ny?).ok() } else { None }
    };
    std::iter::successors(Some(finest), next).skip(1)
}

fn half(side: usize) -> Option<usize> {
    side.is_multiple_of(2).then_some(side / 2)
}

/// Half the side, or a little more.
///
/// It is a little more unless the half can be halved again or has small prime factors.
fn about_half(side: usize) -> usize {
    match half(side) {
        Some(half) if half.is_multiple_of(2) || has_small_factors(half, GREATEST_FACTOR) => half,
        _ => {
            let least = side.div_ceil(2);
            let k = (least / MULTIPLES[0]).max(1).ilog2();
            let sides = (k..=k + 1).flat_map(|k| MULTIPLES.map(|multiple| multiple << k));
            sides.filter(|&side| side >= least).min().unwrap_or(least)
        }
    }
}

/// Maximum number of heights that the quartile is computed from.
const SAMPLES: usize = 1 << 14;

/// Ratio of the depth of the floor to the depth of the lower quartile.
///
/// Depths are below the highest point.
const FLOOR_DEPTH: f64 = 5.0;

/// The height that only pits are below.
///
/// Interpolation next to a deep pit overshoots. A summit that does not exist would then carry the whole load of a
/// coarse grid. On a plateau, whose quartile is its top, no height is below the floor.
fn floor(heights: &Field) -> f64 {
    let values = heights.values();
    // An odd step does not stay in one column of a grid with even sides.
    let step = (values.len() / SAMPLES) | 1;
    let mut samples: Vec<f64> = values.iter().copied().step_by(step).collect();
    let highest = parallel::maximum(values, f64::NEG_INFINITY);
    let quarter = samples.len() / 4;
    let (_, quartile, _) = samples.select_nth_unstable_by(quarter, f64::total_cmp);
    let depth = highest - *quartile;
    if depth > 0.0 { highest - FLOOR_DEPTH * depth } else { f64::NEG_INFINITY }
}

/// The heights at the centres of a coarser grid of the same cell.
///
/// The centre of an element twice as large lies at the midpoint of two centres. There, six neighbours keep 99.9 % of a
/// wave of eight elements. Averaging would keep 92 %.
fn sample(finer: &Field, grid: Grid, (floor, boundary): (f64, Boundary)) -> Field {
    let heights =
        interpolate::<6>(finer.values(), ([finer.grid(), grid], boundary), |height| height.max(floor), |height| height);
    Field::new(grid, heights).expect("a value for each element")
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use rc_core::DVec2;

    use super::*;

    #[test]
    fn halving_samples_a_resolved_wave_at_the_coarse_centres() {
        let wave = |DVec2 { x, y }: DVec2| (2.0 * PI * (5.0 * x + 3.0 * y)).cos();
        let fine = Field::from_fn(Grid::new(160, 128).expect("grid"), wave);
        let coarse = coarsen(&fine, Boundary::Periodic, Pits::Kept, halved(fine.grid(), 64));
        let grid = Grid::new(80, 64).expect("grid");
        assert_eq!(coarse.len(), 1, "80 x 64 is too small to halve again");
        let exact = Field::from_fn(grid, wave);
        let worst = exact.values().iter().zip(coarse[0].values()).map(|(e, c)| (e - c).abs()).fold(0.0, f64::max);
        // Twice the interpolation error of a wave of 32 elements, (20/4096)·(2π/32)^6 to leading order.
        assert!(worst < 1e-6, "off by {worst:e}");
    }

    #[test]
    fn a_pit_raises_no_summit_beside_it() {
        let grid = Grid::square(128).expect("a grid");
        let wave = |at: DVec2| (2.0 * PI * at.x).cos() * (2.0 * PI * at.y).cos();
        let mut heights = Field::from_fn(grid, wave);
        heights.values_mut()[7 * 128 + 40] -= 1e6;
        let coarse = coarsen(&heights, Boundary::Periodic, Pits::Filled, halved(heights.grid(), 32));
        for level in &coarse {
            assert!(level.max() < 1.6, "a summit of {} on {}", level.max(), level.grid());
        }
    }

    #[test]
    fn a_grooved_plateau_keeps_its_grooves() {
        let grooved = |at: DVec2| if (8.0 * at.x).fract() < 0.2 { -1.0 } else { 0.0 };
        let heights = Field::from_fn(Grid::square(128).expect("a grid"), grooved);
        let coarse = coarsen(&heights, Boundary::Periodic, Pits::Filled, halved(heights.grid(), 32));
        assert!(coarse[0].min() < -0.5, "grooves of {}", coarse[0].min());
    }

    #[test]
    fn odd_sides_are_not_halved() {
        assert!(halved(Grid::new(256, 255).expect("grid"), 2).next().is_none());
    }

    #[test]
    fn grids_of_any_size_have_coarser_ones_with_the_same_wave() {
        for (nx, ny) in [(1001, 1001), (997, 640), (334, 130), (255, 64), (640, 480), (2001, 17)] {
            // A short side has too few elements for a wave along it.
            let along_y = if ny < 64 { 0.0 } else { 2.0 };
            let wave = |DVec2 { x, y }: DVec2| (2.0 * PI * (3.0 * x + along_y * y)).cos();
            let fine = Field::from_fn(Grid::new(nx, ny).expect("grid"), wave);
            let coarser = coarsen(&fine, Boundary::Periodic, Pits::Filled, about_halved(fine.grid(), 64));
            let coarsest = coarser.last().expect("coarser grids").grid();
            assert!((64..128).contains(&coarsest.nx().max(coarsest.ny())) || coarsest.ny() < 16, "{coarsest}");
            let mut finer = fine.grid();
            for level in &coarser {
                let grid = level.grid();
                for (coarse, fine) in [(grid.nx(), finer.nx()), (grid.ny(), finer.ny())] {
                    assert!((0.5..0.63).contains(&(coarse as f64 / fine as f64)), "{grid} under {finer}");
                }
                let exact = Field::from_fn(grid, wave);
                let errors = exact.values().iter().zip(level.values()).map(|(e, c)| (e - c).abs());
                assert!(errors.fold(0.0, f64::max) < 1e-4, "{grid} under {}", fine.grid());
                finer = grid;
            }
        }
    }

    /// A ramp is not continuous across the border.
    #[test]
    fn a_patch_is_coarsened_without_what_is_across_its_borders() {
        let ramp = |DVec2 { x, y }: DVec2| x - 2.0 * y + 0.1 * (x * y).powi(2);
        for (nx, ny) in [(256, 256), (300, 130), (1001, 64)] {
            let fine = Field::from_fn(Grid::new(nx, ny).expect("grid"), ramp);
            for level in coarsen(&fine, Boundary::Free, Pits::Filled, about_halved(fine.grid(), 32)) {
                let exact = Field::from_fn(level.grid(), ramp);
                let errors = exact.values().iter().zip(level.values()).map(|(e, c)| (e - c).abs());
                assert!(errors.fold(0.0, f64::max) < 1e-12, "{} under {}", level.grid(), fine.grid());
            }
        }
    }

    #[test]
    fn sides_that_divide_well_are_halved() {
        for (side, next) in
            [(1024, 512), (1000, 500), (250, 125), (1001, 512), (1002, 512), (997, 512), (257, 144), (17, 9)]
        {
            assert_eq!(about_half(side), next, "{side}");
        }
    }
}
