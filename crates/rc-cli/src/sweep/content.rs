//! What a journal says: its first line, its rows, and how they are read back.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::plan::MOST_ROWS;
use super::settings;
use super::shard::{Shape, Shard};
use crate::error::CliError;

/// The journal's name in the folder of a sweep.
pub(super) const JOURNAL_FILE: &str = "sweep.jsonl";

/// First key of the first line, by which a journal is recognised.
const FORMAT: u32 = 2;

/// The cells of a row by the names of their columns, in order.
pub(super) type Cells = Map<String, Value>;

/// Finished rows by their index.
pub(super) type Rows = BTreeMap<usize, Cells>;

/// The first line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    rc_sweep: u32,
    pub(super) shape: Shape,
    pub(super) shard: Shard,
    pub(super) settings: Value,
}

/// Any other line.
#[derive(Serialize, Deserialize)]
struct Line {
    row: usize,
    cells: Cells,
    crc32: u32,
}

impl Line {
    fn new(row: usize, cells: Cells) -> Self {
        let crc32 = crc32fast::hash(format!("{row}{}", Value::Object(cells.clone())).as_bytes());
        Self { row, cells, crc32 }
    }
}

impl Header {
    pub(super) fn new(shape: Shape, shard: Shard, settings: Value) -> Self {
        Self { rc_sweep: FORMAT, shape, shard, settings }
    }

    /// As a line of the journal.
    pub(super) fn to_line(&self) -> String {
        to_line(self)
    }

    /// Refuses to go on with the sweep in `folder` when it is not this one.
    pub(super) fn check_same(&self, there: &Self, folder: &Path) -> Result<(), CliError> {
        if let Some(difference) = settings::difference(&there.settings, &self.settings) {
            return Err(CliError::in_file(
                folder,
                format_args!("this folder holds another sweep: {difference}; give its settings, or another --out"),
            ));
        }
        if there.shape != self.shape {
            return Err(CliError::in_file(
                folder,
                "the number of rows in its journal is not that of its settings: it is damaged",
            ));
        }
        if there.shard != self.shard {
            let (there, here) = (there.shard, self.shard);
            return Err(CliError::in_file(folder, format_args!("holds shard {there}, not {here}; give another --out")));
        }
        Ok(())
    }
}

/// A line of the journal for the row `row`.
pub(super) fn row_line(row: usize, cells: &Cells) -> String {
    to_line(&Line::new(row, cells.clone()))
}

fn to_line(value: &impl Serialize) -> String {
    let mut line = serde_json::to_string(value).expect("a record of numbers and text is valid JSON");
    line.push('\n');
    line
}

/// What a journal holds.
#[derive(Debug)]
pub(super) struct Content {
    pub(super) header: Header,
    pub(super) rows: Rows,
    /// Bytes up to the end of the last whole line.
    pub(super) whole: u64,
}

impl Content {
    /// Reads the journal in `folder`, but for what a process that was ended left of its last line.
    ///
    /// # Errors
    /// [`CliError::Input`] when there is none, it is not one, or a line before the last is damaged.
    pub(super) fn read(folder: &Path) -> Result<Self, CliError> {
        let path = folder.join(JOURNAL_FILE);
        let bytes = std::fs::read(&path).map_err(|cause| {
            CliError::in_file(folder, format_args!("no sweep of rc here ({JOURNAL_FILE} cannot be read: {cause})"))
        })?;
        Self::of_bytes(&bytes, &path)
    }

    /// What `bytes` say, those of the journal at `path`.
    ///
    /// # Errors
    /// As [`Content::read`].
    pub(super) fn of_bytes(bytes: &[u8], path: &Path) -> Result<Self, CliError> {
        let mut lines = bytes.split_inclusive(|&byte| byte == b'\n').peekable();
        let first = lines.next().filter(|line| line.ends_with(b"\n"));
        let header: Option<Header> = first.and_then(|line| serde_json::from_slice(line).ok());
        let header = header.filter(|header| header.rc_sweep == FORMAT && header.shape.rows() <= MOST_ROWS);
        let header = header.ok_or_else(|| CliError::in_file(path, "not a journal of rc sweep"))?;
        let mut content = Self { header, rows: Rows::new(), whole: first.map_or(0, <[u8]>::len) as u64 };
        let mut number = 1;
        while let Some(line) = lines.next() {
            number += 1;
            match content.parse(line) {
                Some(Line { row, cells, .. }) => content.rows.insert(row, cells),
                None if lines.peek().is_none() => break,
                None => return Err(CliError::in_file(path, format_args!("line {number} is damaged; remove it"))),
            };
            content.whole += line.len() as u64;
        }
        Ok(content)
    }

    /// A whole line with a row of this sweep.
    fn parse(&self, line: &[u8]) -> Option<Line> {
        let whole = line.strip_suffix(b"\n")?;
        let line: Line = serde_json::from_slice(whole).ok()?;
        let is_sound = Line::new(line.row, line.cells.clone()).crc32 == line.crc32;
        (is_sound && line.row < self.header.shape.rows()).then_some(line)
    }
}
