//! An elastic layer, bonded to a rigid or an elastic base, in place of the half-space.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use rc_core::{Complex64, ComplexSymbol, DVec2, EdgeBias, Grid, Kernel, Sliding, SplitByScale, Symbol};

use crate::curvature::curvature;
use crate::{Love, Spectral};

/// A layer that is bonded to a base and loaded without friction.
///
/// Units are λ and E* = E/(1-ν²) of the layer. A pressure wave of wavenumber q displaces its surface by 2/(E* q) · M(q
/// d). With ξ = q d, the ratio of shear moduli μ = G/G2, k = 3-4ν and k2 = 3-4ν2, where the base has the index 2,
///
/// ```text
/// M(ξ) = [1 + 4κξ exp(-2ξ) - λκ exp(-4ξ)] / [1 - (λ + κ + 4κξ²) exp(-2ξ) + λκ exp(-4ξ)]
/// λ = (μ k2 - k)/(1 + μ k2),   κ = (μ - 1)/(μ + k)
/// ```
///
/// On a rigid base, μ = 0 and
///
/// ```text
/// M(ξ) = [(3-4ν) sinh 2ξ - 2ξ] / [(3-4ν) cosh 2ξ + 2ξ² + 5 - 12ν + 8ν²]
/// ```
///
/// Short waves have M → 1, as for the half-space. On a rigid base, long waves have M → ξ (1-2ν)/(2(1-ν)²). There each
/// column of the layer is a spring, and a pressure of E* causes [`Layer::uniform_displacement`]. An incompressible layer
/// (ν = 1/2) has M → 2ξ³/3, and a uniform pressure does not displace it. On an elastic base, long waves see the base, M
/// → E*/E2*.
///
/// *Accuracy*: a few roundings, relative to M (test `the_factor_is_that_of_transfer_matrices`).
///
/// *Sources*: R. H. Bentall, K. L. Johnson, *Int. J. Mech. Sci.* 10 (1968) 637-663. For any layer and substrate: T. C.
/// O'Sullivan, R. B. King, *J. Tribol.* 110 (1988) 235-240. On a rigid base in this form: G. Carbone, L. Mangialardi,
/// *J. Mech. Phys. Solids* 56 (2008) 684-706.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness d > 0, in λ.
    pub thickness: f64,
    /// Poisson's ratio ν of the layer, above -1 and at most 1/2.
    pub poisson: f64,
    /// The elastic half-space below the layer. `None` for a rigid base.
    pub substrate: Option<Substrate>,
}

/// An elastic half-space below a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Substrate {
    /// E2* > 0, in units of E* of the layer.
    pub modulus: f64,
    /// Poisson's ratio ν2 of the substrate, above -1 and at most 1/2.
    pub poisson: f64,
}

/// What the interface below a layer makes of waves that reach it: λ and κ of [`Layer`], and differences of them.
///
/// The differences are free of cancellation.
#[derive(Clone, Copy)]
struct Interface {
    lambda: f64,
    kappa: f64,
    /// 1 - λ, 1 + λ, 1 - κ and 1 - λκ.
    less_lambda: f64,
    plus_lambda: f64,
    less_kappa: f64,
    less_product: f64,
}

impl Interface {
    /// Whether both sides are one material.
    fn is_absent(&self) -> bool {
        self.lambda == 0.0 && self.kappa == 0.0
    }

    /// M(ξ) for ξ ≥ 0.
    fn factor(&self, xi: f64) -> f64 {
        let Self { lambda, kappa, plus_lambda, less_product, .. } = *self;
        let decay = (-2.0 * xi).exp();
        let above = if xi < SERIES {
            // The same, without the cancellation that long waves would cause.
            less_product + 2.0 * kappa * decay * (2.0 * xi * plus_lambda + lambda * sinh_minus_argument(2.0 * xi))
        } else {
            1.0 + 4.0 * kappa * xi * decay - lambda * kappa * decay * decay
        };
        above / self.denominator(xi)
    }

    /// The denominator of M.
    fn denominator(&self, xi: f64) -> f64 {
        let Self { lambda, kappa, less_lambda, less_kappa, .. } = *self;
        let decay = (-2.0 * xi).exp();
        if lambda <= 0.0 || kappa <= 0.0 {
            return (1.0 - lambda * decay) * (1.0 - kappa * decay) - 4.0 * kappa * xi * xi * decay;
        }
        // A sum of positive terms, since a stiff layer bends like a plate under long waves.
        let risen = -(-2.0 * xi).exp_m1();
        let bent =
            if xi < SERIES { square_of_sinh_minus_square(xi) * decay } else { 0.25 * risen * risen - xi * xi * decay };
        less_lambda * less_kappa
            + lambda * less_kappa * risen
            + kappa * less_lambda * (risen - 4.0 * xi * xi * decay)
            + 4.0 * kappa * lambda * bent
    }

