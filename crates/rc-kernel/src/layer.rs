//! An elastic layer, bonded to a rigid base, in place of the half-space.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use rc_core::{Complex64, ComplexSymbol, DVec2, EdgeBias, Grid, Kernel, Sliding, Symbol};

use crate::{Love, Spectral};

/// A layer that is bonded to a rigid base and loaded without friction.
///
/// Units are λ and E* = E/(1-ν²) of the layer. A pressure wave of wavenumber q displaces its surface by 2/(E* q) · M(q
/// d), with ξ = q d:
///
/// ```text
/// M(ξ) = [(3-4ν) sinh 2ξ - 2ξ] / [(3-4ν) cosh 2ξ + 2ξ² + 5 - 12ν + 8ν²]
/// ```
///
/// Short waves have M → 1, as for the half-space. Long waves have M → ξ (1-2ν)/(2(1-ν)²). There each column of the
/// layer is a spring, and a pressure of E* causes [`Layer::uniform_displacement`]. An incompressible layer (ν = 1/2)
/// has M → 2ξ³/3, and a uniform pressure does not displace it.
///
/// *Accuracy*: the factor is the solution of the equations of elasticity in the layer (test
/// `the_factor_solves_the_equations_of_the_layer`).
///
/// *Sources*: R. H. Bentall, K. L. Johnson, *Int. J. Mech. Sci.* 10 (1968) 637-663. For any layer and substrate: T. C.
/// O'Sullivan, R. B. King, *J. Tribol.* 110 (1988) 235-240. In this form: G. Carbone, L. Mangialardi, *J. Mech. Phys.
/// Solids* 56 (2008) 684-706.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Thickness d > 0, in λ.
    pub thickness: f64,
    /// Poisson's ratio ν of the layer, above -1 and at most 1/2.
    pub poisson: f64,
}

impl Layer {
    /// The thickness in sides of an element of `grid`.
    fn in_elements(self, grid: Grid) -> f64 {
        let sides = grid.spacing();
        self.thickness / (sides.x * sides.y).sqrt()
    }

    /// The factor M(ξ) for ξ ≥ 0.
    ///
    /// It is 0 at 0, positive beyond, and tends to 1. The relative error is a few roundings.
    #[must_use]
    pub fn factor(self, xi: f64) -> f64 {
        let (kappa, decay) = (3.0 - 4.0 * self.poisson, (-2.0 * xi).exp());
        if xi < SERIES {
            // κ sinh 2ξ - 2ξ without the cancellation that long waves would cause.
            let above = (kappa - 1.0) * 2.0 * xi + kappa * sinh_minus_argument(2.0 * xi);
            return above / (kappa * (2.0 * xi).cosh() + 2.0 * xi * xi + 0.5 * (1.0 + kappa * kappa));
        }
        // Numerator and denominator are multiplied by 2 exp(-2ξ), so that short waves do not overflow.
        let above = kappa * (1.0 - decay * decay) - 4.0 * xi * decay;
        above / (kappa * (1.0 + decay * decay) + (4.0 * xi * xi + 1.0 + kappa * kappa) * decay)
    }

    /// M(ξ) - 1, with the same relative error where it is small.
    fn excess(self, xi: f64) -> f64 {
        if xi < SERIES {
            return self.factor(xi) - 1.0;
        }
        let (kappa, decay) = (3.0 - 4.0 * self.poisson, (-2.0 * xi).exp());
        let constant = 1.0 + kappa * kappa;
        let above = -decay * (2.0 * kappa * decay + 4.0 * xi * (1.0 + xi) + constant);
        above / (kappa * (1.0 + decay * decay) + (4.0 * xi * xi + constant) * decay)
    }

    /// Displacement of the surface under a uniform pressure of E*, in λ: d (1-2ν)/(1-ν)².
    ///
    /// With E* = E/(1-ν²) this is the uniaxial compression d (1+ν)(1-2ν)/((1-ν) E) per unit pressure.
    #[must_use]
    pub fn uniform_displacement(self) -> f64 {
        self.thickness * (1.0 - 2.0 * self.poisson) / (1.0 - self.poisson).powi(2)
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
        let (layer, half_space, spacing) = (self.0, Love.symbol(grid), grid.spacing());
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
                        sum += 2.0 / q * layer.excess(q * layer.thickness) * wx * wy;
                    }
                }
            }
            sum
        })
    }

    fn symbol_while<'a>(&'a self, sliding: &Sliding, grid: Grid) -> ComplexSymbol<'a> {
        let (layer, half_space, spacing) = (self.0, Love.symbol_while(sliding, grid), grid.spacing());
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
                        let excess = layer.excess(length * layer.thickness);
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
        let (shift, springs) = (0.105 * (-1.43 * thickness).exp(), (-thickness / 2.2).exp());
        EdgeBias {
            per_edge: half_space.per_edge + shift,
            per_edge_error: half_space.per_edge_error + 0.4 * shift + 0.01 * (-thickness / 4.0).exp(),
            per_difference: half_space.per_difference + 0.12 * springs,
            per_second_difference: half_space.per_second_difference - 0.08 * springs,
            per_difference_error: half_space.per_difference_error + 0.07 * (-thickness / 3.0).exp(),
            gap_errors: half_space.gap_errors.map(|error| error * stiffening(thickness)),
            ..half_space
        }
    }

    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(&Love)
    }

    fn uniform_displacement(&self) -> Option<f64> {
        Some(self.0.uniform_displacement())
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }
}

/// Displacement that an error of the pressure at an edge causes, relative to the half-space.
///
/// The layer has a thickness in elements.
fn stiffening(thickness: f64) -> f64 {
    1.0 - (-0.25 * thickness).exp()
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
        Box::new(move |kx, ky| match grid.waves(kx, ky) {
            0.0 => 0.0,
            waves => self.0.factor(TAU * waves * self.0.thickness) / (PI * waves),
        })
    }

    fn half_space(&self) -> Option<&dyn Kernel> {
        Some(&Spectral)
    }

    fn uniform_displacement(&self) -> Option<f64> {
        Some(self.0.uniform_displacement())
    }

    fn to_shared(&self) -> Option<Arc<dyn Kernel + Send + Sync>> {
        Some(Arc::new(*self))
    }

    fn edge_bias(&self, grid: Grid) -> EdgeBias {
        let (half_space, thickness) = (Spectral.edge_bias(grid), self.0.in_elements(grid));
        let shift = 0.03 * (-1.4 * thickness).exp();
        EdgeBias {
            per_edge: half_space.per_edge + shift,
            per_edge_error: half_space.per_edge_error + shift,
            per_difference_error: 0.018 * (-thickness / 6.0).exp(),
            gap_errors: half_space.gap_errors.map(|error| error * stiffening(thickness)),
            ..half_space
        }
    }
}

#[cfg(test)]
mod tests;
