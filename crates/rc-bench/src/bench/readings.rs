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

    /// Name in the heads of tables.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Reported => "as reported",
            Self::Published => "corrected, 0.1181",
            Self::Calibrated => "corrected, 0.1013",
            Self::Extrapolated => "extrapolated",
        }
    }

    /// Name of the peers in sentences.
    pub(super) fn peers(self) -> &'static str {
        match self {
            Self::Reported => "peers as they report",
            Self::Published => "peers corrected with 0.1181",
            Self::Calibrated => "peers corrected with 0.1013",
            Self::Extrapolated => "peers extrapolated",
        }
    }

    /// Whether this reading gives another value of the quantity than the others.
    ///
    /// Corrections by edges are for areas only.
    pub(super) fn applies_to(self, quantity: Quantity) -> bool {
        quantity == Quantity::Area || matches!(self, Self::Reported | Self::Extrapolated)
    }
}

/// A value that a user has after one or more solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Answer<'a> {
    /// The finest solve that the value needs.
    pub(super) row: &'a Row,
    pub(super) value: f64,
    /// Seconds of all solves that the value needs.
    pub(super) seconds: f64,
    /// The error that the user can state with the value.
    pub(super) stated: Option<Stated>,
}

/// An error that a user can state without knowing the true value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stated {
    /// Error relative to the value.
    pub(super) error: f64,
    /// Seconds of all solves that the value and its error need.
    pub(super) seconds: f64,
}

/// The answers of one family, whose `rows` are ordered from coarse to fine.
///
/// We state the error bars of the summary. A peer does not state errors, so its user compares with the next coarser
/// mesh. The error of the finer value is then its change divided by 2^order - 1. The order is 1 for counted areas,
/// corrected or not, and 1.5 for other quantities. The error of an extrapolated value is its change from the previous
/// extrapolation.
pub(super) fn answers<'a>(rows: &[&'a Row], quantity: Quantity, reading: Reading) -> Vec<Answer<'a>> {
    let mut answers: Vec<Answer<'a>> = Vec::new();
    for (i, &row) in rows.iter().enumerate() {
        // A mesh is missing when a peer failed on it.
        let coarser =
            rows[..i].last().copied().filter(|coarser| 2 * coarser.elements_per_wave == row.elements_per_wave);
        let answer = if row.program == OURS {
            Some(ours(row, quantity))
        } else if reading == Reading::Extrapolated {
            let before = answers.last().copied().filter(|before| coarser == Some(before.row));
            coarser.map(|coarser| extrapolated(row, coarser, quantity, before))
        } else {
            Some(compared(row, coarser, quantity, reading))
        };
        answers.extend(answer);
    }
    answers
}

fn ours(row: &Row, quantity: Quantity) -> Answer<'_> {
    let (value, bar) = match quantity {
        Quantity::Area => (row.area.unwrap_or(row.area_counted), row.area_bar),
        Quantity::RmsPressure => (row.rms_pressure, row.rms_pressure_bar),
        Quantity::MeanGap | Quantity::Penetration => (row.mean_gap, row.mean_gap_bar),
    };
    let seconds = row.total_seconds();
    Answer { row, value, seconds, stated: bar.map(|bar| Stated { error: bar / value, seconds }) }
}

/// The value of a quantity on one mesh of a peer.
fn of_peer(row: &Row, quantity: Quantity, reading: Reading) -> f64 {
    match (quantity, reading) {
        (Quantity::Area, Reading::Published) => row.area_counted - PUBLISHED * row.perimeter,
        (Quantity::Area, Reading::Calibrated) => row.area_counted - CALIBRATED * row.perimeter,
        (Quantity::Area, _) => row.area_counted,
        (Quantity::RmsPressure, _) => row.rms_pressure,
        (Quantity::MeanGap | Quantity::Penetration, _) => row.mean_gap,
    }
}

fn compared<'a>(row: &'a Row, coarser: Option<&Row>, quantity: Quantity, reading: Reading) -> Answer<'a> {
    let value = of_peer(row, quantity, reading);
    let order = if quantity == Quantity::Area { COUNTED_ORDER } else { SMOOTH_ORDER };
    let stated = coarser.map(|coarser| {
        let change = (value - of_peer(coarser, quantity, reading)).abs();
        let error = change / (2.0_f64.powf(order) - 1.0) / value;
        Stated { error, seconds: row.total_seconds() + coarser.total_seconds() }
    });
    Answer { row, value, seconds: row.total_seconds(), stated }
}

