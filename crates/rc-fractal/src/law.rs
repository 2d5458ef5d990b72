//! A power law with its ends: roll-off, cut-off, and what an instrument adds.

use crate::bins::{BIN_RATIO, FEW_WAVES, FEWEST_BINS, LEAST_RATIO, Limit, Point, SELF_AFFINE};

/// Penalty of each parameter of an end, in units of ln(number of bins). The criterion of Bayes has 1.
const CAUTION: f64 = 2.0;

/// Minimum fall of the spectrum at a cut-off, in ln C.
const CLIFF: f64 = 3.0;

/// Minimum increase of the exponent at a bend.
const LEAST_BEND: f64 = 0.6;

/// Maximum mean misfit of the bins in a law, in variances.
const MOST_MISFIT: f64 = 3.0;

/// Standard error of H from how rings average the spectrum, and from what a tip does to waves before the bend.
const OF_RINGS: f64 = 0.02;
const OF_TIP: f64 = 0.15;

/// Steps to the law with noise.
const ROUNDS: usize = 8;

/// Distance between the spectrum and its law at the limit of resolution, in ln C: a factor of 2.
const LIMIT: f64 = std::f64::consts::LN_2;

/// First possible roll-off, in waves per longer side. There are too few waves below it.
const FIRST_ROLL_OFF: f64 = 3.5;

/// Steps in ln k between possible ends, for each bin.
const STEPS: usize = 2;

/// What limits the power law at short waves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tail {
    /// Nothing up to the limit of the grid.
    None,
    /// No waves beyond this ln k.
    CutOff(f64),
    /// A factor exp(-g k²), as from a lens.
    Blur,
    /// A steeper power law from this ln k on, as from a tip.
    Bend(f64),
}

impl Tail {
    /// The term of ln C that multiplies the third unknown.
    fn term(self, ln_k: f64) -> f64 {
        match self {
            Self::None | Self::CutOff(_) => 0.0,
            Self::Blur => -(2.0 * ln_k).exp(),
            Self::Bend(at) => -(ln_k - at).max(0.0),
        }
    }

    fn parameters(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::CutOff(_) | Self::Blur => 1.0,
            Self::Bend(_) => 2.0,
        }
    }

    fn is_beyond(self, ln_k: f64) -> bool {
        matches!(self, Self::CutOff(at) if ln_k > at)
    }

    /// Whether a bin may contain the cut-off. Its mean says nothing.
    fn is_at(self, ln_k: f64) -> bool {
        matches!(self, Self::CutOff(at) if (at..at + BIN_RATIO.ln()).contains(&ln_k))
    }
}

/// C = exp(a - s max(ln k, r)) times the tail, plus noise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    /// ln k of the roll-off.
    roll_off: Option<f64>,
    tail: Tail,
    /// C of the noise; 0 for none.
    noise: f64,
    /// a, s and the factor of the tail's term.
    unknowns: [f64; 3],
    /// Variance of s.
    variance: f64,
    /// Misfit with the penalties of the ends.
    cost: f64,
}

impl Law {
    /// ln C of the power law alone, without roll-off.
    fn line(&self, ln_k: f64) -> f64 {
        self.unknowns[0] - self.unknowns[1] * ln_k
    }

    /// ln C without the noise.
    fn surface(&self, ln_k: f64) -> f64 {
        let from = self.roll_off.map_or(ln_k, |at| ln_k.max(at));
        self.line(from) + self.unknowns[2] * self.tail.term(ln_k)
    }

    pub(crate) fn value(&self, ln_k: f64) -> f64 {
        if self.noise > 0.0 { (self.surface(ln_k).exp() + self.noise).ln() } else { self.surface(ln_k) }
    }

    pub(crate) fn hurst(&self) -> f64 {
        0.5 * self.unknowns[1] - 1.0
    }

    pub(crate) fn ln_c(&self) -> f64 {
        self.unknowns[0]
    }

    /// ln k of the roll-off.
    pub(crate) fn roll_off(&self) -> Option<f64> {
        self.roll_off
    }

    /// ln k of the cut-off.
    pub(crate) fn cut_off(&self) -> Option<f64> {
        if let Tail::CutOff(at) = self.tail { Some(at) } else { None }
    }

