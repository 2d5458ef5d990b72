//! Roughness parameters of a profile, as in ISO 21920-2 and ISO 4287.

/// Height parameters of a profile, in the unit of its heights. They are relative to the mean.
///
/// *Accuracy*: test `parameters_of_a_wave_are_those_of_a_wave`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProfileParameters {
    /// Mean absolute height, Ra of a roughness profile and Pa of a profile without filters.
    pub a: f64,
    /// Root mean square height, Rq or Pq.
    pub q: f64,
    /// Skewness ⟨h³⟩/q³, Rsk or Psk: 0 for a Gaussian.
    pub sk: f64,
    /// Kurtosis ⟨h⁴⟩/q⁴, Rku or Pku: 3 for a Gaussian.
    pub ku: f64,
    /// Height of the highest peak of a section above the mean, averaged over the sections: Rp or Pp.
    pub p: f64,
    /// Depth of the deepest valley of a section, likewise: Rv or Pv.
    pub v: f64,
    /// Mean over the sections of their height from valley to peak: Rz or Pz.
    pub z: f64,
    /// Height from the deepest valley to the highest peak of all: Rt or Pt.
    pub t: f64,
}

impl ProfileParameters {
    /// The parameters of `heights`, which are divided into this number of equal sections. `NaN` is passed over.
    ///
    /// Without heights, all are `NaN`.
    #[must_use]
    pub fn of(heights: &[f64], sections: usize) -> Self {
        let measured = || heights.iter().copied().filter(|height| !height.is_nan());
        let n = measured().count() as f64;
        let mean = measured().sum::<f64>() / n;
        let moment = |power: i32| measured().map(|height| (height - mean).powi(power)).sum::<f64>() / n;
        let q = moment(2).sqrt();
        let ends = |part: &[f64]| {
            let part = part.iter().copied().filter(|height| !height.is_nan());
            part.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| [low.min(height), high.max(height)])
        };
        let sections = sections.clamp(1, heights.len().max(1));
        let cut = |i: usize| i * heights.len() / sections;
        let of_sections: Vec<[f64; 2]> =
            (0..sections).map(|i| ends(&heights[cut(i)..cut(i + 1)])).filter(|[low, high]| low <= high).collect();
        let over_sections = |of: &dyn Fn([f64; 2]) -> f64| {
            of_sections.iter().map(|ends| of(*ends)).sum::<f64>() / of_sections.len() as f64
        };
        let [low, high] = ends(heights);
        Self {
            a: measured().map(|height| (height - mean).abs()).sum::<f64>() / n,
            q,
            sk: moment(3) / q.powi(3),
            ku: moment(4) / q.powi(4),
            p: over_sections(&|[_, high]| high - mean),
            v: over_sections(&|[low, _]| mean - low),
            z: over_sections(&|[low, high]| high - low),
            t: if n > 0.0 { high - low } else { f64::NAN },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn parameters_of_a_wave_are_those_of_a_wave() {
        let wave = |i: usize| 7.0 + 2.0 * (TAU * (i as f64 + 0.5) / 1000.0).sin();
        let mut heights: Vec<f64> = (0..10_000).map(wave).collect();
        let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-4, "{found} for {expected}");
        for sections in [1, 5] {
            let ProfileParameters { a, q, sk, ku, p, v, z, t } = ProfileParameters::of(&heights, sections);
            for (found, expected) in
                [(a, 4.0 / PI), (q, 2.0_f64.sqrt()), (sk, 0.0), (ku, 1.5), (p, 2.0), (v, 2.0), (z, 4.0), (t, 4.0)]
            {
                close(found, expected);
            }
        }
        // A scratch of one point is in one of five sections. A missing point is passed over.
        heights[4321] = -3.0;
        heights[10] = f64::NAN;
        let ProfileParameters { z, t, .. } = ProfileParameters::of(&heights, 5);
        close(t, 12.0);
        close(z, 4.0 + 8.0 / 5.0);
        assert!(ProfileParameters::of(&[], 1).q.is_nan());
    }
}
