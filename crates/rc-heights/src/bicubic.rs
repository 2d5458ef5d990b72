//! Heights between the points of a map.

use std::sync::Arc;

use rc_core::{Boundary, DVec2, Field, HeightField};

/// A square map with heights between its points: cubic polynomials along both axes, through the points, with the slopes of
/// central differences there (Catmull and Rom).
///
/// Heights and slopes are continuous. Points are the centres of the map's elements. Between points, the heights are a
/// guess about what was not measured: they have no roughness of their own.
#[derive(Clone, Debug)]
pub struct Bicubic {
    map: Arc<Field>,
    boundary: Boundary,
}

/// Points that a height is interpolated from, along each axis.
const POINTS: usize = 4;

impl Bicubic {
    /// The heights (λ) of `map` and between its points. Beyond a free border are the heights of the border.
    ///
    /// `None` if the cell of the map is not a square.
    #[must_use]
    pub fn new(map: Arc<Field>, boundary: Boundary) -> Option<Self> {
        let is_square = (map.grid().cell_ratio() - 1.0).abs() < 1e-9;
        is_square.then_some(Self { map, boundary })
    }

    /// The indices and weights of the points around a coordinate in 0 to 1, along a side of `n` points.
    fn around(&self, at: f64, n: usize) -> ([usize; POINTS], [f64; POINTS]) {
        let from_first = at * n as f64 - 0.5;
        let (before, t) = (from_first.floor(), from_first - from_first.floor());
        let index = |offset: isize| {
            let i = before as isize + offset;
            match self.boundary {
                Boundary::Periodic => i.rem_euclid(n as isize) as usize,
                Boundary::Free => i.clamp(0, n as isize - 1) as usize,
            }
        };
        let weights = [
            0.5 * t * (t * (2.0 - t) - 1.0),
            0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
            0.5 * t * (t * (4.0 - 3.0 * t) + 1.0),
            0.5 * t * t * (t - 1.0),
        ];
        ([index(-1), index(0), index(1), index(2)], weights)
    }
}

impl HeightField for Bicubic {
    fn height(&self, at: DVec2) -> f64 {
        let grid = self.map.grid();
        let (columns, of_columns) = self.around(at.x, grid.nx());
        let (rows, of_rows) = self.around(at.y, grid.ny());
        let along_row = |iy: usize| columns.iter().zip(of_columns).map(|(&ix, w)| w * self.map.at(ix, iy)).sum::<f64>();
        rows.iter().zip(of_rows).map(|(&iy, w)| w * along_row(iy)).sum()
    }

    fn band_limit(&self) -> Option<usize> {
        None
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rc_core::{Grid, testing};

    use super::*;

    fn map(n: usize, height: impl Fn(DVec2) -> f64 + Sync) -> Arc<Field> {
        Arc::new(Field::from_fn(Grid::square(n).expect("a grid"), height))
    }

    #[test]
    fn heights_are_those_of_the_points_and_converge_between_them() {
        let wave = |at: DVec2| (TAU * at.x).sin() + (TAU * (at.x - 2.0 * at.y)).cos();
        let error = |n: usize| {
            let map = map(n, wave);
            let surface = Bicubic::new(Arc::clone(&map), Boundary::Periodic).expect("a square");
            testing::check_height_field(&surface);
            let of_points = surface.sample(map.grid());
            let off = of_points.values().iter().zip(map.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-14, "{off:e} at a point");
            let finer = Grid::square(4 * n).expect("a grid");
            let (found, exact) = (surface.sample(finer), Field::from_fn(finer, wave));
            found.values().iter().zip(exact.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = [32, 64].map(error);
        assert!(coarse < 3e-3 && fine < coarse / 7.0, "{coarse:e}, then {fine:e}");
    }

    #[test]
    fn a_free_border_does_not_know_the_other_side() {
        let map = map(16, |at| at.x);
        let at = DVec2::new(0.5 / 32.0, 0.5);
        let [free, periodic] = [Boundary::Free, Boundary::Periodic]
            .map(|boundary| Bicubic::new(Arc::clone(&map), boundary).map(|surface| surface.height(at)));
        assert!(free.is_some_and(|h| (0.0..0.05).contains(&h)), "{free:?}");
        assert!(periodic.is_some_and(|h| h > 0.1), "{periodic:?}");
        let oblong = Arc::new(Field::zeros(Grid::in_cell(16, 8, 0.5).expect("a grid")));
        assert!(Bicubic::new(oblong, Boundary::Periodic).is_none());
    }
}
