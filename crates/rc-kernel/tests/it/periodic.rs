//! Tests of periodic coefficients with tables, slow sums, the symbol, and identities.

use std::f64::consts::PI;
use std::path::Path;

use proptest::prelude::{ProptestConfig, prop_assert, proptest};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rc_core::{DVec2, Grid, Kernel};
use rc_kernel::{
    KernelError, LoadForm, Love, MAX_SHELLS, PeriodicLove, ewald_coefficient, shells_for, truncated_coefficient,
    truncation_error_bound,
};

/// The scale of errors: |L|, or the contribution of a unit φ where L changes sign.
fn scale(reference: f64, half_side: f64) -> f64 {
    reference.abs().max(4.0 * half_side * half_side)
}

#[test]
fn coefficients_match_the_seventeen_digit_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/reference/periodic-love-coefficients.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let love = PeriodicLove::new();
    let mut n_rows = 0;
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let (n, reference) = (row[0], row[3]);
        let (x, y, half_side) = (row[1] / n, row[2] / n, 0.5 / n);
        let source = love.source(half_side).expect("a source");
        let slow = ewald_coefficient(DVec2::new(x, y), half_side);
        for (value, allowed) in [
            (love.coefficient(DVec2::new(x, y), half_side), 1e-12),
            (source.coefficient(DVec2::new(x, y)), 1e-12),
            (slow, 4e-14),
        ] {
            let error = (PI * value / reference - 1.0).abs();
            assert!(error <= allowed, "{line}: {:e}, off by {error:.1e}", PI * value);
        }
        n_rows += 1;
    }
    assert_eq!(n_rows, 28, "the table is complete");
}

#[test]
fn coefficients_match_the_hundred_digit_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/reference/periodic-decades.csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert_eq!(text.lines().count(), 43, "the table is complete");
    let love = PeriodicLove::new();
    for line in text.lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let (x, y, half_side, reference) = (row[0], row[1], row[2], row[3]);
        let value = love.coefficient(DVec2::new(x, y), half_side);
        let error = (value - reference).abs() / scale(reference, half_side);
        assert!(error <= 1e-12, "{line}: {value:e}, off by {error:.1e}");
    }
}

#[test]
fn coefficients_match_the_quadrature_of_ewald_sums() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let love = PeriodicLove::new();
    // The table of λ/2 squares is interpolated closer to their images than the other tables.
    let (mut worst, mut worst_of_half_cells) = (0.0_f64, 0.0_f64);
    let sizes = (1..=17).map(|level| 0.5_f64.powi(level)).chain([0.4, 1.0 / 6.0, 0.1, 1.0 / 96.0, 3e-3, 1e-7, 1e-12]);
    for d in sizes {
        let source = love.source(d).expect("a source");
        // Centre, edge, corner, in line with a side inside and outside, neighbours, the border of the cell.
        let mut offsets = vec![(0.0, 0.0), (d, 0.0), (d, d), (0.3 * d, d), (d, 5.0 * d), (2.0 * d, 0.0), (3.0 * d, d)];
        offsets.extend([(0.5, 0.0), (0.5, 0.5), (0.5, 0.2), (0.5, d), (12.9 * d, 3.0 * d), (13.1 * d, 3.0 * d)]);
        offsets.extend((0..12).map(|_| (random.random_range(-0.5..0.5), random.random_range(-0.5..0.5))));
        offsets.extend((0..6).map(|_| (random.random_range(-4.0..4.0) * d, random.random_range(-4.0..4.0) * d)));
        for (x, y) in offsets {
            let reference = ewald_coefficient(DVec2::new(x, y), d);
            for value in [love.coefficient(DVec2::new(x, y), d), source.coefficient(DVec2::new(x, y))] {
                let error = (value - reference).abs() / scale(reference, d);
                let worst = if d > 0.125 { &mut worst_of_half_cells } else { &mut worst };
                *worst = worst.max(error);
                assert!(error <= 1e-12, "({x}, {y}), d = {d}: {value:e}, reference {reference:e}, off by {error:.1e}");
            }
        }
    }
    assert!(worst <= 1e-13, "the documented accuracy is exceeded: {worst:e}");
    assert!(worst_of_half_cells <= 2e-13, "the documented accuracy of λ/2 is exceeded: {worst_of_half_cells:e}");
}

