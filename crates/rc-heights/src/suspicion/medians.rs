//! Medians of few values.

/// The median of values without `NaN`, or `None` if there are none. The values are rearranged.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    let n = values.len();
    if n == 0 {
        return None;
    }
    let (below, upper, _) = values.select_nth_unstable_by(n / 2, f64::total_cmp);
    if n % 2 == 1 {
        return Some(*upper);
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(0.5 * (lower + *upper))
}

/// 1.4826 times the median of absolute deviations from `centre`: the standard deviation of a normal distribution.
pub(super) fn robust_deviation(values: &mut [f64], centre: f64) -> Option<f64> {
    for value in values.iter_mut() {
        *value = (*value - centre).abs();
    }
    median(values).map(|median| 1.4826 * median)
}

/// The standard deviation of a normal distribution with this sixth of seven parts of absolute values.
///
/// Spikes do not change it unless they are a seventh of all points. There must be at least one value.
pub(super) fn upper_deviation(absolute: &mut [f64]) -> f64 {
    let i = 6 * absolute.len() / 7;
    // A normal deviation is within 1.465 standard deviations in six of seven cases.
    *absolute.select_nth_unstable_by(i, f64::total_cmp).1 / 1.465
}

/// The exchanges of a network that sorts eight values far enough for the fourth and fifth.
const NETWORK: [(usize, usize); 17] = [
    (0, 1),
    (2, 3),
    (4, 5),
    (6, 7),
    (0, 2),
    (1, 3),
    (4, 6),
    (5, 7),
    (1, 2),
    (5, 6),
    (0, 4),
    (3, 7),
    (1, 5),
    (2, 6),
    (2, 4),
    (3, 5),
    (3, 4),
];

/// The medians of eight values each, for `N` places at once. There must be no `NaN`.
pub(super) fn medians_of_eight<const N: usize>(mut v: [[f64; N]; 8]) -> [f64; N] {
    for (a, b) in NETWORK {
        let (before, after) = v.split_at_mut(b);
        for (low, high) in before[a].iter_mut().zip(&mut after[0]) {
            (*low, *high) = if *low < *high { (*low, *high) } else { (*high, *low) };
        }
    }
    std::array::from_fn(|i| 0.5 * (v[3][i] + v[4][i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_network_finds_the_median_of_every_order_of_zeros_and_ones() {
        // A network that sorts all zeros and ones sorts everything.
        for bits in 0..256_u32 {
            let values: [[f64; 1]; 8] = std::array::from_fn(|i| [f64::from(bits >> i & 1)]);
            let expected = median(&mut values.concat());
            assert_eq!(Some(medians_of_eight(values)[0]), expected, "{bits:08b}");
        }
        assert_eq!((median(&mut []), median(&mut [3.0]), median(&mut [4.0, 1.0])), (None, Some(3.0), Some(2.5)));
        assert_eq!(robust_deviation(&mut [1.0, 2.0, 9.0], 2.0), Some(1.4826));
    }
}
