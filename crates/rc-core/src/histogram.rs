//! Probability densities.

/// A probability density in bins of equal width.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Histogram {
    /// Lower end of the first bin.
    pub low: f64,
    /// Upper end of the last bin.
    pub high: f64,
    /// Density in each bin. Its integral is 1, or 0 if no value is in the range.
    pub density: Vec<f64>,
}

impl Histogram {
    /// The density of the values in [`low`, `high`], in `n_bins` bins.
    ///
    /// Values outside this range are ignored. Without any value inside it, the density is zero everywhere.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>, low: f64, high: f64, n_bins: usize) -> Self {
        let mut counts = vec![0_u64; n_bins];
        let per_width = n_bins as f64 / (high - low);
        for value in values.filter(|value| (low..=high).contains(value)) {
            counts[(((value - low) * per_width) as usize).min(n_bins - 1)] += 1;
        }
        let total: u64 = counts.iter().sum();
        let scale = if total > 0 { per_width / total as f64 } else { 0.0 };
        Self { low, high, density: counts.iter().map(|count| *count as f64 * scale).collect() }
    }

    /// Middle and density of each bin.
    pub fn bins(&self) -> impl Iterator<Item = (f64, f64)> {
        let width = (self.high - self.low) / self.density.len() as f64;
        self.density.iter().enumerate().map(move |(i, density)| (self.low + (i as f64 + 0.5) * width, *density))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_of_a_density_is_one() {
        let histogram = Histogram::of((0..1000).map(f64::from), 0.0, 999.0, 40);
        let integral = histogram.density.iter().sum::<f64>() * 999.0 / histogram.density.len() as f64;
        assert!((integral - 1.0).abs() < 1e-12, "integral {integral}");
    }
}
