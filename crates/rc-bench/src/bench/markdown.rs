//! Markdown tables and their cells.

use rc_core::quantity::digits;

use super::record::Spread;

/// Content of a cell without a value.
pub(super) const NONE: &str = "\u{2013}";

/// A table with the titles `head` of its columns.
pub(super) fn table<S: AsRef<str>>(head: &[S], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let line = |cells: Vec<&str>| format!("| {} |\n", cells.join(" | "));
    let titles = line(head.iter().map(AsRef::as_ref).collect());
    let ruler = format!("|{}\n", "---|".repeat(head.len()));
    titles + &ruler + &rows.into_iter().map(|row| line(row.iter().map(String::as_str).collect())).collect::<String>()
}

/// A value in a cell, or a dash.
pub(super) fn cell<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or_else(|| NONE.to_owned(), text)
}

/// A part of one as a percentage.
pub(super) fn percent(part: f64) -> String {
    format!("{} %", digits(100.0 * part, 3))
}

pub(super) fn time(seconds: f64) -> String {
    if seconds < 1.0 { format!("{} ms", digits(1e3 * seconds, 3)) } else { format!("{} s", digits(seconds, 3)) }
}

/// A median, with the fastest and slowest if there are several times.
pub(super) fn spread(Spread { median, min, max }: Spread) -> String {
    if min < max { format!("{} ({} to {})", time(median), time(min), time(max)) } else { time(median) }
}

pub(super) fn megabytes(memory: f64) -> String {
    format!("{memory:.0} MB")
}
