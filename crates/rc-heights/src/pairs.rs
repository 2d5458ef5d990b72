//! Readers and writers of tables of two columns: spectra (q, C) and profiles (x, z).
//!
//! Commas, semicolons or blanks separate the numbers. Empty lines and lines that begin with `#` are skipped, and so is
//! a first line of titles.

use std::fs::File;
use std::io::{self, BufWriter, Read as _, Write as _};
use std::path::Path;

use crate::formats::{check_size, check_text, data_lines, decoded, is_text, number, shown, words};
use crate::{FormatError, ReadError};

/// Reads the pairs at `path`, in their order, with at most `max_bytes` of memory.
///
/// `expected` says in an error what a line has, such as `q and C`.
///
/// # Errors
/// [`ReadError`] when the file cannot be read, is not a text, or has a line without exactly two numbers.
pub fn read_within(path: &Path, max_bytes: u64, expected: &str) -> Result<Vec<[f64; 2]>, ReadError> {
    let fail = |problem: FormatError| ReadError { path: path.to_owned(), problem };
    let unreadable = |cause: io::Error| fail(FormatError::Unreadable(cause.to_string()));
    let mut file = File::open(path).map_err(unreadable)?;
    let metadata = file.metadata().map_err(unreadable)?;
    if metadata.is_dir() {
        return Err(fail(FormatError::Unreadable("it is a folder, not a table of two columns".into())));
    }
    check_size(metadata.len(), max_bytes).map_err(fail)?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(unreadable)?;
    parse_within(&bytes, max_bytes, expected).map_err(fail)
}

fn parse_within(bytes: &[u8], max_bytes: u64, expected: &str) -> Result<Vec<[f64; 2]>, FormatError> {
    if !is_text(bytes) {
        return Err(FormatError::ZeroBytes);
    }
    check_text(bytes, max_bytes)?;
    let text = decoded(bytes);
    let mut lines = data_lines(&text, 1).peekable();
    if lines.peek().is_some_and(|(_, line)| is_title(line)) {
        lines.next();
    }
    let pairs: Vec<[f64; 2]> = lines.map(|(line, row)| pair(line, row, expected)).collect::<Result<_, _>>()?;
    if pairs.is_empty() {
        return Err(FormatError::NoNumbers { expected: "give lines of two numbers" });
    }
    Ok(pairs)
}

/// Whether a line has words and no numbers.
fn is_title(line: &str) -> bool {
    let (mut words, comma) = words(line.trim());
    words.all(|word| number(word, comma).is_none())
}

fn pair(line: usize, row: &str, expected: &str) -> Result<[f64; 2], FormatError> {
    let (mut values, mut found) = ([0.0; 2], 0);
    let (words, comma) = words(row.trim());
    for word in words {
        if let Some(value) = values.get_mut(found) {
            let no_number = || FormatError::NoNumber { line, value: found + 1, text: shown(word) };
            *value = number(word, comma).ok_or_else(no_number)?;
        }
        found += 1;
    }
    if found == values.len() {
        return Ok(values);
    }
    Err(FormatError::Columns { line, found, expected: format!("but it must have two: {expected}") })
}

/// Writes pairs as text under a line of `titles`, which reads back exactly.
///
/// # Errors
/// Errors of the file system.
pub fn write(path: &Path, titles: &str, pairs: &[[f64; 2]]) -> io::Result<()> {
    let mut out = BufWriter::new(File::create(path)?);
    writeln!(out, "# {titles}")?;
    for [first, second] in pairs {
        writeln!(out, "{first:e},{second:e}")?;
    }
    out.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Vec<[f64; 2]>, FormatError> {
        parse_within(text.as_bytes(), 1 << 20, "q and C")
    }

    #[test]
    fn pairs_are_read_with_and_without_titles_and_read_back_exactly() {
        let expected = vec![[1.0, 2e-28], [3.5, 1e-29]];
        for text in ["1,2e-28\n3.5,1e-29", "q (rad/m), C (m^4)\n1 , 2e-28\n\n3.5,1e-29\n", "# q C\n1 2e-28\n3.5\t1e-29"]
        {
            assert_eq!(parse(text), Ok(expected.clone()), "{text:?}");
        }
        let dir = tempfile::tempdir().expect("a temporary folder");
        let path = dir.path().join("psd.csv");
        let exact: Vec<_> = (1..50).map(|i| [f64::from(i).sqrt(), (-f64::from(i)).exp()]).collect();
        write(&path, "q C", &exact).expect("a written file");
        assert_eq!(read_within(&path, 1 << 20, "q and C"), Ok(exact));
    }

    #[test]
    fn bad_lines_are_refused_with_their_place() {
        let cases = [
            ("1 2\n1 2 3\n", "line 2 has 3 values, but it must have two: q and C"),
            ("1\n", "line 1 has 1 value, but"),
            ("1 2\nq C\n", "line 2, value 1: 'q'"),
            ("q C\n", "it has no numbers; give lines of two numbers"),
        ];
        for (text, expected) in cases {
            let error = parse(text).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error}");
        }
    }
}
