//! Load curves over realisations: many loads on many surfaces, kept row by row.
//!
//! A [`SweepPlan`] is what is to be solved, the journal what is done, workers do the difference, and a table is the
//! result. No row depends on another one, so that resumed and sharded sweeps give the rows of an uninterrupted one. How
//! a row is solved is handed in as a [`RowSolver`]; this crate prints nothing and knows no command line.
//!
//! An [`Ensemble`] is the mean over as many realisations, on as fine grids, as its error asks for, kept in the same
//! way.
//!
//! [`Summary`] is what a row of a contact problem holds, in SI, and what `summary.json` holds. [`files`] writes files
//! that are there whole or not at all, [`memory`] knows how many solves fit side by side.
//!
//! ```
//! use rc_sweep::{Cells, ControlKind, SweepPlan, PlannedSurface, SweepRow, RowError, RowSolver, Shard, Sweep, Workers};
//!
//! /// A spring instead of a contact.
//! struct Spring;
//!
//! impl RowSolver for Spring {
//!     type Error = String;
//!     fn solve(&self, row: &SweepRow) -> Result<Cells, RowError<String>> {
//!         Ok(Cells::from_iter([("penetration".to_owned(), (row.load / 2e9).into())]))
//!     }
//! }
//!
//! let folder = tempfile::tempdir()?;
//! let surface = PlannedSurface { seed: Some(1), loads: vec![1e3, 2e3], ..PlannedSurface::default() };
//! let plan = SweepPlan::new(ControlKind::Pressure, vec![surface]);
//! let sweep = Sweep::start(plan, Shard::WHOLE, &folder.path().join("s"), false)?;
//! let table = sweep.run(&Spring, Workers { threads: 2, at_once: 2 })?;
//! let expected = "seed,control_value,penetration\n1,1000.0,5e-7\n1,2000.0,1e-6\n";
//! assert_eq!(std::fs::read_to_string(table)?, expected);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod files;
pub mod memory;

mod content;
mod deal;
mod ensemble;
mod error;
mod folder;
mod job;
mod journal;
mod kept;
mod latest;
mod leakage;
mod levels;
mod lists;
mod lock;
mod merge;
mod number_or_text;
mod plan;
mod row_solver;
mod settings;
mod shard;
mod summary;
mod sweep;
mod table;
mod workers;

pub use content::{Cells, SweepRows, finished_rows, settings_in};
pub use deal::Deal;
pub use ensemble::{Ensemble, EnsembleLevel, EnsembleMean, EnsemblePlan, Realisation, WantedMean};
pub use error::SweepError;
pub use folder::{TABLE_FILE, replace_fields};
pub use job::JobError;
pub use kept::Kept;
pub use latest::Latest;
pub use leakage::LeakageSummary;
pub use levels::LevelMean;
pub use lists::{Loads, Seeds};
pub use merge::{Merged, merge};
pub use number_or_text::number_or_text;
pub use plan::{ControlKind, FileMark, MAX_ROWS, PlannedSurface, SweepPlan, SweepRow};
pub use row_solver::{RowError, RowSolver, RunError, Workers};
pub use shard::{Shard, SweepShape};
pub use summary::{SolveContext, Summary, to_json};
pub use sweep::Sweep;
pub use table::n_not_converged;
