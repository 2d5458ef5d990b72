//! The base grid: the coarsest whole grid that still has the surface's waves.

use rc_core::{Boundary, Field, Grid, HeightField, HeightSource};
use rc_quadtree::TILE;

use crate::descent::layout::BlockLayout;
use crate::parallel;
use crate::problem::adaptive_error::AdaptiveError;
use crate::tiles::ladder::sides_of;
use crate::tiles::memory::{BYTES_PER_SAMPLE, base_bytes};
use rc_fft::has_small_factors;

/// Number of elements of the base grid for the shortest wave.
///
/// The interpolation of heights to other levels does not need more.
pub(crate) const BASE_ELEMENTS_PER_WAVE: usize = 4;

/// Minimum number of elements along the longer side of the base grid.
pub(super) const SMALLEST_BASE: usize = 64;

/// Minimum number of elements along the shorter side of an uneven base grid.
///
/// Otherwise this number follows from the finest grid.
const SMALLEST_WIDTH: usize = 16;

/// Part of a map's mean square slope that the base grid must keep.
///
/// It is the slope of differences over the base grid's spacing. Four elements for a wave keep 0.81 of its slope, two
/// keep 0.41.
const SLOPE_KEPT: f64 = 0.8;

/// Maximum spacing of a map's base grid, in elements of the map: three levels above it.
///
/// The error of the operators grows with each level, and iterations with it: `docs/constants.md`.
const MOST_SPACING: usize = 8;

/// Checks or chooses the sides of the base grid, in elements.
///
/// If the elements along x are `wanted`, those along y are in proportion.
pub(crate) fn base_sides(
    source: &HeightSource<'_>,
    wanted: Option<usize>,
    boundary: Boundary,
) -> Result<[usize; 2], AdaptiveError> {
    let finest = sides_of(source.grid());
    let waves = source.surface().and_then(HeightField::band_limit);
    if let Some(base) = wanted {
        let error = AdaptiveError::Base { base, waves: waves.unwrap_or(0), finest: finest[0] };
        return wanted_sides(base, waves.unwrap_or(0), finest).ok_or(error);
    }
    let long = finest[0].max(finest[1]);
    // Heights may have waves as short as a few elements. Two levels above the base grid are safe, and three on large
    // grids.
    let safe = long / if long >= 4096 { 8 } else { 4 };
    let least = match (waves, source.map()) {
        (Some(waves), _) => BASE_ELEMENTS_PER_WAVE * waves,
        (None, Some(map)) => safe.min(smooth_side(map, boundary)),
        (None, None) => safe,
    };
    let least = least.max(SMALLEST_BASE);
    let halved = |n: usize| {
        let is_whole = finest.iter().all(|&side| side.is_multiple_of(n * TILE));
        is_whole.then(|| finest.map(|side| side / n))
    };
    // The longer side is halved as often as it stays at least `least`. It is halved at least once if that keeps the
    // waves.
    let mut n = 1;
    while long / (2 * n) >= least {
        n *= 2;
    }
    if n == 1 && long / 2 > 2 * waves.unwrap_or(0) {
        n = 2;
    }
    // If all levels are halves, a surface is sampled only where it is needed.
    let is_surface = waves.is_some() && source.grid().is_square();
    let mut halves = std::iter::successors(Some(n), |n| Some(n / 2)).take_while(|&n| n > 1);
    let even = if is_surface { halves.find_map(halved) } else { halves.next().and_then(halved) };
    let others = halves.find_map(halved);
    let [nx, ny] = finest;
    // Half the elements must hold the waves and at least one tile.
    let smallest = 2 * (2 * waves.unwrap_or(0) + 1).max(TILE);
    let error = AdaptiveError::Grid { nx, ny, smallest };
    let mut all = std::iter::successors(Some(n), |n| Some(n / 2)).take_while(|&n| n > 1 && long >= SMALLEST_BASE);
    let uneven =
        all.find_map(|n| GREATEST_FACTORS.into_iter().find_map(|factor| uneven_sides(source.grid(), n, factor)));
    // Below uneven grids a surface is sampled on its whole grid, like a map.
    let samples = if is_surface { BYTES_PER_SAMPLE * source.grid().len() as f64 } else { 0.0 };
    let is_larger = |even: &[usize; 2]| uneven.is_some_and(|other| base_bytes(*even) > base_bytes(other) + samples);
    even.filter(|even| !is_larger(even)).or(uneven).or(others).ok_or(error)
}

/// Maximum excess of the doubled base grid over the finest grid, relative to a side.
///
/// The excess is in elements. Patches of the operator are large enough for it.
const MOST_ADDED: f64 = 0.15;

/// Relative amount by which elements of the base grid may be longer along one side.
///
/// The second number holds if there is no other grid.
const OBLONG: [f64; 2] = [0.01, 0.02];

