//! A part of a map.

use std::str::FromStr;

use rc_core::{Field, Grid};

use super::error::TreatError;
use super::treatment::Crop;
use crate::HeightMap;

impl FromStr for Crop {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let unknown = || TreatError::Unknown {
            found: text.to_owned(),
            expected: "a part of a map: measured, square, or numbers of points such as 512, 512x256 or 512x256+100+50",
        };
        match text {
            "measured" => return Ok(Self::Measured),
            "square" => return Ok(Self::Square),
            _ => {}
        }
        let mut words = text.split('+');
        let size = words.next().unwrap_or_default();
        let (nx, ny) = size.split_once('x').unwrap_or((size, size));
        let count = |word: &str| word.parse().map_err(|_| unknown());
        let from = match (words.next(), words.next(), words.next()) {
            (None, ..) => None,
            (Some(x), Some(y), None) => Some([count(x)?, count(y)?]),
            _ => return Err(unknown()),
        };
        Ok(Self::Points { nx: count(nx)?, ny: count(ny)?, from })
    }
}

/// Maximum relative difference of sides of a map that counts as a square.
pub const SAME_LENGTH: f64 = 1e-3;

/// First point and grid of the part of `grid` that is kept. Points have distances of `spacing`.
///
/// The measured rectangle is at most the whole grid, which is returned for it.
pub(super) fn part(grid: Grid, spacing: [f64; 2], crop: Crop) -> Result<([usize; 2], Grid), TreatError> {
    let (nx, ny, from) = match crop {
        Crop::Measured => return Ok(([0, 0], grid)),
        Crop::Points { nx, ny, from } => (nx, ny, from),
        Crop::Square => {
            let [nx, ny] = square(grid, spacing).ok_or(TreatError::NoSquare { grid, spacing })?;
            (nx, ny, None)
        }
    };
    let outside = || TreatError::Outside { crop, grid };
    let room = [grid.nx().checked_sub(nx), grid.ny().checked_sub(ny)];
    let [Some(x_room), Some(y_room)] = room else { return Err(outside()) };
    let [x, y] = from.unwrap_or([x_room / 2, y_room / 2]);
    if x > x_room || y > y_room {
        return Err(outside());
    }
    Ok(([x, y], Grid::new(nx, ny)?))
}

/// Numbers of points of the largest part whose sides are equal within [`SAME_LENGTH`].
fn square(grid: Grid, [dx, dy]: [f64; 2]) -> Option<[usize; 2]> {
    let most = ((dy * grid.ny() as f64 / dx).round() as usize).clamp(1, grid.nx());
    (1..=most).rev().find_map(|nx| {
        let ny = ((dx * nx as f64 / dy).round() as usize).clamp(1, grid.ny());
        let ratio = (dx * nx as f64) / (dy * ny as f64);
        ((ratio - 1.0).abs() <= SAME_LENGTH).then_some([nx, ny])
    })
}

/// First point and grid of the measured rectangle.
///
/// The border row or column with the largest missing part is cut, as long as that is more than half of it. A map
/// without measured points is kept as a whole.
fn measured(heights: &Field) -> ([usize; 2], Grid) {
    let whole = heights.grid();
    let (mut x, mut y) = (0..whole.nx(), 0..whole.ny());
    let is_missing = |ix: usize, iy: usize| heights.at(ix, iy).is_nan();
    loop {
        let of_row = |iy: usize| x.clone().filter(|ix| is_missing(*ix, iy)).count() as f64 / x.len() as f64;
        let of_column = |ix: usize| y.clone().filter(|iy| is_missing(ix, *iy)).count() as f64 / y.len() as f64;
        let borders = [of_row(y.start), of_row(y.end - 1), of_column(x.start), of_column(x.end - 1)];
        let most = borders.iter().copied().fold(0.0, f64::max);
        if most <= 0.5 {
            let grid = Grid::new(x.len(), y.len()).expect("a part of a grid");
            return ([x.start, y.start], grid);
        }
        match borders.iter().position(|missing| *missing >= most) {
            Some(0 | 1) if y.len() == 1 => return ([0, 0], whole),
            Some(2 | 3) if x.len() == 1 => return ([0, 0], whole),
            Some(0) => y.start += 1,
            Some(1) => y.end -= 1,
            Some(2) => x.start += 1,
            _ => x.end -= 1,
        }
    }
}

pub(super) fn crop(map: &HeightMap, crop: Crop) -> Result<HeightMap, TreatError> {
    let [dx, dy] = map.spacing();
    let ([x, y], grid) = match crop {
        Crop::Measured => measured(&map.heights),
        _ => part(map.heights.grid(), [dx, dy], crop)?,
    };
    let (nx, ny) = (grid.nx(), grid.ny());
    let values = (y..y + ny).flat_map(|iy| &map.heights.row(iy)[x..x + nx]).copied().collect();
    let heights = Field::new(grid, values).expect("as many values as points");
    let sides = map.sides.map(|_| [dx * nx as f64, dy * ny as f64]);
    Ok(HeightMap { heights, sides, ..map.clone() })
}

/// The grid of every second point of `grid`.
pub(super) fn every_second(grid: Grid) -> Result<Grid, TreatError> {
    Ok(Grid::new(grid.nx() / 2, grid.ny() / 2)?)
}

/// The map of every second point, from the first on.
pub(super) fn thin(map: &HeightMap) -> Result<HeightMap, TreatError> {
    let [dx, dy] = map.spacing();
    let grid = every_second(map.heights.grid())?;
    let (nx, ny) = (grid.nx(), grid.ny());
    let values = (0..ny).flat_map(|iy| map.heights.row(2 * iy).iter().step_by(2).take(nx)).copied().collect();
    let heights = Field::new(grid, values).expect("as many values as points");
    let sides = map.sides.map(|_| [2.0 * dx * nx as f64, 2.0 * dy * ny as f64]);
    Ok(HeightMap { heights, sides, ..map.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::treat::{Treatment, apply, grids_after};

    #[test]
    fn every_second_point_has_twice_the_spacing() {
        let grid = Grid::new(5, 4).expect("a grid");
        let heights = Field::new(grid, (0..20).map(f64::from).collect()).expect("a field");
        let map = HeightMap { sides: Some([10.0, 4.0]), ..HeightMap::bare(heights) };
        let (thin, effects) = apply(map.clone(), &[Treatment::EverySecond]).expect("a map");
        assert_eq!(thin.heights.values(), [0.0, 2.0, 10.0, 12.0]);
        assert_eq!((thin.sides, effects[0].changed), (Some([8.0, 4.0]), 16));
        let grids = grids_after(&map, &[Treatment::EverySecond]).expect("grids");
        assert_eq!((grids[0].nx(), grids[0].ny()), (2, 2));
    }
}
