//! Medians, and comparison of tables: text must agree exactly, numbers within a tolerance.
//!
//! FFT code paths depend on the processor, so the last digits of a result may; a table that changed in its sixth digit is
//! the same table, and one that changed in its fourth is not.

/// Numbers `a` (reference) and `b` agree when |a - b| ≤ `absolute` + `relative` · |a|.
#[derive(Clone, Copy, Debug)]
pub struct Numeric {
    /// Allowed whatever the reference is.
    pub absolute: f64,
    /// Allowed relative to the reference.
    pub relative: f64,
}

impl Numeric {
    /// The first difference between two tables, as a sentence.
    #[must_use]
    pub fn difference(self, reference: &str, test: &str) -> Option<String> {
        let (n_reference, n_test) = (reference.trim().lines().count(), test.trim().lines().count());
        if n_reference != n_test {
            return Some(format!("{n_reference} lines against {n_test}"));
        }
        let mut lines = reference.trim().lines().zip(test.trim().lines()).enumerate();
        lines.find_map(|(row, (a, b))| {
            let (a, b): (Vec<&str>, Vec<&str>) = (a.split(',').collect(), b.split(',').collect());
            let cell = a.iter().zip(&b).position(|(a, b)| !self.agree(a, b));
            let column = cell.or((a.len() != b.len()).then_some(a.len().min(b.len())))?;
            let shown = |cells: &[&str]| cells.get(column).map_or("nothing".to_owned(), ToString::to_string);
            Some(format!("line {}, column {}: {} against {}", row + 1, column + 1, shown(&a), shown(&b)))
        })
    }

    fn agree(self, reference: &str, test: &str) -> bool {
        match (reference.parse::<f64>(), test.parse::<f64>()) {
            (Ok(a), Ok(b)) => (a - b).abs() <= self.absolute + self.relative * a.abs(),
            _ => reference == test,
        }
    }
}

/// The middle of values, or the mean of the two in the middle; NaN without any.
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

    const TOLERANCE: Numeric = Numeric { absolute: 1e-12, relative: 1e-6 };

    #[test]
    fn medians() {
        assert_eq!((median(vec![4.0, 1.0, 2.0, 3.0]), median(vec![5.0])), (2.5, 5.0));
        assert!(median(Vec::new()).is_nan());
    }

    #[test]
    fn numbers_within_the_tolerance_agree() {
        assert_eq!(TOLERANCE.difference("x,y\nage,1.000000e0\n", "x,y\nage,1.0000005e0"), None);
        assert_eq!(TOLERANCE.difference("0.000000e0", "9e-13"), None);
    }

    #[test]
    fn other_numbers_texts_and_shapes_differ() {
        for (reference, test) in [
            ("1.000000e0", "1.000002e0"),
            ("0.000000e0", "2e-12"),
            ("radius,1.0", "width,1.0"),
            ("1.0,2.0", "1.0"),
            ("1.0\n2.0", "1.0"),
            ("1.0", "NaN"),
        ] {
            assert!(TOLERANCE.difference(reference, test).is_some(), "{reference} against {test}");
        }
    }
}
