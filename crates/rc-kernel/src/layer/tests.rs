//! Tests of the factor of a layer, its limits, and its kernels.
//!
//! The factor is compared with the equations of elasticity.

use rc_core::testing::check_kernel;

use super::*;

const RATIOS: [f64; 6] = [-0.5, 0.0, 0.3, 0.45, 0.499, 0.5];

fn layer(thickness: f64, poisson: f64) -> Layer {
    Layer { thickness, poisson }
}

/// Displacement u_z of the surface of a layer under the pressure cos(q x).
///
/// It follows from the equations of elasticity. The layer has thickness 1 and E* = 1. The two potentials of Papkovich
/// and Neuber in plane strain have four constants, which follow from four conditions.
fn of_boundary_values(q: f64, poisson: f64) -> f64 {
    let shear = 0.5 * (1.0 - poisson);
    let kappa = 3.0 - 4.0 * poisson;
    // 2G u_x = sin(qx) (-q F - q z P), 2G u_z = cos(qx) (F' + z P' - κ P). F and P consist of exp(±q(z - 1/2)), and z
    // increases from the base upwards.
    let potentials = |z: f64| {
        let [up, down] = [(q * (z - 0.5)).exp(), (-q * (z - 0.5)).exp()];
        [[up, q * up, q * q * up], [down, -q * down, q * q * down]]
    };
    // Rows are the coefficients of the two waves of F and of the two waves of P.
    let row = |of_f: &dyn Fn([f64; 3]) -> f64, of_p: &dyn Fn([f64; 3]) -> f64, z: f64| {
        let [up, down] = potentials(z);
        [of_f(up), of_f(down), of_p(up), of_p(down)]
    };
    let along = |z: f64| row(&|[f, ..]| -q * f, &|[p, ..]| -q * z * p, z);
    let across = |z: f64| row(&|[_, f, _]| f, &|[p, slope, _]| z * slope - kappa * p, z);
    // σ_zz = cos(qx) (F'' + z P'' - 2(1-ν) P'), σ_xz = -q sin(qx) (F' + z P' - (1-2ν) P).
    let normal = row(&|[.., f]| f, &|[_, slope, bend]| bend - 2.0 * (1.0 - poisson) * slope, 1.0);
    let tangential = row(&|[_, f, _]| -q * f, &|[p, slope, _]| -q * (slope - (1.0 - 2.0 * poisson) * p), 1.0);
    let constants = eliminate([along(0.0), across(0.0), normal, tangential], [0.0, 0.0, -1.0, 0.0]);
    let lifted: f64 = across(1.0).iter().zip(constants).map(|(a, c)| a * c).sum();
    -lifted / (2.0 * shear)
}

/// Gaussian elimination with pivots.
fn eliminate(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> [f64; 4] {
    for i in 0..4 {
        let pivot = (i..4).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs())).expect("rows");
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        for row in i + 1..4 {
            let factor = matrix[row][i] / matrix[i][i];
            let pivot_row = matrix[i];
            for (value, pivot) in matrix[row].iter_mut().zip(pivot_row).skip(i) {
                *value -= factor * pivot;
            }
            right[row] -= factor * right[i];
        }
    }
    let mut solved = [0.0; 4];
    for i in (0..4).rev() {
        let known: f64 = (i + 1..4).map(|column| matrix[i][column] * solved[column]).sum();
        solved[i] = (right[i] - known) / matrix[i][i];
    }
    solved
}

#[test]
fn the_factor_solves_the_equations_of_the_layer() {
    for poisson in RATIOS {
        for xi in [0.05, 0.3, 0.49, 0.51, 1.0, 2.0, 5.0] {
            let (found, expected) = (2.0 / xi * layer(1.0, poisson).factor(xi), of_boundary_values(xi, poisson));
            // Elimination loses digits for long waves, whose displacement is small.
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-9, "ν = {poisson}, ξ = {xi}: {found} for {expected}, off by {error:e}");
        }
    }
}

