//! The multilevel operator against exact sums of the periodic coefficients.

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{DVec2, Grid};
use rc_kernel::{PeriodicLove, ScaleSplit, SplitParams};
use rc_quadtree::{BLOCK_CELLS, CELLS, Elements, TILE, TileSet, quarters};

use crate::descent::operators::{BlockOperator, PreconditionedOperator, read_blocks, write_blocks};
use crate::descent::stiffness::{stiffness_pressure, stiffness_under};
use crate::tiles::mesh::Mesh;
use crate::tiles::operator::corrections::TileCorrections;
use crate::tiles::operator::hierarchy::Hierarchy;
use crate::tiles::operator::sizes::Real;
use crate::tiles::operator::tables::Prepared;
use crate::tiles::operator::tile_operator::TileOperator;
use crate::tiles::roughness::roughness;
use crate::tiles::solid::Solid;
use crate::tiles::solution::rms_pressure;
use crate::tiles::split::GapSplit;

/// Radii of spots a few elements of a base grid wide.
pub(super) const SMALL: [f64; 2] = [0.01, 0.06];

/// Radii of spots that have larger elements inside.
const LARGE: [f64; 2] = [0.06, 0.12];

/// Round contacts with Hertz's pressure, at random places, as in contact problems.
pub(super) fn spots(tiles: &TileSet, [least, greatest]: [f64; 2], seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let side = tiles.sides()[0] as f64;
    let centres: Vec<[f64; 3]> =
        (0..12).map(|_| [rng.random(), rng.random(), rng.random_range(least..greatest)]).collect();
    let mut p = vec![0.0; tiles.n_cells()];
    for (tile, place) in tiles.places().iter().enumerate() {
        for cell in 0..CELLS {
            let x = (f64::from(place[0]) * 8.0 + (cell % TILE) as f64 + 0.5) / side;
            let y = (f64::from(place[1]) * 8.0 + (cell / TILE) as f64 + 0.5) / side;
            for [cx, cy, a] in &centres {
                let (dx, dy) = (x - cx - (x - cx).round(), y - cy - (y - cy).round());
                p[tile * CELLS + cell] += (a * a - dx * dx - dy * dy).max(0.0).sqrt();
            }
        }
    }
    p
}

/// The tiles of a level that any of the spots touches, and some at random.
pub(super) fn tiles_of_spots(side: usize, radii: [f64; 2], seed: u64) -> TileSet {
    let all = TileSet::full([side, side]);
    let p = spots(&all, radii, seed);
    let mut rng = ChaCha8Rng::seed_from_u64(seed + 100);
    let touched = all
        .places()
        .iter()
        .enumerate()
        .filter(|(tile, _)| p[tile * CELLS..][..CELLS].iter().any(|&p| p > 0.0) || rng.random::<f64>() < 0.02);
    TileSet::new([side, side], touched.map(|(_, &place)| place).collect())
}

fn apply<T: Real + Into<f64>>(split: &ScaleSplit, base: usize, elements: Elements, p: &[f64]) -> Vec<f64> {
    apply_above::<T>(split, Grid::square(base).expect("a grid"), elements, p)
}

pub(super) fn apply_above<T: Real + Into<f64>>(
    split: &ScaleSplit,
    solid: impl Into<Solid>,
    elements: Elements,
    p: &[f64],
) -> Vec<f64> {
    let solid = solid.into();
    let base = solid.base();
    let n_coarse = elements.levels().len() - 1;
    let [nx, ny] = elements.finest().sides();
    let finest = base.grid().with_elements(nx, ny).expect("a grid");
    let prepared = Prepared::<T>::displacement(split, solid, n_coarse);
    let hierarchy = Arc::new(Hierarchy::new(base, elements, prepared.reach()));
    let mut operator = TileOperator::new(hierarchy, prepared.tables(finest));
    write_blocks(&mut operator, p.chunks(BLOCK_CELLS), |p, cells| {
        cells.iter_mut().zip(p).for_each(|(cell, &p)| *cell = T::rounded(p));
    });
    operator.apply();
    let mut v = vec![0.0; p.len()];
    read_blocks(&operator, v.chunks_mut(BLOCK_CELLS), |v, cells| {
        v.iter_mut().zip(cells).for_each(|(v, &cell)| *v = cell.into());
    });
    v
}

