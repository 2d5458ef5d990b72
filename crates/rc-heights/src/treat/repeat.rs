//! Copies of a periodic map beside each other.

use std::str::FromStr;

use rc_core::{Field, Grid};

use super::crop::SAME_LENGTH;
use super::error::TreatError;
use super::treatment::{MOST_COPIES, Repeat};
use crate::HeightMap;

impl FromStr for Repeat {
    type Err = TreatError;

    fn from_str(text: &str) -> Result<Self, TreatError> {
        let unknown = || TreatError::Unknown {
            found: text.to_owned(),
            expected: "square, or two numbers of copies from 1 to 16, such as 3x4",
        };
        if text == "square" {
            return Ok(Self::Square);
        }
        let times = |word: &str| word.parse().ok().filter(|n| (1..=MOST_COPIES).contains(n)).ok_or_else(unknown);
        let (x, y) = text.split_once('x').ok_or_else(unknown)?;
        Ok(Self::Times([times(x)?, times(y)?]))
    }
}

/// Numbers of copies along x and y, and the grid of all copies.
pub(super) fn copies(grid: Grid, sides: [f64; 2], repeat: Repeat) -> Result<([usize; 2], Grid), TreatError> {
    let [x, y] = match repeat {
        Repeat::Times(times) => times,
        Repeat::Square => square(grid, sides).ok_or(TreatError::NoSquareOfCopies { grid, sides })?,
    };
    Ok(([x, y], Grid::new(x * grid.nx(), y * grid.ny())?))
}

/// The smallest numbers of copies that make a square with equal numbers of points.
///
/// The sides of the square are equal within [`SAME_LENGTH`].
fn square(grid: Grid, [side_x, side_y]: [f64; 2]) -> Option<[usize; 2]> {
    let fits = |&[x, y]: &[usize; 2]| {
        let ratio = x as f64 * side_x / (y as f64 * side_y);
        (ratio - 1.0).abs() <= SAME_LENGTH && x * grid.nx() == y * grid.ny()
    };
    (1..=MOST_COPIES).flat_map(|x| (1..=MOST_COPIES).map(move |y| [x, y])).find(fits)
}

pub(super) fn repeat(map: &HeightMap, repeat: Repeat) -> Result<HeightMap, TreatError> {
    let (grid, [dx, dy]) = (map.heights.grid(), map.spacing());
    let sides = [dx * grid.nx() as f64, dy * grid.ny() as f64];
    let ([x, y], all) = copies(grid, sides, repeat)?;
    let rows = (0..y).flat_map(|_| 0..grid.ny());
    let values = rows.flat_map(|iy| std::iter::repeat_n(map.heights.row(iy), x).flatten().copied()).collect();
    let heights = Field::new(all, values).expect("as many values as points");
    Ok(HeightMap { heights, sides: map.sides.map(|[a, b]| [x as f64 * a, y as f64 * b]), ..map.clone() })
}

#[cfg(test)]
mod tests {
    use rc_core::DVec2;

    use super::*;

    #[test]
    fn copies_make_a_square_where_few_do() {
        let of = |nx, ny, sides| square(Grid::new(nx, ny).expect("a grid"), sides);
        assert_eq!(of(64, 64, [2e-3, 2e-3]), Some([1, 1]));
        assert_eq!(of(1024, 768, [4e-3, 3e-3]), Some([3, 4]));
        assert_eq!(of(8, 128, [1e-3, 16e-3]), Some([16, 1]));
        assert_eq!(of(64, 64, [1.0, 3f64.sqrt()]), None);
        assert_eq!(of(64, 64, [2e-3, 1e-3]), None, "points are no squares");
        assert_eq!(
            of(302, 194, [604e-6, 388e-6]),
            None,
            "9 and 14 copies are a square within 0.1 %, their points are not"
        );
        let grid = Grid::new(3, 2).expect("a grid");
        let map = HeightMap {
            sides: Some([3.0, 2.0]),
            ..HeightMap::bare(Field::from_fn(grid, |DVec2 { x, y }| 10.0 * y + x))
        };
        let repeated = repeat(&map, Repeat::Square).expect("2 x 3 copies");
        assert_eq!((repeated.heights.grid(), repeated.sides), (Grid::new(6, 6).expect("a grid"), Some([6.0, 6.0])));
        for iy in 0..6 {
            for ix in 0..6 {
                assert_eq!(repeated.heights.at(ix, iy).to_bits(), map.heights.at(ix % 3, iy % 2).to_bits());
            }
        }
    }

    #[test]
    fn words_are_read_and_others_refused() {
        assert_eq!("square".parse(), Ok(Repeat::Square));
        assert_eq!("3x4".parse(), Ok(Repeat::Times([3, 4])));
        for wrong in ["", "3", "0x1", "17x1", "3x", "axb", "-1x2"] {
            assert!(wrong.parse::<Repeat>().is_err(), "{wrong}");
        }
    }
}
