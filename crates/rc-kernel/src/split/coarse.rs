//! Elements that are coarser than the finest.
//!
//! A coarse element is a square of 2^m × 2^m finest elements under one pressure. Its displacement is the mean over the
//! finest elements.
//!
//! P copies a value to four elements of half the side, and R = ¼ Pᵀ takes their mean. The operator on level K - m is
//! `Rᵐ L Pᵐ`. It is symmetric, and uses the same L for a patch of contact on any level. In its smooth part, points are
//! replaced by elements with the blur
//!
//! ```text
//! b_m(q) = Π_{i=1}^{m} cos(q/2^{i+1}) · √sinc(q/2^{m+1})        (q in radians per coarse element)
//! ```
//!
//! along each axis ([`CoarseFilter`]). Its short-range part follows level by level from that of Love's squares.

use super::SplitParams;
use super::filter::{EXACT, SAMPLES, least_squares, love_target, weight};
use super::stencil::Stencil;
use super::window::Window;

/// The blur of a coarse element along one axis.
///
/// It takes pressures to the density of their own level. Its transpose takes the smooth displacement of that level to
/// the means over elements.
#[derive(Clone, Debug, PartialEq)]
pub struct CoarseFilter {
    taps: Vec<f64>,
}

impl CoarseFilter {
    /// Weights of the element itself and of the elements 1, 2, … away on either side.
    #[must_use]
    pub fn taps(&self) -> &[f64] {
        &self.taps
    }

    /// The factor on a wave of `q` radians per element.
    #[must_use]
    pub fn response(&self, q: f64) -> f64 {
        let both_sides: f64 = (1_u32..).zip(&self.taps[1..]).map(|(j, tap)| tap * (q * f64::from(j)).cos()).sum();
        self.taps[0] + 2.0 * both_sides
    }
}

/// The response of an element of a coarse level, for elements of side 1.
#[derive(Clone, Debug, PartialEq)]
pub struct CoarseElement {
    /// The blur of the element.
    pub filter: CoarseFilter,
    /// The displacement of other elements of its size by finer levels.
    ///
    /// It excludes the level's own stencil and all coarser levels.
    pub near: Stencil,
    /// The displacement including the level's own stencil, but excluding all coarser levels.
    pub whole: Stencil,
}

/// Elements of 2, 4, … 2^`n_levels` times the finest side.
///
/// They follow from Love's stencil and the stencil of the levels.
pub(super) fn elements(
    window: &Window,
    params: SplitParams,
    love: &Stencil,
    level: &Stencil,
    n_levels: usize,
) -> Vec<CoarseElement> {
    let mut elements: Vec<CoarseElement> = Vec::with_capacity(n_levels);
    for m in 1..=n_levels {
        let finer = elements.last().map_or(love, |element| &element.whole);
        let near = mean_over_pairs(finer);
        let filter = design(window, params, m as u32);
        let whole = with_level(&near, level, &filter);
        elements.push(CoarseElement { filter, near, whole });
    }
    elements
}

/// `R S P` of a stencil S on elements of half the side.
///
/// The unit of length is the coarse side.
fn mean_over_pairs(finer: &Stencil) -> Stencil {
    let radius = finer.radius() as i32;
    Stencil::new(usize::midpoint(finer.radius(), 1), |dx, dy| {
        // The four by four pairs of halves have distances with multiplicities 1, 2, 1 along each axis.
        let pairs = [(-1, 1.0), (0, 2.0), (1, 1.0)];
        let (x, y) = (2 * dx as i32, 2 * dy as i32);
        let mut sum = 0.0;
        for (j, wy) in pairs {
            for (i, wx) in pairs {
                if (x + i).abs() <= radius && (y + j).abs() <= radius {
                    sum += wx * wy * finer.weight(x + i, y + j);
                }
            }
        }
        // A factor of a quarter for the mean, and a half for the unit of length.
        0.125 * sum
    })
}

