//! Files of Prony series: lines g τ.

use std::path::Path;

use rc_core::Dimension;
use rc_heights::pairs;

use super::quantity;
use crate::error::CliError;

/// Memory that such a file may take. It has some tens of lines.
const MOST_BYTES: u64 = 16 << 20;

/// A Prony series in SI units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PronyFile {
    /// Pairs of a modulus and a relaxation time (s).
    pub(super) terms: Vec<[f64; 2]>,
    /// Whether moduli are Young's moduli in Pa, and not relative to the relaxed modulus.
    pub(super) is_in_pascals: bool,
}

impl PronyFile {
    /// Reads the lines g τ at `path`.
    ///
    /// A title or comment above them may give units: moduli are in Pa if they are called E, or have a unit of pressure.
    ///
    /// # Errors
    /// [`CliError::Input`] with the file and its line.
    pub(super) fn read(path: &Path) -> Result<Self, CliError> {
        let pairs = pairs::read_within(path, MOST_BYTES, "g and tau (s)")?;
        let text = std::fs::read(path)
            .map_err(|cause| CliError::in_file(path, format_args!("cannot read this file: {cause}")))?;
        Self::of(&pairs, &String::from_utf8_lossy(&text)).map_err(|cause| CliError::in_file(path, cause))
    }

    /// The series of these pairs, which are those of `text`.
    fn of(pairs: &[[f64; 2]], text: &str) -> Result<Self, String> {
        let lines = text.trim_start_matches('\u{feff}').lines().zip(1..).map(|(line, number)| (number, line.trim()));
        let is_comment = |line: &str| line.is_empty() || line.starts_with('#');
        let rows: Vec<usize> = lines.clone().filter(|(_, line)| !is_comment(line)).map(|(number, _)| number).collect();
        // A title is a row without numbers.
        let rows = &rows[rows.len().saturating_sub(pairs.len())..];
        let first = rows.first().copied().unwrap_or_default();
        let title = lines.filter(|(number, line)| *number < first && !line.is_empty()).last();
        let titles = title.map_or(Ok(Titles::default()), |(number, line)| {
            Titles::of(line).map_err(|cause| format!("line {number}: {cause}"))
        })?;
        let mut terms = Vec::with_capacity(pairs.len());
        for (&[modulus, time], line) in pairs.iter().zip(rows) {
            for (value, name) in [(modulus, "modulus"), (time, "relaxation time")] {
                if !(value > 0.0 && value.is_finite()) {
                    return Err(format!("line {line}: a {name} must be above 0 and finite, not {value}"));
                }
            }
            terms.push([modulus * titles.pascals.unwrap_or(1.0), time * titles.seconds]);
        }
        Ok(Self { terms, is_in_pascals: titles.pascals.is_some() })
    }
}

/// What the titles of the columns say.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Titles {
    /// The unit of moduli (Pa); `None` for relative moduli.
    pascals: Option<f64>,
    /// The unit of times (s).
    seconds: f64,
}

impl Default for Titles {
    fn default() -> Self {
        Self { pascals: None, seconds: 1.0 }
    }
}

/// Beginnings of titles of moduli. A shear modulus G is not relative to Young's modulus.
const MODULI: [&str; 6] = ["g", "E", "e", "modul", "Modul", "relative"];

impl Titles {
    /// Reads titles such as `E (MPa), tau (ms)`, which may be `commented`. Comments in words have no units.
    fn of(line: &str) -> Result<Self, String> {
        let (line, commented) = (line.trim_start_matches('#').trim(), line.starts_with('#'));
        let mut titles = Self::default();
        let name: String = line.chars().take_while(|c| !c.is_whitespace() && !",;([".contains(*c)).collect();
        if ["tau", "τ", "t", "time"].iter().any(|time| {
            name.trim_end_matches(|c: char| c == '_' || c.is_ascii_digit() || c == 'i').eq_ignore_ascii_case(time)
        }) {
            return Err(format!("the first column is '{name}'; the modulus comes first, then the relaxation time"));
        }
        let is_words = commented || name.is_empty();
        if !is_words && !MODULI.iter().any(|known| name.starts_with(known)) {
            return Err(format!(
                "the first column is '{name}'; it must be g, relative to the relaxed modulus, or E (Pa, Young's modulus)"
            ));
        }
        let index = name.strip_prefix('E').map(|index| index.trim_start_matches('_'));
        if index.is_some_and(|index| index.chars().all(|c| c.is_ascii_digit() || "ink".contains(c))) {
            titles.pascals = Some(1.0);
        }
        for unit in line.split(['(', '[']).skip(1).filter_map(|rest| rest.split([')', ']']).next()) {
            let one = format!("1{}", unit.trim());
            match (Dimension::Pressure.parse(&one), quantity::time::parse(&one)) {
                _ if matches!(unit.trim(), "" | "-" | "1") => {}
                (Ok(pascals), _) => titles.pascals = Some(pascals),
                (_, Ok(seconds)) => titles.seconds = seconds,
                _ if unit.contains(' ') => {}
                _ => {
                    return Err(format!(
                        "'{unit}' is not a unit of pressure or time; give g relative to the relaxed modulus or E in Pa, and tau in s"
                    ));
                }
            }
        }
        Ok(titles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exchanged_columns_are_refused() {
        for title in ["tau (s), g", "tau_i, E (MPa)", "t g", "# time; modulus"] {
            let refused = PronyFile::of(&[[1e-3, 3.0]], &format!("{title}\n1e-3 3\n"));
            assert!(refused.expect_err(title).contains("the modulus comes first"), "{title}");
        }
    }

    #[test]
    fn a_column_that_is_no_modulus_is_refused() {
        for title in ["foo bar", "G (MPa), tau (s)", "storage, loss"] {
            let refused = PronyFile::of(&[[3.0, 1e-3]], &format!("{title}\n3 1e-3\n"));
            assert!(
                refused.expect_err(title).contains("it must be g, relative to the relaxed modulus, or E"),
                "{title}"
            );
        }
    }

    #[test]
    fn titles_give_units() {
        let pairs = [[3.0, 1e-3], [5.0, 1.0]];
        let of = |title: &str| PronyFile::of(&pairs, &format!("{title}\n3 1e-3\n# between\n\n5 1\n")).expect(title);
        for title in ["", "# of a compound (2020 batch)", "g, tau", "g (-), tau (s)", "# g tau"] {
            assert_eq!(of(title), PronyFile { terms: pairs.to_vec(), is_in_pascals: false }, "{title}");
        }
        for (title, pascals, seconds) in
            [("E tau", 1.0, 1.0), ("E_i (MPa), tau_i (ms)", 1e6, 1e-3), ("# modulus [kPa]; time", 1e3, 1.0)]
        {
            let terms = pairs.map(|[g, tau]| [g * pascals, tau * seconds]).to_vec();
            assert_eq!(of(title), PronyFile { terms, is_in_pascals: true }, "{title}");
        }
        assert!(
            PronyFile::of(&pairs, "E (psi), tau (s)\n3 1e-3\n5 1").expect_err("a unit").starts_with("line 1: 'psi'")
        );
    }

    #[test]
    fn a_bad_term_has_its_line() {
        for (text, pair, expected) in [
            ("g tau\n# note\n1 1\n0 2\n", [0.0, 2.0], "line 4: a modulus must be above 0"),
            ("1 1\n1 -2", [1.0, -2.0], "line 2: a relaxation time must be above 0"),
        ] {
            let error = PronyFile::of(&[[1.0, 1.0], pair], text).expect_err(expected);
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
