//! Heights on nested coarser grids.

use rayon::prelude::*;
use rc_core::{Field, Grid};

/// Six-point interpolation to the midpoint of two centres (Lagrange), which is where the centre of a coarse element lies:
/// keeps 99.9 % of a wave of eight fine elements, where averaging would keep 92 %.
const MIDPOINT: [f64; 6] = [3.0 / 256.0, -25.0 / 256.0, 150.0 / 256.0, 150.0 / 256.0, -25.0 / 256.0, 3.0 / 256.0];

/// Elements across a long cell on its coarsest grid, at least.
const SMALLEST_WIDTH: usize = 8;

/// The heights on coarser and coarser grids, finest of them first, each with half the elements per side, as long as that
/// leaves whole elements, at least `smallest_side` of them along the side with more; a long cell is in need of coarser grids too.
pub(crate) fn coarsen(heights: &Field, smallest_side: usize) -> Vec<Field> {
    coarsen_above(heights, smallest_side, f64::NEG_INFINITY)
}

/// The same for starts on finer grids: heights below the [`floor`] count as that.
pub(crate) fn coarsen_without_pits(heights: &Field, smallest_side: usize) -> Vec<Field> {
    coarsen_above(heights, smallest_side, floor(heights))
}

fn coarsen_above(heights: &Field, smallest_side: usize, floor: f64) -> Vec<Field> {
    let mut levels: Vec<Field> = Vec::new();
    loop {
        let finer = levels.last().unwrap_or(heights);
        let (nx, ny) = (finer.grid().nx(), finer.grid().ny());
        let large = nx.max(ny) >= 2 * smallest_side && nx.min(ny) >= 2 * SMALLEST_WIDTH.min(smallest_side);
        if !(large && nx.is_multiple_of(2) && ny.is_multiple_of(2)) {
            return levels;
        }
        let Ok(grid) = finer.grid().with_elements(nx / 2, ny / 2) else { return levels };
        let next = halve(finer, grid, floor);
        levels.push(next);
    }
}

/// Heights that are looked at for the quartile, at most.
const SAMPLES: usize = 1 << 14;

/// How many times farther below the highest point than the lower quartile the floor is.
const FLOOR_DEPTH: f64 = 5.0;

/// What only pits are below: interpolation next to a deep pit overshoots, and a summit that is not there would carry the whole load of a
/// coarse grid. On a plateau, whose quartile is its top, nothing is.
fn floor(heights: &Field) -> f64 {
    let values = heights.values();
    // An odd step, which does not stay in one column of a grid whose sides are even.
    let step = (values.len() / SAMPLES) | 1;
    let mut samples: Vec<f64> = values.iter().copied().step_by(step).collect();
    let highest = heights.max();
    let quarter = samples.len() / 4;
    let (_, quartile, _) = samples.select_nth_unstable_by(quarter, f64::total_cmp);
    let depth = highest - *quartile;
    if depth > 0.0 { highest - FLOOR_DEPTH * depth } else { f64::NEG_INFINITY }
}

fn halve(finer: &Field, grid: Grid, floor: f64) -> Field {
    let (nx, ny) = (finer.grid().nx(), finer.grid().ny());
    let mut coarse = Field::zeros(grid);
    coarse.values_mut().par_chunks_mut(grid.nx()).enumerate().for_each_init(
        || vec![0.0; nx],
        |blended, (iy, row)| {
            blended.fill(0.0);
            for (tap, weight) in MIDPOINT.iter().enumerate() {
                let source = finer.row((2 * iy + tap + ny - 2) % ny);
                for (sum, value) in blended.iter_mut().zip(source) {
                    *sum += weight * value.max(floor);
                }
            }
            for (ix, value) in row.iter_mut().enumerate() {
                let taps = MIDPOINT.iter().enumerate();
                *value = taps.map(|(tap, weight)| weight * blended[(2 * ix + tap + nx - 2) % nx]).sum();
            }
        },
    );
    coarse
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
        let coarse = coarsen(&fine, 64);
        let grid = Grid::new(80, 64).expect("grid");
        assert_eq!(coarse.len(), 1, "80 x 64 is too small to halve again");
        let exact = Field::from_fn(grid, wave);
        let worst = exact.values().iter().zip(coarse[0].values()).map(|(e, c)| (e - c).abs()).fold(0.0, f64::max);
        // The interpolation error of a wave of 32 elements, (20/4096)·(2π/32)^6 to leading order, twice.
        assert!(worst < 1e-6, "off by {worst:e}");
    }

    #[test]
    fn a_pit_raises_no_summit_beside_it() {
        let grid = Grid::square(128).expect("a grid");
        let wave = |at: DVec2| (2.0 * PI * at.x).cos() * (2.0 * PI * at.y).cos();
        let mut heights = Field::from_fn(grid, wave);
        heights.values_mut()[7 * 128 + 40] -= 1e6;
        let coarse = coarsen_without_pits(&heights, 32);
        for level in &coarse {
            assert!(level.max() < 1.6, "a summit of {} on {}", level.max(), level.grid());
        }
    }

    #[test]
    fn a_grooved_plateau_keeps_its_grooves() {
        let grooved = |at: DVec2| if (8.0 * at.x).fract() < 0.2 { -1.0 } else { 0.0 };
        let heights = Field::from_fn(Grid::square(128).expect("a grid"), grooved);
        let coarse = coarsen_without_pits(&heights, 32);
        assert!(coarse[0].min() < -0.5, "grooves of {}", coarse[0].min());
    }

    #[test]
    fn odd_sides_are_not_coarsened() {
        assert!(coarsen(&Field::zeros(Grid::new(256, 255).expect("grid")), 2).is_empty());
    }
}
