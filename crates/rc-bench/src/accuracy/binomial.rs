//! The binomial distribution.

/// Probability of at most `held` successes in `n` trials, each with the probability `p`.
pub(super) fn at_most(held: usize, n: usize, p: f64) -> f64 {
    let mut logarithm = n as f64 * (-p).ln_1p();
    let mut sum = logarithm.exp();
    for k in 1..=held.min(n) {
        logarithm += ((n - k + 1) as f64 / k as f64).ln() + p.ln() - (-p).ln_1p();
        sum += logarithm.exp();
    }
    sum.min(1.0)
}

/// Probability of at least `held` successes in `n` trials.
pub(super) fn at_least(held: usize, n: usize, p: f64) -> f64 {
    at_most(n - held, n, 1.0 - p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_the_distribution() {
        // Two dice: at most one six in two throws is 35/36.
        assert!((at_most(1, 2, 1.0 / 6.0) - 35.0 / 36.0).abs() < 1e-14);
        assert!((at_least(2, 2, 1.0 / 6.0) - 1.0 / 36.0).abs() < 1e-14);
        assert!((at_most(400, 400, 0.93) - 1.0).abs() < 1e-12);
        let (low, high) = (at_most(351, 400, 0.93), at_least(352, 400, 0.93));
        assert!((low + high - 1.0).abs() < 1e-12);
        assert!((1e-5..1e-3).contains(&low), "{low}");
    }
}
