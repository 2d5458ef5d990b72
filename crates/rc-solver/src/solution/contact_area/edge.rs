//! The position of a contact edge between two neighbouring elements.

/// Maximum number of Newton steps. Four reach rounding from the start that is used.
const MOST_STEPS: usize = 12;

/// The edge of a contact between an element in contact and one out of it.
///
/// At an edge the pressure is c √s inside and the gap (4c/3E*) s^{3/2} outside, with the same c. Let h be the distance
/// between the centres of the two elements, and s h the distance of the edge from the first centre. Then p² = c² s h
/// and (3g/4)² = c² (1 - s)³ h³. So u = s^{1/3} solves u³ + β u = 1 with β = (3g/4ph)^{2/3}. Only the ratio of the gap
/// to the pressure matters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    u: f64,
}

impl Edge {
    /// The edge from the ratio g E*/(p h). A gap below 0 counts as 0.
    ///
    /// `None` for a ratio that is not a number.
    pub(super) fn new(gap_ratio: f64) -> Option<Self> {
        if gap_ratio.is_nan() {
            return None;
        }
        let beta = beta(gap_ratio);
        // The start is above the root, where the function is convex. Newton's steps lead down to the root without
        // passing it.
        let mut u = beta.recip().min(1.0);
        for _ in 0..MOST_STEPS {
            let step = (u * (u * u + beta) - 1.0) / (3.0 * u * u + beta);
            u -= step;
            if step <= 1e-12 {
                break;
            }
        }
        Some(Self { u: u.clamp(0.0, 1.0) })
    }

    /// Distance of the edge from the centre in contact.
    ///
    /// It is a fraction of the distance between the centres.
    pub(super) fn position(self) -> f64 {
        self.u.powi(3)
    }

    /// Deviation from the law of the gap one element further out, in elements.
    ///
    /// The gap is given as g E*/(p h). The deviation is the distance from the edge at which the law has this gap, minus
    /// the true distance. It is -2 to about 0 in gaps between contacts, where the gap is smaller than the gap of the
    /// law. `None` for a ratio that is not a number.
    pub(super) fn deviation(self, next_gap_ratio: f64) -> Option<f64> {
        let deviation = beta(next_gap_ratio) * self.u - (2.0 - self.position());
        (!next_gap_ratio.is_nan()).then(|| deviation.min(MAX_DEVIATION))
    }
}

/// Maximum deviation of an edge. Only heights that jump have a larger one.
const MAX_DEVIATION: f64 = 2.0;

fn beta(gap_ratio: f64) -> f64 {
    (0.75 * gap_ratio).clamp(0.0, 1e100).cbrt().powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edge_with_the_square_root_law_is_found_and_does_not_deviate() {
        let (c, h) = (0.3, 0.01);
        for k in 1..=100 {
            let s = 0.01 * f64::from(k);
            let pressure = c * (s * h).sqrt();
            let ratio = |distance: f64| 4.0 / 3.0 * c * (distance * h).powf(1.5) / (pressure * h);
            let edge = Edge::new(ratio(1.0 - s)).expect("a number");
            assert!((edge.position() - s).abs() < 1e-9, "{} for {s}", edge.position());
            assert!(edge.deviation(ratio(2.0 - s)).expect("a number").abs() < 1e-8, "{s}");
        }
    }

    #[test]
    fn nothing_else_than_a_fraction_comes_out() {
        for gap_ratio in [0.0, 1e-300, 1e300, f64::INFINITY, -1.0] {
            let edge = Edge::new(gap_ratio).expect("a number");
            assert!((0.0..=1.0).contains(&edge.position()), "{edge:?} for {gap_ratio}");
            assert!(edge.deviation(gap_ratio).expect("a number").abs() <= 2.0, "{edge:?} for {gap_ratio}");
        }
        assert!(Edge::new(f64::NAN).is_none());
        assert_eq!(Edge::new(1.0).expect("a number").deviation(f64::NAN), None);
    }
}
