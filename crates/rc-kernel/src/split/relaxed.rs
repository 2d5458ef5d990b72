//! Stencils of a solid that relaxes while a surface slides over it along x.
//!
//! The displacement at a place follows what lies ahead of it. A stencil K of the relaxed solid becomes
//!
//! ```text
//! J0 K + Σ J F K,        (F K)(x, y) = ∫₀^∞ exp(-s/ℓ) K(x + s, y) ds/ℓ.
//! ```
//!
//! F is exact on the continuous kernel, which the stencil samples. Beyond the reach of K, F K falls by exp(-1/ℓ) from
//! element to element along x, exactly. So it is a compact stencil, and one tail for each ℓ ([`RelaxedStencil`]).
//!
//! The filters between levels stay those of the solid at rest. F commutes with them up to waves that they damp, and no
//! wave passes F with a factor above 1, so no wave is farther off than at rest (tests below).

use rc_core::{DVec2, SlidingCompliance};

use super::params::SplitParams;
use super::stencil::{Stencil, mean_remainder, remainder_between};
use super::window::Window;
use crate::chebyshev::{coefficients, node, polynomials};
use crate::gauss_legendre::gauss_legendre;
use crate::love_displacement;

/// Chebyshev terms in a panel, and points of the rule for its moments.
const TERMS: usize = 16;

/// Panels in an element, without those towards a singularity.
const PANELS: usize = 2;

/// Halvings of the panels next to the sides of a loaded square, where the slope of the displacement is infinite.
const HALVINGS: i32 = 30;

/// Lengths after which an exponential is below rounding.
const LONGEST: f64 = 40.0;

/// Lengths that one panel of the rule for an exponential may have.
const RESOLVED: f64 = 2.0;

/// A tail is left out if its weights are below this part of the greatest weight of the stencil at rest.
const NEGLIGIBLE: f64 = 1e-18;

/// A stencil of finite reach, with tails that decay along x.
#[derive(Clone, Debug, PartialEq)]
pub struct RelaxedStencil {
    /// The part of finite reach. It is not even in x: its weight at (dx, dy) is the displacement by the element at
    /// (dx, dy) from the displaced one.
    pub near: Stencil,
    /// The parts beyond its reach.
    pub tails: Vec<Tail>,
}

/// The displacement by elements beyond the reach of a stencil, on one side along x.
#[derive(Clone, Debug, PartialEq)]
pub struct Tail {
    /// ℓ in elements. The elements are those at larger x if it is positive, otherwise those at smaller x.
    pub length: f64,
    /// Weights of the nearest of these elements, for each offset along y from minus the radius of the stencil on.
    ///
    /// Those of the elements beyond are exp(-1/|ℓ|), exp(-2/|ℓ|), … times these.
    pub weights: Vec<f64>,
}

impl RelaxedStencil {
    /// Sum of all weights.
    #[must_use]
    pub fn sum(&self) -> f64 {
        let tails =
            self.tails.iter().map(|tail| tail.weights.iter().sum::<f64>() / -(-tail.length.abs().recip()).exp_m1());
        self.near.sum() + tails.sum::<f64>()
    }
}

/// A kernel of finite reach along rows of elements, for x ≥ 0, as Chebyshev series.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    radius: usize,
    rows: Vec<Vec<Panel>>,
}

/// A series in a piece of a row.
#[derive(Clone, Debug)]
struct Panel {
    start: f64,
    width: f64,
    terms: [f64; TERMS],
}

impl Panel {
    fn new(start: f64, width: f64, kernel: impl Fn(f64) -> f64) -> Self {
        let values: [f64; TERMS] = std::array::from_fn(|i| kernel(start + width * (0.5 + 0.5 * node(i, TERMS))));
        let terms = coefficients(&values);
        Self { start, width, terms: std::array::from_fn(|k| terms[k]) }
    }

    /// The panel of an even kernel at negative x.
    fn mirrored(&self) -> Self {
        let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        Self {
            start: -self.start - self.width,
            width: self.width,
            terms: std::array::from_fn(|k| sign(k) * self.terms[k]),
        }
    }
}