/// Relative rms difference of displacements to exact sums at some of the cells.
fn error_against_exact_sums(tiles: &TileSet, p: &[f64], v: &[f64]) -> f64 {
    let exact = PeriodicLove::new();
    let (side, half_side) = (tiles.sides()[0] as f64, 0.5 / tiles.sides()[0] as f64);
    let centre = |i: usize| {
        let place = tiles.places()[i / CELLS];
        let cell = i % CELLS;
        let x = (f64::from(place[0]) * 8.0 + (cell % TILE) as f64 + 0.5) / side;
        DVec2::new(x, (f64::from(place[1]) * 8.0 + (cell / TILE) as f64 + 0.5) / side)
    };
    let (mut difference, mut size) = (0.0, 0.0);
    for i in (0..p.len()).step_by(p.len() / 200) {
        let sources = p.iter().enumerate().filter(|&(_, &p)| p != 0.0);
        let sum: f64 = sources.map(|(j, p)| p * exact.coefficient(centre(i) - centre(j), half_side)).sum();
        difference += (v[i] - sum).powi(2);
        size += sum * sum;
    }
    (difference / size).sqrt()
}

#[test]
fn one_application_agrees_with_exact_sums() {
    for (bound, sides) in [(2e-3, 4), (1e-6, 4), (2e-9, 2), (1e-10, 4)] {
        for (base, side, seed) in [(64, 128, 1), (64, 256, 2), (80, 320, 3), (64, 512, 4)].into_iter().take(sides) {
            let tiles = tiles_of_spots(side, SMALL, seed);
            let p = spots(&tiles, SMALL, seed);
            let split = ScaleSplit::new(SplitParams::for_error(bound).expect("a bound in range"));
            let v = apply::<f64>(&split, base, Elements::uniform(tiles.clone()), &p);
            let error = error_against_exact_sums(&tiles, &p, &v);
            assert!(error < bound, "{bound:e}, {base} to {side}: {error:e}");
        }
    }
}

/// Elements of three sizes under the spots, graded as the operator needs.
///
/// Elements are the smaller the nearer they are to a point.
fn graded(side: usize, cutoff: usize, seed: u64) -> Elements {
    let mut rng = ChaCha8Rng::seed_from_u64(seed + 200);
    let centre: [f64; 2] = [rng.random(), rng.random()];
    let mut fine = tiles_of_spots(side / 4, LARGE, seed);
    let mut levels = Vec::new();
    for radius in [0.4, 0.33 - (cutoff.div_ceil(TILE) * 2 * TILE) as f64 / side as f64] {
        let per_side = fine.extent()[0] as f64;
        let is_near = |place: &[u32; 2]| {
            let [dx, dy] = [0, 1].map(|axis| {
                let d = (f64::from(place[axis]) + 0.5) / per_side - centre[axis];
                d - d.round()
            });
            dx.hypot(dy) < radius
        };
        let (near, far): (Vec<_>, Vec<_>) = fine.places().iter().copied().partition(is_near);
        levels.insert(0, TileSet::new(fine.sides(), far));
        fine = TileSet::new(fine.sides().map(|side| 2 * side), near.into_iter().flat_map(quarters).collect());
    }
    levels.insert(0, fine);
    Elements::new(levels)
}

/// The pressures of the spots on each element, and on the finest elements everywhere.
fn pressures(elements: &Elements, seed: u64) -> Vec<f64> {
    let mut p = vec![0.0; elements.len()];
    for (coarser, tiles) in elements.levels().iter().enumerate() {
        p[elements.cells(coarser)].copy_from_slice(&spots(tiles, LARGE, seed));
    }
    p
}

/// Centres of the finest elements that the element at `cell` of level `coarser` consists of.
fn finest_centres(elements: &Elements, coarser: usize, cell: usize) -> impl Iterator<Item = DVec2> {
    let tiles = &elements.levels()[coarser];
    let [column, row] = tiles.places()[cell / CELLS].map(|i| i as usize * TILE);
    let (x, y) = (column + cell % CELLS % TILE, row + cell % CELLS / TILE);
    let (n, side) = (1_usize << coarser, (tiles.sides()[0] << coarser) as f64);
    let centre = move |i: usize, part: usize| ((i * n + part) as f64 + 0.5) / side;
    (0..n * n).map(move |part| DVec2::new(centre(x, part % n), centre(y, part / n)))
}

