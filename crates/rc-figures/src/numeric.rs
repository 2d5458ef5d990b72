//! Medians.

/// The median of `values`; NaN without values.
///
/// For an even number of values it is the mean of the two in the middle.
#[must_use]
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!((median(vec![4.0, 1.0, 2.0, 3.0]), median(vec![5.0])), (2.5, 5.0));
        assert!(median(Vec::new()).is_nan());
    }
}
