//! `rc sweep merge`: the shards of a sweep as if it had been one.

use std::path::{Path, PathBuf};

use super::content::{Content, Header, JOURNAL_FILE, Rows, row_line};
use super::shard::Shard;
use super::{FILES, ROWS_FOLDER, check_converged, fields_folder, has_fields, row_name, settings, table};
use crate::args::MergeArgs;
use crate::error::CliError;
use crate::output::{self, Staged};

/// Runs `rc sweep merge`.
///
/// # Errors
/// [`CliError::Input`] when the folders are not all shards of one sweep, complete; [`CliError::Write`];
/// [`CliError::NotConverged`] as of the whole sweep.
pub(super) fn run(args: &MergeArgs) -> Result<(), CliError> {
    if let Some(name) = FILES.iter().find(|name| args.out.join(name).symlink_metadata().is_ok()) {
        return Err(CliError::in_file(&args.out, format_args!("has {name} already; give another --out")));
    }
    output::check_folder(&args.out)?;
    let shards = read(&args.folders)?;
    let header = match shards.first() {
        Some((_, first)) => Header::new(first.header.shape, Shard::WHOLE, first.header.settings.clone()),
        None => return Err(CliError::input("no folder to merge; give those of all shards")),
    };
    if header.settings["fields"] == true {
        check_fields(&shards)?;
    }
    let n_shards = shards.len();
    let rows = write(&args.out, &header, &shards)?;
    let path = args.out.join(table::TABLE_FILE);
    if !args.quiet {
        output::print(&format!("{} rows of {n_shards} shards\n\nwritten to {}\n", rows.len(), path.display()))?;
    }
    check_converged(&rows, &path)
}

/// The shards, checked to be all those of one sweep, and complete.
fn read(folders: &[PathBuf]) -> Result<Vec<(&Path, Content)>, CliError> {
    let mut shards: Vec<(&Path, Content)> = Vec::new();
    for folder in folders {
        let content = Content::read(folder)?;
        if let Some((first, other)) = shards.first() {
            check_same_sweep(first, &other.header, folder, &content.header)?;
        }
        let shard = content.header.shard;
        if let Some((other, _)) = shards.iter().find(|(_, other)| other.header.shard == shard) {
            return Err(CliError::in_file(folder, format_args!("is shard {shard}, and so is {}", other.display())));
        }
        let missing = shard.rows(content.header.shape).filter(|row| !content.rows.contains_key(row)).count();
        if missing > 0 {
            let message = format_args!("{missing} rows of shard {shard} are missing; finish it with --resume");
            return Err(CliError::in_file(folder, message));
        }
        shards.push((folder, content));
    }
    let count = shards.first().map_or(0, |(_, content)| content.header.shard.count);
    let given = |index: usize| shards.iter().any(|(_, content)| content.header.shard.index == index);
    match (1..=count).find(|&index| !given(index)) {
        None => Ok(shards),
        Some(index) => {
            Err(CliError::input(format_args!("shard {index}/{count} is missing; give the folders of all shards")))
        }
    }
}

fn check_same_sweep(first: &Path, there: &Header, folder: &Path, here: &Header) -> Result<(), CliError> {
    let first = first.display();
    if let Some(difference) = settings::difference(&there.settings, &here.settings) {
        return Err(CliError::in_file(folder, format_args!("not of the same sweep as {first}: {difference}")));
    }
    if there.shard.count != here.shard.count {
        let (a, b) = (here.shard, there.shard);
        return Err(CliError::in_file(folder, format_args!("is shard {a}, but {first} is shard {b}")));
    }
    Ok(())
}

/// Writes the sweep in one go: nothing of it appears unless all of it can be copied.
fn write(out: &Path, header: &Header, shards: &[(&Path, Content)]) -> Result<Rows, CliError> {
    let rows: Rows = shards.iter().flat_map(|(_, content)| content.rows.clone()).collect();
    let lines = rows.iter().map(|(&row, cells)| row_line(row, cells));
    let journal: String = std::iter::once(header.to_line()).chain(lines).collect();
    let csv = table::to_csv(&rows).map_err(|cause| CliError::write(&out.join(table::TABLE_FILE), cause))?;
    let mut staged = Staged::new(out)?;
    if header.settings["fields"] == true {
        staged.add(ROWS_FOLDER, |path| copy_fields(shards, path))?;
    }
    staged.add_text(JOURNAL_FILE, &journal)?;
    staged.add(table::TABLE_FILE, |path| output::write_synced(path, &csv))?;
    staged.commit()?;
    Ok(rows)
}

/// The result folder of each row must be there before any is copied.
fn check_fields(shards: &[(&Path, Content)]) -> Result<(), CliError> {
    for (folder, content) in shards {
        if let Some(row) = content.rows.keys().find(|&&row| !has_fields(folder, row)) {
            let missing = fields_folder(folder, *row);
            let message = "the fields of this row are missing; --resume in the folder of the shard makes them again";
            return Err(CliError::in_file(&missing, message));
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