    /// M(ξ) - 1, with the same relative error where it is small.
    fn excess(&self, xi: f64) -> f64 {
        if self.is_absent() {
            return 0.0;
        }
        if xi < SERIES {
            return self.factor(xi) - 1.0;
        }
        let (Self { lambda, kappa, .. }, decay) = (*self, (-2.0 * xi).exp());
        let above = decay * (4.0 * kappa * xi * (1.0 + xi) + lambda + kappa - 2.0 * lambda * kappa * decay);
        above / self.denominator(xi)
    }

    /// A value of ξ beyond which |M - 1| is at most `tolerance`.
    fn deviates_below(&self, tolerance: f64) -> f64 {
        let Self { lambda, kappa, .. } = *self;
        if self.is_absent() {
            return 0.0;
        }
        // The magnitudes of the terms of the excess. Its denominator differs from 1 by no more than their sum. Both
        // decrease from here on, and are zero at the end.
        let terms = |xi: f64| {
            let decay = (-2.0 * xi).exp();
            let [lambda, kappa] = [lambda.abs(), kappa.abs()];
            decay * (4.0 * kappa * xi * (1.0 + xi) + lambda + kappa + 2.0 * lambda * kappa * decay)
        };
        let allowed = tolerance / (1.0 + tolerance);
        let [mut low, mut high] = [2.0, 400.0];
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            if terms(middle) <= allowed { high = middle } else { low = middle }
        }
        high
    }
}

impl Layer {
    /// A layer on a rigid base.
    #[must_use]
    pub const fn on_rigid_base(thickness: f64, poisson: f64) -> Self {
        Self { thickness, poisson, substrate: None }
    }

    /// The thickness in sides of an element of `grid`.
    fn in_elements(self, grid: Grid) -> f64 {
        let sides = grid.spacing();
        self.thickness / (sides.x * sides.y).sqrt()
    }

    fn interface(self) -> Interface {
        let k = 3.0 - 4.0 * self.poisson;
        let Substrate { modulus, poisson } =
            self.substrate.unwrap_or(Substrate { modulus: f64::INFINITY, poisson: 0.5 });
        let (k2, mu) = (3.0 - 4.0 * poisson, (1.0 - self.poisson) / ((1.0 - poisson) * modulus));
        let [below, above] = [1.0 + mu * k2, mu + k];
        Interface {
            lambda: (mu * k2 - k) / below,
            kappa: (mu - 1.0) / above,
            less_lambda: (1.0 + k) / below,
            plus_lambda: (2.0 * mu * k2 - 2.0 * (1.0 - 2.0 * self.poisson)) / below,
            less_kappa: (1.0 + k) / above,
            less_product: mu / above * ((1.0 + k) * (1.0 + k2) / below),
        }
    }

    /// The factor M(ξ) for ξ ≥ 0.
    ///
    /// It tends to 1 for large ξ. On a rigid base it is 0 at 0, and positive beyond. The relative error is a few
    /// roundings.
    #[must_use]
    pub fn factor(self, xi: f64) -> f64 {
        self.interface().factor(xi)
    }

    /// M(0), the displacement of the base relative to that of the material of the layer.
    fn softness(self) -> f64 {
        self.substrate.map_or(0.0, |substrate| substrate.modulus.recip())
    }

    /// Displacement that an error of the pressure at an edge causes, relative to the half-space.
    fn stiffening(self, grid: Grid) -> f64 {
        1.0 - (1.0 - self.softness()) * (-0.25 * self.in_elements(grid)).exp()
    }

    /// Part of the corrections for layers on a rigid base that applies: 0 for one material, and 1 for a rigid base.
    fn contrast(self) -> f64 {
        (1.0 - self.softness()) / (1.0 + self.softness())
    }

    /// Displacement of the surface under a uniform pressure of E*, in λ: d (1-2ν)/(1-ν)².
    ///
    /// With E* = E/(1-ν²) this is the uniaxial compression d (1+ν)(1-2ν)/((1-ν) E) per unit pressure. `None` on an
    /// elastic substrate, whose mean displacement is not finite and is left out (Eq. 3).
    #[must_use]
    pub fn uniform_displacement(self) -> Option<f64> {
        let compressed = || self.thickness * (1.0 - 2.0 * self.poisson) / (1.0 - self.poisson).powi(2);
        self.substrate.is_none().then(compressed)
    }
}

