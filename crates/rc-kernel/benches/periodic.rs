//! Time of periodic coefficients.
//!
//! Targets are near, midway and far, sources small and large. Tables and truncated sums are timed too. Run
//! `cargo bench -p rc-kernel --bench periodic`. A sample of a benchmark of values is 1000 values.

use divan::{Bencher, black_box};
use rc_core::DVec2;
use rc_kernel::{LoadForm, PeriodicLove, ewald_coefficient, truncated_coefficient};

const VALUES: usize = 1000;

fn main() {
    divan::main();
}

/// Sources of half side 2^-level, and offsets all around at `distance`.
#[divan::bench(args = [(2, 0.3), (3, 0.3), (3, 0.5), (5, 0.02), (5, 0.1), (5, 0.4), (8, 0.001), (8, 0.01), (8, 0.1), (8, 0.4), (12, 0.001), (12, 0.4), (17, 0.4)])]
fn coefficient(bencher: Bencher<'_, '_>, (level, distance): (i32, f64)) {
    let love = PeriodicLove::new();
    let half_side = 0.5_f64.powi(level);
    let offsets = ring(distance);
    // This call makes the table.
    let _ = love.coefficient(DVec2::splat(0.1), half_side);
    bencher.counter(VALUES).bench(|| {
        let half_side = black_box(half_side);
        offsets.iter().map(|&offset| love.coefficient(offset, half_side)).sum::<f64>()
    });
}

/// Offsets all around the source, in an order without a pattern.
fn ring(distance: f64) -> Vec<DVec2> {
    let point = |i: usize| (2.4 * i as f64).sin_cos();
    (0..VALUES).map(point).map(|(sin, cos)| distance * DVec2::new(cos, sin)).collect()
}

/// Sizes from λ/4 to λ/2048 in random order, with targets anywhere in the cell.
///
/// This resembles a row of L on an adaptive mesh.
#[divan::bench]
fn mixed_sizes(bencher: Bencher<'_, '_>) {
    let love = PeriodicLove::new();
    let requests: Vec<(DVec2, f64)> = (0..VALUES)
        .map(|i| {
            let random = |factor: f64| (factor * i as f64).fract();
            (DVec2::new(random(0.618034), random(0.414214)) - 0.5, 0.5_f64.powi(3 + (10.0 * random(0.732051)) as i32))
        })
        .collect();
    bencher.counter(VALUES).bench(|| requests.iter().map(|&(offset, d)| love.coefficient(offset, d)).sum::<f64>());
}

/// Sizes that are not powers of two, with a table and without.
#[divan::bench(args = [true, false])]
fn other_sizes(bencher: Bencher<'_, '_>, table: bool) {
    let love = PeriodicLove::new();
    let half_side = 1.0 / 96.0;
    let source = love.source(half_side).expect("a source");
    let offsets = ring(0.4);
    let of = |&offset: &DVec2| {
        if table { source.coefficient(offset) } else { love.coefficient(offset, black_box(half_side)) }
    };
    bencher.counter(VALUES).bench(|| offsets.iter().map(of).sum::<f64>());
}

#[divan::bench]
fn make_a_table(bencher: Bencher<'_, '_>) {
    let love = PeriodicLove::new();
    bencher.bench(|| love.source(black_box(1.0 / 96.0)));
}

#[divan::bench]
fn make_a_handle() -> PeriodicLove {
    PeriodicLove::new()
}

/// One coefficient from K shells of images.
#[divan::bench(args = [1, 8, 64])]
fn truncated(shells: usize) -> f64 {
    truncated_coefficient(DVec2::new(black_box(0.25), 0.1), 1.0 / 128.0, shells, LoadForm::Plain)
        .expect("a valid request")
}

#[divan::bench]
fn slow_reference() -> f64 {
    ewald_coefficient(DVec2::new(black_box(0.25), 0.1), 1.0 / 128.0)
}
