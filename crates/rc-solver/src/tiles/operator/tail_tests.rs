//! The multilevel operator under a sliding surface, against the operator of the uniform grid.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{DVec2, Grid, Operator, SlidingCompliance};
use rc_kernel::{Love, Relaxation, ScaleSplit, Viscoelastic};
use rc_quadtree::{CELLS, Elements, TILE, TileSet};

use crate::grid::uniform_operator::UniformOperator;
use crate::tiles::base::Base;
use crate::tiles::operator::tests::{SMALL, apply_above, spots, tiles_of_spots};
use crate::tiles::roughness::roughness;
use crate::tiles::solid::Solid;
use crate::tiles::split::GapSplit;

/// A pressure on some tiles.
struct Scene {
    grid: Grid,
    tiles: TileSet,
    pressure: Vec<f64>,
}

impl Scene {
    /// Noise on tiles at random places.
    fn noise([nx, ny]: [usize; 2]) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64((nx + 7 * ny) as u64);
        let all = TileSet::full([nx, ny]);
        let chosen = all.places().iter().filter(|_| rng.random::<f64>() < 0.2).copied().collect();
        let tiles = TileSet::new([nx, ny], chosen);
        let pressure = (0..tiles.n_cells()).map(|_| (rng.random::<f64>() - 0.3).max(0.0)).collect();
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        Self { grid, tiles, pressure }
    }

    /// Round contacts, and some tiles without pressure.
    fn spots(side: usize) -> Self {
        let tiles = tiles_of_spots(side, SMALL, 5);
        let pressure = spots(&tiles, SMALL, 5);
        Self { grid: Grid::square(side).expect("a grid"), tiles, pressure }
    }

    /// The displacement of a solid by the multilevel operator.
    fn displacement(&self, base: [usize; 2], split: GapSplit, compliance: SlidingCompliance) -> Vec<f64> {
        let base = self.grid.with_elements(base[0], base[1]).expect("a base grid");
        let solid = Solid::from(Base::from(base)).under_sliding(compliance);
        let (kernel, elements) = (ScaleSplit::new(split.params), Elements::uniform(self.tiles.clone()));
        if split.is_single_precision() {
            apply_above::<f32>(&kernel, solid, elements, &self.pressure)
        } else {
            apply_above::<f64>(&kernel, solid, elements, &self.pressure)
        }
    }

    fn cells(&self) -> impl Iterator<Item = usize> + '_ {
        let places = self.tiles.places().iter();
        places.flat_map(move |&[column, row]| {
            (0..CELLS).map(move |cell| {
                let (x, y) = (column as usize * TILE + cell % TILE, row as usize * TILE + cell / TILE);
                y * self.grid.nx() + x
            })
        })
    }

    /// The displacement by the operator of the uniform grid.
    fn exact(&self, material: &Relaxation, velocity: f64) -> Vec<f64> {
        let kernel = Viscoelastic::new(Love, material, velocity * DVec2::X);
        let (mut on_grid, mut result) = (vec![0.0; self.grid.len()], vec![0.0; self.grid.len()]);
        self.cells().zip(&self.pressure).for_each(|(cell, &p)| on_grid[cell] = p);
        UniformOperator::new(self.grid, &kernel).apply(&on_grid, &mut result, &mut []);
        self.cells().map(|cell| result[cell]).collect()
    }
}

fn compliance(material: &Relaxation, velocity: f64) -> SlidingCompliance {
    let retardation = material.retardation().expect("a series");
    let modes = retardation.modes.iter().map(|&[part, time]| [part, velocity * time]).collect();
    SlidingCompliance { instantaneous: retardation.instantaneous, modes }
}

/// One relaxation time, and a series over twelve decades.
fn materials() -> [Relaxation; 2] {
    let many: Vec<[f64; 2]> = (0..12).map(|i| [0.8, 10_f64.powi(i - 6)]).collect();
    [Relaxation::single(10.0, 1.0), Relaxation::prony(&many)].map(|material| material.expect("a material"))
}

fn greatest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Errors are within the bound that certificates add for the split of a solid at rest.
#[test]
fn one_application_agrees_with_the_uniform_grid() {
    let scenes = [
        ([64, 64], Scene::noise([128, 128])),
        ([64, 64], Scene::noise([512, 512])),
        ([64, 32], Scene::noise([256, 128])),
        ([64, 16], Scene::noise([128, 32])),
        ([64, 64], Scene::spots(256)),
        ([64, 64], Scene::spots(512)),
    ];
    for (base, scene) in &scenes {
        let rough = roughness(&Elements::uniform(scene.tiles.clone()).into(), &scene.pressure);
        let n_levels = f64::from((scene.grid.nx() / base[0]).ilog2());
        for material in materials() {
            for velocity in [1e-5, 1e-3, 0.03, -0.3, 10.0, 1e6] {
                let exact = scene.exact(&material, velocity);
                let greatest = exact.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
                for error in [1e-6, 2e-9, 1e-10] {
                    let split = GapSplit::for_error(error).expect("a split");
                    let found = scene.displacement(*base, split, compliance(&material, velocity));
                    let difference = greatest_difference(&found, &exact);
                    let bound = split.error * n_levels * greatest + split.error_of_roughness * rough;
                    let ratio = difference / bound;
                    assert!(ratio < 1.0, "{error:e} on {}, velocity {velocity:e}: {ratio} of the bound", scene.grid);
                }
            }
        }
    }
}

/// Tails on both sides are those of either side.
#[test]
fn a_sum_of_both_directions_is_their_mean() {
    let (scene, split) = (Scene::noise([256, 128]), GapSplit::most_accurate());
    let [_, material] = materials();
    let [ahead, behind] = [0.02, -0.02].map(|velocity| compliance(&material, velocity));
    let modes = ahead.modes.iter().chain(&behind.modes).map(|[part, length]| [0.5 * part, *length]).collect();
    let both = SlidingCompliance { instantaneous: ahead.instantaneous, modes };
    let [ahead, behind, both] = [ahead, behind, both].map(|compliance| scene.displacement([64, 32], split, compliance));
    let mean: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| 0.5 * (a + b)).collect();
    let size = mean.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    assert!(greatest_difference(&both, &mean) < 1e-12 * size && greatest_difference(&ahead, &behind) > 0.01 * size);
}

#[test]
fn digits_do_not_depend_on_the_number_of_threads() {
    let scene = Scene::noise([512, 512]);
    let [_, material] = materials();
    for split in [GapSplit::fastest(), GapSplit::most_accurate()] {
        let with_threads = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads");
            pool.install(|| scene.displacement([64, 64], split, compliance(&material, 0.02)))
        };
        let one = with_threads(1);
        for n in [2, 5] {
            assert!(with_threads(n).iter().zip(&one).all(|(a, b)| a.to_bits() == b.to_bits()), "{n} threads");
        }
    }
}
