//! Where the edge of a contact is, between two neighbouring elements.

/// Newton steps; four reach rounding from the start that is used.
const MOST_STEPS: usize = 12;

/// The edge of a contact between the centre of an element in contact and that of a neighbour out of it.
///
/// At an edge the pressure is c √s inside and the gap (4c/3E*) s^{3/2} outside, with the same c. With h the distance
/// between the centres and s the distance of the edge from the first of them, divided by h: p² = c² s h and (3g/4)² =
/// c² (1 - s)³ h³, so u = s^{1/3} solves u³ + β u = 1, β = (3g/4ph)^{2/3}: the pressure and the gap matter by their
/// ratio only.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    u: f64,
}

impl Edge {
    /// From g E*/(p h); a gap below 0 counts as 0. `None` for a ratio that is not a number.
    pub(super) fn new(gap_ratio: f64) -> Option<Self> {
        if gap_ratio.is_nan() {
            return None;
        }
        let beta = beta(gap_ratio);
        // From above, where the function is convex: Newton's steps lead down to the root without passing it.
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

    /// Its distance from the centre in contact, as a fraction of that between the centres.
    pub(super) fn position(self) -> f64 {
        self.u.powi(3)
    }

    /// The deviation of the gap one element further out, as g E*/(p h), from the law: the distance from the edge at
    /// which the law has this gap, minus the true distance, in elements. It is -2 to about 0 in gaps between contacts,
    /// where the gap is smaller than the law's. `None` for a ratio that is not a number.
    pub(super) fn deviation(self, next_gap_ratio: f64) -> Option<f64> {
        let deviation = beta(next_gap_ratio) * self.u - (2.0 - self.position());
        (!next_gap_ratio.is_nan()).then(|| deviation.min(MAX_DEVIATION))
    }
}

/// A larger deviation is that of heights that jump, not of an edge.
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
