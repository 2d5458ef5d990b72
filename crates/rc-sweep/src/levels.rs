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
}

/// A mean over realisations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    pub(crate) standard_error: f64,
    /// Estimated error of the finest grid.
    pub(crate) bias: f64,
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
    let variances = guarded(&levels);
    let counts: Vec<usize> = levels.iter().map(|level| level.realisations).collect();
    let mean: f64 = levels.iter().map(|level| level.mean).sum();
    let wanted = wanted * mean.abs();
    let bias = bias(&levels);
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
    Step::Done(Estimate { mean, standard_error: variance.sqrt(), bias, is_reached, levels })
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
        Self { realisations, mean, variance, cost, fine_cost: mean_of(&samples.fine_costs).max(1.0) }
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
            let error = estimate.standard_error.hypot(estimate.bias);
            assert!(estimate.is_reached && error <= wanted * estimate.mean, "{wanted}: {estimate:?}");
            assert!((estimate.mean - 1.0).abs() < 3.0 * error, "{wanted}: {estimate:?}");
            // The cost of differences is small. With enough realisations, the total cost is less than a third of the
            // cost on the finest grid.
            assert!(wanted > 0.005 || 3.0 * estimate.cost() < estimate.cost_of_plain_mean(), "{wanted}: {estimate:?}");
        }
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
        assert!(estimate.bias > 0.02 * estimate.mean, "{estimate:?}");
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