impl Rows {
    /// Love's square minus the mean of the remainder over it, as [`super::stencil::love`] samples it.
    pub(super) fn love(window: &Window, SplitParams { cutoff, .. }: SplitParams) -> Self {
        let rule = gauss_legendre();
        Self::new(cutoff, true, |x, y| {
            let offset = DVec2::new(x, y);
            love_displacement(offset, 0.5) - mean_remainder(window, cutoff as f64, offset, &rule)
        })
    }

    /// The kernel between two cutoffs, as [`super::stencil::between`] samples it.
    pub(super) fn between(window: &Window, cutoff: usize, inner: f64, [width, height]: [f64; 2]) -> Self {
        let kernel = remainder_between(window, cutoff as f64, inner);
        Self::new(cutoff, false, |x, y| width * height * kernel((width * x).hypot(height * y)))
    }

    /// A kernel that reaches less than an element beyond `radius`. Its slope may be infinite at the sides of a square.
    fn new(radius: usize, is_square: bool, kernel: impl Fn(f64, f64) -> f64) -> Self {
        let side = 1.0 / PANELS as f64;
        let row = |y: usize| {
            let panel = |start: f64, width: f64| Panel::new(start, width, |x| kernel(x, y as f64));
            let mut panels = Vec::new();
            for i in 0..PANELS * (radius + 1) {
                let start = side * i as f64;
                if y == 0 && is_square && i == 0 {
                    // Towards the end of this panel, and from the start of the next one on.
                    panels.extend((1..HALVINGS).map(|n| panel(0.5 - 2_f64.powi(-n), 2_f64.powi(-n - 1))));
                    panels.push(panel(0.5 - 2_f64.powi(-HALVINGS), 2_f64.powi(-HALVINGS)));
                } else if y == 0 && is_square && i == 1 {
                    panels.push(panel(0.5, 2_f64.powi(-HALVINGS)));
                    panels.extend((1..HALVINGS).rev().map(|n| panel(0.5 + 2_f64.powi(-n - 1), 2_f64.powi(-n - 1))));
                } else {
                    panels.push(panel(start, side));
                }
            }
            panels
        };
        Self { radius, rows: (0..=radius).map(row).collect() }
    }

    /// The kernel of the relaxed solid behind a `compliance`, with lengths in elements.
    ///
    /// `at_rest` is the stencil that samples the kernel.
    pub(super) fn relaxed(&self, at_rest: &Stencil, compliance: &SlidingCompliance) -> RelaxedStencil {
        let (radius, n) = (self.radius as i32, 2 * self.radius + 2);
        // For each mode and row, from the element at +radius to that at -(radius + 1).
        let modes: Vec<(f64, f64, Vec<Vec<f64>>)> = compliance
            .modes
            .iter()
            .map(|&[part, length]| {
                let mut moments = Moments::new(length.abs());
                (part, length, self.rows.iter().map(|row| averages(row, &mut moments, n)).collect())
            })
            .collect();
        let near = Stencil::of_any(self.radius, |dx, dy| {
            let row = dy.unsigned_abs() as usize;
            let of_mode = |(part, length, rows): &(f64, f64, Vec<Vec<f64>>)| {
                // An element at +dx acts over the distance -dx.
                let towards = if *length > 0.0 { dx } else { -dx };
                part * rows[row][(radius + towards) as usize]
            };
            compliance.instantaneous * at_rest.weight(dx, dy) + modes.iter().map(of_mode).sum::<f64>()
        });
        let tails = modes.iter().map(|(part, length, rows)| Tail {
            length: *length,
            weights: (-radius..=radius).map(|dy| part * rows[dy.unsigned_abs() as usize][n - 1]).collect(),
        });
        let least = NEGLIGIBLE * at_rest.weight(0, 0).abs();
        RelaxedStencil { near, tails: tails.filter(|tail| tail.weights.iter().any(|w| w.abs() > least)).collect() }
    }
}

