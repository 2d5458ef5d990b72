//! The symbol of the paper's element under a sliding surface.
//!
//! It is the alias sum of [`crate::alias_sum`], in which each alias q has the compliance J~(q·v) of its own: an alias
//! across the velocity relaxes like the wave itself, one along the velocity is nearly glassy.
//!
//! Along an axis, J~ depends on the alias along that axis only. For each wavenumber along it, the aliases nearest to
//! the wave are summed, and the rest of the sum is a smooth and even function of θ across. A Chebyshev interpolant in θ²
//! represents it, fitted to the whole sum.
//!
//! In another direction every alias has the compliance of the wave. With compliances of their own, aliases across the
//! velocity would stay relaxed while the wave itself is glassy. The real part would then be negative for some short
//! waves, and the contact would have no unique solution.

use std::f64::consts::{FRAC_PI_2, PI};

use rc_core::{Complex64, ComplexSymbol, DVec2, Grid, Sliding};

use crate::alias_sum::{Damping, alternating_weights, phase};
use crate::chebyshev;
use crate::love_symbol::LoveSymbol;

/// Chebyshev nodes across the velocity.
const NODES: usize = 14;

/// Weighted terms of a sum over aliases. A bound of the error is 5.8^-18 = 2e-14.
const TERMS: usize = 18;

/// The symbol on `grid`.
pub(crate) fn symbol<'a>(sliding: &Sliding, grid: Grid) -> ComplexSymbol<'a> {
    let velocity = sliding.velocity();
    if velocity.x == 0.0 || velocity.y == 0.0 {
        let along = AlongAxis::new(sliding, grid, usize::from(velocity.x == 0.0));
        return Box::new(move |kx, ky| along.value([kx, ky]));
    }
    let (elastic, sliding) = (LoveSymbol::new(grid), sliding.clone());
    Box::new(move |kx, ky| {
        let at_rest = elastic.eigenvalue(kx.unsigned_abs() as usize, ky.unsigned_abs() as usize);
        at_rest * sliding.compliance(grid.angular_wave(kx, ky))
    })
}

/// The symbol for a velocity along an axis.
struct AlongAxis {
    /// Which component of a wave is along the velocity.
    axis: usize,
    /// For each wavenumber along the velocity.
    columns: Vec<Column>,
    /// For each wavenumber across.
    rows: Vec<Row>,
}

/// One wavenumber along the velocity.
struct Column {
    /// The near aliases: J~ T_m, and the square of half the wavenumber.
    near: Vec<(Complex64, f64)>,
    /// Chebyshev coefficients of the rest.
    rest: [Complex64; NODES],
}

/// One wavenumber across the velocity.
struct Row {
    /// The near aliases: T_n, and the square of half the wavenumber.
    near: [(f64, f64); 3],
    /// θ² mapped to [-1, 1].
    mapped: f64,
}

/// The sides of elements along and across the velocity, and what the sums over aliases need.
struct Sums {
    along: f64,
    across: f64,
    weights: [f64; TERMS],
    /// Near aliases along the velocity, on each side.
    reach: i64,
}

impl Sums {
    /// Σ over n of T_n(θ)/√(a² + b²), without the near aliases where `is_near`.
    fn across(&self, theta: f64, a: f64, is_near: bool) -> f64 {
        let damping = Damping::new(theta);
        let term = |n: f64| damping.at(n) / (a * a + ((theta + PI * n) / self.across).powi(2)).sqrt();
        let pair = |(i, weight): (usize, &f64), first: usize| {
            let n = (first + i) as f64;
            weight * (term(n) + term(-n))
        };
        let far = |first: usize| self.weights.iter().enumerate().map(|term| pair(term, first)).sum::<f64>();
        if is_near { far(2) } else { term(0.0) + far(1) }
    }