#[test]
fn the_inverse_transform_of_the_symbol_gives_the_coefficients() {
    const N: usize = 32;
    let symbol = Love.symbol(Grid::square(N).expect("grid"));
    let fold = |k: usize| k.min(N - k);
    let cosine = |k: usize, i: usize| (2.0 * PI * ((k * i) % N) as f64 / N as f64).cos();
    // Σ_k λ(k) cos cos, along one direction at a time.
    let values: Vec<f64> = (0..N * N).map(|at| symbol(fold(at % N), fold(at / N)) / (N * N) as f64).collect();
    let transformed = |values: &[f64]| -> Vec<f64> {
        let along = |i: usize, row: &[f64]| row.iter().enumerate().map(|(k, value)| value * cosine(k, i)).sum::<f64>();
        (0..N).flat_map(|i| values.chunks(N).map(move |row| along(i, row))).collect()
    };
    let reference = transformed(&transformed(&values));
    let love = PeriodicLove::new();
    for at in 0..N * N {
        let (i, j) = (at % N, at / N);
        let value = love.coefficient(DVec2::new(i as f64 / N as f64, j as f64 / N as f64), 0.5 / N as f64);
        let error = (value - reference[at]).abs();
        assert!(error <= 1e-13 * reference[0], "({i}, {j}): {value:e}, symbol {:e}, off by {error:.1e}", reference[at]);
    }
}

/// Centres and half sides of a random tiling.
///
/// Squares are quartered with a probability, down to a side of 2^-`depth`.
fn tiling(random: &mut ChaCha8Rng, x: f64, y: f64, d: f64, depth: usize, tiles: &mut Vec<(f64, f64, f64)>) {
    if depth > 0 && (d > 0.2 || random.random_bool(0.6)) {
        let h = 0.5 * d;
        for (u, v) in [(-h, -h), (h, -h), (-h, h), (h, h)] {
            tiling(random, x + u, y + v, h, depth - 1, tiles);
        }
    } else {
        tiles.push((x, y, d));
    }
}

#[test]
fn a_uniform_load_on_any_tiling_moves_nothing() {
    let love = PeriodicLove::new();
    for seed in 0..8 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // Half of the tilings start from 3 x 3 squares, so their sizes are not powers of two.
        let base = if seed % 2 == 0 { 1 } else { 3 };
        let mut tiles = Vec::new();
        let root = 0.5 / f64::from(base);
        for at in 0..base * base {
            let (i, j) = (f64::from(2 * (at % base) + 1), f64::from(2 * (at / base) + 1));
            tiling(&mut random, i * root, j * root, root, 6, &mut tiles);
        }
        let area: f64 = tiles.iter().map(|&(_, _, d)| 4.0 * d * d).sum();
        assert!((area - 1.0).abs() < 1e-12, "the tiling covers the cell: {area}");
        for &(x, y, _) in tiles.iter().step_by(tiles.len().div_ceil(40)) {
            let row = tiles.iter().map(|&(u, v, d)| love.coefficient(DVec2::new(x - u, y - v), d));
            let (sum, absolute) = row.fold((0.0, 0.0), |(sum, absolute), l| (sum + l, absolute + l.abs()));
            assert!(
                sum.abs() <= 1e-13 * absolute,
                "seed {seed}, {} tiles, target ({x}, {y}): sum {sum:e} of terms {absolute:e}",
                tiles.len()
            );
        }
    }
}

#[test]
fn a_load_on_the_whole_cell_moves_nothing() {
    let love = PeriodicLove::new();
    // Four squares of side λ/2, each with its own error.
    for (x, y) in [(0.0, 0.0), (0.5, 0.5), (0.1, -0.3)] {
        assert!(
            love.coefficient(DVec2::new(x, y), 0.5).abs() <= 2e-13,
            "at ({x}, {y}): {:e}",
            love.coefficient(DVec2::new(x, y), 0.5)
        );
    }
}

#[test]
fn symmetric_offsets_have_the_same_coefficient() {
    let love = PeriodicLove::new();
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for d in [0.5, 0.3, 0.25, 0.125, 0.1, 1.0 / 64.0, 1e-5] {
        let source = love.source(d).expect("a source");
        for _ in 0..50 {
            let (x, y): (f64, f64) = (random.random_range(-1.0..1.0), random.random_range(-1.0..1.0));
            let (value, of_source) = (love.coefficient(DVec2::new(x, y), d), source.coefficient(DVec2::new(x, y)));
            for (u, v) in [(-x, y), (x, -y), (-x, -y), (y, x), (-y, x), (y, -x), (-y, -x)] {
                assert_eq!(
                    love.coefficient(DVec2::new(u, v), d).to_bits(),
                    value.to_bits(),
                    "({x}, {y}) and ({u}, {v}), d = {d}"
                );
                assert_eq!(
                    source.coefficient(DVec2::new(u, v)).to_bits(),
                    of_source.to_bits(),
                    "source: ({x}, {y}) and ({u}, {v}), d = {d}"
                );
            }
        }
    }
}

