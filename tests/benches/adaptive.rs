//! Times of the multilevel operator and of whole solves, beside the uniform method.
//!
//! Run with `cargo bench -p rc-tests`. Items are elements of the operator, or elements of the finest grid of a solve.

use std::sync::LazyLock;

use divan::{Bencher, black_box, counter::ItemsCount};
use rc_core::{Field, Grid, HeightField, Operator};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::Love;
use rc_solver::{Control, Method, MultilevelOperator, SolveParams, UniformOperator, solve};

/// The paper's surface with N = 64.
static SURFACE: LazyLock<Surface> =
    LazyLock::new(|| Surface::new(&SpectrumParams::paper(64, 1)).expect("the paper's surface"));

fn main() {
    divan::main();
}

/// Tiles in the highest 12 % of the surface.
///
/// They are as many and as ragged as the tiles in contact at σ0/E* = 8.9e-4.
fn tiles(side: usize) -> Vec<[u32; 2]> {
    let per_side = side / 8;
    let heights = SURFACE.sample(Grid::square(per_side).expect("a grid"));
    let mut sorted = heights.values().to_vec();
    sorted.sort_by(f64::total_cmp);
    let level = sorted[sorted.len() * 88 / 100];
    let places = (0..per_side * per_side).filter(|&i| heights.values()[i] > level);
    places.map(|i| [(i % per_side) as u32, (i / per_side) as u32]).collect()
}

/// One application of the operator, with one to three levels above the base grid.
#[divan::bench(args = [(1024, 512), (2048, 512), (4096, 512)])]
fn multilevel_operator(bencher: Bencher<'_, '_>, (side, base): (usize, usize)) {
    let operator = MultilevelOperator::new(base, side, tiles(side), 2e-3).expect("a valid operator");
    let n = operator.n_elements();
    let (pressure, mut displacement) = (vec![1.0; n], vec![0.0; n]);
    bencher
        .counter(ItemsCount::new(n))
        .bench_local(|| operator.apply(black_box(&pressure), &mut displacement, &mut []));
}

/// One application of the operator with an error of 1e-6 of the rms displacement.
#[divan::bench(args = [(1024, 512), (2048, 512), (4096, 512)])]
fn certified_multilevel_operator(bencher: Bencher<'_, '_>, (side, base): (usize, usize)) {
    let operator = MultilevelOperator::new(base, side, tiles(side), 1e-6).expect("a valid operator");
    let n = operator.n_elements();
    let (pressure, mut displacement) = (vec![1.0; n], vec![0.0; n]);
    bencher
        .counter(ItemsCount::new(n))
        .bench_local(|| operator.apply(black_box(&pressure), &mut displacement, &mut []));
}

/// One application on the whole uniform grid, in double precision like the multilevel operators.
#[divan::bench(args = [1024, 2048, 4096])]
fn uniform_operator(bencher: Bencher<'_, '_>, side: usize) {
    let operator = UniformOperator::new(Grid::square(side).expect("a grid"), &Love);
    let n = operator.n_elements();
    let (pressure, mut displacement) = (vec![1.0; n], vec![0.0; n]);
    bencher
        .counter(ItemsCount::new(n))
        .bench_local(|| operator.apply(black_box(&pressure), &mut displacement, &mut []));
}

/// σ0/E* for 0.1 %, 1 %, 7 %, 29 %, 61 %, 90 % and 99 % contact.
const PRESSURES: [f64; 7] = [1e-5, 1e-4, 8.9e-4, 4e-3, 1e-2, 2e-2, 3.4e-2];

/// Elements per side of the solves: λ_min/16.
const SIDE: usize = 1024;

#[divan::bench(args = PRESSURES, sample_count = 5, sample_size = 1)]
fn adaptive_solve(bencher: Bencher<'_, '_>, pressure: f64) {
    let control = Control::MeanPressure(pressure);
    bencher.counter(ItemsCount::new(SIDE * SIDE)).bench(|| {
        let heights = SURFACE.on(Grid::square(SIDE).expect("a grid"));
        solve(heights, control, &SolveParams::default().by(Method::Adaptive)).expect("a solvable scene")
    });
}

#[divan::bench(args = PRESSURES, sample_count = 5, sample_size = 1)]
fn uniform_solve(bencher: Bencher<'_, '_>, pressure: f64) {
    let heights: Field = SURFACE.sample(Grid::square(SIDE).expect("a grid"));
    let control = Control::MeanPressure(pressure);
    bencher
        .counter(ItemsCount::new(SIDE * SIDE))
        .bench(|| solve(&heights, control, &SolveParams::default().by(Method::Uniform)).expect("a solvable scene"));
}