    /// The rest at one node θ across, for the wavenumber θ along.
    fn rest(&self, sliding: &dyn Fn(f64) -> Complex64, theta: f64, across: f64) -> Complex64 {
        let damping = Damping::new(theta);
        let half = |m: f64| (theta + PI * m) / self.along;
        let term = |m: f64, is_near: bool| {
            let weight = damping.at(m);
            if weight == 0.0 {
                return Complex64::ZERO;
            }
            sliding(2.0 * half(m)) * (weight * self.across(across, half(m), is_near))
        };
        let near: Complex64 = (-self.reach..=self.reach).map(|m| term(m as f64, true)).sum();
        let far = self.weights.iter().enumerate().map(|(i, weight)| {
            let m = (self.reach + 1) as f64 + i as f64;
            *weight * (term(m, false) + term(-m, false))
        });
        near + far.sum::<Complex64>()
    }
}

impl AlongAxis {
    fn new(sliding: &Sliding, grid: Grid, axis: usize) -> Self {
        let (n, h) = ([grid.nx(), grid.ny()], grid.spacing());
        let (sides, unit) = if axis == 0 { ([h.x, h.y], DVec2::X) } else { ([h.y, h.x], DVec2::Y) };
        let (along, across) = (n[axis], n[1 - axis]);
        // With this reach, the singularities of the rest are at least as far away as for squares and three aliases.
        let reach = ((1.5 * sides[0] / sides[1] - 0.5).ceil() as i64).max(1);
        let sums = Sums { along: sides[0], across: sides[1], weights: alternating_weights(), reach };
        let compliance = |q: f64| sliding.compliance(q * unit);
        let columns = (0..=along / 2).map(|k| {
            let theta = phase(k, along);
            let damping = Damping::new(theta);
            let near = (-reach..=reach).map(|m| {
                let half = (theta + PI * m as f64) / sides[0];
                (compliance(2.0 * half) * damping.at(m as f64), half * half)
            });
            let rest = if across == 1 {
                // All waves of a profile are along it.
                let mut constant = [Complex64::ZERO; NODES];
                constant[0] = sums.rest(&compliance, theta, 0.0);
                constant
            } else {
                coefficients(&std::array::from_fn(|node| {
                    let node = FRAC_PI_2 * f64::midpoint(1.0, chebyshev::node(node, NODES)).sqrt();
                    sums.rest(&compliance, theta, node)
                }))
            };
            Column { near: near.collect(), rest }
        });
        let rows = (0..=across / 2).map(|k| {
            let theta = phase(k, across);
            let damping = Damping::new(theta);
            let near = [-1.0, 0.0, 1.0].map(|n| (damping.at(n), ((theta + PI * n) / sides[1]).powi(2)));
            Row { near, mapped: 2.0 * (theta / FRAC_PI_2).powi(2) - 1.0 }
        });
        Self { axis, columns: columns.collect(), rows: rows.collect() }
    }

    fn value(&self, wave: [i64; 2]) -> Complex64 {
        let (along, across) = (wave[self.axis], wave[1 - self.axis]);
        if along == 0 && across == 0 {
            return Complex64::ZERO;
        }
        let column = &self.columns[along.unsigned_abs() as usize];
        let row = &self.rows[across.unsigned_abs() as usize];
        let mut sum = clenshaw(&column.rest, row.mapped);
        for (factor, a) in &column.near {
            let across: f64 = row.near.iter().filter(|(t, _)| *t != 0.0).map(|(t, b)| t / (a + b).sqrt()).sum();
            if *factor != Complex64::ZERO {
                sum += factor * across;
            }
        }
        if along < 0 { sum.conj() } else { sum }
    }
}

/// Chebyshev coefficients of the interpolant of complex values at the nodes.
fn coefficients(values: &[Complex64; NODES]) -> [Complex64; NODES] {
    let [re, im] = [values.map(|value| value.re), values.map(|value| value.im)];
    let (re, im) = (chebyshev::coefficients(&re), chebyshev::coefficients(&im));
    std::array::from_fn(|k| Complex64::new(re[k], im[k]))
}

