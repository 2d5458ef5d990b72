//! Merging of the shards of a sweep.

use std::path::{Path, PathBuf};

use crate::content::{Content, Header, SweepRows, row_line};
use crate::error::SweepError;
use crate::files::{self, Staged};
use crate::folder::{FILES, JOURNAL_FILE, ROWS_FOLDER, TABLE_FILE, fields_folder, has_fields, row_name};
use crate::shard::Shard;
use crate::{settings, table};

/// A sweep that was merged from shards.
#[derive(Clone, Debug, PartialEq)]
pub struct Merged {
    /// All rows.
    pub rows: SweepRows,
    /// Path of the table.
    pub table: PathBuf,
}

/// Merges the shards in `folders` to one sweep in `out`.
///
/// # Errors
/// [`SweepError`] when the folders are not all shards of one sweep, or a shard is not complete. Also when `out`
/// contains a sweep or cannot be written. Nothing remains in `out` then.
pub fn merge(folders: &[PathBuf], out: &Path) -> Result<Merged, SweepError> {
    if let Some(name) = FILES.iter().find(|name| out.join(name).symlink_metadata().is_ok()) {
        return Err(SweepError::InTheWay { folder: out.to_owned(), name: (*name).to_owned() });
    }
    files::check_folder(out)?;
    let shards = read(folders)?;
    let (_, first) = shards.first().ok_or(SweepError::NoShards)?;
    let header = Header::whole(first.header.shape, first.header.settings.clone());
    if header.keeps_fields() {
        check_fields(&shards)?;
    }
    let rows = write(out, &header, &shards)?;
    Ok(Merged { rows, table: out.join(TABLE_FILE) })
}

/// Reads the shards, and checks that they are complete and form one sweep.
fn read(folders: &[PathBuf]) -> Result<Vec<(&Path, Content)>, SweepError> {
    let mut shards: Vec<(&Path, Content)> = Vec::new();
    for folder in folders {
        let content = Content::read(folder)?;
        if let Some((first, other)) = shards.first() {
            check_same_sweep(first, &other.header, folder, &content.header)?;
        }
        let shard = content.header.shard;
        if let Some((other, _)) = shards.iter().find(|(_, other)| other.header.shard == shard) {
            let (folder, other) = (folder.clone(), other.to_path_buf());
            return Err(SweepError::SameShard { folder, other, shard });
        }
        let missing = content.header.rows().iter().filter(|row| !content.rows.contains_key(row)).count();
        if missing > 0 {
            return Err(SweepError::MissingRows { folder: folder.clone(), shard, missing });
        }
        shards.push((folder, content));
    }
    let count = shards.first().map_or(0, |(_, content)| content.header.shard.count);
    let given = |index: usize| shards.iter().any(|(_, content)| content.header.shard.index == index);
    match (1..=count).find(|&index| !given(index)) {
        None => Ok(shards),
        Some(index) => Err(SweepError::MissingShard { shard: Shard { index, count } }),
    }
}

fn check_same_sweep(first: &Path, there: &Header, folder: &Path, here: &Header) -> Result<(), SweepError> {
    let (first, folder) = (first.to_owned(), folder.to_owned());
    let places = [&first, &folder].map(|path| format!("in {}", path.display()));
    let difference = settings::difference((&there.settings, &places[0]), (&here.settings, &places[1]));
    if let Some(difference) = difference {
        return Err(SweepError::NotSameSweep { folder, first, difference });
    }
    if there.shard.count != here.shard.count {
        return Err(SweepError::OtherDivision { folder, here: here.shard, first, there: there.shard });
    }
    if there.deal != here.deal {
        return Err(SweepError::OtherDeal { folder, first });
    }
    Ok(())
}

/// Writes the sweep in one step. No file appears unless all files can be copied.
fn write(out: &Path, header: &Header, shards: &[(&Path, Content)]) -> Result<SweepRows, SweepError> {
    let rows: SweepRows = shards.iter().flat_map(|(_, content)| content.rows.clone()).collect();
    let lines = rows.iter().map(|(&row, cells)| row_line(row, cells));
    let journal: String = std::iter::once(header.to_line()).chain(lines).collect();
    let csv = table::to_csv(&rows).map_err(|cause| SweepError::table(out, cause))?;
    let mut staged = Staged::new(out)?;
    if header.keeps_fields() {
        staged.add(ROWS_FOLDER, |path| copy_fields(shards, path))?;
    }
    staged.add_text(JOURNAL_FILE, &journal)?;
    staged.add(TABLE_FILE, |path| files::write_synced(path, &csv))?;
    staged.commit()?;
    Ok(rows)
}

/// Checks that the result folder of each row exists, before any is copied.
fn check_fields(shards: &[(&Path, Content)]) -> Result<(), SweepError> {
    for (folder, content) in shards {
        if let Some(row) = content.rows.keys().find(|&&row| !has_fields(folder, row)) {
            return Err(SweepError::MissingFields { folder: fields_folder(folder, *row) });
        }
    }
    Ok(())
}

/// Copies the result folder of each row into `rows`.
fn copy_fields(shards: &[(&Path, Content)], rows: &Path) -> std::io::Result<()> {
    for (folder, content) in shards {
        for &row in content.rows.keys() {
            let to = rows.join(row_name(row));
            std::fs::create_dir_all(&to)?;
            for entry in std::fs::read_dir(fields_folder(folder, row))? {
                let entry = entry?;
                std::fs::copy(entry.path(), to.join(entry.file_name()))?;
            }
        }
    }
    Ok(())
}
