//! What kind of edge is between an element in contact and one out of it.

use crate::solution::contact_area::edge::Edge;

/// Position below which the last element of a contact has a lower pressure than the next one inside.
///
/// At the edge of a flat top the pressure is highest, and the gap beside it is that of the lower ground.
const NEAR_CENTRE: f64 = 0.02;

/// Ratio of the pressures of the last two elements inside. It is about 2 at the edge of a stamp.
const HIGHER: f64 = 1.5;

/// Ratio of a jump of the heights at the edge of a plastic element to their steps beside it. A slope has 1.
const STEEPER: f64 = 4.0;

/// The edge, with what locates it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// The heights jump, as at the edge of a flat top. The edge is anywhere between the centres.
    Jump,
    /// The element is plastic: its overlap, and the gap beside it if that is known.
    ///
    /// The gap grows in proportion to the distance from the edge, and so does the overlap on the other side.
    Sharp { overlap: f64, gap: Option<f64> },
    /// The pressure falls to zero. `None` if the gap beside the edge is not known.
    Smooth(Option<Edge>),
}

impl Kind {
    /// The edge between 0 and 1 `steps` along an axis.
    ///
    /// `at` gives pressure and gap there. `side` is that of the elements along the axis.
    pub(super) fn of(at: &impl Fn(isize) -> [f64; 2], side: f64, hardness: f64) -> Self {
        let ([pressure, inside], [_, outside]) = (at(0), at(1));
        let [next, third] = [-1, -2].map(at);
        // Fewer elements are no flat top.
        let is_wide = next[0] > 0.0 && third[0] > 0.0;
        if pressure >= hardness {
            let (overlap, gap) = ((-inside).max(0.0), outside.max(0.0));
            let [free, beyond] = at(2);
            let behind = if free <= 0.0 && !beyond.is_nan() { (beyond - outside).abs() } else { 0.0 };
            let steps = (inside - next[1]).abs().max((next[1] - third[1]).abs()).max(behind);
            if is_wide && gap > overlap && gap + overlap > STEEPER * steps {
                return Self::Jump;
            }
            return Self::Sharp { overlap, gap: (!outside.is_nan()).then_some(gap) };
        }
        let edge = Edge::new(outside / (pressure * side));
        let is_high = is_wide && pressure > HIGHER * next[0];
        // A gap that is not known is proven to be wide.
        let is_far = edge.is_none_or(|edge| edge.position() < NEAR_CENTRE);
        if is_high && is_far { Self::Jump } else { Self::Smooth(edge) }
    }

    /// Distance of the edge from the centre in contact, as a fraction of the distance between the centres.
    ///
    /// It is a half if it is not known.
    pub(super) fn position(self) -> f64 {
        match self {
            Self::Smooth(Some(edge)) => edge.position(),
            Self::Sharp { overlap, gap: Some(gap) } if overlap + gap > 0.0 => overlap / (overlap + gap),
            Self::Jump | Self::Smooth(None) | Self::Sharp { .. } => 0.5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pressure and gap of the places from -2 to 2.
    fn kind(pressures: [f64; 5], gaps: [f64; 5], hardness: f64) -> Kind {
        let place = |steps: isize| (steps + 2) as usize;
        Kind::of(&|steps| [pressures[place(steps)], gaps[place(steps)]], 1.0, hardness)
    }

    /// The pressure of a stamp rises to its edge, and that of other contacts falls to zero.
    #[test]
    fn heights_jump_at_the_edge_of_a_stamp() {
        let is_jump = |pressures: [f64; 3], gap: f64| {
            let [third, next, last] = pressures;
            let kind = kind([third, next, last, 0.0, 0.0], [0.0, 0.0, 0.0, gap, gap], f64::INFINITY);
            matches!(kind, Kind::Jump)
        };
        assert!(is_jump([1.5, 2.0, 4.0], 1e3) && is_jump([1.5, 2.0, 4.0], f64::NAN));
        assert!(!is_jump([1.5, 2.0, 4.0], 0.1) && !is_jump([2.0, 2.0, 1.0], 1e3));
        // Two elements are no flat top.
        assert!(!is_jump([0.0, 2.0, 4.0], 1e3));
    }

    #[test]
    fn heights_jump_at_the_edge_of_a_plastic_flat_top_but_not_of_a_slope() {
        let flat = kind([1.0, 1.0, 1.0, 0.0, 0.0], [-0.02, -0.02, -0.02, 1.0, 1.1], 1.0);
        assert!(matches!(flat, Kind::Jump), "{flat:?}");
        let slope = kind([1.0, 1.0, 1.0, 0.0, 0.0], [-0.65, -0.4, -0.15, 0.1, 0.35], 1.0);
        assert!(matches!(slope, Kind::Sharp { .. }) && (slope.position() - 0.6).abs() < 1e-12, "{slope:?}");
        // The last element of a parabola.
        let top = kind([0.0, 1.0, 1.0, 0.0, 0.0], [0.4, -0.1, -0.6, 0.4, 2.4], 1.0);
        assert!(matches!(top, Kind::Sharp { .. }), "{top:?}");
    }
}