    /// ln k of the end of the law, and its cause. `last` is that of the limit of the grid.
    pub(crate) fn end(&self, last: f64) -> (f64, Limit) {
        let first = self.roll_off.unwrap_or(0.0);
        let end = self.cut_off().unwrap_or(last).min(last);
        let n = 400;
        let steps = (0..=n).map(|i| first + (end - first) * f64::from(i) / f64::from(n));
        for ln_k in steps {
            let off = self.value(ln_k) - self.line(ln_k);
            if off.abs() > LIMIT {
                return (ln_k, if off > 0.0 { Limit::Noise } else { Limit::Blunt });
            }
        }
        match self.cut_off() {
            Some(at) if self.noise > 0.0 => (at, Limit::Noise),
            _ => (end, Limit::Grid),
        }
    }
}

/// The law that explains all `points` best, if it is self-affine over a factor of 4.
///
/// The second value is the standard error of H. It contains the spread of laws that explain the points nearly as well.
pub(crate) fn best(points: &[Point], longest: f64) -> Option<(Law, f64)> {
    let (first, last) = (points.first()?, points.last()?);
    if points.len() < FEWEST_BINS {
        return None;
    }
    let places: Vec<f64> = points
        .windows(2)
        .flat_map(|pair| {
            let width = pair[1].ln_k - pair[0].ln_k;
            (0..STEPS).map(move |i| pair[0].ln_k + width * (i as f64 + 0.5) / STEPS as f64)
        })
        .collect();
    let is_place = |at: &f64| last.ln_k - at > LEAST_RATIO.ln() && *at > (FIRST_ROLL_OFF * longest).ln();
    let of_roll_off = places.iter().copied().filter(is_place).map(Some);
    let roll_offs: Vec<_> = [None].into_iter().chain(of_roll_off).collect();
    let of_tail = places.iter().copied().filter(|at| at - first.ln_k > LEAST_RATIO.ln());
    let mut tails = vec![Tail::None, Tail::Blur];
    tails.extend(of_tail.flat_map(|at| [Tail::CutOff(at), Tail::Bend(at)]));
    let mut laws = Vec::new();
    for &roll_off in &roll_offs {
        for &tail in &tails {
            laws.extend([false, true].into_iter().filter_map(|noisy| fit(points, roll_off, tail, noisy)));
        }
    }
    laws.retain(|law| is_self_affine(law, points, longest));
    let best = *laws.iter().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let near = laws.iter().filter(|law| law.cost < best.cost + 2.0);
    let spread = near.fold(0.0_f64, |most, law| most.max((law.hurst() - best.hurst()).abs()));
    let systematic = if matches!(best.tail, Tail::Bend(_)) { OF_TIP } else { OF_RINGS };
    Some((best, (0.5 * best.variance.sqrt()).hypot(spread).hypot(systematic)))
}

/// Whether the part of a law between its ends is long enough, and near the points.
///
/// Waves longer than a third of the side are too few to make the part longer.
fn is_self_affine(law: &Law, points: &[Point], longest: f64) -> bool {
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return false };
    let from = law.roll_off.unwrap_or(first.ln_k);
    let (end, _) = law.end(last.ln_k);
    let inside = || points.iter().filter(|point| (from..=end).contains(&point.ln_k));
    let off = |point: &Point| point.ln_c - law.value(point.ln_k);
    let misfit: f64 = inside().map(|point| off(point).powi(2) / point.variance).sum();
    let n = inside().count();
    SELF_AFFINE.contains(&law.hurst())
        && end - from.max((FEW_WAVES * longest).ln()) >= LEAST_RATIO.ln() - 1e-9
        && n >= FEWEST_BINS
        && misfit <= MOST_MISFIT * n as f64
        && inside().all(|point| off(point).abs() <= point.tolerance)
}

/// The law with these ends that fits `points` best.
fn fit(points: &[Point], roll_off: Option<f64>, tail: Tail, noisy: bool) -> Option<Law> {
    let lowest = points.iter().fold(f64::INFINITY, |least, point| least.min(point.ln_c)).exp();
    let noise = if noisy { 0.7 * lowest } else { 0.0 };
    let mut law = Law { roll_off, tail, noise, unknowns: [0.0; 3], variance: 0.0, cost: f64::INFINITY };
    // Without noise the first step is exact.
    law.step(points, true)?;
    for _ in 0..if noisy { ROUNDS } else { 0 } {
        law.step(points, false)?;
    }
    match tail {
        Tail::Blur if law.unknowns[2] <= 0.0 => return None,
        Tail::Bend(_) if law.unknowns[2] < LEAST_BEND => return None,
        _ => {}
    }
    let n_ends = f64::from(u8::from(roll_off.is_some())) + tail.parameters() + f64::from(u8::from(noisy));
    law.cost = misfit(points, &law)? + CAUTION * n_ends * (points.len() as f64).ln();
    Some(law)
}