/// The sum of `near` and the level's stencil between two blurred elements.
fn with_level(near: &Stencil, level: &Stencil, filter: &CoarseFilter) -> Stencil {
    let n = filter.taps.len() as i32 - 1;
    let tap = |j: i32| filter.taps.get(j.unsigned_abs() as usize).copied().unwrap_or(0.0);
    let twice: Vec<f64> = (0..=2 * n).map(|d| (-n..=n).map(|j| tap(j) * tap(d - j)).sum()).collect();
    let (radius, reach) = (level.radius() as i32, 2 * n);
    Stencil::new(level.radius(), |dx, dy| {
        let (dx, dy) = (dx as i32, dy as i32);
        let mut sum = if dx.max(dy) <= near.radius() as i32 { near.weight(dx, dy) } else { 0.0 };
        for y in (dy - reach).max(-radius)..=(dy + reach).min(radius) {
            for x in (dx - reach).max(-radius)..=(dx + reach).min(radius) {
                let weight = twice[(y - dy).unsigned_abs() as usize] * twice[(x - dx).unsigned_abs() as usize];
                sum += weight * level.weight(x, y);
            }
        }
        sum
    })
}

/// The blur b_m(q).
fn blur(q: f64, m: u32) -> f64 {
    let halves = (1..=m).map(|i| (q / f64::from(1_u32 << (i + 1))).cos());
    halves.product::<f64>() * love_target(q / f64::from(1_u32 << m))
}

/// The taps whose response is nearest to b_m by least squares.
///
/// The weight is the spectrum that the level has to represent.
fn design(window: &Window, params: SplitParams, m: u32) -> CoarseFilter {
    let n = params.taps / 2;
    let c = 0.5 * params.cutoff as f64;
    let mut rows: Vec<Vec<f64>> = (1..=SAMPLES)
        .map(|sample| {
            let q = std::f64::consts::PI * sample as f64 / SAMPLES as f64;
            let weight = weight(window, c, q);
            let waves = (0..=n).map(|j| weight * if j == 0 { 1.0 } else { 2.0 * (q * j as f64).cos() });
            waves.chain([weight * blur(q, m)]).collect()
        })
        .collect();
    let heaviest = rows.iter().map(|row| row[n + 1].abs()).fold(0.0, f64::max);
    let exact = (0..=n).map(|j| if j == 0 { 1.0 } else { 2.0 }).chain([1.0]);
    rows.insert(0, exact.map(|value| EXACT * heaviest * value).collect());
    CoarseFilter { taps: least_squares(rows, n + 1) }
}

#[cfg(test)]
mod tests {
    use crate::{ScaleSplit, SplitParams};

    #[test]
    fn filters_blur_as_elements_do() {
        let split = ScaleSplit::new(SplitParams::certified());
        for (m, element) in (1..).zip(split.coarse_elements(3)) {
            assert!((element.filter.response(0.0) - 1.0).abs() < 1e-9);
            for q in [0.2, 0.6, 1.2] {
                let (n, side) = (1 << m, 1.0 / f64::from(1 << m));
                // The mean of a wave over the centres of the finest elements. Each of these has the square root of the
                // blur of a square.
                let centres = (0..n).map(|i| (q * (f64::from(i) + 0.5 - 0.5 * f64::from(n)) * side).cos());
                let mean = centres.sum::<f64>() / f64::from(n);
                let finest = ((0.5 * q * side).sin() / (0.5 * q * side)).sqrt();
                let error = element.filter.response(q) - mean * finest;
                assert!(error.abs() < 1e-5, "m {m}, q {q}: {error:e}");
            }
        }
    }

    /// A constant pressure displaces the surface equally on every level.
    ///
    /// The sum of the stencils of the levels up to a common level is the same.
    #[test]
    fn a_constant_is_the_same_on_every_level() {
        let split = ScaleSplit::new(SplitParams::certified());
        let mut finest = split.love_stencil().sum();
        for element in split.coarse_elements(4) {
            // In units of the side of the coarser elements.
            let near = element.near.sum();
            assert!((near / (0.5 * finest) - 1.0).abs() < 1e-12, "{near} for {}", 0.5 * finest);
            finest = element.whole.sum();
            let expected = near + split.level_stencil().sum();
            assert!((finest / expected - 1.0).abs() < 1e-5, "{finest} for {expected}");
        }
    }
}
