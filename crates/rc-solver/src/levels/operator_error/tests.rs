//! The bounds on the operator's error against Fourier transforms and exact sums.

mod sliding;
mod smooth;

use std::f64::consts::TAU;
use std::sync::Arc;

use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{Boundary, Field, Grid, HeightSource, Kernel, Operator, Silent};
use rc_fft::SymbolTable;
use rc_kernel::{FreeLove, HalfSpace, Love};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet};

use crate::descent::operators::{BlockOperator, read_blocks, write_blocks};
use crate::grid::factors::Factors;
use crate::grid::operators::SymbolOperator;
use crate::grid::uniform_operator::UniformOperator;
use crate::levels::adaptive::Finest;
use crate::levels::operator_error::*;
use crate::levels::params::AdaptiveParams;
use crate::levels::tiles::{TileLevels, prepare};
use crate::problem::contact_problem::ContactProblem;
use crate::problem::control::Control;
use crate::problem::params::IterationParams;
use crate::tiles::base::Base;
use crate::tiles::gap_operator::{GapOperator, PreparedGap};
use crate::tiles::ladder::sides_of;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::solid::Solid;

/// Places of the elements of a mesh of one size on its whole grid.
///
/// They are row by row. Elements beyond the grid have no place.
fn places(elements: &Elements) -> Vec<Option<usize>> {
    let ([nx, ny], tiles) = (elements.finest().sides(), elements.finest().places());
    let place = |i: usize| {
        let ([column, row], cell) = (tiles[i / CELLS], i % CELLS);
        let (x, y) = (column as usize * TILE + cell % TILE, row as usize * TILE + cell / TILE);
        (x < nx && y < ny).then_some(y * nx + x)
    };
    (0..elements.len()).map(place).collect()
}

/// Result of `operator` on `values`.
fn applied(operator: &mut (impl BlockOperator<f64> + ?Sized), values: &[f64]) -> Vec<f64> {
    let block = operator.layout().len();
    write_blocks(operator, values.chunks(block), |values, block| block.copy_from_slice(values));
    operator.apply();
    let mut result = vec![0.0; values.len()];
    read_blocks(operator, result.chunks_mut(block), |result, block| result.copy_from_slice(block));
    result
}

/// ‖L^(-1/2) (L~ - L) L^(-1/2)‖ for the split operator L~, from below.
///
/// The operator is above a base grid on every tile of a grid. The norm comes from power iteration.
fn energy_error(split: GapSplit, base_grid: Grid, grid: Grid, rng: &mut impl Rng) -> f64 {
    let elements = Elements::uniform(TileSet::full(sides_of(grid)));
    let places = places(&elements);
    let prepared = PreparedGap::new(split, base_grid, 0);
    let hierarchy = Arc::new(Hierarchy::new(base_grid, elements, prepared.reach()));
    let tables = prepared.tables(grid);
    let mut split_operator = tables.operator(hierarchy, 0.0, 1.0);
    let symbol = Love.symbol(grid);
    let of_symbol = |power: f64| {
        let value = |kx: usize, ky: usize| if kx + ky == 0 { 0.0 } else { symbol(kx, ky).powf(power) };
        SymbolOperator::new(grid, Factors::AtRest(SymbolTable::new(grid, value)))
    };
    let (mut exact, mut root) = (of_symbol(1.0), of_symbol(-0.5));
    let mut vector: Vec<f64> = (0..grid.len()).map(|_| rng.random::<f64>() - 0.5).collect();
    let mut norm = 0.0;
    for _ in 0..30 {
        let pressure = applied(&mut root, &vector);
        let mut difference = applied(&mut exact, &pressure);
        let on_tiles: Vec<f64> = places.iter().map(|place| place.map_or(0.0, |place| pressure[place])).collect();
        for (v, &place) in applied(&mut *split_operator, &on_tiles).into_iter().zip(&places) {
            if let Some(place) = place {
                difference[place] -= v;
            }
        }
        vector = applied(&mut root, &difference);
        norm = vector.iter().map(|v| v * v).sum::<f64>().sqrt();
        for v in &mut vector {
            *v /= norm;
        }
    }
    norm
}

