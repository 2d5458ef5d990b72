//! The Gaussian filter of profiles, ISO 16610-21.

use rc_fft::{Complex64, TransformReal};

/// Ratio α of the width of the weight to the cut-off wavelength, √(ln 2/π).
///
/// A wave of the cut-off wavelength keeps half of its amplitude.
const ALPHA: f64 = 0.469_718_639_349_825_8;

/// Distance, in cut-off wavelengths, beyond which weights are zero. They are below 1e-6 of the largest.
const REACH: f64 = 1.0;

/// The mean line of a profile: `heights` at equal steps, smoothed with this `cutoff` wavelength in steps.
///
/// The weight at the distance x is exp(-π (x/α λ)²)/(α λ) (ISO 16610-21). Near its ends the profile ends, and the sum of
/// the weights that are left is 1 there. So values within half a cut-off of the ends have a larger error, and are
/// usually omitted.
///
/// # Panics
/// For a cut-off that is not positive.
#[must_use]
pub fn gaussian_mean_line(heights: &[f64], cutoff: f64) -> Vec<f64> {
    assert!(cutoff > 0.0, "a cut-off of {cutoff}");
    let n = heights.len();
    let reach = ((REACH * cutoff) as usize).min(n.saturating_sub(1));
    let weights: Vec<f64> =
        (0..=reach).map(|i| (-std::f64::consts::PI * (i as f64 / (ALPHA * cutoff)).powi(2)).exp()).collect();
    // Twice the profile, so that no end acts on the other.
    let period = (n + reach + 1).next_power_of_two();
    let middle = heights.iter().sum::<f64>() / n.max(1) as f64;
    let transformed = |value: &dyn Fn(usize) -> f64| {
        let mut values: Vec<Complex64> = (0..period).map(|i| Complex64::new(value(i), 0.0)).collect();
        f64::complex_forward(period).process(&mut values);
        values
    };
    let weight = |i: usize| weights.get(i.min(period - i)).copied().unwrap_or(0.0);
    let mut waves = transformed(&|i| heights.get(i).map_or(0.0, |height| height - middle));
    for (wave, weight) in waves.iter_mut().zip(transformed(&weight)) {
        *wave *= weight.re / period as f64;
    }
    f64::complex_inverse(period).process(&mut waves);
    // Sums of weights up to a distance, for the weights that are left near an end.
    let sums: Vec<f64> = weights
        .iter()
        .scan(0.0, |sum, weight| {
            *sum += weight;
            Some(*sum)
        })
        .collect();
    let side = |points: usize| sums[points.min(reach)];
    (0..n).map(|i| middle + waves[i].re / (side(i) + side(n - 1 - i) - weights[0])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_of_the_cut_off_keeps_half_and_others_the_share_of_the_standard() {
        let (n, cutoff) = (4000, 200.0);
        for (wavelength, kept) in [(200.0, 0.5), (400.0, 0.5_f64.powf(0.25)), (100.0, 0.5_f64.powi(4))] {
            let wave = |i: usize| (std::f64::consts::TAU * i as f64 / wavelength).cos();
            let heights: Vec<f64> = (0..n).map(wave).collect();
            let line = gaussian_mean_line(&heights, cutoff);
            for i in (200..n - 200).step_by(7) {
                assert!((line[i] - kept * wave(i)).abs() < 1e-5, "{wavelength}, point {i}: {}", line[i]);
            }
        }
    }

    #[test]
    fn it_is_the_weighted_mean_of_the_points_that_are_there() {
        let heights: Vec<f64> = (0..50).map(|i| 5.0 + f64::from(i * i % 17)).collect();
        for cutoff in [3.3, 12.0, 90.0] {
            let line = gaussian_mean_line(&heights, cutoff);
            for (i, found) in line.iter().enumerate() {
                let weight =
                    |j: usize| (-std::f64::consts::PI * (i.abs_diff(j) as f64 / (ALPHA * cutoff)).powi(2)).exp();
                let near = (0..50).filter(|j| i.abs_diff(*j) <= cutoff as usize);
                let [sum, all] = near.fold([0.0; 2], |[sum, all], j| [sum + weight(j) * heights[j], all + weight(j)]);
                assert!((found - sum / all).abs() < 1e-12, "{cutoff}, point {i}: {found} for {}", sum / all);
            }
        }
    }
}
