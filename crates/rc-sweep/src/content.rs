//! Contents of a journal: its first line, its rows, and how to read them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::deal::Deal;
use crate::error::SweepError;
use crate::folder::{self, JOURNAL_FILE};
use crate::settings;
use crate::shard::{MAX_ROWS, Shard, SweepShape};

/// Value of the first key of the first line, which identifies a journal.
///
/// It belongs to a whole sweep, or to a shard that is dealt load by load.
const FORMAT: u32 = 2;

/// As [`FORMAT`], for a shard that is dealt by costs. Programs that deal load by load must not read it.
const DEALT_BY_COST: u32 = 3;

/// The cells of a row by the names of their columns, in order.
pub type Cells = Map<String, Value>;

/// Finished rows by their index.
pub type SweepRows = BTreeMap<usize, Cells>;

/// The first line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Header {
    rc_sweep: u32,
    pub(crate) shape: SweepShape,
    pub(crate) shard: Shard,
    #[serde(default, skip_serializing_if = "Deal::is_by_load")]
    pub(crate) deal: Deal,
    pub(crate) settings: Value,
}

/// Any other line, which holds a row.
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
    /// The first line of a whole sweep.
    pub(crate) fn whole(shape: SweepShape, settings: Value) -> Self {
        Self { rc_sweep: FORMAT, shape, shard: Shard::WHOLE, deal: Deal::default(), settings }
    }

    /// The first line of a shard, with the way in which rows are dealt.
    pub(crate) fn of_shard(shape: SweepShape, shard: Shard, deal: Deal, settings: Value) -> Self {
        let deal = if shard == Shard::WHOLE { Deal::default() } else { deal };
        let rc_sweep = if deal.is_by_load() { FORMAT } else { DEALT_BY_COST };
        Self { rc_sweep, shape, shard, deal, settings }
    }

    /// Whether this program understands the line.
    fn is_sound(&self) -> bool {
        let format = if self.deal.is_by_load() { FORMAT } else { DEALT_BY_COST };
        self.rc_sweep == format && self.shape.rows() <= MAX_ROWS && self.deal.fits(self.shape)
    }

    /// The rows of the shard.
    pub(crate) fn rows(&self) -> Vec<usize> {
        self.deal.rows(self.shard, self.shape)
    }

    /// The line of the journal.
    pub(crate) fn to_line(&self) -> String {
        to_line(self)
    }

    /// Refuses to continue the sweep in `folder` when it is another one.
    ///
    /// # Errors
    /// [`SweepError`] with the first difference.
    pub(crate) fn check_same(&self, there: &Self, folder: &Path) -> Result<(), SweepError> {
        let folder = folder.to_owned();
        if let Some(difference) = settings::difference((&there.settings, "in the folder"), (&self.settings, "now")) {
            return Err(SweepError::OtherSettings { folder, difference });
        }
        if there.shape != self.shape {
            return Err(SweepError::DamagedShape { folder });
        }
        if there.shard != self.shard {
            return Err(SweepError::OtherShard { folder, there: there.shard, here: self.shard });
        }
        Ok(())
    }

    /// Whether the fields of rows are stored.
    pub(crate) fn keeps_fields(&self) -> bool {
        self.settings["fields"] == true
    }
}

/// The line of the journal for row `row`.
pub(crate) fn row_line(row: usize, cells: &Cells) -> String {
    to_line(&Line::new(row, cells.clone()))
}

fn to_line(value: &impl Serialize) -> String {
    let mut line = serde_json::to_string(value).expect("a record of numbers and text is valid JSON");
    line.push('\n');
    line
}

/// Number of finished rows in the journal of a sweep (`sweep.jsonl`).
///
/// The last line may be incomplete.
///
/// # Errors
/// [`SweepError`] when the file is not a journal, or a line before the last is damaged.
pub fn finished_rows(journal: &[u8]) -> Result<usize, SweepError> {
    Content::of_bytes(journal, Path::new(JOURNAL_FILE)).map(|content| content.rows.len())
}

/// The settings of the sweep in `folder`, or `None` without a valid journal.
#[must_use]
pub fn settings_in(folder: &Path) -> Option<Value> {
    Some(Content::read(folder).ok()?.header.settings)
}

/// Where a row of a sweep comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowPlace {
    /// Index of its surface in the settings.
    pub surface: usize,
    /// The folder of its fields, if these are stored.
    pub fields: Option<PathBuf>,
}

/// The places of the finished rows of the sweep in `folder`, in the order of its table; `None` without a valid journal.
#[must_use]
pub fn rows_in(folder: &Path) -> Option<Vec<RowPlace>> {
    let content = Content::read(folder).ok()?;
    let loads = content.header.shape.loads.max(1);
    let place = |index: usize| RowPlace {
        surface: index / loads,
        fields: folder::has_fields(folder, index).then(|| folder::fields_folder(folder, index)),
    };
    Some(content.rows.keys().map(|index| place(*index)).collect())
}

/// Contents of a journal.
#[derive(Debug)]
pub(crate) struct Content {
    pub(crate) header: Header,
    pub(crate) rows: SweepRows,
    /// Number of bytes up to the end of the last complete line.
    pub(crate) whole: u64,
}

impl Content {
    /// Reads the journal in `folder`.
    ///
    /// A process that was killed may have left an incomplete last line, which is ignored.
    ///
    /// # Errors
    /// When there is no journal, the file is not one, or a line before the last is damaged.
    pub(crate) fn read(folder: &Path) -> Result<Self, SweepError> {
        let path = folder.join(JOURNAL_FILE);
        let bytes = std::fs::read(&path)
            .map_err(|cause| SweepError::NoJournal { folder: folder.to_owned(), cause: cause.to_string() })?;
        Self::of_bytes(&bytes, &path)
    }

    /// Reads `bytes`, the contents of the journal at `path`.
    ///
    /// # Errors
    /// Those of [`Content::read`].
    pub(crate) fn of_bytes(bytes: &[u8], path: &Path) -> Result<Self, SweepError> {
        let mut lines = bytes.split_inclusive(|&byte| byte == b'\n').peekable();
        let first = lines.next().filter(|line| line.ends_with(b"\n"));
        let header: Option<Header> = first.and_then(|line| serde_json::from_slice(line).ok());
        let header = header.filter(Header::is_sound);
        let header = header.ok_or_else(|| SweepError::NotAJournal { path: path.to_owned() })?;
        let mut content = Self { header, rows: SweepRows::new(), whole: first.map_or(0, <[u8]>::len) as u64 };
        let mut number = 1;
        while let Some(line) = lines.next() {
            number += 1;
            match content.parse(line) {
                Some(Line { row, cells, .. }) => content.rows.insert(row, cells),
                None if lines.peek().is_none() => break,
                None => return Err(SweepError::DamagedLine { path: path.to_owned(), line: number }),
            };
            content.whole += line.len() as u64;
        }
        Ok(content)
    }

    /// The journal as text.
    pub(crate) fn text(&self) -> String {
        let lines = self.rows.iter().map(|(&row, cells)| row_line(row, cells));
        std::iter::once(self.header.to_line()).chain(lines).collect()
    }

    /// Reads a complete line with a row of this sweep.
    fn parse(&self, line: &[u8]) -> Option<Line> {
        let whole = line.strip_suffix(b"\n")?;
        let line: Line = serde_json::from_slice(whole).ok()?;
        let is_sound = Line::new(line.row, line.cells.clone()).crc32 == line.crc32;
        (is_sound && line.row < self.header.shape.rows()).then_some(line)
    }
}
