//! The base grid: the coarsest whole grid that still has the surface's waves.

use rc_core::{Field, HeightField, HeightSource};
use rc_quadtree::TILE;

use super::AdaptiveError;
use crate::descent::BlockLayout;
use crate::parallel;

/// Elements of the base grid for the shortest wave: what interpolates heights to other levels needs no more.
const BASE_ELEMENTS_PER_WAVE: usize = 4;

/// Fewest elements per side of the base grid.
pub(super) const SMALLEST_BASE: usize = 64;

/// Part of the mean square slope of a map that differences over the base grid's spacing must keep: four elements for a wave keep 0.81 of its slope,
/// two keep 0.41.
const SLOPE_KEPT: f64 = 0.8;

/// Checks or chooses the elements per side of the base grid.
pub(super) fn base_side(source: &HeightSource<'_>, wanted: Option<usize>) -> Result<usize, AdaptiveError> {
    let finest = source.grid().nx();
    let waves = source.surface().and_then(HeightField::band_limit);
    if let Some(base) = wanted {
        let fits = base >= TILE && base.is_multiple_of(TILE) && base > 2 * waves.unwrap_or(0) && 2 * base <= finest;
        let divides = fits && finest.is_multiple_of(base) && (finest / base).is_power_of_two();
        let error = AdaptiveError::Base { base, waves: waves.unwrap_or(0), finest };
        return if divides { Ok(base) } else { Err(error) };
    }
    // Heights may have waves as short as a few elements: two levels above the base grid are safe, and three on large grids.
    let safe = finest / if finest >= 4096 { 8 } else { 4 };
    let least = match (waves, source.map()) {
        (Some(waves), _) => BASE_ELEMENTS_PER_WAVE * waves,
        (None, Some(map)) => safe.min(smooth_side(map)),
        (None, None) => safe,
    };
    let least = least.max(SMALLEST_BASE);
    let halves = |side: usize| side.is_multiple_of(2 * TILE) && side / 2 >= least;
    let mut base = finest;
    while halves(base) {
        base /= 2;
    }
    if base == finest && finest.is_multiple_of(2 * TILE) && finest / 2 > 2 * waves.unwrap_or(0) {
        base /= 2;
    }
    if base < finest { Ok(base) } else { Err(AdaptiveError::Grid { nx: finest, ny: finest, smallest: 2 * least }) }
}

/// Elements per side that keep the slopes of a map: the coarsest that halving leads to.
fn smooth_side(map: &Field) -> usize {
    let nx = map.grid().nx();
    let finest = mean_square_slope(map, 1);
    let mut spacing = 1;
    while nx.is_multiple_of(4 * spacing) && mean_square_slope(map, 2 * spacing) >= SLOPE_KEPT * finest {
        spacing *= 2;
    }
    nx / spacing
}

/// Of differences over so many elements along both axes, in units of the height over the side of an element. All rows are looked at: on
/// some of them a surface that repeats may look smooth.
fn mean_square_slope(map: &Field, spacing: usize) -> f64 {
    let (nx, ny) = (map.grid().nx(), map.grid().ny());
    let of_row = |iy: usize| {
        let (row, below) = (map.row(iy), map.row((iy + spacing) % ny));
        let squares = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
        let (near, far) = row.split_at(nx - spacing);
        [squares(near, &row[spacing..]) + squares(far, &row[..spacing]) + squares(row, below)]
    };
    let [sum] = BlockLayout::of(nx).total(parallel::map(0..ny, of_row));
    sum / (map.grid().len() * spacing * spacing) as f64
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
        let base = |side, waves| base_side(&Waves(waves).on(Grid::square(side).expect("a grid")), None);
        for (side, waves, expected) in [(2048, 64, 256), (32768, 1024, 4096), (128, 8, 64), (1_000_000, 8, 125_000)] {
            assert_eq!(base(side, waves).ok(), Some(expected), "{side}, {waves} waves");
        }
        assert!(matches!(base(1001, 8), Err(AdaptiveError::Grid { .. })));
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
        assert_eq!(base_side(&HeightSource::Map(&grooves(true)), None).ok(), Some(256));
        assert_eq!(base_side(&HeightSource::Map(&grooves(false)), None).ok(), Some(256));
        for (map, expected) in [(wave(8.0), 64), (wave(30.0), 128), (wave(100.0), 256), (noise, 256), (with_pit, 256)] {
            assert_eq!(base_side(&HeightSource::Map(&map), None).ok(), Some(expected));
        }
    }
}
