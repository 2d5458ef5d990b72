//! Tests of the factor of a layer, its limits, and its kernels.
//!
//! The factor is compared with the equations of elasticity, solved by transfer matrices.

use rc_core::testing::check_kernel;

use super::double::Double;
use super::*;

const RATIOS: [f64; 6] = [-0.5, 0.0, 0.3, 0.45, 0.499, 0.5];

fn layer(thickness: f64, poisson: f64) -> Layer {
    Layer::on_rigid_base(thickness, poisson)
}

fn coating(thickness: f64, poisson: f64, substrate: Substrate) -> Layer {
    Layer { substrate: Some(substrate), ..layer(thickness, poisson) }
}

type Matrix = [[Double; 4]; 4];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).fold(Double::ZERO, |sum, k| sum + a[i][k] * b[k][j])))
}

fn unit(value: f64) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { value.into() } else { Double::ZERO }))
}

fn sum(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j]))
}

/// The equations of plane strain for waves with q = 1, as d/dz of the state (U, W, T, S).
///
/// u_x = U sin x, u_z = W cos x, σ_xz = T sin x, σ_zz = S cos x: Hooke's law and equilibrium.
fn equations(shear: f64, poisson: f64) -> Matrix {
    let (one, nu) = (Double::from(1.0), Double::from(poisson));
    let rest = one - nu;
    let shear = Double::from(shear);
    // The ratio of λ to λ + 2G, and the reciprocal of the latter.
    let (ratio, softness) = (nu / rest, (one - nu - nu) / ((shear + shear) * rest));
    let zero = Double::ZERO;
    [
        [zero, one, one / shear, zero],
        [zero - ratio, zero, zero, softness],
        [(shear + shear) / rest, zero, zero, ratio],
        [zero, zero, zero - one, zero],
    ]
}

/// The state at the top of a layer of this thickness as a matrix times that at its bottom: exp(A d).
fn transfer(equations: &Matrix, thickness: f64) -> Matrix {
    const HALVINGS: i32 = 12;
    let step = Double::from(thickness * 0.5_f64.powi(HALVINGS));
    let step: Matrix = equations.map(|row| row.map(|value| value * step));
    let mut transfer = unit(1.0);
    for n in (1..=16).rev() {
        let part = product(&step, &transfer).map(|row| row.map(|value| value / Double::from(f64::from(n))));
        transfer = sum(&unit(1.0), &part);
    }
    (0..HALVINGS).fold(transfer, |transfer, _| product(&transfer, &transfer))
}

/// 2 M/ξ, the displacement of the surface of a layer with E* = 1 under the pressure cos x, where d = ξ.
///
/// Two states at the bottom are possible: no displacement on a rigid base, waves that decay downwards on an elastic
/// one. The stresses at the surface choose the sum of them.
fn displacement(layer: Layer) -> f64 {
    let bottom = match layer.substrate {
        None => unit(1.0),
        Some(Substrate { modulus, poisson }) => {
            let equations = equations(0.5 * (1.0 - poisson) * modulus, poisson);
            // All waves are combinations of (1 + z) exp(±z). This removes those that grow downwards.
            let rising = sum(&equations, &unit(1.0));
            product(&rising, &rising)
        }
    };
    let states = product(&transfer(&equations(0.5 * (1.0 - layer.poisson), layer.poisson), layer.thickness), &bottom);
    let [first, second] = [2, 3];
    let [[t, also_t], [s, also_s], [w, also_w]] = [2, 3, 1].map(|row: usize| [states[row][first], states[row][second]]);
    // T = 0 and S = -1.
    let determinant = t * also_s - also_t * s;
    let lifted = (also_t * w - t * also_w) / determinant;
    -lifted.0
}

/// For long waves, a rigid base or a ratio of moduli of 1e6, the reference loses up to 18 of its 31 digits.
#[test]
fn the_factor_is_that_of_transfer_matrices() {
    let mut n = 0;
    let mut assert_same = |layer: Layer| {
        let (found, expected) = (2.0 * layer.factor(layer.thickness), displacement(layer));
        let error = (found / expected - 1.0).abs();
        assert!(error < 1e-12, "{layer:?}: {found} for {expected}, off by {error:e}");
        n += 1;
    };
    for poisson in RATIOS {
        for xi in [1e-3, 0.01, 0.05, 0.3, 0.499, 0.5, 0.8, 1.0, 2.0, 5.0, 15.0] {
            assert_same(layer(xi, poisson));
            for exponent in -6..=6 {
                for of_substrate in RATIOS {
                    let modulus = 1.3 * 10.0_f64.powi(exponent);
                    assert_same(coating(xi, poisson, Substrate { modulus, poisson: of_substrate }));
                }
            }
        }
    }
    assert!(n > 5000, "{n} layers");
}

