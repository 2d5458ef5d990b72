//! Limits of fine meshes, with their uncertainty.

/// A value with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limit {
    pub(super) value: f64,
    pub(super) uncertainty: f64,
}

/// A counted area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counted {
    /// Area relative to the cell.
    pub(super) area: f64,
    /// Number of edges between elements in and out of contact.
    pub(super) n_edges: usize,
    /// Number of smallest elements along a side of the cell.
    pub(super) side: usize,
}

/// Uncertainty of the calibrated perimeter constants.
const CONSTANT_UNCERTAINTY: f64 = 0.003;

/// Scatter of a counted area, in units of √edges · (element area).
///
/// Each edge of contact falls anywhere in its element. The value was measured on sequences of meshes.
const SCATTER: f64 = 0.4;

/// The area in the limit of small elements, from counts on several meshes.
///
/// A count is A + c · edges · (element area) with scatter. A and c are fitted by least squares. The calibrated
/// `constant` counts as a measurement of c. The uncertainty is two standard deviations. Without counts the result is
/// NaN.
pub(super) fn area_limit(counts: &[Counted], constant: f64) -> Limit {
    let lines = counts.iter().map(|count| {
        let cell = (count.side as f64).powi(-2);
        (count.n_edges as f64 * cell, count.area, SCATTER * (count.n_edges as f64).sqrt() * cell)
    });
    // Normal equations of area = A + c x. The calibration is one more equation, which has c alone.
    let (mut aa, mut ac, mut cc) = (0.0, 0.0, CONSTANT_UNCERTAINTY.powi(-2));
    let (mut right_a, mut right_c) = (0.0, constant * cc);
    for (x, area, scatter) in lines {
        let weight = scatter.powi(-2);
        aa += weight;
        ac += weight * x;
        cc += weight * x * x;
        right_a += weight * area;
        right_c += weight * x * area;
    }
    let determinant = aa * cc - ac * ac;
    Limit { value: (cc * right_a - ac * right_c) / determinant, uncertainty: 2.0 * (cc / determinant).sqrt() }
}

/// Smallest and largest order of convergence of quantities that the edges of contacts determine.
const ORDERS: [f64; 2] = [1.5, 2.0];

/// The limit of a quantity from its values on two meshes.
///
/// The elements of the second mesh are half as large. The value is the middle between the extrapolations of the two
/// orders, and the uncertainty is half the distance between the two.
pub(super) fn richardson(coarse: f64, fine: f64) -> Limit {
    let [first, second] = ORDERS.map(|order| fine + (fine - coarse) / (2.0_f64.powf(order) - 1.0));
    Limit { value: 0.5 * (first + second), uncertainty: 0.5 * (first - second).abs() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_with_a_perimeter_term_have_their_limit() {
        let count = |side: usize| {
            let n_edges = 5 * side;
            Counted { area: 0.07 + 0.09 * n_edges as f64 / (side * side) as f64, n_edges, side }
        };
        let limit = area_limit(&[256, 512, 1024].map(count), 0.0872);
        // The scatter of the finest mesh alone is 2.7e-5.
        assert!((limit.value - 0.07).abs() < limit.uncertainty && limit.uncertainty < 1e-4, "{limit:?}");
        let finer = area_limit(&[1024, 2048, 4096].map(count), 0.0872);
        assert!((finer.value - 0.07).abs() < (limit.value - 0.07).abs(), "{finer:?} after {limit:?}");
        assert!(finer.uncertainty < 0.3 * limit.uncertainty, "{finer:?} after {limit:?}");
    }

    #[test]
    fn either_order_is_within_the_uncertainty() {
        for order in ORDERS {
            let value = |h: f64| 4e-3 + 1e-4 * h.powf(order);
            let limit = richardson(value(0.5), value(0.25));
            assert!((limit.value - 4e-3).abs() < 1.0001 * limit.uncertainty, "order {order}: {limit:?}");
        }
        let limit = richardson(4e-3, 4e-3);
        assert!((limit.value - 4e-3).abs() < 1e-18 && limit.uncertainty < 1e-18, "{limit:?}");
    }
}