#[test]
fn the_error_in_the_energy_norm_does_not_grow_with_the_levels() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for (error, bound) in [(1e-6, 4.5e-5), (2e-9, 4e-7), (1e-10, 4e-9)] {
        let split = GapSplit::for_error(error).expect("a split");
        for (base, side) in [(64, 128), (32, 128), (32, 256)] {
            let [base, side] = [base, side].map(|side| Grid::square(side).expect("a grid"));
            let found = energy_error(split, base, side, &mut rng);
            assert!(found < bound, "{error:e}, {base} to {side}: {found:e}");
        }
    }
}

/// The error in the energy norm is the same on any grid.
///
/// It depends neither on halved sides nor on the shape of the cell.
#[test]
fn the_error_in_the_energy_norm_is_the_same_on_any_grid() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for (error, bound) in [(1e-6, 4.5e-5), (2e-9, 4e-7), (1e-10, 4e-9)] {
        let split = GapSplit::for_error(error).expect("a split");
        // In the last case the elements of coarser levels are 2 % longer along one side, which is the maximum. The
        // error is twice that of squares.
        for ([bx, by], [nx, ny], times) in [
            ([64, 32], [128, 64], 1.0),
            ([64, 64], [125, 125], 1.0),
            ([64, 64], [249, 249], 1.0),
            ([56, 56], [201, 201], 1.0),
            ([72, 40], [260, 142], 1.5),
        ] {
            let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
            let base = grid.with_elements(bx, by).expect("a grid");
            let found = energy_error(split, base, grid, &mut rng);
            assert!(found < times * bound, "{error:e}, {base} to {grid}: {found:e}");
        }
    }
}

/// Waves of random phases up to `waves` along x, rms 1e-3.
fn rough(grid: Grid, waves: i32, hurst: f64, rng: &mut impl Rng) -> Field {
    let mut heights = Field::zeros(grid);
    let along = |side: usize, k: i32, phase: f64| -> Vec<(f64, f64)> {
        (0..side).map(|i| (TAU * f64::from(k) * (i as f64 + 0.5) / side as f64 + phase).sin_cos()).collect()
    };
    for (kx, ky) in (0..=waves).flat_map(|kx| (-waves..=waves).map(move |ky| (kx, ky))) {
        let squares = grid.squared_waves(kx.unsigned_abs() as usize, ky.unsigned_abs() as usize);
        if kx == 0 && ky <= 0 || squares > f64::from(waves * waves) {
            continue;
        }
        let amplitude = squares.powf(-0.5 * (1.0 + hurst));
        let (x, y) = (along(grid.nx(), kx, TAU * rng.random::<f64>()), along(grid.ny(), ky, 0.0));
        for (row, (sin_y, cos_y)) in heights.values_mut().chunks_exact_mut(grid.nx()).zip(y) {
            for (h, (sin_x, cos_x)) in row.iter_mut().zip(&x) {
                *h += amplitude * (cos_x * cos_y - sin_x * sin_y);
            }
        }
    }
    let factor = 1e-3 / heights.rms();
    for h in heights.values_mut() {
        *h *= factor;
    }
    heights
}

/// A map with its base grid, load and tolerance.
struct Scene<'a> {
    map: &'a Field,
    boundary: Boundary,
    /// Number of elements of the base grid along x. `None` stands for the method's own choice.
    base: Option<usize>,
    control: Control,
    bound: ErrorBound,
}

/// A solution with the exact displacement of its pressure on the whole grid.
struct Audited {
    base: Base,
    problem: Problem,
    solved: Finest,
    pressure: Vec<f64>,
    displacement: Vec<f64>,
}

impl<'a> Scene<'a> {
    /// The levels of its contact with the solid of `kernel`.
    fn levels(&self, kernel: &'a dyn Kernel) -> TileLevels<'a> {
        let params = AdaptiveParams {
            solve: IterationParams { bound: self.bound, max_iterations: 500 },
            operator_error: 1e-6,
            spare_above: usize::MAX,
            border_level: 0,
            base_side: self.base,
            memory_limit: None,
        };
        let data = prepare(HeightSource::Map(self.map), kernel, &HalfSpace, &params).expect("heights");
        let problem = ContactProblem::new(self.map, self.control).with_kernel(kernel);
        TileLevels::new(&Arc::new(data), &problem, &params).expect("a problem")
    }

    fn audited(&self) -> Audited {
        self.audited_with(if self.boundary == Boundary::Free { &FreeLove } else { &Love })
    }

    fn audited_with(&self, kernel: &'a dyn Kernel) -> Audited {
        let levels = self.levels(kernel);
        let solved = levels.finish(levels.climb(levels.begin(&Silent), &Silent), &Silent);
        let grid = self.map.grid();
        let mut pressure = vec![0.0; grid.len()];
        for (p, place) in solved.level.pressure.iter().zip(places(&solved.level.elements)) {
            match place {
                Some(place) => pressure[place] = *p,
                None => assert!(*p == 0.0, "a pressure of {p:e} beyond the grid"),
            }
        }
        let mut displacement = vec![0.0; grid.len()];
        UniformOperator::new(grid, kernel).apply(&pressure, &mut displacement, &mut []);
        Audited { base: levels.base(), problem: levels.problem, solved, pressure, displacement }
    }
}

impl Audited {
    fn error(&self) -> OperatorError {
        OperatorError::of(self.solved.certified, &self.solved.scale, self.problem.bounds.control)
    }

