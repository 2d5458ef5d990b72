//! Heights, bounds and extremes against every point of the finest grid, computed directly.

use std::f64::consts::TAU;

use rc_core::testing::quasi_random;
use rc_core::{Boundary, DVec2, Field, Grid, HeightField, HeightSource};
use rc_fft::Complex64;

use crate::grid::coarser::{Pits, coarsen, halved};
use crate::problem::error::ProblemError;
use crate::problem::summit::Summit;
use crate::tiles::heights::on_demand::Heights;
use rc_quadtree::TILE;

/// A self-affine surface with waves up to |k| ≤ N on a mean height.
///
/// Its rms height is 1, except for rounding.
struct SelfAffine {
    waves: usize,
    mean: f64,
    /// `columns[kx][ky + N]` for kx ≥ 0. The other half is conjugate.
    columns: Vec<Vec<Complex64>>,
}

impl SelfAffine {
    fn new(waves: usize, hurst: f64, mean: f64) -> Self {
        let n = waves as i64;
        let amplitude = |kx: i64, ky: i64| {
            let k_squared = (kx * kx + ky * ky) as f64;
            let counted = k_squared <= (n * n) as f64 && (kx > 0 || ky > 0);
            let size = if counted { k_squared.powf(-0.5 * (1.0 + hurst)) } else { 0.0 };
            // Phases linear in k would only shift a surface whose waves all meet in one point.
            let wave = (kx * (2 * n + 1) + ky + n) as usize;
            Complex64::from_polar(size, TAU * quasi_random(wave * wave * wave % 1_000_003))
        };
        let mut columns: Vec<Vec<_>> = (0..=n).map(|kx| (-n..=n).map(|ky| amplitude(kx, ky)).collect()).collect();
        let squares: f64 = columns.iter().flatten().map(Complex64::norm_sqr).sum();
        for amplitude in columns.iter_mut().flatten() {
            *amplitude /= (2.0 * squares).sqrt();
        }
        Self { waves, mean, columns }
    }

    /// The waves along x at this y.
    fn along_x(&self, y: f64) -> Vec<Complex64> {
        let waves: Vec<Complex64> = (0..self.columns[0].len())
            .map(|i| Complex64::cis(TAU * ((i as f64 - self.waves as f64) * y).fract()))
            .collect();
        self.columns.iter().map(|column| column.iter().zip(&waves).map(|(a, wave)| a * wave).sum()).collect()
    }

    fn at(&self, along_x: &[Complex64], x: f64) -> f64 {
        let step = Complex64::cis(TAU * x);
        let sum = along_x.iter().rev().fold(Complex64::ZERO, |sum, amplitude| sum * step + amplitude);
        self.mean + 2.0 * sum.re
    }
}

impl HeightField for SelfAffine {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        self.at(&self.along_x(y), x)
    }

    fn band_limit(&self) -> Option<usize> {
        Some(self.waves)
    }

    fn sample(&self, grid: Grid) -> Field {
        let mut field = Field::zeros(grid);
        for (iy, row) in field.values_mut().chunks_exact_mut(grid.nx()).enumerate() {
            let along_x = self.along_x(grid.centre(0, iy).y);
            for (ix, height) in row.iter_mut().enumerate() {
                *height = self.at(&along_x, grid.centre(ix, iy).x);
            }
        }
        field
    }
}

/// A surface that is not band-limited.
struct Ridge;

impl HeightField for Ridge {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        (TAU * x).sin().abs() + 0.3 * (TAU * y).cos().abs()
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

/// Only the shortest waves, with summits between the centres. The bound of the maximum by samples is sharp for them.
struct EggBox {
    waves: usize,
}

impl HeightField for EggBox {
    fn height(&self, DVec2 { x, y }: DVec2) -> f64 {
        (TAU * self.waves as f64 * x).cos() * (TAU * self.waves as f64 * y).cos()
    }

