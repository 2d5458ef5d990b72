//! Multilevel Monte Carlo, a mean over realisations on several grids.
//!
//! There are many realisations on coarse grids, and few differences to finer grids. Source: M. B. Giles, Acta Numerica
//! 24 (2015), 259-328.
//!
//! The mean on the finest grid is the mean on the coarsest grid plus the means of the differences from grid to grid.
//! Both values of a difference have the same realisation. The differences vary little, so they need few realisations.
//! The numbers of realisations on the levels make the variance of the sum small enough at minimum cost.

use serde::Serialize;

/// Numbers of realisations at the start of the coarsest and of other levels.
const PILOT: [usize; 2] = [16, 5];

/// Number of levels at the start, if there are so many grids.
///
/// Fewer levels do not show how differences decrease.
const FIRST_LEVELS: usize = 3;

/// Maximum growth of a level in one step. The variance from a few realisations may be much too large.
const GROWTH: usize = 4;

/// Maximum number of realisations of a level. A larger number means that an error was mistyped.
pub(crate) const MOST_REALISATIONS: usize = 10_000;

/// Maximum ratio of the bias to the wanted error.
///
/// The first value applies while finer grids are left. Above it, a finer grid is added. The second value applies on the
/// last grid.
const BIAS_SHARE: [f64; 2] = [0.5, 0.9];

/// Minimum ratio of the variance of a difference to the variance of the previous difference.
///
/// Elements of half the side divide the variance by 8. A few realisations may appear not to vary at all (Giles, Sec.
/// 3.3).
const SMALLEST_RATIO: f64 = 1.0 / 16.0;

/// Relative increase of the variance of a mean by the choice of its number of values, times this number.
///
/// The number is more often large enough when the variance seems small. The value was measured with normal values.
const STOPPING: f64 = 1.0;

/// The realisations of one level so far, in the order of seeds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Samples {
    /// Quantity on the grid of the level minus quantity on the next coarser grid.
    ///
    /// On the coarsest grid it is the quantity itself.
    pub(crate) differences: Vec<f64>,
    /// Cost of each realisation: elements times applications of the operator, on both grids.
    pub(crate) costs: Vec<f64>,
    /// Cost of each realisation on the grid of the level alone.
    pub(crate) fine_costs: Vec<f64>,
}

/// Results on one level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LevelMean {
    /// Number of realisations.
    pub realisations: usize,
    /// Mean of the difference to the next coarser grid. On the coarsest grid, mean of the quantity.
    pub mean: f64,
    /// Variance of the difference, or of the quantity, between realisations.
    pub variance: f64,
    /// Mean cost of a realisation, in elements times applications of the operator.
    pub cost: f64,
    /// Mean cost of a realisation on the finer of the two grids alone.
    #[serde(skip)]
    fine_cost: f64,
    /// Skewness of the differences.
    #[serde(skip)]
    skewness: f64,
}

/// A mean over realisations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    /// Rms error of the mean, with the uncertainty of the variances of few realisations.
    pub(crate) standard_error: f64,
    /// Estimated error of the finest grid. `None` if there is only one.
    pub(crate) bias: Option<f64>,
    /// Whether the wanted error is reached.
    ///
    /// It is compared with the square root of the sum of both squared errors.
    pub(crate) is_reached: bool,
    pub(crate) levels: Vec<LevelMean>,
}

/// The next step of the procedure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// More realisations are needed. These are the total numbers for each level.
    More(Vec<usize>),
    /// The wanted error is reached, or cannot be reached.
    Done(Estimate),
}

/// Numbers of realisations at the start, for at most `n_grids` levels.
pub(crate) fn pilot(n_grids: usize) -> Vec<usize> {
    (0..n_grids.min(FIRST_LEVELS)).map(|level| PILOT[level.min(1)]).collect()
}