fn extrapolated<'a>(row: &'a Row, coarser: &Row, quantity: Quantity, before: Option<Answer<'_>>) -> Answer<'a> {
    let [coarse, fine] = [coarser, row].map(|row| of_peer(row, quantity, Reading::Reported));
    let value = match quantity {
        Quantity::Area => fine + (fine - coarse) / (2.0_f64.powf(COUNTED_ORDER) - 1.0),
        _ => richardson(coarse, fine).value,
    };
    let stated = before.map(|before| Stated {
        error: (value - before.value).abs() / value,
        // Both extrapolations use the middle mesh.
        seconds: row.total_seconds() + before.seconds,
    });
    Answer { row, value, seconds: row.total_seconds() + coarser.total_seconds(), stated }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::levels::tests::rows;

    /// A peer on three meshes.
    ///
    /// Its counts exceed the area by `c` perimeters, and its perimeters are those of straight edges.
    fn peer(c: f64) -> Vec<Row> {
        let model = rows().pop().expect("a line of a peer");
        let row = |(mesh, seconds): (usize, f64)| {
            let side = 1.0 / mesh as f64;
            let (area_counted, rms_pressure) = (0.07 + c * side, 4e-3 * (1.0 + side * side));
            Row { elements_per_wave: mesh, seconds, area_counted, rms_pressure, perimeter: side, ..model.clone() }
        };
        [(4, 1.0), (8, 5.0), (16, 25.0)].map(row).to_vec()
    }

    fn of(rows: &[Row], quantity: Quantity, reading: Reading) -> Vec<Answer<'_>> {
        answers(&rows.iter().collect::<Vec<_>>(), quantity, reading)
    }

    #[test]
    fn a_count_states_the_change_and_takes_both_solves() {
        let rows = peer(0.1);
        let counted = of(&rows, Quantity::Area, Reading::Reported);
        assert_eq!((counted.len(), counted[0].stated), (3, None));
        let (finest, stated) = (counted[2], counted[2].stated.expect("a coarser mesh"));
        // Counts converge with order 1, so the stated error is the true one.
        assert!((stated.error * finest.value - 0.1 / 16.0).abs() < 1e-12, "{stated:?}");
        assert!((finest.seconds - 25.0).abs() < 1e-12 && (stated.seconds - 30.0).abs() < 1e-12, "{finest:?}");
        // The constant of the discretisation removes the whole error, another constant only a part of it.
        let calibrated = of(&rows, Quantity::Area, Reading::Calibrated)[2];
        let published = of(&rows, Quantity::Area, Reading::Published)[2];
        assert!((calibrated.value - 0.07).abs() < 0.0014 / 16.0, "{calibrated:?}");
        assert!((published.value - 0.07).abs() > 0.017 / 16.0, "{published:?}");
    }

    #[test]
    fn extrapolations_take_two_solves_and_their_errors_three() {
        let rows = peer(0.1);
        let areas = of(&rows, Quantity::Area, Reading::Extrapolated);
        assert_eq!((areas.len(), areas[0].stated), (2, None));
        let stated = areas[1].stated.expect("two extrapolations");
        assert!((areas[1].value - 0.07).abs() < 1e-12 && stated.error < 1e-10, "{areas:?}");
        assert!((areas[1].seconds - 30.0).abs() < 1e-12 && (stated.seconds - 31.0).abs() < 1e-12, "{areas:?}");
        // The pressure converges with order 2, and is extrapolated with orders 1.5 and 2. A part of the finer error
        // remains.
        let pressure = of(&rows, Quantity::RmsPressure, Reading::Extrapolated)[1];
        let stated = pressure.stated.expect("two extrapolations");
        assert!((pressure.value / 4e-3 - 1.0).abs() < 0.4 / 256.0, "{pressure:?}");
        assert!((pressure.value / 4e-3 - 1.0).abs() < stated.error, "{pressure:?}");
        // As reported, the error by order 1.5 is on the safe side.
        let reported = of(&rows, Quantity::RmsPressure, Reading::Reported)[1];
        assert!(reported.stated.expect("two meshes").error > reported.value / 4e-3 - 1.0, "{reported:?}");
    }

    #[test]
    fn ours_are_the_bars_of_the_summary_and_a_gap_between_meshes_states_nothing() {
        let all = rows();
        let ours = of(&all[..3], Quantity::Area, Reading::Reported);
        let stated = ours[1].stated.expect("a bar");
        assert!((stated.error - all[1].area_bar.expect("a bar") / 0.0714).abs() < 1e-12, "{stated:?}");
        assert!((stated.seconds - all[1].total_seconds()).abs() < 1e-12);
        let mut rows = peer(0.1);
        rows.remove(1);
        assert!(of(&rows, Quantity::Area, Reading::Reported).iter().all(|answer| answer.stated.is_none()));
        assert!(of(&rows, Quantity::Area, Reading::Extrapolated).is_empty());
    }
}
