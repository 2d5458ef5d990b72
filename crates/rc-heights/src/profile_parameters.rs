//! Roughness parameters of a profile, as in ISO 21920-2 and ISO 4287.

/// Height parameters of a profile, in the unit of its heights, above a mean line.
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
    /// Height of the highest peak of a section above the mean line, averaged over the sections: Rp or Pp.
    pub p: f64,
    /// Depth of the deepest valley of a section, likewise: Rv or Pv.
    pub v: f64,
    /// Mean over the sections of their height from valley to peak: Rz or Pz.
    pub z: f64,
    /// Height from the deepest valley to the highest peak of all: Rt or Pt.
    pub t: f64,
}

impl ProfileParameters {
    /// The parameters of `heights` about their mean, in one section. `NaN` is passed over.
    ///
    /// Without heights, all are `NaN`.
    #[must_use]
    pub fn of(heights: &[f64]) -> Self {
        let measured = || heights.iter().copied().filter(|height| !height.is_nan());
        Self::about(measured().sum::<f64>() / measured().count() as f64, heights, 1)
    }

    /// The parameters of `heights` above the mean line at the height `line`, in this number of equal sections.
    ///
    /// The mean line of a roughness profile is that of its filter, 0, and not the mean of the evaluated part (ISO
    /// 21920-2: ordinates of the profile). `NaN` is passed over. Without heights, all are `NaN`.
    #[must_use]
    pub fn about(line: f64, heights: &[f64], sections: usize) -> Self {
        let measured = || heights.iter().copied().filter(|height| !height.is_nan());
        let n = measured().count() as f64;
        let moment = |power: i32| measured().map(|height| (height - line).powi(power)).sum::<f64>() / n;
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
            a: measured().map(|height| (height - line).abs()).sum::<f64>() / n,
            q,
            sk: moment(3) / q.powi(3),
            ku: moment(4) / q.powi(4),
            p: over_sections(&|[_, high]| high - line),
            v: over_sections(&|[low, _]| line - low),
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
            let ProfileParameters { a, q, sk, ku, p, v, z, t } = ProfileParameters::about(7.0, &heights, sections);
            for (found, expected) in
                [(a, 4.0 / PI), (q, 2.0_f64.sqrt()), (sk, 0.0), (ku, 1.5), (p, 2.0), (v, 2.0), (z, 4.0), (t, 4.0)]
            {
                close(found, expected);
            }
        }
        // A scratch of one point is in one of five sections. A missing point is passed over.
        heights[4321] = -3.0;
        heights[10] = f64::NAN;
        let ProfileParameters { z, t, .. } = ProfileParameters::about(7.0, &heights, 5);
        close(t, 12.0);
        close(z, 4.0 + 8.0 / 5.0);
        assert!(ProfileParameters::of(&[]).q.is_nan());
    }

    #[test]
    fn the_mean_line_is_the_given_one_or_the_mean() {
        let heights = [1.0, 1.0, 1.0, 5.0];
        let [given, mean] = [ProfileParameters::about(0.0, &heights, 2), ProfileParameters::of(&heights)];
        assert_eq!((given.a, given.q, given.sk), (2.0, 7_f64.sqrt(), 32.0 / 7_f64.powf(1.5)));
        assert_eq!((given.p, given.v, given.z, given.t), (3.0, -1.0, 2.0, 4.0));
        assert_eq!((mean.a, mean.q, mean.p, mean.v), (1.5, 3_f64.sqrt(), 3.0, 1.0));
    }
}