/// (F K)(x) in a row at x = r, r - 1, …, -(r + 1), `n` = 2 r + 2 values.
fn averages(row: &[Panel], moments: &mut Moments, n: usize) -> Vec<f64> {
    let length = moments.length;
    let decay = (-length.recip()).exp();
    let start = (n / 2 - 1) as f64;
    let (mut value, mut values) = (0.0, Vec::with_capacity(n));
    let mut panels: Vec<Panel> = row.iter().map(Panel::mirrored).collect();
    panels.reverse();
    panels.extend_from_slice(row);
    for i in 0..n {
        let x = start - i as f64;
        let inside = panels.iter().filter(|panel| panel.start >= x && panel.start < x + 1.0);
        value *= decay;
        for panel in inside {
            let of_terms = moments.of(panel.width).iter().zip(&panel.terms).map(|(m, c)| m * c).sum::<f64>();
            value += (-(panel.start - x) / length).exp() * of_terms;
        }
        values.push(value);
    }
    values
}

/// Moments of an exponential over panels: ∫ exp(-s/ℓ) T_k ds/ℓ, with T_k on the panel 0 ≤ s ≤ width.
struct Moments {
    length: f64,
    rule: [(f64, f64); TERMS],
    known: Vec<(f64, [f64; TERMS])>,
}

impl Moments {
    fn new(length: f64) -> Self {
        Self { length, rule: gauss_legendre(), known: Vec::new() }
    }

