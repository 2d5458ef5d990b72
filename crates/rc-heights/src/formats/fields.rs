//! Fields of headers, `name = value` lines, and checks of their values.

use std::str::FromStr;

use rc_core::Grid;

use crate::{Format, FormatError};

/// The `name = value` lines of a header.
#[derive(Clone, Debug)]
pub(crate) struct Fields<'a> {
    format: Format,
    pairs: Vec<(&'a str, &'a str)>,
}

impl<'a> Fields<'a> {
    /// Reads the lines of a header. Lines without `=` are ignored.
    pub(crate) fn of(header: &'a str, format: Format) -> Self {
        let pairs = header.lines().filter_map(|line| line.split_once('='));
        Self { format, pairs: pairs.map(|(name, value)| (name.trim(), value.trim())).collect() }
    }

    /// The text of a field, or `None` if the field is missing or empty.
    pub(crate) fn text(&self, name: &str) -> Option<&'a str> {
        let pair = self.pairs.iter().find(|(field, _)| field.eq_ignore_ascii_case(name));
        pair.map(|(_, value)| *value).filter(|value| !value.is_empty())
    }

    /// The number of a required field.
    pub(crate) fn number<T: FromStr>(&self, name: &'static str) -> Result<T, FormatError> {
        let format = self.format;
        self.optional(name)?.ok_or(FormatError::Missing { format, field: name })
    }

    /// The number of a field, or `None` if the field is missing.
    pub(crate) fn optional<T: FromStr>(&self, name: &'static str) -> Result<Option<T>, FormatError> {
        let Some(text) = self.text(name) else { return Ok(None) };
        text.parse().map(Some).map_err(|_| refused(self.format, name, text, "a number"))
    }

    /// The grid whose sides are the fields `x` and `y`.
    pub(crate) fn grid(&self, x: &'static str, y: &'static str) -> Result<Grid, FormatError> {
        Ok(Grid::new(self.number(x)?, self.number(y)?)?)
    }
}

/// Returns a length of a header if it is positive and finite.
pub(crate) fn positive(format: Format, field: &'static str, value: f64) -> Result<f64, FormatError> {
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(refused(format, field, &value, "a positive length")) }
}

/// Returns a factor of a header if it is finite and not zero.
pub(crate) fn factor(format: Format, field: &'static str, value: f64) -> Result<f64, FormatError> {
    if value != 0.0 && value.is_finite() { Ok(value) } else { Err(refused(format, field, &value, "finite and not 0")) }
}

/// The error for a field with an invalid value.
pub(crate) fn refused(
    format: Format,
    field: &'static str,
    found: &(impl ToString + ?Sized),
    expected: &'static str,
) -> FormatError {
    FormatError::Field { format, field, found: shown(&found.to_string()), expected }
}

/// The first characters of a value, which may be long or not a text.
pub(crate) fn shown(text: &str) -> String {
    let start = text.chars().take(40).map(|c| if c.is_control() { '\u{FFFD}' } else { c });
    start.collect::<String>() + if text.chars().nth(40).is_some() { "…" } else { "" }
}

/// A message as one line of at most 200 characters. Parsers quote what they find.
pub(super) fn shown_as_line(text: &str) -> String {
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let start: String = line.chars().take(200).map(|c| if c.is_control() { '\u{FFFD}' } else { c }).collect();
    if line.chars().nth(200).is_some() { start + "…" } else { start }
}