    /// Gives `look` the certifying operator, after an application to the pressure, and its displacement.
    fn certified<R>(&self, solid: impl Into<Solid>, look: impl FnOnce(&dyn GapOperator, &[f64]) -> R) -> R {
        let (level, solid) = (&self.solved.level, solid.into());
        let base = solid.base();
        let prepared = PreparedGap::new(self.solved.certified, solid, 0);
        let hierarchy = Arc::new(Hierarchy::new(base, level.elements.clone(), prepared.reach()));
        let tables = prepared.tables(self.solved.grid);
        let mut operator = tables.operator(hierarchy, level.outcome.mean_pressure, self.problem.h_range);
        debug_assert_eq!(operator.layout().len(), BLOCK_CELLS);
        let displacement = applied(&mut *operator, &level.pressure);
        look(&*operator, &displacement)
    }

    /// The penetration from the exact displacement.
    fn approach(&self, map: &Field) -> f64 {
        let total: f64 = self.pressure.iter().sum();
        let gap = self.displacement.iter().zip(map.values()).map(|(v, h)| v - h + self.problem.h_max);
        self.pressure.iter().zip(gap).map(|(p, gap)| p / total * gap).sum()
    }

    /// The certificate from the exact displacement, over the whole cell.
    fn certificate(&self, map: &Field) -> Certificate {
        let gap: Vec<f64> =
            self.displacement.iter().zip(map.values()).map(|(v, h)| v - h + self.problem.h_max).collect();
        let total: f64 = self.pressure.iter().sum();
        let mean = |values: &[f64]| self.pressure.iter().zip(values).map(|(p, value)| p / total * value).sum::<f64>();
        let overlap = mean(&gap) - gap.iter().copied().fold(f64::INFINITY, f64::min);
        let penetration = overlap / self.problem.h_range;
        let off = match self.problem.bounds.control {
            Control::MeanPressure(_) => 0.0,
            Control::Penetration(wanted) => (mean(&gap) - wanted).abs(),
        };
        let energy = ((overlap + off) / (0.5 * mean(&self.displacement))).sqrt();
        Certificate { complementarity: penetration, penetration, energy, load: 0.0 }
    }
}

/// Calls `check` with scenes on any grid, and their solutions.
///
/// The grids are a rectangle, one whose sides are not halved, and one with both. Loads are light and heavy, under both
/// controls.
fn for_any_grid(bounds: &[ErrorBound], mut check: impl FnMut(&str, &Scene<'_>, &Audited)) {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let grids = [([256, 64], 16), ([300, 207], 16), ([101, 101], 8), ([250, 250], 30), ([261, 261], 12)];
    for ([nx, ny], waves) in grids {
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        let map = rough(grid, waves, 0.7, &mut rng);
        for load in [0.003, 0.03, 0.3] {
            for &bound in bounds {
                let control = Control::MeanPressure(1e-3 * load * f64::from(waves));
                let scene = Scene { map: &map, boundary: Boundary::Periodic, base: None, control, bound };
                under_both_controls(&format!("{grid}, load {load}"), &scene, &mut check);
            }
        }
    }
}

/// Calls `check` with a scene under its load, and under its penetration.
fn under_both_controls(name: &str, scene: &Scene<'_>, check: &mut impl FnMut(&str, &Scene<'_>, &Audited)) {
    let (audited, bound) = (scene.audited(), scene.bound);
    check(&format!("{name}, {bound}"), scene, &audited);
    let scene = Scene { control: Control::Penetration(audited.approach(scene.map)), ..*scene };
    check(&format!("{name}, its penetration, {bound}"), &scene, &scene.audited());
}

/// Calls `check` with scenes on square grids, and their solutions.
///
/// Maps are rough or like noise. Loads are light and heavy, under both controls, with both kinds of tolerance.
fn for_each_scene(bounds: &[ErrorBound], mut check: impl FnMut(&str, &Scene<'_>, &Audited)) {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut maps = Vec::new();
    for (waves, side, hurst) in [(16, 128, 0.3), (16, 256, 0.8), (16, 512, 0.5), (8, 256, 1.0), (30, 128, 0.2)] {
        maps.push((
            format!("{waves} waves on {side}, H = {hurst}"),
            rough(Grid::square(side).expect("a grid"), waves, hurst, &mut rng),
            1e-3 * f64::from(waves),
        ));
    }
    let noise = Field::from_fn(Grid::square(256).expect("a grid"), |_| 1e-3 * rng.random::<f64>());
    maps.push(("noise".to_owned(), noise, 1e-2));
    for (name, map, slope) in &maps {
        for load in [0.003, 0.03, 0.3] {
            for &bound in bounds {
                let base = Some((map.grid().nx() / 4).clamp(32, 64));
                let control = Control::MeanPressure(load * slope);
                let scene = Scene { map, boundary: Boundary::Periodic, base, control, bound };
                under_both_controls(&format!("{name}, load {load}"), &scene, &mut check);
            }
        }
    }
}

/// Patches whose borders do not meet, on grids that halve and on others.
fn for_each_patch(bounds: &[ErrorBound], mut check: impl FnMut(&str, &Scene<'_>, &Audited)) {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let grids = [([256, 256], 16), ([256, 128], 24), ([250, 250], 12), ([300, 207], 16)];
    for ([nx, ny], waves) in grids {
        let grid = Grid::in_cell(nx, ny, ny as f64 / nx as f64).expect("a grid");
        let mut map = rough(grid, waves, 0.7, &mut rng);
        for (i, h) in map.values_mut().iter_mut().enumerate() {
            let at = grid.centre(i % nx, i / nx);
            *h += 5e-3 * (at.x + 0.5 * at.y) - 2e-3 * at.length_squared();
        }
        for load in [0.003, 0.1] {
            for &bound in bounds {
                let control = Control::MeanPressure(1e-3 * load * f64::from(waves));
                let scene = Scene { map: &map, boundary: Boundary::Free, base: None, control, bound };
                under_both_controls(&format!("a patch of {grid}, load {load}"), &scene, &mut check);
            }
        }
    }
}

const ENERGY: [ErrorBound; 2] = [ErrorBound::Energy(1e-2), ErrorBound::Energy(2e-3)];
const RELATIVE: [ErrorBound; 2] = [ErrorBound::Relative(1e-6), ErrorBound::Relative(1e-8)];

#[test]
fn an_audit_by_fourier_transform_finds_no_more_than_is_claimed() {
    for_each_scene(&[ENERGY, RELATIVE].concat(), audit);
}

#[test]
fn an_audit_on_any_grid_finds_no_more_than_is_claimed() {
    let bounds = [ENERGY[0], RELATIVE[0], RELATIVE[1]];
    for_any_grid(&bounds, audit);
}

#[test]
fn an_audit_of_patches_finds_no_more_than_is_claimed() {
    let bounds = [ENERGY[0], RELATIVE[0], RELATIVE[1]];
    for_each_patch(&bounds, audit);
}

/// Asserts that the claims hold.
fn audit(name: &str, scene: &Scene<'_>, audited: &Audited) {
    audit_of(audited.base.into(), name, scene, audited);
}

fn audit_of(solid: Solid, name: &str, scene: &Scene<'_>, audited: &Audited) {
    let claimed = audited.solved.level.outcome.certificate;
    let found = audited.certificate(scene.map);
    assert!(claimed.meets(scene.bound), "{name}: not converged: {claimed}");
    assert!(found.penetration <= claimed.penetration, "{name}: {found}, claimed {claimed}");
    assert!(found.energy <= claimed.energy, "{name}: {found}, claimed {claimed}");
    let bound = audited.error().displacement;
    let worst = audited.certified(solid, |_, displacement| {
        let both = displacement.iter().zip(places(&audited.solved.level.elements));
        let errors = both.filter_map(|(v, place)| Some((v - audited.displacement[place?]).abs()));
        errors.fold(0.0, f64::max)
    });
    assert!(worst < bound, "{name}: {worst:e} for {bound:e}");
}