impl Law {
    /// A step of Gauss and Newton to the least misfit, from nothing but the noise if it is the `first`.
    fn step(&mut self, points: &[Point], first: bool) -> Option<()> {
        let n_surface = if matches!(self.tail, Tail::None | Tail::CutOff(_)) { 2 } else { 3 };
        let n = if first || self.noise <= 0.0 { n_surface } else { n_surface + 1 };
        let mut matrix = [[0.0; N]; N];
        let mut right = [0.0; N];
        for point in points.iter().filter(|point| !self.tail.is_at(point.ln_k)) {
            let Some((part, off)) = (if first { self.above_noise(point) } else { Some(self.off(point)) }) else {
                continue;
            };
            let from = self.roll_off.map_or(point.ln_k, |at| point.ln_k.max(at));
            let of_surface = [part, -part * from, part * self.tail.term(point.ln_k)];
            let row: [f64; N] = std::array::from_fn(|i| if i < n_surface { of_surface[i] } else { 1.0 - part });
            for i in 0..n {
                right[i] += row[i] * off / point.variance;
                for j in 0..n {
                    matrix[i][j] += row[i] * row[j] / point.variance;
                }
            }
        }
        let (found, variance) = solved(matrix, right, n)?;
        self.unknowns = std::array::from_fn(|i| self.unknowns[i] + if i < n_surface { found[i] } else { 0.0 });
        if n > n_surface {
            self.noise *= found[n_surface].clamp(-1.0, 1.0).exp();
        }
        self.variance = variance;
        Some(())
    }

    /// 1 and ln C of a bin without the noise. `None` if it is mostly noise.
    fn above_noise(&self, point: &Point) -> Option<(f64, f64)> {
        let part = 1.0 - self.noise / point.ln_c.exp();
        (part > 0.5 && !self.tail.is_beyond(point.ln_k)).then(|| (1.0, point.ln_c + part.ln()))
    }

    /// The part of the surface in a bin, and how far the bin is above the law.
    fn off(&self, point: &Point) -> (f64, f64) {
        if self.tail.is_beyond(point.ln_k) {
            return (0.0, point.ln_c - self.noise.ln());
        }
        let value = self.value(point.ln_k);
        ((self.surface(point.ln_k) - value).exp(), point.ln_c - value)
    }
}

/// Misfit of `law`, in variances. `None` if it has a cut-off where the spectrum does not fall enough.
fn misfit(points: &[Point], law: &Law) -> Option<f64> {
    let mut sum = 0.0;
    let mut is_cliff = true;
    for point in points {
        let square = |off: f64| off * off / point.variance;
        sum += if law.tail.is_at(point.ln_k) {
            1.0
        } else if !law.tail.is_beyond(point.ln_k) {
            square(point.ln_c - law.value(point.ln_k))
        } else if law.noise > 0.0 {
            is_cliff &= law.noise.ln() < law.line(point.ln_k) - LIMIT;
            square(point.ln_c - law.noise.ln())
        } else {
            // What is beyond is not part of the law, and costs what a bin that fits does.
            1.0 + square((point.ln_c - law.line(point.ln_k) + CLIFF).max(0.0))
        };
    }
    is_cliff.then_some(sum)
}

/// Maximum number of unknowns: a, s, the factor of the tail's term, and ln of the noise.
const N: usize = 4;

/// The solution of the first `n` equations, and the element (1, 1) of the inverse.
fn solved(matrix: [[f64; N]; N], right: [f64; N], n: usize) -> Option<([f64; N], f64)> {
    let mut m = matrix;
    let mut columns = right.map(|value| [value, 0.0]);
    columns[1][1] = 1.0;
    for i in 0..n {
        let pivot = m[i][i];
        if pivot.is_nan() || pivot <= 1e-12 * matrix[i][i] {
            return None;
        }
        for j in i + 1..n {
            let factor = m[j][i] / pivot;
            m[j] = std::array::from_fn(|k| m[j][k] - factor * m[i][k]);
            columns[j] = std::array::from_fn(|c| columns[j][c] - factor * columns[i][c]);
        }
    }
    let mut found = [[0.0; 2]; N];
    for i in (0..n).rev() {
        for c in 0..2 {
            let known: f64 = (i + 1..n).map(|k| m[i][k] * found[k][c]).sum();
            found[i][c] = (columns[i][c] - known) / m[i][i];
        }
    }
    Some((found.map(|row| row[0]), found[1][1]))
}