/// Maximum prime factors of the base grid's sides, each for grids without sides of smaller factors.
///
/// Fourier transforms of such lengths are fast. A finer base grid would cost four times as much.
const GREATEST_FACTORS: [usize; 3] = [7, 13, 31];

/// The best base grid for a finest grid that is about `n` times as large.
///
/// A side of the base grid, times `n`, has at least as many elements as the finest grid, and not many more. Elements
/// are nearly squares. Of such grids, it has the smallest number of elements. `None` if there is no such grid whose
/// sides have prime factors up to `greatest`.
fn uneven_sides(finest: Grid, n: usize, greatest: usize) -> Option<[usize; 2]> {
    let candidates = |side: usize| -> Vec<usize> {
        let least = side.div_ceil(n).next_multiple_of(TILE).max(SMALLEST_WIDTH);
        let most = ((1.0 + MOST_ADDED) * side as f64 / n as f64) as usize;
        (least..=most).step_by(TILE).filter(|&side| has_small_factors(side, greatest)).collect()
    };
    let [along_x, along_y] = sides_of(finest).map(candidates);
    let oblong = |[nx, ny]: [usize; 2]| {
        let ratio = ny as f64 / (nx as f64 * finest.cell_ratio());
        ratio.max(ratio.recip()) - 1.0
    };
    let all = along_x.iter().flat_map(|&nx| along_y.iter().map(move |&ny| [nx, ny]));
    let allowed = all.filter(|&sides| oblong(sides) <= OBLONG[1]);
    allowed.min_by(|&a, &b| {
        let is_oblong = |sides| oblong(sides).max(OBLONG[0]);
        is_oblong(a).total_cmp(&is_oblong(b)).then((a[0] * a[1]).cmp(&(b[0] * b[1])))
    })
}

/// The sides of a base grid of `base` elements along x, if it fits.
fn wanted_sides(base: usize, waves: usize, [nx, ny]: [usize; 2]) -> Option<[usize; 2]> {
    let fits = base >= TILE && base > 2 * waves && 2 * base <= nx;
    let n = (fits && nx.is_multiple_of(base)).then(|| nx / base).filter(|n| n.is_power_of_two())?;
    let sides = [base, ny / n];
    (ny.is_multiple_of(n) && sides.iter().all(|side| side.is_multiple_of(TILE))).then_some(sides)
}

/// Number of elements along the longer side that keeps the slopes of a map.
///
/// The spacing is a power of two, up to [`MOST_SPACING`].
fn smooth_side(map: &Field, boundary: Boundary) -> usize {
    let sides = sides_of(map.grid());
    let finest = mean_square_slope(map, 1, boundary);
    let mut spacing = 1;
    let is_kept = |spacing| mean_square_slope(map, spacing, boundary) >= SLOPE_KEPT * finest;
    while spacing < MOST_SPACING && 4 * spacing <= sides[0].min(sides[1]) && is_kept(2 * spacing) {
        spacing *= 2;
    }
    sides[0].max(sides[1]) / spacing
}

/// Mean square slope from differences over `spacing` elements along both axes.
///
/// Slopes are in units of the height over the side of an element. All rows count, because a repeating surface may look
/// smooth on some of them. There are no slopes across free borders.
fn mean_square_slope(map: &Field, spacing: usize, boundary: Boundary) -> f64 {
    let (nx, ny) = (map.grid().nx(), map.grid().ny());
    let of_row = |iy: usize| {
        let (row, below) = (map.row(iy), map.row((iy + spacing) % ny));
        let squares = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
        let (near, far) = row.split_at(nx - spacing);
        match boundary {
            Boundary::Periodic => [squares(near, &row[spacing..]) + squares(far, &row[..spacing]), squares(row, below)],
            Boundary::Free if iy + spacing < ny => [squares(near, &row[spacing..]), squares(row, below)],
            Boundary::Free => [squares(near, &row[spacing..]), 0.0],
        }
    };
    let sums = BlockLayout::of(nx).total(parallel::map(0..ny, of_row));
    let [along_x, along_y] = match boundary {
        Boundary::Periodic => sums,
        // Sums of fewer differences.
        Boundary::Free => [0, 1].map(|axis| sums[axis] * [nx, ny][axis] as f64 / ([nx, ny][axis] - spacing) as f64),
    };
    (along_x + along_y) / (map.grid().len() * spacing * spacing) as f64
}

#[cfg(test)]
mod tests {
    use rc_core::testing::quasi_random;
    use rc_core::{DVec2, Grid};

    use super::*;

    /// Any surface with this many waves.
    struct Waves(usize);

    impl HeightField for Waves {
        fn height(&self, _at: DVec2) -> f64 {
            0.0
        }