fn clenshaw(coefficients: &[Complex64; NODES], x: f64) -> Complex64 {
    let [mut next, mut after] = [Complex64::ZERO; 2];
    for &coefficient in coefficients[1..].iter().rev() {
        (next, after) = (coefficient + 2.0 * x * next - after, next);
    }
    coefficients[0] + x * next - after
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;

    use super::*;
    use crate::relaxation::Relaxation;

    fn sliding(velocity: DVec2, tau: f64) -> Sliding {
        let material = Relaxation::prony(&[[4.0, tau], [5.0, 30.0 * tau]]).expect("a material");
        Sliding::new(velocity, Arc::new(move |omega| material.compliance(omega)))
    }

    /// The alias sum up to `reach` on each side. Its tail falls like 1/reach², with alternating signs.
    fn brute(sliding: &Sliding, grid: Grid, [kx, ky]: [i64; 2], reach: i64) -> Complex64 {
        let (own, h) = (grid.angular_wave(kx, ky), grid.spacing());
        let (x, y) = (Damping::new(0.5 * own.x * h.x), Damping::new(0.5 * own.y * h.y));
        // The mean of two successive cuts of an alternating sum is much closer than either.
        let weight = |m: i64| if m.abs() == reach { 0.5 } else { 1.0 };
        let mut sum = Complex64::ZERO;
        for n in -reach..=reach {
            for m in -reach..=reach {
                let of_element = x.at(m as f64) * y.at(n as f64) * weight(m) * weight(n);
                if of_element != 0.0 {
                    let q = own + TAU * DVec2::new(m as f64, n as f64) / h;
                    sum += 2.0 * of_element / q.length() * sliding.compliance(q);
                }
            }
        }
        sum
    }

    #[test]
    fn along_an_axis_it_is_the_whole_alias_sum() {
        let grids =
            [Grid::new(16, 16), Grid::new(9, 20), Grid::new(24, 7), Grid::in_cell(12, 12, 3.0), Grid::new(32, 1)];
        for grid in grids.map(|grid| grid.expect("a grid")) {
            for velocity in [DVec2::X, -DVec2::X, DVec2::Y] {
                for tau in [1e-4, 1e-2, 1.0, 1e3] {
                    let sliding = sliding(velocity, tau);
                    let symbol = symbol(&sliding, grid);
                    let (half_x, half_y) = ((grid.nx() / 2) as i64, (grid.ny() / 2) as i64);
                    for wave in [[1, 0], [0, 1], [half_x, half_y], [half_x / 2, 1], [1, half_y], [-1, half_y / 2]] {
                        if wave[0].abs() > half_x || wave[1].abs() > half_y {
                            continue;
                        }
                        let (found, expected) = (symbol(wave[0], wave[1]), brute(&sliding, grid, wave, 400));
                        let error = (found - expected).norm() / expected.norm();
                        assert!(
                            error < 3e-7,
                            "{wave:?} on {grid}, {velocity}, tau {tau}: {found} for {expected}: {error:e}"
                        );
                    }
                }
            }
        }
    }

    /// The contact has one solution.
    #[test]
    fn the_real_part_is_positive_in_every_direction() {
        for grid in [Grid::new(24, 24), Grid::new(16, 9), Grid::in_cell(12, 20, 2.0)].map(|grid| grid.expect("a grid"))
        {
            for (glassy_ratio, angle) in
                [(30.0, 0.35_f64), (1000.0, 0.0), (1000.0, 0.5), (1e4, std::f64::consts::FRAC_PI_2)]
            {
                for tau in [1e-3, 0.03, 1.0, 30.0] {
                    let material = Relaxation::single(glassy_ratio, tau).expect("a material");
                    let velocity = DVec2::new(angle.cos(), angle.sin()).map(|v| if v.abs() < 1e-12 { 0.0 } else { v });
                    let sliding = Sliding::new(velocity, Arc::new(move |omega| material.compliance(omega)));
                    let symbol = symbol(&sliding, grid);
                    let [half_x, half_y] = [grid.nx(), grid.ny()].map(|n| (n / 2) as i64);
                    for wave in (0..=half_x).flat_map(|kx| (-half_y..=half_y).map(move |ky| [kx, ky])) {
                        let value = symbol(wave[0], wave[1]);
                        assert!(value.re > 0.0 || wave == [0, 0], "{wave:?} on {grid}, {velocity}, {tau}: {value}");
                    }
                }
            }
        }
    }
}