#[test]
fn neutral_loads_on_a_uniform_grid_have_positive_energy() {
    const N: usize = 8;
    let love = PeriodicLove::new();
    let offset = |i: usize, j: usize| (i as f64 - j as f64) / N as f64;
    // A uniform load causes no displacement. So L + 1 is positive definite if L is positive definite on loads with zero
    // mean. Cholesky factorisation, in place.
    let mut a: Vec<Vec<f64>> = (0..N * N)
        .map(|i| {
            let entry =
                |j: usize| love.coefficient(DVec2::new(offset(i % N, j % N), offset(i / N, j / N)), 0.5 / N as f64);
            (0..N * N).map(|j| 1.0 + entry(j)).collect()
        })
        .collect();
    for i in 0..N * N {
        for j in 0..=i {
            let rest = a[i][j] - (0..j).map(|k| a[i][k] * a[j][k]).sum::<f64>();
            if i == j {
                // The smallest eigenvalue of L belongs to the shortest wave and is about 0.4/N.
                assert!(rest > 0.2 / N as f64, "pivot {i} is {rest:e}");
                a[i][i] = rest.sqrt();
            } else {
                a[i][j] = rest / a[j][j];
            }
        }
    }
}

#[test]
fn truncation_error_is_below_its_bound() {
    let love = PeriodicLove::new();
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut tightest = 0.0_f64;
    for shells in [1, 2, 3, 5, 8, 16, 32, 64] {
        for form in [LoadForm::Plain, LoadForm::Printed] {
            for case in 0..12 {
                let d = 0.5_f64.powi(case % 6 + 1) * random.random_range(0.7..1.0);
                let random_offset = (random.random_range(-0.5..0.5), random.random_range(-0.5..0.5));
                let (x, y) = [(0.0, 0.0), (0.5, 0.5), random_offset, random_offset][case as usize % 4];
                let value = truncated_coefficient(DVec2::new(x, y), d, shells, form).expect("a valid request");
                let error = (value - love.coefficient(DVec2::new(x, y), d)).abs();
                let bound = truncation_error_bound(d, shells, form);
                tightest = tightest.max(error / bound);
                assert!(error <= bound, "({x}, {y}), d = {d}, {shells} shells, {form:?}: {error:e} above {bound:e}");
            }
        }
    }
    assert!(tightest > 0.9, "the bound is needlessly wide: errors reach {tightest} of it");
}

#[test]
fn truncation_errors_are_those_measured_for_small_sources() {
    // e = π K error/(2d)², for the printed and for the plain form (n = 64, many shells).
    let love = PeriodicLove::new();
    let (d, shells) = (1.0 / 128.0, 40);
    for (x, y, printed, plain) in [(0.0, 0.0, 0.94, 0.235), (0.25, 0.1, 0.84, 0.13), (0.5, 0.5, 0.23, -0.47)] {
        for (form, expected) in [(LoadForm::Printed, printed), (LoadForm::Plain, plain)] {
            let value = truncated_coefficient(DVec2::new(x, y), d, shells, form).expect("a valid request");
            let e = (value - love.coefficient(DVec2::new(x, y), d)) * PI * (shells as f64 + 0.5) / (4.0 * d * d);
            assert!((e - expected).abs() < 0.006, "({x}, {y}), {form:?}: e = {e}, expected {expected}");
        }
    }
}

#[test]
fn eq_6_as_printed_has_the_limit_of_the_plain_form() {
    let love = PeriodicLove::new();
    for (x, y, d) in [(0.0, 0.0, 0.01), (0.3, 0.1, 0.0625), (0.5, 0.5, 0.25)] {
        let exact = love.coefficient(DVec2::new(x, y), d);
        for form in [LoadForm::Plain, LoadForm::Printed] {
            let at = |shells: usize| truncated_coefficient(DVec2::new(x, y), d, shells, form).expect("a valid request");
            // The error is c/(K + ½) + O(K⁻³), so two values give the limit.
            let limit = |k: usize| ((2 * k) as f64 + 0.5) * at(2 * k) - (k as f64 + 0.5) * at(k);
            let errors = [8, 16, 32].map(|k| (limit(k) / k as f64 - exact).abs() / scale(exact, d));
            assert!(errors[2] < 2e-5, "({x}, {y}), d = {d}, {form:?}: extrapolated errors {errors:?}");
            assert!(errors[2] < 0.2 * errors[1] + 1e-10, "({x}, {y}), d = {d}, {form:?}: not third order, {errors:?}");
        }
    }
}