        fn band_limit(&self) -> Option<usize> {
            Some(self.0)
        }
    }

    #[test]
    fn the_base_grid_follows_the_waves_and_the_divisors() {
        let base =
            |side, waves| base_sides(&Waves(waves).on(Grid::square(side).expect("a grid")), None, Boundary::Periodic);
        for (side, waves, expected) in
            [(2048, 64, 256), (32768, 1024, 4096), (128, 8, 64), (1_000_000, 8, 125_000), (2032, 8, 128)]
        {
            assert_eq!(base(side, waves).ok(), Some([expected; 2]), "{side}, {waves} waves");
        }
        // Sides that cannot be halved have a base grid of their own.
        for (side, waves, expected) in [(1001, 8, 128), (1000, 62, 256), (997, 8, 128), (1040, 30, 144)] {
            assert_eq!(base(side, waves).ok(), Some([expected; 2]), "{side}, {waves} waves");
        }
        assert!(matches!(base(60, 20), Err(AdaptiveError::Grid { .. })));
    }

    /// What the message says of small grids is true: none below the number that it names is solved, and multiples of 16
    /// are from there on.
    #[test]
    fn grids_that_are_too_small_are_those_that_the_message_names() {
        for waves in [1, 2, 3, 5, 8, 16, 24, 31, 40, 64] {
            let base = |side: usize| {
                base_sides(&Waves(waves).on(Grid::square(side).expect("a grid")), None, Boundary::Periodic)
            };
            let Err(AdaptiveError::Grid { smallest, .. }) = base(1) else { panic!("{waves} waves on one element") };
            for side in 1..400 {
                let text = base(side).err().map(|error| error.to_string());
                let names_the_smallest = |text: &String| text.contains(&format!("at least {smallest} elements"));
                assert_eq!(
                    text.as_ref().is_some_and(names_the_smallest),
                    side < smallest,
                    "{waves} waves, {side}: {text:?}"
                );
                assert!(
                    side < smallest || text.is_none() || !side.is_multiple_of(16),
                    "{waves} waves, {side}: {text:?}"
                );
            }
        }
    }

    #[test]
    fn a_map_is_coarsened_as_far_as_it_is_smooth() {
        let grid = Grid::square(1024).expect("a grid");
        let wave = |n: f64| Field::from_fn(grid, move |at| (std::f64::consts::TAU * n * (at.x + at.y)).cos());
        let noise = Field::new(grid, (0..grid.len()).map(quasi_random).collect()).expect("a value for each element");
        let mut with_pit = wave(8.0);
        with_pit.values_mut()[39 * 1024 + 512] = -1e3;
        let grooves = |along_x: bool| {
            let is_groove = |i: usize| (6..10).contains(&(if along_x { i / 1024 } else { i % 1024 } % 16));
            let heights = (0..grid.len()).map(|i| if is_groove(i) { -1.0 } else { 0.0 }).collect();
            Field::new(grid, heights).expect("a value for each element")
        };
        let of_noise = |nx: usize, ny: usize| {
            let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
            let noise = Field::new(grid, (0..nx * ny).map(quasi_random).collect()).expect("a value for each element");
            base_sides(&HeightSource::Map(&noise), None, Boundary::Periodic).ok()
        };
        for ([nx, ny], expected) in [
            ([640, 480], [160, 120]),
            ([1024, 256], [256, 64]),
            ([860, 634], [216, 160]),
            ([1001, 1001], [256, 256]),
            ([1000, 1000], [256, 256]),
            ([1499, 400], [392, 104]),
            // An eighth of the elements along both sides would be far from it along x.
            ([130, 520], [72, 288]),
        ] {
            assert_eq!(of_noise(nx, ny), Some(expected), "{nx} x {ny}");
        }
        let base = |map: &Field, boundary| base_sides(&HeightSource::Map(map), None, boundary).ok();
        assert_eq!(base(&grooves(true), Boundary::Periodic), Some([256; 2]));
        assert_eq!(base(&grooves(false), Boundary::Periodic), Some([256; 2]));
        for (map, expected) in [(wave(8.0), 128), (wave(30.0), 128), (wave(100.0), 256), (noise, 256), (with_pit, 256)]
        {
            assert_eq!(base(&map, Boundary::Periodic), Some([expected; 2]));
        }
        // A slope that does not meet itself across the border is as steep as its wave and a jump.
        let mut tilted = wave(8.0);
        for (i, h) in tilted.values_mut().iter_mut().enumerate() {
            *h += 0.1 * (i % 1024) as f64;
        }
        assert_eq!(base(&tilted, Boundary::Free), Some([128; 2]));
        assert_eq!(base(&tilted, Boundary::Periodic), Some([256; 2]));
    }
}