#[test]
fn elements_of_several_sizes_agree_with_exact_means() {
    let exact = PeriodicLove::new();
    for bound in [2e-3, 1e-6, 2e-9] {
        let params = SplitParams::for_error(bound).expect("a bound in range");
        for (base, side, seed) in [(64, 512, 1), (64, 512, 2)] {
            let elements = graded(side, params.cutoff, seed);
            assert!(elements.levels().iter().all(|tiles| tiles.len() > 8), "all sizes take part");
            let p = pressures(&elements, seed);
            let v = apply::<f64>(&ScaleSplit::new(params), base, elements.clone(), &p);
            let sources: Vec<(DVec2, f64)> = (0..elements.levels().len())
                .flat_map(|coarser| elements.cells(coarser).enumerate().map(move |(cell, i)| (coarser, cell, i)))
                .filter(|&(_, _, i)| p[i] != 0.0)
                .flat_map(|(coarser, cell, i)| finest_centres(&elements, coarser, cell).zip(std::iter::repeat(p[i])))
                .collect();
            for coarser in 0..elements.levels().len() {
                let (mut difference, mut size) = (0.0, 0.0);
                let n_cells = elements.cells(coarser).len();
                for cell in (0..n_cells).step_by(n_cells / 20) {
                    let centres: Vec<DVec2> = finest_centres(&elements, coarser, cell).collect();
                    let coefficient = |target: DVec2, source| exact.coefficient(target - source, 0.5 / side as f64);
                    let sum: f64 =
                        centres.iter().map(|&x| sources.iter().map(|&(s, p)| p * coefficient(x, s)).sum::<f64>()).sum();
                    let mean = sum / centres.len() as f64;
                    difference += (v[elements.cells(coarser).start + cell] - mean).powi(2);
                    size += mean * mean;
                }
                let error = (difference / size).sqrt();
                assert!(error < bound, "{bound:e}, {base} to {side}, elements {coarser} levels coarser: {error:e}");
            }
        }
    }
}

#[test]
fn the_operator_is_symmetric_in_the_areas() {
    for split in [SplitParams::quick(), SplitParams::certified()].map(ScaleSplit::new) {
        let elements = graded(512, split.params().cutoff, 5);
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let [p, q] = [(); 2].map(|()| {
            let mut values = vec![0.0; elements.len()];
            for coarser in 0..3 {
                values[elements.cells(coarser)].fill_with(|| rng.random::<f64>() - 0.3);
            }
            values
        });
        let product = |a: &[f64], b: &[f64]| -> f64 {
            let level = |c: usize| elements.cells(c).map(|i| a[i] * b[i]).sum::<f64>() * Elements::area(c);
            (0..3).map(level).sum()
        };
        let [lp, lq] = [&p, &q].map(|p| apply::<f64>(&split, 64, elements.clone(), p));
        let (there, back) = (product(&q, &lp), product(&p, &lq));
        assert!((there - back).abs() < 1e-12 * product(&p, &lp), "{there} and {back}");
    }
}

/// The preconditioner of `active` elements applied to `values`.
fn preconditioned(elements: &Elements, base: usize, active: &[bool], values: &[f32]) -> Vec<f32> {
    let split = ScaleSplit::new(SplitParams::quick());
    let [grid, finest] = [base, elements.finest().sides()[0]].map(|side| Grid::square(side).expect("a grid"));
    let quick = Prepared::<f32>::displacement(&split, grid, elements.levels().len() - 1);
    let hierarchy = Arc::new(Hierarchy::new(grid, elements.clone(), quick.reach()));
    let displacement = quick.tables(finest);
    let mut inverse = Prepared::inverse(&split, grid).tables(finest);
    let mut corrections = TileCorrections::new(hierarchy, &displacement, &mut inverse);
    let mut values = values.to_vec();
    corrections.set_active(active);
    corrections.precondition(active, &mut values);
    values
}

#[test]
fn the_preconditioner_is_symmetric_and_positive_among_active_elements() {
    let (base, side) = (64, 512);
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let cutoff = SplitParams::quick().cutoff;
    for elements in
        [Elements::uniform(tiles_of_spots(side, SMALL, 1)), graded(side, cutoff, 7), graded(side, cutoff, 8)]
    {
        let mut area = vec![0.0; elements.len()];
        for (coarser, _, first) in elements.tiles() {
            area[first..first + CELLS].fill(Elements::area(coarser));
        }
        let active: Vec<bool> = area.iter().map(|&area| area > 0.0 && rng.random::<f64>() < 0.4).collect();
        // A residual that is the same everywhere is a change of the penetration. A pressure of zero mean does not
        // change it.
        let ones: Vec<f32> = active.iter().map(|&active| if active { 1.0 } else { 0.0 }).collect();
        let of_ones = preconditioned(&elements, base, &active, &ones);
        assert!(of_ones.iter().all(|z| z.abs() < 1e-3), "{of_ones:?}");
        let mut random = || -> Vec<f32> {
            active.iter().map(|&active| if active { rng.random::<f32>() - 0.5 } else { 0.0 }).collect()
        };
        let (a, b) = (random(), random());
        let product = |a: &[f32], b: &[f32]| -> f64 {
            a.iter().zip(b).zip(&area).map(|((a, b), area)| area * f64::from(*a) * f64::from(*b)).sum()
        };
        let [of_a, of_b] = [&a, &b].map(|values| preconditioned(&elements, base, &active, values));
        let (one, other) = (product(&a, &of_b), product(&b, &of_a));
        let size = (product(&a, &of_a) * product(&b, &of_b)).sqrt();
        assert!(product(&a, &of_a) > 0.0, "{} levels", elements.levels().len());
        assert!((one - other).abs() < 1e-4 * size, "{} levels: {one:e}, {other:e}, {size:e}", elements.levels().len());
    }
}