#[test]
fn a_coating_is_its_substrate_for_long_waves_and_its_material_for_short_ones() {
    for (poisson, of_substrate) in [(0.3, 0.3), (0.5, 0.0), (0.2, 0.45)] {
        for modulus in [1e-6, 0.1, 1.0, 7.0, 1e6] {
            let layer = coating(1.0, poisson, Substrate { modulus, poisson: of_substrate });
            let long = layer.factor(1e-9) * modulus;
            assert!((long - 1.0).abs() < 1e-2, "{layer:?}: {long}");
            assert!((layer.factor(0.0) * modulus - 1.0).abs() < 1e-14 && (layer.factor(30.0) - 1.0).abs() < 1e-14);
            assert_eq!(layer.uniform_displacement(), None);
        }
        let stiff = coating(1.0, poisson, Substrate { modulus: 1e12, poisson: of_substrate });
        let same = coating(1.0, poisson, Substrate { modulus: 1.0, poisson });
        for xi in [0.05, 0.3, 1.0, 4.0] {
            let [stiff, rigid] = [stiff, layer(1.0, poisson)].map(|layer| layer.factor(xi));
            assert!((stiff / rigid - 1.0).abs() < 1e-6, "ν = {poisson}, ξ = {xi}: {stiff} and {rigid}");
            assert!((same.factor(xi) - 1.0).abs() < 1e-15 && same.interface().excess(xi).abs() < 1e-15);
        }
        assert_eq!((same.deviates_below(0.0), same.curvature()), (0.0, 0.0));
    }
}

/// The deviation is at most the tolerance from the announced wave on, and not far before it.
#[test]
fn deviations_end_where_they_are_said_to_end() {
    let soft = Substrate { modulus: 1e-3, poisson: 0.2 };
    for layer in [layer(0.2, 0.5), layer(0.2, 0.0), coating(0.2, 0.3, soft)] {
        for tolerance in [1e-3, 1e-6, 1e-10] {
            let below = layer.deviates_below(tolerance);
            let relative = |q: f64| 0.5 * q * layer.deviation(q).abs();
            assert!((1..100).all(|n| relative(below * (1.0 + 0.03 * f64::from(n))) <= tolerance), "{layer:?}");
            assert!(relative(0.97 * below) > tolerance, "{layer:?}, {tolerance:e}: {}", relative(0.97 * below));
        }
        assert!(layer.deviates_below(0.0).is_finite());
    }
}

/// The pressure that bends the surface at the origin most presses where ∂²κ/∂x² is positive.
///
/// κ is summed over waves of a cell that is much wider than the layer is thick.
#[test]
fn no_pressure_bends_the_surface_more_than_the_bound() {
    const N: usize = 96;
    let soft = Substrate { modulus: 0.1, poisson: 0.3 };
    for layer in [layer(0.05, 0.5), layer(0.05, 0.3), coating(0.05, 0.3, soft)] {
        let waves: Vec<f64> = (0..N).map(|k| TAU * (if 2 * k < N { k as f64 } else { k as f64 - N as f64 })).collect();
        let cosines = |i: usize, k: usize| (TAU * ((i * k) % N) as f64 / N as f64).cos();
        // The transform is separated into both axes. Its value for each k_x and y comes first.
        let transform = |kx: usize, ky: usize| {
            let q = waves[kx].hypot(waves[ky]);
            if q == 0.0 { 0.0 } else { -waves[kx].powi(2) * layer.deviation(q) }
        };
        let rows: Vec<Vec<f64>> = (0..N)
            .map(|kx| (0..N).map(|y| (0..N).map(|ky| transform(kx, ky) * cosines(y, ky)).sum()).collect())
            .collect();
        let bent = (0..N).flat_map(|x| {
            let rows = &rows;
            (0..N).map(move |y| (0..N).map(|kx| rows[kx][y] * cosines(x, kx)).sum::<f64>().max(0.0))
        });
        let (bent, bound) = (bent.sum::<f64>() / (N * N) as f64, layer.curvature());
        assert!(bent <= bound && bound < 1.6 * bent, "{layer:?}: {bent} for the bound {bound}");
    }
}

#[test]
fn the_factor_is_that_of_columns_and_of_the_half_space_in_its_limits() {
    for poisson in RATIOS {
        let layer = layer(1.0, poisson);
        let (thin, xi) = (layer.factor(1e-4), 1e-4);
        let column = 0.5 * xi * layer.uniform_displacement().expect("a base");
        let bent = 2.0 / 3.0 * xi.powi(3);
        let expected = if poisson < 0.5 { column } else { bent };
        assert!((thin / expected - 1.0).abs() < 2e-5, "ν = {poisson}: {thin:e} for {expected:e}");
        assert!((layer.factor(20.0) - 1.0).abs() < 1e-13 && (layer.factor(1e4) - 1.0).abs() < 1e-15, "ν = {poisson}");
        for xi in [0.1, 0.5, 0.7, 3.0, 9.0] {
            let (excess, difference) = (layer.interface().excess(xi), layer.factor(xi) - 1.0);
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
        let substrate = Substrate { modulus: 0.1, poisson: 0.4 };
        check_kernel(&LoveLayer(coating(thickness, poisson, substrate)));
        check_kernel(&SpectralLayer(coating(thickness, poisson, substrate)));
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
