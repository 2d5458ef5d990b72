//! Tests of the kernels with tabulated values and closed forms.

use std::f64::consts::PI;
use std::path::Path;

use rc_core::testing::{check_kernel, quasi_random};
use rc_core::{DVec2, Grid, Kernel};
use rc_kernel::{Love, Spectral, love_alias_sum, love_displacement};
use rustfft::FftPlannerScalar;
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
    // The second table has distances and half sides over 20 decades.
    let (usual, decades) = (rows("love-square.csv"), rows("kernel-decades.csv"));
    assert_eq!((usual.len(), decades.len()), (77, 168), "the tables are complete");
    for row in usual.into_iter().chain(decades) {
        let (x, y, half_side, reference) = (row[0], row[1], row[2], row[3]);
        let value = love_displacement(DVec2::new(x, y), half_side);
        let error = (value / reference - 1.0).abs();
        // 1e-15, plus the rounding of the reference to a double and of this division.
        assert!(
            error <= 1.2e-15,
            "at ({x}, {y}), d = {half_side}: {value:e}, reference {reference:e}, off by {error:.1e}"
        );
        for (u, v) in [(-x, y), (x, -y), (y, x), (-y, -x)] {
            let mirrored = love_displacement(DVec2::new(u, v), half_side);
            assert!(mirrored.to_bits() == value.to_bits(), "not symmetric at ({u}, {v})");
        }
    }
}

#[test]
fn a_square_is_the_sum_of_its_quarters() {
    // The quarters are twice as far in their own units, so near and far forms check each other. Each has 1e-15.
    for i in 0..20_000 {
        let distance = 0.01 * 1000.0_f64.powf(quasi_random(i));
        // Rounded to a dyadic grid, on which the centres of the quarters are exact.
        let dyadic = |fraction: f64| (fraction * distance * 2.0_f64.powi(32)).round() / 2.0_f64.powi(32);
        let (x, y) = (dyadic(1.0), dyadic(quasi_random(7 * i + 3)));
        let quarters = [(0.5, 0.5), (0.5, -0.5), (-0.5, 0.5), (-0.5, -0.5)];
        let sum: f64 = quarters.iter().map(|(a, b)| love_displacement(DVec2::new(x + a, y + b), 0.5)).sum();
        let whole = love_displacement(DVec2::new(x, y), 1.0);
        let error = (sum / whole - 1.0).abs();
        assert!(error <= 2e-15, "at ({x}, {y}): whole {whole:e}, quarters {sum:e}, off by {error:.1e}");
    }
}

#[test]
fn displacement_is_smooth_where_the_series_takes_over() {
    // Third differences of a smooth function over 1e-6 are 1e-18. The remaining difference is rounding, eight times as
    // large as for a value.
    for y in [0.0, 1.0, 1.7, 2.5] {
        let at = |i: i32| love_displacement(DVec2::new(2.5 + 1e-6 * f64::from(i), y), 1.0);
        let jump = (at(1) - 3.0 * at(0) + 3.0 * at(-1) - at(-2)).abs() / at(0);
        assert!(jump <= 8e-15, "jump {jump:e} at y = {y}");
    }
}

#[test]
fn extreme_arguments_give_limits_and_no_panics() {
    let centre = 8.0 * (1.0 + 2.0_f64.sqrt()).ln() / PI;
    for scale in [1e-300, 1e-150, 1.0, 1e150, 1e300] {
        let value = love_displacement(DVec2::ZERO, scale) / scale;
        assert!((value / centre - 1.0).abs() <= 1e-15, "at the centre, d = {scale:e}: {value}");
    }
    let faint = love_displacement(DVec2::new(1e200, 0.0), 1.0) * 1e200;
    assert!((faint * PI / 4.0 - 1.0).abs() <= 1e-15, "monopole at R = 1e200: {faint}");
    assert!(love_displacement(DVec2::new(f64::INFINITY, 1.0), 1.0) == 0.0, "at infinity");
    for (x, y, half_side) in [(f64::NAN, 0.0, 1.0), (0.0, f64::NAN, 1.0), (9.0, f64::NAN, 1.0), (1.0, 1.0, f64::NAN)] {
        assert!(love_displacement(DVec2::new(x, y), half_side).is_nan(), "NaN in ({x}, {y}, {half_side}) is lost");
    }
}

/// Coefficients L between element (0, 0) and all others, the inverse transform of the symbol.
fn coefficients(kernel: &dyn Kernel, n: usize) -> Vec<f64> {
    let symbol = kernel.symbol(Grid::square(n).expect("grid"));
    let fold = |k: usize| k.min(n - k);
    let mut values: Vec<Complex64> =
        (0..n * n).map(|i| Complex64::new(symbol(fold(i % n), fold(i / n)) / (n * n) as f64, 0.0)).collect();
    let fft = FftPlannerScalar::new().plan_fft_inverse(n);
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
            // Measured: below 4e-14, for coefficients down to 1e-4 of the self coefficient.
            let error = (value / reference - 1.0).abs();
            assert!(error <= 1e-12, "n = {n}, ({i}, {j}): {value:e}, reference {reference:e}, off by {error:.1e}");
        }
    }
}