#[test]
fn shells_for_is_the_least_number_that_guarantees_the_tolerance() {
    for form in [LoadForm::Plain, LoadForm::Printed] {
        for tolerance in [1e-2, 1e-4, 1e-6] {
            let shells = shells_for(1.0 / 64.0, tolerance, form).expect("within reach");
            assert!(truncation_error_bound(1.0 / 64.0, shells, form) <= tolerance);
            assert!(
                truncation_error_bound(1.0 / 64.0, shells - 1, form) > tolerance,
                "{shells} shells for {tolerance}"
            );
        }
    }
}

#[test]
fn bad_requests_are_typed_errors() {
    let love = PeriodicLove::new();
    let form = LoadForm::Plain;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(matches!(love.try_coefficient(DVec2::new(bad, 0.0), 0.1), Err(KernelError::Offset { .. })));
        assert!(matches!(truncated_coefficient(DVec2::new(0.0, bad), 0.1, 1, form), Err(KernelError::Offset { .. })));
    }
    for half_side in [0.0, -0.1, 0.500001, 1e300, f64::NAN, f64::INFINITY] {
        let error = love.try_coefficient(DVec2::ZERO, half_side).expect_err("a bad size");
        assert!(matches!(error, KernelError::HalfSide { .. }), "{error}");
        assert!(love.source(half_side).is_err() && shells_for(half_side, 1e-3, form).is_err());
        assert!(truncated_coefficient(DVec2::ZERO, half_side, 1, form).is_err());
        assert!(truncation_error_bound(half_side, 1, form) == f64::INFINITY);
        assert!(ewald_coefficient(DVec2::ZERO, half_side).is_nan());
    }
    assert_eq!(truncated_coefficient(DVec2::ZERO, 0.1, 0, form), Err(KernelError::NoShells));
    let shells = MAX_SHELLS + 1;
    assert_eq!(truncated_coefficient(DVec2::ZERO, 0.1, shells, form), Err(KernelError::TooManyShells { shells }));
    assert!(truncation_error_bound(0.1, 0, form) == f64::INFINITY);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(shells_for(0.1, tolerance, form), Err(KernelError::Tolerance { .. })));
    }
    let error = shells_for(0.1, 1e-12, form).expect_err("out of reach");
    assert!(matches!(error, KernelError::Unreachable { reached, .. } if reached > 1e-12), "{error}");
    assert!(error.to_string().contains("exact"), "the message names the way out: {error}");
}

#[test]
fn the_smallest_sources_are_points() {
    let love = PeriodicLove::new();
    for d in [1e-7, 1e-20, 1e-100, 1e-150] {
        let value = love.try_coefficient(DVec2::new(0.3, 0.1), d).expect("a valid request") / (4.0 * d * d);
        let phi = rc_kernel::ewald_phi(DVec2::new(0.3, 0.1)) / PI;
        assert!((value - phi).abs() <= 1e-12, "d = {d}: {value}, point load {phi}");
        let own = love.try_coefficient(DVec2::ZERO, d).expect("a valid request") / d;
        // The images contribute 4 d C/π, that is 4.97 d.
        assert!((own - 8.0 * 1.0_f64.asinh() / PI).abs() <= 5.0 * d + 1e-14, "d = {d}: {own}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Offsets are exact multiples of 2^-40, so a shift by whole cells is exact.
    #[test]
    fn whole_cells_between_source_and_target_do_not_matter(
        x in -(1_i64 << 40)..(1_i64 << 40), y in -(1_i64 << 40)..(1_i64 << 40),
        h in -1000_i32..1000, k in -1000_i32..1000, level in 1_i32..18,
    ) {
        let to_length = |i: i64| i as f64 / (1_i64 << 40) as f64;
        let (x, y, d) = (to_length(x), to_length(y), 0.5_f64.powi(level));
        let love = PeriodicLove::new();
        let (here, there) = (love.coefficient(DVec2::new(x, y), d), love.coefficient(DVec2::new(x + f64::from(h), y + f64::from(k)), d));
        prop_assert!((here - there).abs() <= 1e-13 * scale(here, d), "({x}, {y}) + ({h}, {k}), d = {d}: {here:e}, {there:e}");
    }

    #[test]
    fn a_square_is_the_sum_of_its_quarters(x in -0.5..0.5_f64, y in -0.5..0.5_f64, d in 1e-4..0.5_f64) {
        let love = PeriodicLove::new();
        let h = 0.5 * d;
        let quarters = [(-h, -h), (h, -h), (-h, h), (h, h)];
        let sum: f64 = quarters.iter().map(|(u, v)| love.coefficient(DVec2::new(x + u, y + v), h)).sum();
        let whole = love.coefficient(DVec2::new(x, y), d);
        prop_assert!((sum - whole).abs() <= 1e-12 * scale(whole, d), "({x}, {y}), d = {d}: {whole:e}, quarters {sum:e}");
    }
}