/// The next step after these levels, coarsest first.
///
/// There are at most `n_grids` levels. `wanted` is the relative rms error of the mean.
pub(crate) fn next(samples: &[Samples], n_grids: usize, wanted: f64) -> Step {
    let levels: Vec<LevelMean> = samples.iter().map(LevelMean::of).collect();
    let variances: Vec<f64> =
        guarded(&levels).iter().zip(&levels).map(|(variance, level)| variance * level.excess()).collect();
    let counts: Vec<usize> = levels.iter().map(|level| level.realisations).collect();
    let mean: f64 = levels.iter().map(|level| level.mean).sum();
    let wanted = wanted * mean.abs();
    let known = (n_grids > 1).then(|| bias(&levels));
    let bias = known.unwrap_or(0.0);
    let is_last = levels.len() == n_grids;
    let most_bias = BIAS_SHARE[usize::from(is_last)] * wanted;
    let variance: f64 = variances.iter().zip(&counts).map(|(variance, &n)| variance / n as f64).sum();
    let most_variance = wanted.powi(2) - bias.min(most_bias).powi(2);
    if variance > most_variance {
        let more = grown(&levels, &variances, most_variance);
        if more != counts {
            return Step::More(more);
        }
    } else if bias > most_bias && !is_last {
        return Step::More(counts.into_iter().chain([PILOT[1]]).collect());
    }
    let is_reached = variance + bias.powi(2) <= wanted.powi(2);
    Step::Done(Estimate { mean, standard_error: variance.sqrt(), bias: known, is_reached, levels })
}

/// The numbers of realisations that give a variance at minimum cost.
///
/// The growth of a level in one step is limited.
fn grown(levels: &[LevelMean], variances: &[f64], most_variance: f64) -> Vec<usize> {
    let sum: f64 = levels.iter().zip(variances).map(|(level, variance)| (variance * level.cost).sqrt()).sum();
    let number = |(level, variance): (&LevelMean, &f64)| {
        let best = (sum * (variance / level.cost).sqrt() / most_variance).ceil() as usize;
        best.min(GROWTH * level.realisations).min(MOST_REALISATIONS).max(level.realisations)
    };
    levels.iter().zip(variances).map(number).collect()
}

/// Variances of the levels, with a lower bound that excludes implausibly small values.
fn guarded(levels: &[LevelMean]) -> Vec<f64> {
    let mut variances: Vec<f64> = levels.iter().map(|level| level.variance).collect();
    for level in 2..variances.len() {
        variances[level] = variances[level].max(SMALLEST_RATIO * variances[level - 1]);
    }
    variances
}

/// Estimated error of the finest grid.
///
/// The quantity is assumed to converge at first order. The remaining error is then as large as the last difference, or
/// half of the difference before.
fn bias(levels: &[LevelMean]) -> f64 {
    match levels {
        [_, .., before, last] => last.mean.abs().max(0.5 * before.mean.abs()),
        [_, last] => last.mean.abs(),
        _ => f64::INFINITY,
    }
}

impl LevelMean {
    fn of(samples: &Samples) -> Self {
        let mean_of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let realisations = samples.differences.len();
        let mean = mean_of(&samples.differences);
        let squares: f64 = samples.differences.iter().map(|value| (value - mean).powi(2)).sum();
        let variance = squares / (realisations.max(2) - 1) as f64;
        let cost = mean_of(&samples.costs).max(1.0);
        let cubes: f64 = samples.differences.iter().map(|value| (value - mean).powi(3)).sum();
        let skewness = if squares > 0.0 { cubes * (realisations as f64).sqrt() / squares.powf(1.5) } else { 0.0 };
        Self { realisations, mean, variance, cost, fine_cost: mean_of(&samples.fine_costs).max(1.0), skewness }
    }

    /// Mean square of the error of the mean, relative to that expected from the variance of these realisations.
    ///
    /// Few realisations do not give the variance itself, and those with a small variance end the procedure. Normal
    /// values give the mean square of Student's t, (n - 1)/(n - 3). The skewness γ adds 2 γ²/n, since the mean and the
    /// variance are then too small together (P. Hall, The Bootstrap and Edgeworth Expansion, 1992, Ch. 2).
    fn excess(&self) -> f64 {
        let n = self.realisations.max(4) as f64;
        (n - 1.0) / (n - 3.0) * (1.0 + (STOPPING + 2.0 * self.skewness.powi(2)) / n)
    }
}