/// The short waves see the half-space of the layer's material: M - 1 decreases like exp(-2ξ).
impl SplitByScale for Layer {
    fn deviation(&self, q: f64) -> f64 {
        2.0 / q * self.interface().excess(q * self.thickness)
    }

    fn deviates_below(&self, tolerance: f64) -> f64 {
        self.interface().deviates_below(tolerance) / self.thickness
    }

    fn curvature(&self) -> f64 {
        let interface = self.interface();
        // Long waves bend a stiff layer on a soft substrate like a plate on an elastic base.
        let length = self.softness().cbrt().clamp(1.0, 1e6);
        // The deviation is (λ/d) 2/ξ (M - 1).
        2.0 * curvature(|xi| interface.excess(xi), length) / self.thickness
    }
}

/// Below this ξ, sums of exponentials would cancel.
const SERIES: f64 = 0.5;

/// sinh y - y for |y| ≤ 1, from its series.
fn sinh_minus_argument(y: f64) -> f64 {
    let squared = y * y;
    // The last term is below 1e-17 of the first.
    let sum = (1..=8).rev().fold(0.0, |sum, n: u32| (1.0 + sum) * squared / f64::from(2 * n * (2 * n + 1)));
    y * sum
}

/// sinh² y - y² for |y| ≤ 1/2, from the series of cosh 2y.
fn square_of_sinh_minus_square(y: f64) -> f64 {
    let squared = 4.0 * y * y;
    let sum = (2..=9).rev().fold(0.0, |sum, n: u32| (1.0 + sum) * squared / f64::from(2 * n * (2 * n - 1)));
    0.25 * squared * sum
}

/// Minimum thickness of a layer, in elements.
///
/// For a thinner layer, which acts like a bed of springs on the grid, the sum over aliases would be long.
pub const THINNEST_LAYER: f64 = 0.25;

/// [`Love`] on a layer: pressures that are constant on elements, displacements at element centres.
///
/// The symbol is that of [`Love`] plus Σ 2/|q| (M(|q|d) - 1) sinc(q_x hx/2) sinc(q_y hy/2) over the aliases q of the
/// wave. These terms decrease like exp(-2|q|d), so few aliases count.
///
/// *Accuracy*: every value is within 1e-13 of the value of the half-space (test `the_symbol_is_the_sum_over_aliases`).
///
/// *Cost*: that of [`Love`], plus about 10 ns for each term. A layer of 4 elements has 1 to 4 terms, a layer of
/// [`THINNEST_LAYER`] has 800.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoveLayer(pub Layer);

/// The value of ξ at which exp(-2ξ), relative to the largest term, is negligible.
const NEGLIGIBLE_XI: f64 = 18.5;