#[test]
fn the_factor_is_that_of_columns_and_of_the_half_space_in_its_limits() {
    for poisson in RATIOS {
        let layer = layer(1.0, poisson);
        let (thin, xi) = (layer.factor(1e-4), 1e-4);
        let column = 0.5 * xi * layer.uniform_displacement();
        let bent = 2.0 / 3.0 * xi.powi(3);
        let expected = if poisson < 0.5 { column } else { bent };
        assert!((thin / expected - 1.0).abs() < 2e-5, "ν = {poisson}: {thin:e} for {expected:e}");
        assert!((layer.factor(20.0) - 1.0).abs() < 1e-13 && (layer.factor(1e4) - 1.0).abs() < 1e-15, "ν = {poisson}");
        for xi in [0.1, 0.5, 0.7, 3.0, 9.0] {
            let (excess, difference) = (layer.excess(xi), layer.factor(xi) - 1.0);
            assert!((excess - difference).abs() < 1e-15, "ν = {poisson}, ξ = {xi}: {excess} and {difference}");
        }
        // The two formulas agree where one replaces the other.
        let [before, after] = [SERIES * (1.0 - 1e-12), SERIES].map(|xi| layer.factor(xi));
        assert!((before / after - 1.0).abs() < 1e-11, "ν = {poisson}: {before} and {after}");
    }
}

/// E of a uniaxial compression is E (1-ν)/((1+ν)(1-2ν)), with E = E* (1-ν²).
#[test]
fn a_uniform_pressure_compresses_columns() {
    for poisson in RATIOS {
        let young = 1.0 - poisson * poisson;
        let expected = 0.3 * (1.0 + poisson) * (1.0 - 2.0 * poisson) / ((1.0 - poisson) * young);
        let found = LoveLayer(layer(0.3, poisson)).uniform_displacement().expect("a base");
        assert!((found - expected).abs() < 1e-15, "ν = {poisson}: {found} for {expected}");
    }
}

#[test]
fn layers_meet_the_contract_of_kernels() {
    for (thickness, poisson) in [(1.0, 0.3), (0.1, 0.5), (0.03, 0.0)] {
        check_kernel(&LoveLayer(layer(thickness, poisson)));
        check_kernel(&SpectralLayer(layer(thickness, poisson)));
    }
}

#[test]
fn a_thick_layer_is_the_half_space() {
    let grid = Grid::square(32).expect("a grid");
    let (thick, half_space) = (layer(4.0, 0.3), [&Love as &dyn Kernel, &Spectral]);
    for (layer, half_space) in [&LoveLayer(thick) as &dyn Kernel, &SpectralLayer(thick)].into_iter().zip(half_space) {
        let (layer, half_space) = (layer.symbol(grid), half_space.symbol(grid));
        for (kx, ky) in [(1, 0), (3, 7), (16, 16)] {
            assert!((layer(kx, ky) / half_space(kx, ky) - 1.0).abs() < 1e-12, "({kx}, {ky})");
        }
    }
}

/// The plain sum over aliases of the whole response. Its slowly converging part is summed for the half-space too.
#[test]
fn the_symbol_is_the_sum_over_aliases() {
    const REACH: i64 = 400;
    for (nx, ny, ratio, thickness) in [(16, 16, 1.0, 0.02), (16, 16, 1.0, 0.2), (12, 9, 0.5, 0.05)] {
        let grid = Grid::in_cell(nx, ny, ratio).expect("a grid");
        let layer = layer(thickness, 0.3);
        let (found, half_space) = (LoveLayer(layer), Love.symbol(grid));
        let found = found.symbol(grid);
        let spacing = grid.spacing();
        let sinc = |t: f64| if t == 0.0 { 1.0 } else { t.sin() / t };
        for (kx, ky) in [(1, 0), (0, 3), (5, 4), (nx / 2, ny / 2)] {
            let mut difference = 0.0;
            for (m, n) in (-REACH..=REACH).flat_map(|m| (-REACH..=REACH).map(move |n| (m, n))) {
                let qx = TAU * (kx as f64 / (nx as f64 * spacing.x) + m as f64 / spacing.x);
                let qy = TAU * (ky as f64 / (ny as f64 * spacing.y) + n as f64 / spacing.y);
                let q = qx.hypot(qy);
                let weight = sinc(0.5 * qx * spacing.x) * sinc(0.5 * qy * spacing.y);
                difference += 2.0 / q * (layer.factor(q * thickness) - 1.0) * weight;
            }
            let expected = half_space(kx, ky) + difference;
            let error = (found(kx, ky) - expected).abs() / half_space(kx, ky);
            assert!(error < 1e-13, "({kx}, {ky}) on {grid}, thickness {thickness}: off by {error:e}");
        }
    }
}
