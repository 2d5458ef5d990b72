//! The multilevel operator against exact sums of the periodic coefficients.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_kernel::{PeriodicLove, ScaleSplit, SplitParams};

use super::*;

/// Round contacts with Hertz's pressure, at random places, as in contact problems.
fn spots(tiles: &TileSet, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let side = tiles.side() as f64;
    let centres: Vec<[f64; 3]> =
        (0..12).map(|_| [rng.random(), rng.random(), 0.01 + 0.05 * rng.random::<f64>()]).collect();
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
fn tiles_of_spots(side: usize, seed: u64) -> TileSet {
    let all = TileSet::full(side / TILE);
    let p = spots(&all, seed);
    let mut rng = ChaCha8Rng::seed_from_u64(seed + 100);
    let touched = all
        .places()
        .iter()
        .enumerate()
        .filter(|(tile, _)| p[tile * CELLS..][..CELLS].iter().any(|&p| p > 0.0) || rng.random::<f64>() < 0.02);
    TileSet::new(side / TILE, touched.map(|(_, &place)| place).collect())
}

fn apply<T: Real + Into<f64>>(split: &ScaleSplit, base: usize, tiles: TileSet, p: &[f64]) -> Vec<f64> {
    let prepared = Prepared::<T>::displacement(split, Grid::square(base).expect("a grid"));
    let hierarchy = Arc::new(Hierarchy::new(base, tiles, prepared.halo()));
    let tables = prepared.tables(hierarchy.n_levels());
    let mut operator = TileOperator::<T>::new(Arc::clone(&hierarchy));
    operator.fill(p.par_chunks(BLOCK_CELLS), |p, cells| {
        for (cell, &p) in cells.iter_mut().zip(p) {
            *cell = T::rounded(p);
        }
    });
    operator.multiply(&tables);
    let mut v = vec![0.0; p.len()];
    operator.take(&tables, v.par_chunks_mut(BLOCK_CELLS), |v, cells| {
        for (v, cell) in v.iter_mut().zip(cells) {
            *v = (*cell).into();
        }
    });
    v
}

/// Exact sums at some of the cells; returns the rms difference over the rms displacement.
fn error_against_exact_sums(tiles: &TileSet, p: &[f64], v: &[f64]) -> f64 {
    let exact = PeriodicLove::new();
    let (side, half_side) = (tiles.side() as f64, 0.5 / tiles.side() as f64);
    let centre = |i: usize| {
        let place = tiles.places()[i / CELLS];
        let cell = i % CELLS;
        let x = (f64::from(place[0]) * 8.0 + (cell % TILE) as f64 + 0.5) / side;
        (x, (f64::from(place[1]) * 8.0 + (cell / TILE) as f64 + 0.5) / side)
    };
    let (mut difference, mut size) = (0.0, 0.0);
    for i in (0..p.len()).step_by(p.len() / 200) {
        let (x, y) = centre(i);
        let sources = p.iter().enumerate().filter(|&(_, &p)| p != 0.0);
        let sum: f64 = sources
            .map(|(j, p)| {
                let (sx, sy) = centre(j);
                p * exact.coefficient(x - sx, y - sy, half_side)
            })
            .sum();
        difference += (v[i] - sum).powi(2);
        size += sum * sum;
    }
    (difference / size).sqrt()
}

#[test]
fn one_application_agrees_with_exact_sums() {
    for bound in [2e-3, 1e-6, 2e-9, 1e-10] {
        for (base, side, seed) in [(64, 128, 1), (64, 256, 2), (80, 320, 3), (64, 512, 4)] {
            let tiles = tiles_of_spots(side, seed);
            let p = spots(&tiles, seed);
            let split = ScaleSplit::new(SplitParams::for_error(bound).expect("a bound in range"));
            let v = apply::<f64>(&split, base, tiles.clone(), &p);
            let error = error_against_exact_sums(&tiles, &p, &v);
            assert!(error < bound, "{bound:e}, {base} to {side}: {error:e}");
        }
    }
}