    fn band_limit(&self) -> Option<usize> {
        Some(self.waves)
    }
}

fn square(side: usize) -> Grid {
    Grid::square(side).expect("a small grid")
}

/// Maximum, minimum and mean height.
fn extremes_of(field: &Field) -> Vec<f64> {
    vec![field.max(), field.min(), field.mean()]
}

fn extremes(heights: &Heights<'_>) -> Vec<f64> {
    let found = heights.extremes();
    vec![found.greatest, found.least, found.mean]
}

/// Largest difference between the tiles of a level and a field on it.
fn worst_tile(heights: &Heights<'_>, exact: &Field) -> f64 {
    let side = exact.grid().nx();
    let mut worst = 0.0_f64;
    for (tx, ty) in (0..(side / TILE).pow(2)).map(|tile| (tile % (side / TILE), tile / (side / TILE))) {
        let mut tile = [f64::NAN; TILE * TILE];
        heights.tile([side, side], [tx, ty], &mut tile);
        for (i, height) in tile.iter().enumerate() {
            let difference = (height - exact.at(tx * TILE + i % TILE, ty * TILE + i / TILE)).abs();
            assert!(!difference.is_nan(), "tile ({tx}, {ty}) was not filled");
            worst = worst.max(difference);
        }
    }
    worst
}

/// Minimum and mean excess of the bounds of `blocks`² blocks.
///
/// The excess is over the maximum value of the finest field inside a block.
fn excess(heights: &Heights<'_>, finest: &Field, blocks: usize) -> (f64, f64) {
    let n = finest.grid().nx() / blocks;
    let (mut least, mut sum) = (f64::INFINITY, 0.0);
    for (ix, iy) in (0..blocks * blocks).map(|block| (block % blocks, block / blocks)) {
        let inside = (iy * n..(iy + 1) * n).flat_map(|row| &finest.row(row)[ix * n..(ix + 1) * n]);
        let greatest = inside.copied().fold(f64::NEG_INFINITY, f64::max);
        let excess = heights.upper_bound([blocks; 2], [ix, iy]) - greatest;
        least = least.min(excess);
        sum += excess;
    }
    (least, sum / (blocks * blocks) as f64)
}

#[test]
fn tiles_of_all_levels_are_exact_to_nine_digits_of_the_rms_height() {
    // The shortest wave has 4 or 8 elements of the interpolation grid (32 or 128, 100). Some bases are not a power of
    // two.
    for (waves, base, finest) in [(32, 32, 1024), (32, 64, 512), (16, 128, 512), (25, 100, 800), (19, 20, 640)] {
        for hurst in [0.1, 0.8, 1.0] {
            // A mean of a thousand times the rms height may cost three digits by rounding, but not by interpolation.
            let surface = SelfAffine::new(waves, hurst, 1e3);
            let heights = Heights::new(
                HeightSource::Surface { surface: &surface, grid: Grid::square(finest).expect("a grid") },
                [base; 2],
            )
            .expect("finite");
            assert_eq!(heights.ladder().finest(), square(finest));
            assert_eq!(heights.base(), &surface.sample(square(base)));
            let sides = (0..).map(|k| base << k).take_while(|&side| side <= finest);
            for side in sides.filter(|side| side % TILE == 0) {
                let worst = worst_tile(&heights, &surface.sample(square(side)));
                assert!(worst <= 1e-9, "{side} of {waves} waves, H = {hurst}: off by {worst:e}");
            }
        }
    }
}

#[test]
fn tiles_far_below_a_cell_of_the_interpolation_grid_are_exact() {
    let surface = SelfAffine::new(5, 0.8, 0.0);
    let side = 32 << 10;
    let heights =
        Heights::new(HeightSource::Surface { surface: &surface, grid: Grid::square(side).expect("a grid") }, [32; 2])
            .expect("finite");
    let mut tile = [0.0; TILE * TILE];
    for (tx, ty) in [(0, 0), (4095, 4095), (63, 64), (2047, 1), (1234, 3210)] {
        heights.tile([side, side], [tx, ty], &mut tile);
        for (i, height) in tile.iter().enumerate() {
            let exact = surface.height(square(side).centre(tx * TILE + i % TILE, ty * TILE + i / TILE));
            assert!((height - exact).abs() <= 1e-9, "({tx}, {ty}) {i}: {height} against {exact}");
        }
    }
}

#[test]
fn bounds_of_a_surface_hold_in_every_block_and_are_close() {
    // The last number is the average excess of the bounds over the maximum height in a block, in units of the rms
    // height. Blocks are not smaller than the cells that are bounded. The excess grows with the share of short waves.
    let cases =
        [(32, 32, 1024, 0.8, 0.03), (32, 32, 1024, 0.1, 0.1), (16, 128, 512, 0.8, 0.03), (25, 100, 800, 0.8, 0.03)];
    for (waves, base, finest, hurst, close) in cases {
        let surface = SelfAffine::new(waves, hurst, -50.0);
        let heights = Heights::new(
            HeightSource::Surface { surface: &surface, grid: Grid::square(finest).expect("a grid") },
            [base; 2],
        )
        .expect("finite");
        let field = surface.sample(square(finest));
        for blocks in (0..).map(|k| (base / 4) << k).take_while(|&blocks| blocks <= finest) {
            let (least, mean) = excess(&heights, &field, blocks);
            assert!(least >= 0.0, "{blocks} blocks: a bound is {:e} too low", -least);
            let as_large_as_cells = blocks <= base.max(4 * waves);
            assert!(!as_large_as_cells || mean <= close, "{blocks} blocks: bounds are {mean:e} above the heights");
        }
    }
}

#[test]
fn bounds_and_extremes_hold_for_the_shortest_waves_alone() {
    for (waves, base) in [(8, 32), (7, 28), (5, 32)] {
        let surface = EggBox { waves };
        let heights = Heights::new(
            HeightSource::Surface { surface: &surface, grid: Grid::square(16 * base).expect("a grid") },
            [base; 2],
        )
        .expect("finite");
        let field = surface.sample(square(16 * base));
        for blocks in [base / 4, base, 2 * base] {
            let (least, mean) = excess(&heights, &field, blocks);
            assert!(least >= 0.0, "{waves} waves, {blocks} blocks: a bound is {:e} too low", -least);
            assert!(mean < 1.0, "{waves} waves, {blocks} blocks: bounds are {mean} above the heights");
        }
        assert!((heights.extremes().greatest - field.max()).abs() < 1e-9);
        assert!((heights.extremes().least - field.min()).abs() < 1e-9);
    }
}

#[test]
fn extremes_are_those_of_every_centre_of_the_finest_grid() {
    for (waves, base, finest) in [(32, 32, 512), (32, 64, 512), (32, 8, 512), (25, 100, 800), (3, 20, 640)] {
        let surface = SelfAffine::new(waves, 0.8, 7.0);
        let heights = Heights::new(
            HeightSource::Surface { surface: &surface, grid: Grid::square(finest).expect("a grid") },
            [base; 2],
        )
        .expect("finite");
        let exact = extremes_of(&surface.sample(square(finest)));
        for (found, exact) in extremes(&heights).into_iter().zip(exact) {
            assert!((found - exact).abs() <= 1e-9, "{waves} waves on {finest}: {found} against {exact}");
        }
    }
}

#[test]
fn a_surface_that_the_finest_grid_barely_resolves_is_sampled_there() {
    let surface = SelfAffine::new(32, 0.8, 0.0);
    // 120 < 4 · 32, and 60 elements per side cannot even represent the waves.
    let heights =
        Heights::new(HeightSource::Surface { surface: &surface, grid: Grid::square(120).expect("a grid") }, [60; 2])
            .expect("finite");
    let field = surface.sample(square(120));
    assert!(worst_tile(&heights, &field) == 0.0);
    assert_eq!(extremes(&heights), extremes_of(&field));
    assert_eq!(heights.base(), &coarsen(&field, Boundary::Periodic, Pits::Kept, halved(field.grid(), 60))[0]);
}

#[test]
fn a_flat_surface_has_its_height_everywhere() {
    let surface = SelfAffine { waves: 0, mean: 0.25, columns: vec![vec![Complex64::ZERO]] };
    let heights =
        Heights::new(HeightSource::Surface { surface: &surface, grid: Grid::square(256).expect("a grid") }, [16; 2])
            .expect("finite");
    assert!(worst_tile(&heights, &surface.sample(square(256))) == 0.0);
    assert_eq!(extremes(&heights), vec![0.25; 3]);
    assert!((heights.upper_bound([32, 32], [3, 4]) - 0.25).abs() < f64::EPSILON);
}

#[test]
fn a_map_keeps_its_values_and_its_bounds_are_its_maxima() {
    let map = Field::from_fn(square(400), |DVec2 { x, y }| 3.0 + quasi_random((997.0 * x + 31.0 * y * 400.0) as usize));
    let heights = Heights::new(HeightSource::Map(&map), [50; 2]).expect("finite");
    assert!(worst_tile(&heights, &map) == 0.0, "the finest level is the map");
    let coarser = coarsen(&map, Boundary::Periodic, Pits::Kept, halved(map.grid(), 50));
    assert!(worst_tile(&heights, &coarser[0]) == 0.0, "the next is interpolated between its values");
    assert_eq!(heights.base(), &coarser[2]);
    assert_eq!(extremes(&heights), extremes_of(&map));
    for blocks in [50, 25, 10, 5, 1] {
        let (least, mean) = excess(&heights, &map, blocks);
        // The bounds are exact except for single precision, relative to the range of heights, if blocks are whole
        // blocks of eight.
        let allowed = if [50, 25].contains(&blocks) { 2e-7 } else { 1.0 };
        assert!(least >= 0.0 && mean <= allowed, "{blocks} blocks: least excess {least:e}, mean {mean:e}");
    }
}

#[test]
fn a_surface_without_band_limit_is_a_map() {
    let heights =
        Heights::new(HeightSource::Surface { surface: &Ridge, grid: Grid::square(256).expect("a grid") }, [32; 2])
            .expect("finite");
    let map = Ridge.sample(square(256));
    assert!(worst_tile(&heights, &map) == 0.0);
    assert_eq!(extremes(&heights), extremes_of(&map));
}

/// The reference is the highest place near all centres of a fine grid.
#[test]
fn the_summit_is_that_of_the_whole_surface() {
    for waves in 20..28 {
        let surface = SelfAffine::new(waves, 0.5, 0.1);
        let fine = surface.sample(square(1024)).max();
        for side in [128, 256] {
            let source = HeightSource::Surface { surface: &surface, grid: Grid::square(side).expect("a grid") };
            let Summit { sampled, excess } = Heights::new(source, [32; 2]).expect("finite").summit();
            let samples = surface.sample(square(side));
            assert!((sampled / samples.max() - 1.0).abs() < 1e-8);
            let missed = sampled + excess - fine;
            // The fine grid is not more than this from the summit.
            assert!((-1e-8..2e-3).contains(&missed), "{waves}, {side}: {missed:e}, {excess:e}");
            let on_grid = Summit::on_grid(Some(&surface), (&samples, samples.max()), Boundary::Periodic);
            assert!((on_grid.excess - excess).abs() < 1e-3 * excess + 1e-8, "{on_grid:?}, {excess:e}");
        }
    }
}

#[test]
fn heights_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut map = Field::zeros(square(64));
        map.values_mut()[64 * 5 + 7] = bad;
        let error = Heights::new(HeightSource::Map(&map), [16; 2]).err();
        let found =
            matches!(error, Some(ProblemError::Height { ix: 7, iy: 5, value }) if value.to_bits() == bad.to_bits());
        assert!(found, "{error:?}");
        let mut surface = SelfAffine::new(3, 0.8, 0.0);
        surface.mean = bad;
        assert!(
            Heights::new(
                HeightSource::Surface { surface: &surface, grid: Grid::square(256).expect("a grid") },
                [16; 2]
            )
            .is_err()
        );
    }
}

#[test]
fn heights_do_not_depend_on_the_number_of_threads() {
    let surface = SelfAffine::new(20, 0.8, 1.0);
    let with_threads = |n_threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().expect("a pool");
        pool.install(|| {
            let heights = Heights::new(
                HeightSource::Surface { surface: &surface, grid: Grid::square(800).expect("a grid") },
                [50; 2],
            )
            .expect("finite");
            let mut tile = [0.0; TILE * TILE];
            heights.tile([800, 800], [99, 13], &mut tile);
            let bounds: Vec<f64> = (0..10_000).map(|i| heights.upper_bound([100; 2], [i % 100, i / 100])).collect();
            (tile, bounds, extremes(&heights))
        })
    };
    assert!(with_threads(1) == with_threads(3), "bits differ");
}
