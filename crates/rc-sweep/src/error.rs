//! Errors of sweeps.

use std::path::PathBuf;

use rc_core::quantity::count;
use thiserror::Error;

use crate::files::FileError;
use crate::folder::{JOURNAL_FILE, TABLE_FILE};
use crate::shard::Shard;

/// Reasons why a sweep cannot be started, continued, stored or merged.
///
/// Folders are those of sweeps.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file could not be written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A row could not be appended to the journal. The rows before it are stored.
    #[error("cannot write {}: {cause}; the earlier rows are kept ({kept})", path.display())]
    Append {
        /// Path of the journal.
        path: PathBuf,
        /// Cause of the failure.
        cause: String,
        /// Number of rows in the journal.
        kept: usize,
    },
    /// The file of a surface cannot be read.
    #[error("{}: cannot read: {cause}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the failure.
        cause: String,
    },
    /// The threads could not be started.
    #[error("cannot start {threads} threads: {cause}")]
    Threads {
        /// Number of threads.
        threads: usize,
        /// Cause of the failure.
        cause: String,
    },
    /// A shard has no rows.
    #[error("shard {shard} is empty, because the sweep has only {}", count(*rows, "row"))]
    EmptyShard {
        /// The shard.
        shard: Shard,
        /// Number of rows of the whole sweep.
        rows: usize,
    },
    /// An ensemble has too many loads for numbers of rows.
    #[error("error_of_mean: at most {most} loads are possible, not {loads}")]
    TooManyMeans {
        /// Number of loads.
        loads: usize,
        /// Maximum number of loads.
        most: usize,
    },
    /// The cell of a row that is to be averaged is not a number.
    #[error("{quantity} of seed {seed} on grid {grid} has no value")]
    NoNumber {
        /// Name of the cell.
        quantity: String,
        /// Seed of the row.
        seed: u64,
        /// Elements per side of the row's grid.
        grid: usize,
    },
    /// Another process is writing the sweep.
    #[error("{}: another process is writing this sweep", folder.display())]
    AnotherProcess {
        /// Folder of the sweep.
        folder: PathBuf,
    },
    /// The folder for a new sweep contains a sweep already.
    #[error("{}: holds a sweep already", folder.display())]
    HoldsSweep {
        /// Folder of the sweep.
        folder: PathBuf,
    },
    /// The folder of a sweep to resume contains something else.
    #[error("{}: no sweep to resume: it has {name}, but no {JOURNAL_FILE}", folder.display())]
    NothingToResume {
        /// The folder.
        folder: PathBuf,
        /// Name of a file in it.
        name: String,
    },
    /// The folder contains a file whose name a sweep uses.
    #[error("{}: has {name} already", folder.display())]
    InTheWay {
        /// The folder.
        folder: PathBuf,
        /// Name of the file.
        name: String,
    },
    /// The folder does not contain a readable journal.
    #[error("{}: not the folder of a sweep ({JOURNAL_FILE} cannot be read: {cause})", folder.display())]
    NoJournal {
        /// The folder.
        folder: PathBuf,
        /// Cause of the failure.
        cause: String,
    },
    /// The file is not a journal, or its first line is damaged.
    #[error("{}: not a journal of rc sweep", path.display())]
    NotAJournal {
        /// Path of the file.
        path: PathBuf,
    },
    /// A line before the last one is damaged.
    #[error("{}: line {line} is damaged", path.display())]
    DamagedLine {
        /// Path of the journal.
        path: PathBuf,
        /// Number of the line, from 1.
        line: usize,
    },
    /// The folder contains a sweep with other settings.
    #[error("{}: this folder holds another sweep: {difference}", folder.display())]
    OtherSettings {
        /// The folder.
        folder: PathBuf,
        /// The first setting that differs, with both values.
        difference: String,
    },
    /// The number of rows in the journal does not agree with its settings.
    #[error("{}: the journal is damaged, because its number of rows is not that of its settings", folder.display())]
    DamagedShape {
        /// The folder.
        folder: PathBuf,
    },
    /// The folder contains another shard of the sweep.
    #[error("{}: holds shard {there}, not {here}", folder.display())]
    OtherShard {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        there: Shard,
        /// The requested shard.
        here: Shard,
    },
    /// There are no folders to merge.
    #[error("no folder to merge")]
    NoShards,
    /// Two folders to merge belong to different sweeps.
    #[error("{}: belongs to another sweep than {}: {difference}", folder.display(), first.display())]
    NotSameSweep {
        /// The folder.
        folder: PathBuf,
        /// The previous folder.
        first: PathBuf,
        /// The first setting that differs, with both values.
        difference: String,
    },
    /// Two folders to merge belong to different divisions into shards.
    #[error("{}: is shard {here}, but {} is shard {there}", folder.display(), first.display())]
    OtherDivision {
        /// The folder.
        folder: PathBuf,
        /// Shard in the folder.
        here: Shard,
        /// The previous folder.
        first: PathBuf,
        /// Shard in the previous folder.
        there: Shard,
    },
    /// The rows of two folders to merge were dealt in different ways.
    #[error("{}: its rows were distributed to shards in another way than those of {}", folder.display(), first.display())]
    OtherDeal {
        /// The folder.
        folder: PathBuf,
        /// The previous folder.
        first: PathBuf,
    },
    /// Two folders contain the same shard.
    #[error("{}: is shard {shard}, and so is {}", folder.display(), other.display())]
    SameShard {
        /// The folder.
        folder: PathBuf,
        /// The previous folder.
        other: PathBuf,
        /// The shard in both folders.
        shard: Shard,
    },
    /// A shard to merge is not finished.
    #[error("{}: shard {shard} lacks {}", folder.display(), count(*missing, "row"))]
    MissingRows {
        /// The folder.
        folder: PathBuf,
        /// The shard in the folder.
        shard: Shard,
        /// Number of rows that are missing.
        missing: usize,
    },
    /// A shard is missing.
    #[error("shard {shard} is missing")]
    MissingShard {
        /// The first shard that is missing.
        shard: Shard,
    },
    /// The result folder of a finished row is missing.
    #[error("{}: the fields of this row are missing", folder.display())]
    MissingFields {
        /// The folder of the row.
        folder: PathBuf,
    },
}

impl SweepError {
    /// The error of a table that could not be made from its rows.
    pub(crate) fn table(folder: &std::path::Path, cause: impl std::fmt::Display) -> Self {
        FileError::write(&folder.join(TABLE_FILE), cause).into()
    }
}
