//! Why a sweep cannot be started, continued, kept or merged.

use std::path::PathBuf;

use thiserror::Error;

use crate::files::FileError;
use crate::folder::{JOURNAL_FILE, TABLE_FILE};
use crate::shard::Shard;

/// Why a sweep cannot be started, continued, kept or merged. Folders are those of sweeps.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A row could not be appended to the journal; the rows before are in it.
    #[error("cannot write {}: {cause}; {kept} rows before are kept", path.display())]
    Append {
        /// The journal.
        path: PathBuf,
        /// Why not.
        cause: String,
        /// Rows that are in it.
        kept: usize,
    },
    /// A file that a surface is made of cannot be read.
    #[error("{}: cannot read: {cause}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        cause: String,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {cause}")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// Why not.
        cause: String,
    },
    /// A shard without rows.
    #[error("shard {shard} of a sweep of {rows} rows is empty")]
    EmptyShard {
        /// The shard.
        shard: Shard,
        /// Rows of the whole sweep.
        rows: usize,
    },
    /// An ensemble has more loads than rows can be numbered for.
    #[error("{loads} loads are too many for means with an error, at most {most}")]
    TooManyMeans {
        /// The loads.
        loads: usize,
        /// Most of them.
        most: usize,
    },
    /// A row has no number for what is averaged.
    #[error("{quantity} of seed {seed} on grid {grid} is not a number")]
    NoNumber {
        /// The cell.
        quantity: String,
        /// Seed of the row.
        seed: u64,
        /// Its elements per side.
        grid: usize,
    },
    /// Another process has the sweep.
    #[error("{}: another process is writing this sweep", folder.display())]
    AnotherProcess {
        /// Its folder.
        folder: PathBuf,
    },
    /// A new sweep was to go where one is.
    #[error("{}: holds a sweep already", folder.display())]
    HoldsSweep {
        /// Its folder.
        folder: PathBuf,
    },
    /// A sweep was to be resumed where there is something else.
    #[error("{}: no sweep to resume: it has {name}, but no {JOURNAL_FILE}", folder.display())]
    NothingToResume {
        /// The folder.
        folder: PathBuf,
        /// What it has.
        name: String,
    },
    /// The folder has a file of a name that a sweep uses.
    #[error("{}: has {name} already", folder.display())]
    InTheWay {
        /// The folder.
        folder: PathBuf,
        /// The file.
        name: String,
    },
    /// The folder has no journal that can be read.
    #[error("{}: no sweep of rc here ({JOURNAL_FILE} cannot be read: {cause})", folder.display())]
    NoJournal {
        /// The folder.
        folder: PathBuf,
        /// Why not.
        cause: String,
    },
    /// The file is not a journal, or its first line is damaged.
    #[error("{}: not a journal of rc sweep", path.display())]
    NotAJournal {
        /// The file.
        path: PathBuf,
    },
    /// A line before the last one is damaged.
    #[error("{}: line {line} is damaged", path.display())]
    DamagedLine {
        /// The journal.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
    },
    /// The folder holds a sweep of other settings.
    #[error("{}: this folder holds another sweep: {difference}", folder.display())]
    OtherSettings {
        /// The folder.
        folder: PathBuf,
        /// The first setting that differs, with both values.
        difference: String,
    },
    /// The journal has another number of rows than its settings say.
    #[error("{}: the number of rows in its journal is not that of its settings: it is damaged", folder.display())]
    DamagedShape {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder holds another shard of the sweep.
    #[error("{}: holds shard {there}, not {here}", folder.display())]
    OtherShard {
        /// The folder.
        folder: PathBuf,
        /// The shard in it.
        there: Shard,
        /// The shard that was wanted.
        here: Shard,
    },
    /// Nothing to merge.
    #[error("no folder to merge")]
    NoShards,
    /// Two folders to be merged are not of one sweep.
    #[error("{}: belongs to another sweep than {}: {difference}", folder.display(), first.display())]
    NotSameSweep {
        /// The folder.
        folder: PathBuf,
        /// The folder before.
        first: PathBuf,
        /// The first setting that differs, with both values.
        difference: String,
    },
    /// Two folders to be merged are of different divisions into shards.
    #[error("{}: is shard {here}, but {} is shard {there}", folder.display(), first.display())]
    OtherDivision {
        /// The folder.
        folder: PathBuf,
        /// Its shard.
        here: Shard,
        /// The folder before.
        first: PathBuf,
        /// The shard of that one.
        there: Shard,
    },
    /// The rows of two folders to be merged were not dealt in the same way.
    #[error("{}: its rows were dealt differently from those of {}", folder.display(), first.display())]
    OtherDeal {
        /// The folder.
        folder: PathBuf,
        /// The folder before.
        first: PathBuf,
    },
    /// A shard was given twice.
    #[error("{}: is shard {shard}, as is {}", folder.display(), other.display())]
    SameShard {
        /// The folder.
        folder: PathBuf,
        /// The folder before.
        other: PathBuf,
        /// The shard of both.
        shard: Shard,
    },
    /// A shard to be merged is not finished.
    #[error("{}: {missing} rows of shard {shard} are missing", folder.display())]
    MissingRows {
        /// The folder.
        folder: PathBuf,
        /// Its shard.
        shard: Shard,
        /// Rows that are not in it.
        missing: usize,
    },
    /// Not all shards were given.
    #[error("shard {shard} is missing")]
    MissingShard {
        /// The first one that is missing.
        shard: Shard,
    },
    /// The result folder of a finished row is gone.
    #[error("{}: the fields of this row are missing", folder.display())]
    MissingFields {
        /// The folder of the row.
        folder: PathBuf,
    },
}

impl SweepError {
    /// The table could not be made of its rows.
    pub(crate) fn table(folder: &std::path::Path, cause: impl std::fmt::Display) -> Self {
        FileError::write(&folder.join(TABLE_FILE), cause).into()
    }
}
