//! The operator on heights with free borders against sums over Love's squares without images.

use rc_core::testing::quasi_random;
use rc_core::{Boundary, Grid, Operator};
use rc_kernel::{FreeLove, ScaleSplit};
use rc_quadtree::{CELLS, Elements, TILE, TileSet};

use crate::grid::uniform_operator::UniformOperator;
use crate::tiles::base::Base;
use crate::tiles::ladder::Ladder;
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::tests::apply_above;
use crate::tiles::roughness::roughness;
use crate::tiles::split::GapSplit;

/// What presses on a patch.
struct Scene {
    base: [usize; 2],
    finest: Grid,
    tiles: TileSet,
    pressure: Vec<f64>,
}

impl Scene {
    /// On every tile of a patch.
    fn new(base: [usize; 2], [nx, ny]: [usize; 2], pressure: impl Fn(usize, usize) -> f64) -> Self {
        let finest = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        let tiles = TileSet::full([nx, ny]).with_boundary(Boundary::Free);
        // In the order of solvers.
        let tiles = tiles.of_same_cell([nx, ny], tiles.places().to_vec());
        let places = places(&tiles);
        let pressure = places.map(|place| place.map_or(0.0, |[x, y]| pressure(x, y))).collect();
        Self { base, finest, tiles, pressure }
    }

    /// The maximum error of a displacement, the maximum displacement and the roughness of the pressure.
    fn error<T: Real + Into<f64>>(&self, split: GapSplit) -> [f64; 3] {
        let base = Base::new(Ladder::new(self.base, self.finest), Boundary::Free);
        let elements = Elements::uniform(self.tiles.clone());
        let found = apply_above::<T>(&ScaleSplit::new(split.params), base, elements.clone(), &self.pressure);
        let (mut on_grid, nx) = (vec![0.0; self.finest.len()], self.finest.nx());
        for (p, place) in self.pressure.iter().zip(places(&self.tiles)) {
            if let Some([x, y]) = place {
                on_grid[y * nx + x] = *p;
            }
        }
        let mut exact = vec![0.0; on_grid.len()];
        UniformOperator::new(self.finest, &FreeLove).apply(&on_grid, &mut exact, &mut []);
        let errors = found.iter().zip(places(&self.tiles)).filter_map(|(v, place)| {
            let [x, y] = place?;
            Some((v - exact[y * nx + x]).abs())
        });
        let greatest = exact.iter().copied().fold(0.0, f64::max);
        [errors.fold(0.0, f64::max), greatest, roughness(&elements.into(), &self.pressure)]
    }
}

/// Column and row of the cells of tiles; none of what is beyond the level.
fn places(tiles: &TileSet) -> impl Iterator<Item = Option<[usize; 2]>> + '_ {
    let [nx, ny] = tiles.sides();
    tiles.places().iter().flat_map(move |&[column, row]| {
        (0..CELLS).map(move |cell| {
            let (x, y) = (column as usize * TILE + cell % TILE, row as usize * TILE + cell / TILE);
            (x < nx && y < ny).then_some([x, y])
        })
    })
}

/// Errors are within the bound that certificates add for the split.
///
/// Pressures are noise, uniform, at opposite corners and borders alone, and under a punch.
#[test]
fn one_application_agrees_with_sums_without_images() {
    for (base, finest) in
        [([64, 64], [128, 128]), ([64, 64], [512, 512]), ([64, 32], [256, 128]), ([64, 64], [125, 125])]
    {
        let [nx, ny] = finest;
        let is_corner = |x: usize, y: usize| (x < 2 || x >= nx - 2) && (y < 2 || y >= ny - 2);
        let is_border = |x: usize, y: usize| x == 0 || x == nx - 1 || y == 0 || y == ny - 1;
        let noise = |x: usize, y: usize| quasi_random(y * nx + x);
        let flag = |is: bool| f64::from(u8::from(is));
        let scenes = [
            Scene::new(base, finest, noise),
            Scene::new(base, finest, |_, _| 1.0),
            Scene::new(base, finest, |x, y| flag(is_corner(x, y)) * (0.5 + noise(x, y))),
            Scene::new(base, finest, |x, y| flag(is_border(x, y))),
            Scene::new(base, finest, |x, _| flag(x < nx / 2)),
        ];
        let n_levels = Ladder::new(base, scenes[0].finest).n_levels() as f64;
        for error in [1e-6, 2e-9, 1e-10] {
            let split = GapSplit::for_error(error).expect("a split");
            for (i, scene) in scenes.iter().enumerate() {
                let single = split.is_single_precision();
                let [found, greatest, rough] =
                    if single { scene.error::<f32>(split) } else { scene.error::<f64>(split) };
                let bound = split.error * n_levels * greatest + split.error_of_roughness * rough;
                assert!(found < bound, "{error:e}, {base:?} to {finest:?}, scene {i}: {found:e} of {bound:e}");
            }
        }
    }
}