impl Estimate {
    /// Elements times applications of the operator, for all realisations.
    pub(crate) fn cost(&self) -> f64 {
        self.levels.iter().map(|level| level.realisations as f64 * level.cost).sum()
    }

    /// Cost of the same standard error on the finest grid alone.
    ///
    /// The variance is that of the coarsest level.
    pub(crate) fn cost_of_plain_mean(&self) -> f64 {
        match self.levels[..] {
            [coarsest, .., finest] => coarsest.variance / self.standard_error.powi(2) * finest.fine_cost,
            _ => self.cost(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quantity with mean 1 and standard deviation 0.1 on an infinitely fine grid.
    ///
    /// Each grid adds `bias` and noise, which decrease by factors of 2 and √8 from grid to grid.
    fn level(level: usize, n: usize, bias: f64) -> Samples {
        let unit = |i: usize, salt: f64| (12.0_f64).sqrt() * ((i as f64 * 0.618_033_988_75 + salt).fract() - 0.5);
        let on = |grid: usize, i: usize| {
            let factor = 0.5_f64.powi(grid as i32);
            let own = 0.3 * level as f64;
            1.0 + 0.1 * unit(i, own) + bias * factor + 0.01 * factor.powf(1.5) * unit(7 * i, own + 0.1 * grid as f64)
        };
        let difference = |i| on(level, i) - if level > 0 { on(level - 1, i) } else { 0.0 };
        let cost = |grid: usize| 4_f64.powi(grid as i32);
        let pair = cost(level) + if level > 0 { cost(level - 1) } else { 0.0 };
        Samples {
            differences: (0..n).map(difference).collect(),
            costs: vec![pair; n],
            fine_costs: vec![cost(level); n],
        }
    }

    fn solve(n_grids: usize, bias: f64, wanted: f64) -> Estimate {
        let mut counts = pilot(n_grids);
        for _ in 0..50 {
            let samples: Vec<Samples> = counts.iter().enumerate().map(|(l, &n)| level(l, n, bias)).collect();
            match next(&samples, n_grids, wanted) {
                Step::Done(estimate) => return estimate,
                Step::More(more) => {
                    assert!(more.len() > counts.len() || more.iter().zip(&counts).any(|(more, n)| more > n));
                    counts = more;
                }
            }
        }
        panic!("no end: {counts:?}");
    }

    #[test]
    fn the_mean_is_within_its_error_at_a_fraction_of_the_cost() {
        for wanted in [0.02, 0.005, 0.002] {
            let estimate = solve(6, 0.002, wanted);
            let error = estimate.standard_error.hypot(estimate.bias.expect("several grids"));
            assert!(estimate.is_reached && error <= wanted * estimate.mean, "{wanted}: {estimate:?}");
            assert!((estimate.mean - 1.0).abs() < 3.0 * error, "{wanted}: {estimate:?}");
            // The cost of differences is small. With enough realisations, the total cost is less than a third of the
            // cost on the finest grid.
            assert!(wanted > 0.005 || 3.0 * estimate.cost() < estimate.cost_of_plain_mean(), "{wanted}: {estimate:?}");
        }
    }

    #[test]
    fn a_mean_on_one_grid_is_a_plain_mean() {
        let estimate = solve(1, 0.002, 0.005);
        assert!(estimate.is_reached && estimate.bias.is_none() && estimate.levels.len() == 1, "{estimate:?}");
        assert!(estimate.standard_error <= 0.005 * estimate.mean, "{estimate:?}");
        assert!((estimate.cost() / estimate.cost_of_plain_mean() - 1.0).abs() < 1e-12, "{estimate:?}");
    }

    #[test]
    fn most_realisations_are_on_the_coarsest_grid() {
        let numbers: Vec<usize> = solve(6, 0.002, 0.002).levels.iter().map(|level| level.realisations).collect();
        assert!(numbers.windows(2).all(|pair| pair[0] >= pair[1]) && numbers[0] > 1000, "{numbers:?}");
    }

    #[test]
    fn grids_are_added_until_the_bias_is_small() {
        let levels = |bias| solve(6, bias, 0.005).levels.len();
        assert_eq!(
            (levels(0.0), levels(0.02), levels(0.04)),
            (3, 4, 5),
            "at first order the last difference is what is missing"
        );
        let estimate = solve(4, 0.2, 0.005);
        assert!(!estimate.is_reached && estimate.levels.len() == 4, "{estimate:?}");
        assert!(estimate.bias.is_some_and(|bias| bias > 0.02 * estimate.mean), "{estimate:?}");
    }

    /// Values without correlation, of mean 0 and variance 1 (SplitMix64).
    ///
    /// They are normal for `shape` 0, and else of a gamma distribution with skewness 2/√shape.
    fn value(shape: usize, i: u64) -> f64 {
        let uniform = |k: u64| {
            let mut bits = (8 * i + k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 + f64::EPSILON
        };
        if shape == 0 {
            return (-2.0 * uniform(0).ln()).sqrt() * (std::f64::consts::TAU * uniform(1)).cos();
        }
        let gamma: f64 = (0..shape as u64).map(|k| -uniform(k).ln()).sum();
        (gamma - shape as f64) / (shape as f64).sqrt()
    }

    /// The number of realisations, and the error of the mean in units of its standard error.
    ///
    /// The quantity has mean 1 and standard deviation 0.1 on the coarsest grid. Differences between grids are 0.004
    /// times 2^-level, with the standard deviation 0.03 at first, and then smaller by √8 from grid to grid.
    fn error_of(run: u64, shape: usize, n_grids: usize, wanted: f64) -> (usize, f64) {
        let mean = |level: i32| if level == 0 { 1.0 } else { 0.004 * 0.5_f64.powi(level) };
        let spread = |level: i32| if level == 0 { 0.1 } else { 0.03 * 8.0_f64.powf(-0.5 * f64::from(level - 1)) };
        let of_level = |(level, &n): (usize, &usize)| {
            let at = |i: usize| {
                let own = value(shape, (run << 24) + ((level as u64) << 16) + i as u64);
                mean(level as i32) + spread(level as i32) * own
            };
            let cost = 4_f64.powi(level as i32);
            Samples { differences: (0..n).map(at).collect(), costs: vec![cost; n], fine_costs: vec![cost; n] }
        };
        let mut counts = pilot(n_grids);
        loop {
            let samples: Vec<Samples> = counts.iter().enumerate().map(of_level).collect();
            match next(&samples, n_grids, wanted) {
                Step::More(more) => counts = more,
                Step::Done(found) => {
                    let truth: f64 = (0..counts.len() as i32).map(mean).sum();
                    return (counts.iter().sum(), (found.mean - truth) / found.standard_error);
                }
            }
        }
    }

    #[test]
    fn the_standard_error_is_the_rms_error_also_of_few_realisations() {
        // The skewness is 0, 1 and 1.4.
        for shape in [0, 4, 2] {
            let cases = [(2, 0.014), (2, 0.02), (2, 0.028), (4, 0.018), (4, 0.028)];
            let runs = cases
                .into_iter()
                .flat_map(|(n_grids, wanted)| (0..250).map(move |run| error_of(run, shape, n_grids, wanted)));
            let errors: Vec<f64> = runs.filter(|(n, _)| (16..=100).contains(n)).map(|(_, error)| error).collect();
            let rms = (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt();
            assert!(errors.len() > 500 && (0.85..1.1).contains(&rms), "shape {shape}: {rms} of {} runs", errors.len());
        }
    }

    #[test]
    fn what_does_not_vary_needs_no_more_than_the_pilot() {
        let same =
            |value: f64, n| Samples { differences: vec![value; n], costs: vec![1.0; n], fine_costs: vec![1.0; n] };
        let Step::Done(estimate) = next(&[same(0.5, 16), same(0.0, 5)], 2, 0.01) else { panic!("not done") };
        assert_eq!((estimate.mean, estimate.standard_error, estimate.is_reached), (0.5, 0.0, true));
        // A mean of zero has no relative error.
        let Step::Done(zero) = next(&[same(0.0, 16), same(0.0, 5)], 2, 0.01) else { panic!("not done") };
        assert!(zero.is_reached && zero.mean == 0.0);
    }
}
