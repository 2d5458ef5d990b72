//! The kernels against tabulated values and closed forms.

use std::f64::consts::PI;
use std::path::Path;

use rc_core::testing::check_kernel;
use rc_core::{Grid, Kernel};
use rc_kernel::{Love, Spectral, love_displacement};
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;

/// Rows of a CSV of numbers in `data/reference`, without the header.
fn rows(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/reference").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let parse = |line: &str| line.split(',').map(|field| field.parse().expect("a number")).collect();
    text.lines().skip(1).map(parse).collect()
}

#[test]
fn kernels_meet_the_contract() {
    check_kernel(&Love);
    check_kernel(&Spectral);
}

#[test]
fn matches_reference_values_everywhere() {
    let rows = rows("love-square.csv");
    assert!(rows.len() > 40, "the table is not empty");
    for row in rows {
        let (x, y, half_side, reference) = (row[0], row[1], row[2], row[3]);
        let value = love_displacement(x, y, half_side);
        let error = (value / reference - 1.0).abs();
        assert!(
            error <= 2e-15,
            "at ({x}, {y}), d = {half_side}: {value:e}, reference {reference:e}, off by {error:.1e}"
        );
        for (u, v) in [(-x, y), (x, -y), (y, x), (-y, -x)] {
            assert!(love_displacement(u, v, half_side) == value, "not symmetric at ({u}, {v})");
        }
    }
}

#[test]
fn displacement_is_smooth_where_the_series_takes_over() {
    // The third difference of a smooth function across the switch is far below its rounding.
    for y in [0.0, 1.0, 3.3, 4.0] {
        let at = |i: i32| love_displacement(4.0 + 1e-6 * f64::from(i), y, 1.0);
        let jump = (at(1) - 3.0 * at(0) + 3.0 * at(-1) - at(-2)).abs() / at(0);
        assert!(jump < 1e-14, "jump {jump:e} at y = {y}");
    }
}

/// Coefficients L between element (0, 0) and all others: the inverse transform of the symbol.
fn coefficients(kernel: &dyn Kernel, n: usize) -> Vec<f64> {
    let symbol = kernel.symbol(Grid::square(n).expect("grid"));
    let fold = |k: usize| k.min(n - k);
    let mut values: Vec<Complex64> =
        (0..n * n).map(|i| Complex64::new(symbol(fold(i % n), fold(i / n)) / (n * n) as f64, 0.0)).collect();
    let fft = FftPlanner::new().plan_fft_inverse(n);
    for _ in 0..2 {
        fft.process(&mut values);
        values = (0..n * n).map(|i| values[(i % n) * n + i / n]).collect();
    }
    values.into_iter().map(|value| value.re).collect()
}

#[test]
fn love_symbol_reproduces_the_periodic_coefficients() {
    let rows = rows("periodic-love-coefficients.csv");
    assert_eq!(rows.len(), 28, "the table is complete");
    for n in [16, 64, 256, 1024] {
        let coefficients = coefficients(&Love, n);
        for row in rows.iter().filter(|row| row[0] as usize == n) {
            let (i, j, reference) = (row[1] as usize, row[2] as usize, row[3]);
            let value = PI * coefficients[j * n + i];
            // Far coefficients are what remains of a sum with terms as large as the self coefficient's.
            let allowed = 1e-12 * reference.abs() + 2e-16 * coefficients[0];
            let error = (value - reference).abs();
            assert!(error <= allowed, "n = {n}, ({i}, {j}): {value:e}, reference {reference:e}, off by {error:.1e}");
        }
    }
}

#[test]
fn love_symbol_reproduces_the_amplitude_ratios() {
    // Full contact of one wave on m elements per wavelength, relative to the continuous half-space.
    let ratio = |m: usize, both: bool| {
        let grid = Grid::square(m).expect("grid");
        Love.symbol(grid)(1, usize::from(both)) / Spectral.symbol(grid)(1, usize::from(both))
    };
    let along_x = [(4, 0.95859755), (8, 0.98159596), (16, 0.99446903), (32, 0.99850450), (64, 0.99961221)];
    for (m, expected) in along_x {
        assert!((ratio(m, false) - expected).abs() <= 5.1e-9, "{m} elements: {}", ratio(m, false));
    }
    for (m, expected) in [(8, 0.9691379), (16, 0.9896918), (32, 0.9971022)] {
        assert!((ratio(m, true) - expected).abs() <= 5.1e-8, "{m} x {m} elements: {}", ratio(m, true));
    }
    assert!((ratio(16, false).recip() - 1.005_561_73).abs() <= 5.1e-9);
}

#[test]
fn near_coefficients_are_free_space_less_the_images() {
    // π L = free space + (2d)² (-C + (S3/4)(R² + 2d²/3) + …): the lattice of images around a small square.
    const C: f64 = 3.900_264_920_001_955_9;
    const S3: f64 = 9.033_621_683_100_950;
    let n = 256;
    let coefficients = coefficients(&Love, n);
    let side = 1.0 / n as f64;
    for (i, j) in [(0_u8, 0_u8), (1, 0), (2, 1), (4, 4)] {
        let (x, y) = (f64::from(i) * side, f64::from(j) * side);
        let squared = x * x + y * y;
        let images = -C + 0.25 * S3 * (squared + side * side / 6.0);
        let expected = love_displacement(x, y, 0.5 * side) + side * side * images / PI;
        let value = coefficients[usize::from(j) * n + usize::from(i)];
        // The next terms are (9 S5/64 + 35 C4/64) R⁴ ≈ 3 R⁴, and 3 d⁴ from the size of the square.
        let next = side * side * 4.0 * (squared * squared + side.powi(4));
        assert!((value - expected).abs() <= next + 1e-17, "({i}, {j}): {value:e} against {expected:e}");
    }
}
