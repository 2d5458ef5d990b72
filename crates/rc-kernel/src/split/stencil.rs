//! Short-range stencils, the displacement of the centres around one element.

use std::f64::consts::FRAC_1_PI;

use rc_core::DVec2;

use super::window::Window;
use crate::gauss_legendre::gauss_legendre;
use crate::love_displacement;

/// Points per direction of the rule on one element.
const POINTS: usize = 8;

/// Weights at the centres around an element, of a symmetric kernel of finite reach.
#[derive(Clone, Debug, PartialEq)]
pub struct Stencil {
    radius: usize,
    weights: Vec<f64>,
}

impl Stencil {
    /// A stencil from its weight at (dx, dy), called for 0 ≤ dy ≤ dx ≤ `radius` only.
    pub(super) fn new(radius: usize, weight: impl Fn(usize, usize) -> f64) -> Self {
        let side = 2 * radius + 1;
        let mut weights = vec![0.0; side * side];
        for dx in 0..=radius {
            for dy in 0..=dx {
                let value = weight(dx, dy);
                for (x, y) in [(dx, dy), (dy, dx)] {
                    for (row, column) in [(radius + y, radius + x), (radius - y, radius - x)] {
                        weights[row * side + column] = value;
                        weights[row * side + (2 * radius - column)] = value;
                    }
                }
            }
        }
        Self { radius, weights }
    }

    /// A stencil of elements that are not squares.
    ///
    /// The weight is called for 0 ≤ dx, dy ≤ `radius`.
    pub(super) fn of_rectangles(radius: usize, weight: impl Fn(usize, usize) -> f64) -> Self {
        let side = 2 * radius + 1;
        let distance = |i: usize| i.abs_diff(radius);
        let weights = (0..side * side).map(|i| weight(distance(i % side), distance(i / side)));
        Self { radius, weights: weights.collect() }
    }

    /// A stencil that need not be symmetric, from its weight at any (dx, dy).
    pub(super) fn of_any(radius: usize, weight: impl Fn(i32, i32) -> f64) -> Self {
        let reach = radius as i32;
        let weights = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
        Self { radius, weights: weights.map(|(dx, dy)| weight(dx, dy)).collect() }
    }

    /// Largest offset along x and along y.
    #[must_use]
    pub fn radius(&self) -> usize {
        self.radius
    }

    /// Weight at offset (`dx`, `dy`). The size of each is at most the radius.
    ///
    /// # Panics
    /// When an offset is larger than the radius.
    #[must_use]
    pub fn weight(&self, dx: i32, dy: i32) -> f64 {
        let radius = self.radius as i32;
        self.weights[((radius + dy) * (2 * radius + 1) + radius + dx) as usize]
    }

    /// Sum of all weights.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.weights.iter().sum()
    }
}

/// Love's square minus the mean of the remainder over it.
pub(super) fn love(window: &Window, cutoff: usize) -> Stencil {
    let rule = gauss_legendre::<POINTS>();
    Stencil::new(cutoff, |dx, dy| {
        let offset = DVec2::new(dx as f64, dy as f64);
        love_displacement(offset, 0.5) - mean_remainder(window, cutoff as f64, offset, &rule)
    })
}

/// Mean of `Ψ(r/c)/(π r)` over the unit square around `centre`.
///
/// The window ends at r = c with a kink. A square that contains a part of the kink is halved a few times.
pub(super) fn mean_remainder(window: &Window, cutoff: f64, DVec2 { x, y }: DVec2, rule: &[(f64, f64); POINTS]) -> f64 {
    let (nearest, farthest) = ((x - 0.5).max(0.0).hypot((y - 0.5).max(0.0)), (x + 0.5).hypot(y + 0.5));
    let parts = if nearest < cutoff && cutoff < farthest { 8 } else { 2 };
    let side = 1.0 / f64::from(parts);
    let mut sum = 0.0;
    for row in 0..parts {
        for column in 0..parts {
            let (left, below) = (x - 0.5 + side * f64::from(column), y - 0.5 + side * f64::from(row));
            for (sy, wy) in rule {
                for (sx, wx) in rule {
                    let r = (left + side * (0.5 + 0.5 * sx)).hypot(below + side * (0.5 + 0.5 * sy));
                    sum += wx * wy * window.rise_over(r / cutoff);
                }
            }
        }
    }
    sum * side * side * FRAC_1_PI / cutoff
}

/// The kernel between cutoffs c/2 and c, at the centres.
pub(super) fn level(window: &Window, cutoff: usize) -> Stencil {
    let c = cutoff as f64;
    Stencil::new(cutoff, |dx, dy| {
        let r = (dx as f64).hypot(dy as f64);
        FRAC_1_PI / c * (2.0 * window.rise_over(2.0 * r / c) - window.rise_over(r / c))
    })
}

/// The kernel between cutoffs `inner` and c, at the centres of elements of these sides.
///
/// The smaller side is 1.
pub(super) fn between(window: &Window, cutoff: usize, inner: f64, [width, height]: [f64; 2]) -> Stencil {
    let kernel = remainder_between(window, cutoff as f64, inner);
    Stencil::of_rectangles(cutoff, |dx, dy| width * height * kernel((width * dx as f64).hypot(height * dy as f64)))
}

/// The kernel between the cutoffs `inner` and `cutoff`, at the distance r.
pub(super) fn remainder_between(window: &Window, cutoff: f64, inner: f64) -> impl Fn(f64) -> f64 + '_ {
    let remainder = |r: f64, c: f64| window.rise_over(r / c) / c;
    move |r| FRAC_1_PI * (remainder(r, inner) - remainder(r, cutoff))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_half_the_cutoff_and_all_of_it_is_the_stencil_of_a_level() {
        let window = Window::new(10.0, 8);
        let (even, any) = (level(&window, 8), between(&window, 8, 4.0, [1.0, 1.0]));
        for (dx, dy) in (0..=64).map(|i| (i / 8 - 4, i % 8 - 4)) {
            assert!((even.weight(dx, dy) - any.weight(dx, dy)).abs() < 1e-15);
        }
        // The sum over rectangles approximates the same integral.
        let sum = between(&window, 8, 4.1, [1.03, 1.0]).sum();
        let squares = between(&window, 8, 4.1, [1.0, 1.0]).sum();
        assert!((sum / squares - 1.0).abs() < 1e-4, "{sum} for {squares}");
    }

    /// The sum of the weights of all squares is the integral of the short-range kernel.
    #[test]
    fn sums_are_integrals() {
        for (cutoff, shape) in [(3, 3.0), (6, 8.0), (12, 18.0)] {
            let window = Window::new(shape, cutoff);
            let integral = cutoff as f64 * window.short_range(0.0);
            let sum = love(&window, cutoff).sum();
            // Squares beyond the radius of the stencil are omitted, although the edge of the window still touches them.
            let tolerance = if shape < 5.0 { 1e-3 } else { 1e-6 };
            assert!((sum / integral - 1.0).abs() < tolerance, "cutoff {cutoff}: {sum} for {integral}");
        }
    }

    #[test]
    fn stencils_end_at_the_cutoff() {
        let window = Window::new(8.0, 6);
        for stencil in [love(&window, 6), level(&window, 6)] {
            assert!(stencil.weight(6, 6).abs() < 1e-14 && stencil.weight(0, 5).abs() > 0.0);
            assert_eq!(stencil.weight(2, -3).to_bits(), stencil.weight(-3, 2).to_bits());
        }
    }
}
