//! Fits and averages of figures: a straight line, mean and scatter.

/// A straight line by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    /// Coefficient of determination R².
    pub(crate) r_squared: f64,
}

impl Line {
    /// The line through at least two points with different x; NaN otherwise.
    pub(crate) fn fit(points: &[(f64, f64)]) -> Self {
        let n = points.len() as f64;
        let (x_mean, y_mean) =
            (points.iter().map(|at| at.0).sum::<f64>() / n, points.iter().map(|at| at.1).sum::<f64>() / n);
        let sum = |of: &dyn Fn(f64, f64) -> f64| points.iter().map(|at| of(at.0 - x_mean, at.1 - y_mean)).sum::<f64>();
        let slope = sum(&|x, y| x * y) / sum(&|x, _| x * x);
        let residual = sum(&|x, y| (y - slope * x).powi(2));
        Self { slope, intercept: y_mean - slope * x_mean, r_squared: 1.0 - residual / sum(&|_, y| y * y) }
    }

    pub(crate) fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}

/// Mean and standard deviation of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sample {
    pub(crate) mean: f64,
    /// Standard deviation of one value, with the divisor n - 1.
    pub(crate) deviation: f64,
    n: usize,
}

impl Sample {
    pub(crate) fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
        Self { mean, deviation: (squares / (n - 1.0)).sqrt(), n: values.len() }
    }

    /// Standard error of the mean.
    pub(crate) fn error(&self) -> f64 {
        self.deviation / (self.n as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_through_points_on_a_line_is_that_line() {
        let line = Line::fit(&[(1.0, 5.0), (2.0, 7.0), (4.0, 11.0)]);
        assert!((line.slope - 2.0).abs() < 1e-14 && (line.intercept - 3.0).abs() < 1e-13, "{line:?}");
        assert!((line.r_squared - 1.0).abs() < 1e-14 && (line.at(10.0) - 23.0).abs() < 1e-13, "{line:?}");
    }

    /// The residuals from the line y = x are -1, 2, -1, so their squares add up to 6. The total sum of squares is 8.
    #[test]
    fn r_squared_is_the_part_that_a_line_explains() {
        let line = Line::fit(&[(-1.0, -2.0), (0.0, 2.0), (1.0, 0.0)]);
        assert!((line.slope - 1.0).abs() < 1e-15 && line.intercept.abs() < 1e-15, "{line:?}");
        assert!((line.r_squared - 0.25).abs() < 1e-15, "{line:?}");
    }

    #[test]
    fn a_sample_has_its_mean_deviation_and_error() {
        let sample = Sample::of(&[1.0, 2.0, 3.0, 6.0]);
        assert!((sample.mean - 3.0).abs() < 1e-15 && (sample.deviation - (14_f64 / 3.0).sqrt()).abs() < 1e-14);
        assert!((sample.error() - (14_f64 / 12.0).sqrt()).abs() < 1e-14, "{sample:?}");
    }
}
