//! The certificate on the page of a solve.

use rc_sweep::{ControlKind, Summary};
use serde::Serialize;

/// Limit of the relative error of the load, for any tolerance.
const LOAD_LIMIT: f64 = 1e-10;

/// The errors that are certified, with their limits.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Certificate {
    rows: Vec<CertificateRow>,
    note: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct CertificateRow {
    name: &'static str,
    value: String,
    limit: String,
    /// Whether the value is below its limit; `None` without a limit.
    holds: Option<bool>,
}

impl Certificate {
    /// The certificate of a solve with the summary `s`.
    pub(super) fn of(s: &Summary) -> Self {
        let row = |name, value: f64, limit: Option<f64>| CertificateRow {
            name,
            value: format!("{value:.1e}"),
            limit: limit.map_or_else(|| "not asked for".to_owned(), |limit| format!("{limit:.1e}")),
            holds: limit.map(|limit| value <= limit),
        };
        let controlled = if s.control == ControlKind::Penetration.key() { "penetration" } else { "load" };
        let mut rows = Vec::new();
        if let Some(energy) = s.energy_error {
            rows.push(row("pressure, in the energy norm", energy, s.energy_tolerance));
        }
        rows.extend([
            row("gap where there is pressure", s.complementarity_error, s.tolerance),
            row("deepest overlap", s.penetration_error, s.tolerance),
            row(controlled, s.load_error, Some(LOAD_LIMIT)),
        ]);
        Self {
            rows,
            note: "All errors come from a fresh application of the elastic operator to the pressure that is shown. The error in the energy \
                   norm is relative to the pressure. Gap, overlap and a given penetration are relative to the range of heights. A given load \
                   is relative to itself. The errors bound how far the pressure is from the solution on these elements. The error bar of the \
                   contact area is another error: the difference from the area on infinitely fine elements.",
        }
    }
}

#[cfg(test)]
mod tests {
    use rc_core::Grid;

    use super::super::contact::tests::summary;
    use super::*;

    #[test]
    fn limits_have_two_digits_and_those_that_were_not_asked_for_do_not_hold() {
        let grid = Grid::square(2).expect("a grid");
        let rows = |tolerance| Certificate::of(&summary(grid, 1.0, 0.1, tolerance)).rows;
        assert_eq!((rows(Some(2.5e-6))[0].limit.as_str(), rows(Some(2.5e-6))[0].holds), ("2.5e-6", Some(false)));
        assert_eq!((rows(None)[0].limit.as_str(), rows(None)[0].holds), ("not asked for", None));
    }

    #[test]
    fn the_error_of_a_given_penetration_is_not_called_load() {
        let mut summary = summary(Grid::square(2).expect("a grid"), 1.0, 0.1, None);
        for control in ["pressure", "penetration"] {
            summary.control = control.to_owned();
            let name = if control == "pressure" { "load" } else { control };
            assert_eq!(Certificate::of(&summary).rows.last().map(|row| row.name), Some(name));
        }
    }
}
