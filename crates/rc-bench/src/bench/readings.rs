//! Readings of a program's results: values, times, and stated errors.

use super::extrapolation::richardson;
use super::record::{OURS, Row};
use super::reference::Quantity;

/// A way to get a quantity from a program's results.
///
/// All readings except the first are a user's own work on the results of a peer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reading {
    /// As the program reports it. We report best estimates, a peer reports counted areas and the values on its
    /// elements.
    Reported,
    /// Counted areas minus [`PUBLISHED`] elements per edge.
    Published,
    /// Counted areas minus [`CALIBRATED`] elements per edge.
    Calibrated,
    /// Extrapolated from two successive meshes to the limit of small elements.
    Extrapolated,
}

/// Published perimeter correction in elements per edge, (π - 1 + ln 2)/24.
///
/// Source: Yastrebov, Anciaux, Molinari, *Tribol. Int.* 114 (2017) 161.
pub(super) const PUBLISHED: f64 = 0.1181141597562;

/// Perimeter correction in elements per edge for `spectral`, the peers' discretisation.
///
/// It is calibrated to 0.003 on Hertz contacts of 51 elements per radius at random offsets.
pub(super) const CALIBRATED: f64 = 0.1013;

/// Order of the error of counted areas in the element side. The order of other quantities is at least [`SMOOTH_ORDER`].
const COUNTED_ORDER: f64 = 1.0;
const SMOOTH_ORDER: f64 = 1.5;

impl Reading {
    /// The readings of a peer's results, in the order of the tables.
    pub(super) const ALL: [Self; 4] = [Self::Reported, Self::Published, Self::Calibrated, Self::Extrapolated];

    /// The letter in tables.
    pub(super) fn letter(self) -> char {
        match self {
            Self::Reported => 'R',
            Self::Published => 'P',
            Self::Calibrated => 'C',
            Self::Extrapolated => 'X',
        }
    }

    /// Whether this reading gives another value of the quantity than the others.
    ///
    /// Corrections by edges are for areas only.
    pub(super) fn applies_to(self, quantity: Quantity) -> bool {
        quantity == Quantity::Area || matches!(self, Self::Reported | Self::Extrapolated)
    }
}

/// A value with an error that a user can state without knowing the true value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stated {
    pub(super) value: f64,
    /// Error relative to the value.
    pub(super) error: f64,
    /// Seconds of all solves that the value and its error need.
    pub(super) seconds: f64,
}

/// What a user can state of one family, whose `rows` are ordered from coarse to fine.
///
/// We state the error bars of the summary. A peer does not state errors, so its user compares with the next coarser
/// mesh. The error of the finer value is then its change divided by 2^order - 1. The order is 1 for counted areas,
/// corrected or not, and 1.5 for other quantities. The error of an extrapolated value is its change from the previous
/// extrapolation, which takes three meshes.
pub(super) fn stated(rows: &[&Row], quantity: Quantity, reading: Reading) -> Vec<Stated> {
    let of_mesh = |i: usize| match rows[..=i] {
        [.., row] if row.program == OURS => ours(row, quantity),
        [.., first, second, third] if reading == Reading::Extrapolated => {
            are_successive(first, second).then_some(())?;
            are_successive(second, third).then_some(())?;
            let value = extrapolated(second, third, quantity);
            let change = value - extrapolated(first, second, quantity);
            let seconds = first.total_seconds() + second.total_seconds() + third.total_seconds();
            Some(Stated { value, error: change.abs() / value, seconds })
        }
        [.., coarse, fine] if reading != Reading::Extrapolated && are_successive(coarse, fine) => {
            let [before, value] = [coarse, fine].map(|row| of_peer(row, quantity, reading));
            let error = (value - before).abs() / (2.0_f64.powf(order(quantity)) - 1.0) / value;
            Some(Stated { value, error, seconds: coarse.total_seconds() + fine.total_seconds() })
        }
        _ => None,
    };
    (0..rows.len()).filter_map(of_mesh).collect()
}

/// Whether no mesh is missing between two. One is when a peer failed on it.
fn are_successive(coarse: &Row, fine: &Row) -> bool {
    (2.0 * coarse.elements_per_wave - fine.elements_per_wave).abs() < 1e-9
}

fn order(quantity: Quantity) -> f64 {
    if quantity == Quantity::Area { COUNTED_ORDER } else { SMOOTH_ORDER }
}

fn ours(row: &Row, quantity: Quantity) -> Option<Stated> {
    let (value, bar) = match quantity {
        Quantity::Area => (row.area.unwrap_or(row.area_counted), row.area_bar),
        Quantity::RmsPressure => (row.rms_pressure, row.rms_pressure_bar),
        Quantity::MeanGap => (row.mean_gap, row.mean_gap_bar),
    };
    Some(Stated { value, error: bar? / value, seconds: row.total_seconds() })
}