/// Pressures that are as rough as possible.
///
/// They are noise on every element, on half and on a tenth of them, alternating elements, and one element alone.
fn rough_pressures(n_elements: usize) -> Vec<Vec<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let mut pressures: Vec<Vec<f64>> = [0.0, 0.5, 0.9]
        .map(|none| (0..n_elements).map(|_| (rng.random::<f64>() - none).max(0.0)).collect())
        .into_iter()
        .collect();
    pressures.push((0..n_elements).map(|i| f64::from(u8::from((i + i / TILE).is_multiple_of(2)))).collect());
    pressures.push((0..n_elements).map(|i| f64::from(u8::from(i == n_elements / 3))).collect());
    pressures
}

#[test]
fn on_rough_pressures_the_error_is_in_proportion_to_the_roughness() {
    let finest = ScaleSplit::new(SplitParams::for_error(SplitParams::SMALLEST_ERROR).expect("a bound in range"));
    for (base, side) in [(64, 128), (64, 512)] {
        let elements = Elements::uniform(TileSet::full([side, side]));
        for mut p in rough_pressures(elements.len()) {
            // The mean is subtracted as for fresh gaps. A uniform pressure displaces nothing.
            let mean = p.iter().sum::<f64>() / p.len() as f64;
            for p in &mut p {
                *p -= mean;
            }
            let better = apply::<f64>(&finest, base, elements.clone(), &p);
            for bound in [1e-6, 2e-9] {
                let gap_split = GapSplit::for_error(bound).expect("a bound in range");
                let split = ScaleSplit::new(gap_split.params);
                let v = if gap_split.is_single_precision() {
                    apply::<f32>(&split, base, elements.clone(), &p)
                } else {
                    apply::<f64>(&split, base, elements.clone(), &p)
                };
                let greatest = v.iter().zip(&better).fold(0.0_f64, |greatest, (a, b)| greatest.max((a - b).abs()));
                let allowed = gap_split.error_of_roughness * roughness(&elements.clone().into(), &p);
                assert!(greatest < allowed, "{bound:e}, {base} to {side}: {greatest:e} for {allowed:e}");
            }
        }
    }
}

/// The stiffness of the contact under `pressure`, the rms of pressures, and their maximum.
fn stiffness_and_squares(mesh: &Mesh, pressure: &[f64], [base, side]: [usize; 2]) -> [f64; 3] {
    let (base, finest) = (Grid::square(base).expect("a grid"), Grid::square(side).expect("a grid"));
    let quick = ScaleSplit::new(SplitParams::quick());
    let inverse = Prepared::<f32>::inverse(&quick, base);
    let displacement = Prepared::<f32>::displacement(&quick, base, 0);
    let tables = displacement.tables(finest);
    let hierarchy = Arc::new(Hierarchy::new(base, mesh.clone(), displacement.reach()));
    let mut inverse = inverse.tables(finest);
    let n = finest.len() as f64;
    let x = {
        let mut operator = TileCorrections::new(Arc::clone(&hierarchy), &tables, &mut inverse);
        stiffness_pressure(pressure, n, &mut operator, true)
    };
    let stiffness = stiffness_under(&x, n, &mut TileOperator::new(hierarchy, &tables));
    [stiffness, rms_pressure(mesh, pressure), mesh.layout().maximum(pressure, 0.0)]
}

#[test]
fn without_the_tiles_out_of_contact_every_digit_is_the_same() {
    for (sides, seed) in [([32, 128], 3), ([32, 512], 8), ([56, 200], 5)] {
        let tiles = TileSet::full([sides[1]; 2]).around(0);
        let pressure = spots(&tiles, [0.02, 0.06], seed);
        let mesh = Mesh::from(Elements::uniform(tiles));
        let thin = mesh.thinned(|cells| pressure[cells].iter().any(|p| *p > 0.0)).expect("elements of one size");
        assert!(thin.n_cells() < mesh.n_cells() / 2 && thin.block_ends().is_some_and(|ends| ends.len() > 3));
        let of_thin = mesh.moved(&thin, &pressure, 0.0);
        let [whole, part] =
            [(&mesh, &pressure), (&thin, &of_thin)].map(|(mesh, p)| stiffness_and_squares(mesh, p, sides));
        assert!(whole[0] > 0.0);
        assert_eq!(whole.map(f64::to_bits), part.map(f64::to_bits), "{sides:?}: {whole:?} and {part:?}");
    }
}
