//! Time of kernel values.
//!
//! They are Love's square at several distances, values of the symbols, and the making of a symbol. Run
//! `cargo bench -p rc-kernel`. A sample of a benchmark of values is 1000 values.

use divan::{Bencher, black_box};
use rc_core::{DVec2, Grid, Kernel};
use rc_kernel::{Love, Spectral, love_alias_sum, love_displacement};

const VALUES: usize = 1000;

fn main() {
    divan::main();
}

/// Distances in half-sides: inside, beside, near the switch to the series, and far away.
#[divan::bench(args = [0.5, 1.5, 2.4, 2.6, 8.0, 50.0, 1e4])]
fn displacement(bencher: Bencher<'_, '_>, distance: f64) {
    let slope = |i: usize| i as f64 / VALUES as f64;
    let offset = |i: usize| DVec2::new(black_box(distance), distance * slope(i));
    bencher.counter(VALUES).bench(|| (0..VALUES).map(|i| love_displacement(offset(i), 1.0)).sum::<f64>());
}

/// One row of the symbol. Elements are squares, rectangles up to 2:1, and longer rectangles.
#[divan::bench(args = [(4096, 4096), (2048, 4096), (512, 4096)])]
fn love_values(bencher: Bencher<'_, '_>, (nx, ny): (usize, usize)) {
    values(bencher, &Love, (nx, ny));
}

#[divan::bench]
fn spectral_values(bencher: Bencher<'_, '_>) {
    values(bencher, &Spectral, (4096, 4096));
}

fn values(bencher: Bencher<'_, '_>, kernel: &dyn Kernel, (nx, ny): (usize, usize)) {
    let symbol = kernel.symbol(Grid::new(nx, ny).expect("grid"));
    bencher.counter(VALUES).bench(|| (0..VALUES).map(|i| symbol(black_box(1 + i % (nx / 2)), 1 + i)).sum::<f64>());
}

#[divan::bench(args = [64, 4096])]
fn make_love_symbol(n: usize) -> f64 {
    Love.symbol(Grid::square(black_box(n)).expect("grid"))(1, 1)
}

#[divan::bench]
fn slow_alias_sum() -> f64 {
    love_alias_sum(Grid::square(64).expect("grid"), black_box(3), black_box(5))
}