/// The value of a quantity on one mesh of a peer.
fn of_peer(row: &Row, quantity: Quantity, reading: Reading) -> f64 {
    match (quantity, reading) {
        (Quantity::Area, Reading::Published) => row.area_counted - PUBLISHED * row.perimeter,
        (Quantity::Area, Reading::Calibrated) => row.area_counted - CALIBRATED * row.perimeter,
        (Quantity::Area, _) => row.area_counted,
        (Quantity::RmsPressure, _) => row.rms_pressure,
        (Quantity::MeanGap, _) => row.mean_gap,
    }
}

fn extrapolated(coarse: &Row, fine: &Row, quantity: Quantity) -> f64 {
    let [before, value] = [coarse, fine].map(|row| of_peer(row, quantity, Reading::Reported));
    match quantity {
        Quantity::Area => value + (value - before) / (2.0_f64.powf(COUNTED_ORDER) - 1.0),
        _ => richardson(before, value).value,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::tests::rows;

    /// A peer on three meshes.
    ///
    /// Its counts exceed the area by `c` perimeters, and its perimeters are those of straight edges.
    fn peer(c: f64) -> Vec<Row> {
        let model = rows().pop().expect("a line of a peer");
        let row = |(mesh, seconds): (f64, f64)| {
            let side = 1.0 / mesh;
            let (area_counted, rms_pressure) = (0.07 + c * side, 4e-3 * (1.0 + side * side));
            Row { elements_per_wave: mesh, seconds, area_counted, rms_pressure, perimeter: side, ..model.clone() }
        };
        [(4.0, 1.0), (8.0, 5.0), (16.0, 25.0)].map(row).to_vec()
    }

    fn of(rows: &[Row], quantity: Quantity, reading: Reading) -> Vec<Stated> {
        stated(&rows.iter().collect::<Vec<_>>(), quantity, reading)
    }

    #[test]
    fn a_count_states_the_change_and_takes_both_solves() {
        let rows = peer(0.1);
        let counted = of(&rows, Quantity::Area, Reading::Reported);
        assert_eq!(counted.len(), 2);
        // Counts converge with order 1, so the stated error is the true one.
        assert!((counted[1].error * counted[1].value - 0.1 / 16.0).abs() < 1e-12, "{counted:?}");
        assert!((counted[1].seconds - 30.0).abs() < 1e-12, "{counted:?}");
        // The constant of the discretisation removes the whole error, another constant only a part of it.
        let calibrated = of(&rows, Quantity::Area, Reading::Calibrated)[1];
        let published = of(&rows, Quantity::Area, Reading::Published)[1];
        assert!((calibrated.value - 0.07).abs() < 0.0014 / 16.0, "{calibrated:?}");
        assert!((published.value - 0.07).abs() > 0.017 / 16.0, "{published:?}");
    }

    #[test]
    fn extrapolations_state_an_error_after_three_solves() {
        let rows = peer(0.1);
        let areas = of(&rows, Quantity::Area, Reading::Extrapolated);
        assert_eq!(areas.len(), 1);
        assert!((areas[0].value - 0.07).abs() < 1e-12 && areas[0].error < 1e-10, "{areas:?}");
        assert!((areas[0].seconds - 31.0).abs() < 1e-12, "{areas:?}");
        // The pressure converges with order 2, and is extrapolated with orders 1.5 and 2. A part of the finer error
        // remains.
        let pressure = of(&rows, Quantity::RmsPressure, Reading::Extrapolated)[0];
        let remains = (pressure.value / 4e-3 - 1.0).abs();
        assert!(remains < 0.4 / 256.0 && remains < pressure.error, "{pressure:?}");
        // As reported, the error by order 1.5 is on the safe side.
        let reported = of(&rows, Quantity::RmsPressure, Reading::Reported)[0];
        assert!(reported.error > reported.value / 4e-3 - 1.0, "{reported:?}");
    }

    #[test]
    fn ours_are_the_bars_of_the_summary_and_a_gap_between_meshes_states_nothing() {
        let all = rows();
        let ours = of(&all[..3], Quantity::Area, Reading::Reported);
        assert!((ours[1].error - all[1].area_bar.expect("a bar") / 0.0714).abs() < 1e-12, "{ours:?}");
        assert!(ours.len() == 3 && (ours[1].seconds - all[1].total_seconds()).abs() < 1e-12);
        let mut rows = peer(0.1);
        rows.remove(1);
        assert!(of(&rows, Quantity::Area, Reading::Reported).is_empty());
        assert!(of(&rows, Quantity::Area, Reading::Extrapolated).is_empty());
    }
}