impl Kernel for LoveLayer {
    fn name(&self) -> &'static str {
        "love"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let (layer, interface) = (self.0, self.0.interface());
        let (half_space, spacing) = (Love.symbol(grid), grid.spacing());
        let farthest = NEGLIGIBLE_XI / layer.thickness;
        let along = |k: usize, n: usize, side: f64| Aliases::new(k, n, side, farthest);
        let columns: Vec<Aliases> = (0..=grid.nx() / 2).map(|k| along(k, grid.nx(), spacing.x)).collect();
        let rows: Vec<Aliases> = (0..=grid.ny() / 2).map(|k| along(k, grid.ny(), spacing.y)).collect();
        Box::new(move |kx, ky| {
            if kx == 0 && ky == 0 {
                return 0.0;
            }
            let mut sum = half_space(kx, ky);
            for (qy, wy) in rows[ky].terms() {
                for (qx, wx) in columns[kx].terms() {
                    let q = (qx * qx + qy * qy).sqrt();
                    // Aliases of the zero wave along both axes are omitted, because the sinc of a whole wave is zero.
                    if q > 0.0 && q < farthest {
                        sum += 2.0 / q * interface.excess(q * layer.thickness) * wx * wy;
                    }
                }
            }
            sum
        })
    }

    fn symbol_while<'a>(&'a self, sliding: &Sliding, grid: Grid) -> ComplexSymbol<'a> {
        let (layer, interface) = (self.0, self.0.interface());
        let (half_space, spacing) = (Love.symbol_while(sliding, grid), grid.spacing());
        let (farthest, sliding) = (NEGLIGIBLE_XI / layer.thickness, sliding.clone());
        let along = |k: usize, n: usize, side: f64| Aliases::new(k, n, side, farthest);
        let columns: Vec<Aliases> = (0..=grid.nx() / 2).map(|k| along(k, grid.nx(), spacing.x)).collect();
        let rows: Vec<Aliases> = (0..=grid.ny() / 2).map(|k| along(k, grid.ny(), spacing.y)).collect();
        Box::new(move |kx, ky| {
            if kx == 0 && ky == 0 {
                return Complex64::ZERO;
            }
            let [sx, sy] = [kx, ky].map(|k| if k < 0 { -1.0 } else { 1.0 });
            let mut sum = half_space(kx, ky);
            for (qy, wy) in rows[ky.unsigned_abs() as usize].terms() {
                for (qx, wx) in columns[kx.unsigned_abs() as usize].terms() {
                    let q = DVec2::new(sx * qx, sy * qy);
                    let length = q.length();
                    if length > 0.0 && length < farthest {
                        let excess = interface.excess(length * layer.thickness);
                        sum += sliding.compliance(q) * (2.0 / length * excess * wx * wy);
                    }
                }
            }
            sum
        })
    }

    /// That of [`Love`], and terms that vanish for layers of several elements.
    ///
    /// A layer thinner than an element responds like a bed of springs. At an edge, the pressure is then proportional to
    /// the distance, and the edge is located too far out. Inside, the pressure of an element is that at its centre.
    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        let (half_space, thickness) = (Love.edge_bias(grid), self.0.in_elements(grid));
        // On an elastic substrate, the corrections are smaller, and the errors are those of the corrections.
        let (contrast, size) = (self.0.contrast().max(0.0), self.0.contrast().abs());
        let [shift, of_error] = [contrast, size].map(|part| part * 0.105 * (-1.43 * thickness).exp());
        let springs = contrast * (-thickness / 2.2).exp();
        EdgeBias {
            per_edge: half_space.per_edge + shift,
            per_edge_error: half_space.per_edge_error + 0.4 * of_error + 0.01 * size * (-thickness / 4.0).exp(),
            per_difference: half_space.per_difference + 0.12 * springs,
            per_second_difference: half_space.per_second_difference - 0.08 * springs,
            per_difference_error: half_space.per_difference_error + 0.07 * size * (-thickness / 3.0).exp(),
            gap_errors: half_space.gap_errors.map(|error| error * self.0.stiffening(grid)),
            ..half_space
        }
    }

    fn split(&self) -> Option<&dyn SplitByScale> {
        Some(&self.0)
    }

    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(&Love)
    }

    fn uniform_displacement(&self) -> Option<f64> {
        self.0.uniform_displacement()
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }
}

/// Aliases along one axis, nearest first. Each is a wavenumber and the mean of its wave over an element.
struct Aliases(Vec<(f64, f64)>);

impl Aliases {
    fn new(k: usize, n: usize, side: f64, farthest: f64) -> Self {
        let own = TAU * k as f64 / (n as f64 * side);
        let sampling = TAU / side;
        let reach = (farthest / sampling).ceil() as i64;
        let term = |m: i64| {
            let q = own + sampling * m as f64;
            let half = 0.5 * q * side;
            let mean = match (k, m) {
                (0, 0) => 1.0,
                (0, _) => 0.0,
                _ => half.sin() / half,
            };
            (q, mean)
        };
        let near = (-reach..=reach).map(term);
        Self(near.filter(|&(q, mean)| mean != 0.0 && q.abs() < farthest).collect())
    }

    fn terms(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.0.iter().copied()
    }
}

/// [`Spectral`] on a layer: waves instead of elements, 2/(E* |q|) M(|q|d) without aliases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralLayer(pub Layer);

impl Kernel for SpectralLayer {
    fn name(&self) -> &'static str {
        "spectral"
    }

    fn symbol(&self, grid: Grid) -> Symbol<'_> {
        let (interface, thickness) = (self.0.interface(), self.0.thickness);
        Box::new(move |kx, ky| match grid.waves(kx, ky) {
            0.0 => 0.0,
            waves => interface.factor(TAU * waves * thickness) / (PI * waves),
        })
    }

    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(&Spectral)
    }

    fn uniform_displacement(&self) -> Option<f64> {
        self.0.uniform_displacement()
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }

    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        let (half_space, thickness) = (Spectral.edge_bias(grid), self.0.in_elements(grid));
        let size = self.0.contrast().abs();
        let [shift, of_error] = [self.0.contrast().max(0.0), size].map(|part| part * 0.03 * (-1.4 * thickness).exp());
        EdgeBias {
            per_edge: half_space.per_edge + shift,
            per_edge_error: half_space.per_edge_error + of_error,
            per_difference_error: 0.018 * size * (-thickness / 6.0).exp(),
            gap_errors: half_space.gap_errors.map(|error| error * self.0.stiffening(grid)),
            ..half_space
        }
    }
}

#[cfg(test)]
mod double;
#[cfg(test)]
mod tests;