#[test]
fn love_symbol_reproduces_the_amplitude_ratios() {
    // Full contact of one wave on m elements per wavelength, relative to the continuous half-space. Compared with the
    // printed digits and with the converged alias sum.
    let ratio = |m: usize, both: bool| {
        let (grid, ky) = (Grid::square(m).expect("grid"), usize::from(both));
        let exact = Spectral.symbol(grid)(1, ky);
        let (fast, slow) = (Love.symbol(grid)(1, ky) / exact, love_alias_sum(grid, 1, ky) / exact);
        assert!((fast / slow - 1.0).abs() <= 4e-15, "{m} elements: {fast}, alias sum {slow}");
        fast
    };
    for (m, expected) in
        [(4, 0.958_597_55), (8, 0.981_595_96), (16, 0.994_469_03), (32, 0.998_504_50), (64, 0.999_612_21)]
    {
        assert!((ratio(m, false) - expected).abs() <= 5.1e-9, "{m} elements: {}", ratio(m, false));
    }
    for (m, expected) in [(8, 0.969_137_9), (16, 0.989_691_8), (32, 0.997_102_2)] {
        assert!((ratio(m, true) - expected).abs() <= 5.1e-8, "{m} x {m} elements: {}", ratio(m, true));
    }
    assert!((ratio(16, false).recip() - 1.005_561_73).abs() <= 5.1e-9, "stress amplitude of 16 elements");
}

/// π times the contribution of the images of a square at (x, y).
///
/// The square has area 1 and half side d. The result is to fourth order in distance over λ. It is the lattice field
/// -C + (S3/4) r² + (9/64) S5 r⁴ + (35/64) C4 r⁴ cos 4θ, averaged over the square.
fn images(x: f64, y: f64, d: f64) -> f64 {
    // 4 ζ(s/2) β(s/2) at s = 1 (with sign), 3, 5, and the lattice sum of cos 4θ/R⁵.
    const C: f64 = 3.900_264_920_001_956;
    const S3: f64 = 9.033_621_683_100_95;
    const S5: f64 = 5.090_258_233_665_483;
    const C4: f64 = 3.373_865_69;
    let (r2, d2) = (x * x + y * y, d * d);
    let second = r2 + 2.0 / 3.0 * d2;
    let fourth = r2 * r2 + 8.0 / 3.0 * r2 * d2 + 28.0 / 45.0 * d2 * d2;
    let angular = x.powi(4) - 6.0 * x * x * y * y + y.powi(4) - 4.0 / 15.0 * d2 * d2;
    -C + 0.25 * S3 * second + 9.0 / 64.0 * S5 * fourth + 35.0 / 64.0 * C4 * angular
}

#[test]
fn near_coefficients_are_free_space_less_the_images() {
    for n in [64, 256] {
        let coefficients = coefficients(&Love, n);
        let side = 1.0 / n as f64;
        for (i, j) in [(0_u8, 0_u8), (1, 0), (1, 1), (2, 1), (4, 4), (6, 0)] {
            let (x, y) = (f64::from(i) * side, f64::from(j) * side);
            let expected =
                love_displacement(DVec2::new(x, y), 0.5 * side) + side * side * images(x, y, 0.5 * side) / PI;
            let value = coefficients[usize::from(j) * n + usize::from(i)];
            // The sixth order is below 2 r⁶, with r up to the far corner of the square. The transform adds its
            // rounding.
            let next = side * side * 2.0 / PI * (x.hypot(y) + side / 2.0_f64.sqrt()).powi(6);
            let (allowed, error) = (next + 2e-16 * coefficients[0], (value - expected).abs());
            assert!(error <= allowed, "n = {n}, ({i}, {j}): {value:e} against {expected:e}, off by {error:.1e}");
        }
    }
}

/// Copies along x of a cell that is longer along y form a square.
///
/// Its side is then the unit of length.
#[test]
fn a_cell_longer_along_y_is_a_part_of_the_square_of_its_copies() {
    for (nx, ny, copies) in [(8, 24, 3), (10, 12, 3), (6, 48, 5)] {
        for kernel in [&Love as &dyn Kernel, &Spectral] {
            let part = kernel.symbol(Grid::in_cell(nx, ny, copies as f64).expect("a grid"));
            let whole = kernel.symbol(Grid::new(copies * nx, ny).expect("a grid"));
            for (kx, ky) in (0..=nx / 2).flat_map(|kx| (0..=ny / 2).map(move |ky| (kx, ky))).skip(1) {
                let (value, of_copies) = (part(kx, ky), copies as f64 * whole(copies * kx, ky));
                let name = kernel.name();
                assert!((value / of_copies - 1.0).abs() < 1e-13, "{name} ({kx}, {ky}): {value}, of copies {of_copies}");
            }
        }
    }
}