    fn of(&mut self, width: f64) -> [f64; TERMS] {
        if let Some((_, moments)) = self.known.iter().find(|(other, _)| other.to_bits() == width.to_bits()) {
            return *moments;
        }
        let mut moments = [0.0; TERMS];
        let end = width.min(LONGEST * self.length);
        let n = (end / (RESOLVED * self.length)).ceil().max(1.0);
        let part = end / n;
        for i in 0..n as usize {
            for (x, weight) in self.rule {
                let s = part * (i as f64 + 0.5 + 0.5 * x);
                let weight = weight * part / self.length * (-s / self.length).exp();
                for (moment, wave) in moments.iter_mut().zip(polynomials::<TERMS>(2.0 * s / width - 1.0)) {
                    *moment += weight * wave;
                }
            }
        }
        self.known.push((width, moments));
        moments
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    use std::sync::Arc;

    use rc_core::{Complex64, Grid, Kernel, Sliding};

    use super::*;
    use crate::{Love, ScaleSplit};

    fn compliance(lengths: &[f64]) -> SlidingCompliance {
        let n = lengths.len() as f64;
        SlidingCompliance { instantaneous: 0.1, modes: lengths.iter().map(|&length| [0.9 / n, length]).collect() }
    }

    fn rest() -> SlidingCompliance {
        SlidingCompliance { instantaneous: 1.0, modes: Vec::new() }
    }

    /// The factor of a wave of q radians per element, with all elements of the plane.
    fn symbol(stencil: &RelaxedStencil, q: DVec2) -> Complex64 {
        let radius = stencil.near.radius() as i32;
        let mut sum = Complex64::ZERO;
        for dy in -radius..=radius {
            let along_y = Complex64::cis(q.y * f64::from(dy));
            for dx in -radius..=radius {
                sum += stencil.near.weight(dx, dy) * Complex64::cis(q.x * f64::from(dx)) * along_y;
            }
            for Tail { length, weights } in &stencil.tails {
                let turn = Complex64::cis(q.x * length.signum());
                let first = turn.powi(radius + 1) * along_y * weights[(dy + radius) as usize];
                sum += first / (1.0 - turn * (-length.abs().recip()).exp());
            }
        }
        sum
    }

    const LENGTHS: [f64; 6] = [1e-3, 0.03, 0.7, 5.0, 300.0, -2.0];

    /// Each sum over levels is the operator of the uniform grid, and no wave is farther off than at rest.
    ///
    /// Waves that the coarse grid resolves are compared: 2/q on it, minus what the finest level has, through the filter.
    #[test]
    fn two_levels_are_the_symbol_of_loves_squares() {
        let n = 64;
        let grid = Grid::square(n as usize).expect("a grid");
        for error in [2e-3, 1e-6, 2e-9, 1e-10] {
            let split = ScaleSplit::new(SplitParams::for_error(error).expect("a split"));
            let (filter, cutoff) = (split.love_filter(), split.params().cutoff as f64);
            for length in LENGTHS {
                let (mut greatest, mut at_rest) = (0.0_f64, 0.0_f64);
                for (compliance, greatest) in [(compliance(&[length]), &mut greatest), (rest(), &mut at_rest)] {
                    let stencil = split.relaxed_love(&compliance);
                    let of_grid = compliance.in_units_of(f64::from(n));
                    let sliding = Sliding::new(DVec2::X, Arc::new(move |q| of_grid.at(q)));
                    let exact = Love.symbol_while(&sliding, grid);
                    for (kx, ky) in [(1, 0), (0, 1), (-2, 3), (5, 1), (3, -7), (9, 9), (16, 0), (1, 14)] {
                        let q = TAU / f64::from(n) * DVec2::new(f64::from(kx), f64::from(ky));
                        let smooth = (filter.response(q.x) * filter.response(q.y)).powi(2)
                            * split.remainder_symbol(q.length(), cutoff);
                        let found = symbol(&stencil, q) + smooth * compliance.at(q.x);
                        let expected = f64::from(n) * exact(kx.into(), ky.into());
                        *greatest = greatest.max((found - expected).norm() * 0.5 * q.length());
                    }
                }
                assert!(greatest < 1.001 * at_rest, "{error:e}, {length}: {greatest:e}, at rest {at_rest:e}");
            }
        }
    }

    /// A level adds its part of 2/q times the compliance of the wave, and no wave is farther off than at rest.
    #[test]
    fn a_level_relaxes_as_its_waves() {
        for error in [1e-6, 2e-9, 1e-10] {
            let split = ScaleSplit::new(SplitParams::for_error(error).expect("a split"));
            let cutoff = split.params().cutoff as f64;
            for length in LENGTHS {
                let (mut greatest, mut at_rest) = (0.0_f64, 0.0_f64);
                let relaxed = compliance(&[length, 2.0 * length, 31.0]);
                for (compliance, greatest) in [(relaxed, &mut greatest), (rest(), &mut at_rest)] {
                    let stencil = split.relaxed_level(&compliance);
                    for q in [[0.1, 0.0], [0.0, 0.2], [-0.3, 0.8], [1.0, 0.9]].map(DVec2::from) {
                        let part = split.remainder_symbol(q.length(), 0.5 * cutoff)
                            - split.remainder_symbol(q.length(), cutoff);
                        let (found, expected) = (symbol(&stencil, q), part * compliance.at(q.x));
                        *greatest = greatest.max((found - expected).norm() * 0.5 * q.length());
                    }
                }
                assert!(greatest < 1.001 * at_rest, "{error:e}, {length}: {greatest:e}, at rest {at_rest:e}");
            }
        }
    }

    #[test]
    fn the_mean_does_not_relax_and_no_weight_is_negative() {
        let split = ScaleSplit::new(SplitParams::certified());
        for length in LENGTHS {
            let compliance = compliance(&[length]);
            // The sum over samples of a level has aliases, which relax.
            for (relaxed, at_rest, bound) in [
                (split.relaxed_love(&compliance), split.love_stencil(), 1e-11),
                (split.relaxed_level(&compliance), split.level_stencil(), 1e-5),
            ] {
                let ratio = relaxed.sum() / at_rest.sum() - 1.0;
                assert!(ratio.abs() < bound, "{length}: {ratio:e}");
                let radius = relaxed.near.radius() as i32;
                let cells = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)));
                let least = cells.map(|(dx, dy)| relaxed.near.weight(dx, dy)).fold(f64::INFINITY, f64::min);
                // Panels represent the kink at the end of the window to 1e-10.
                assert!(least > -1e-9, "an average of what is not negative: {least:e}");
            }
        }
    }
}
