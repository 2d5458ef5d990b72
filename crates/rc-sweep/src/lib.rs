//! Load curves over realisations: many loads on many surfaces, stored row by row.
//!
//! A [`SweepPlan`] says which rows are to be solved, and a journal holds the finished rows. Workers solve the rest, and
//! the result is a table. No row depends on another row, so resumed and sharded sweeps give the rows of an
//! uninterrupted sweep. This crate does not print and does not know a command line.
//!
//! There are three ways to say what a row is:
//!
//! - [`Sweep::solve_surfaces`] gets a function that makes surfaces, and one contact for all of them.
//! - [`Sweep::solve`] gets [`RowProblems`] and [`RowResults`], for other contacts, errors and files. The command line
//!   uses it.
//! - [`Sweep::run`] gets a [`RowSolver`], for rows that are no contacts, or that something else solves.
//!
//! An [`Ensemble`] is a mean over realisations with a wanted error. The error determines the number of realisations and
//! the fineness of grids. Rows are stored in the same way.
//!
//! [`Summary`] is the result of a contact problem in SI units. A row and `summary.json` hold it. Module [`files`]
//! writes each file completely or not at all. Module [`memory`] computes how many solves fit into memory at once.
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

mod contact_rows;
mod content;
mod deal;
mod ensemble;
mod error;
mod extended;
mod folder;
mod friction;
mod held;
mod hidden;
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
mod origin;
mod plan;
mod problems;
mod results;
mod row;
mod row_solver;
mod settings;
mod shard;
mod shear;
mod solve;
mod summary;
mod surfaces;
mod sweep;
mod table;
mod warning;
mod workers;

pub use content::{Cells, RowPlace, SweepRows, finished_rows, rows_in, settings_in};
pub use deal::Deal;
pub use ensemble::{Ensemble, EnsembleLevel, EnsembleMean, EnsemblePlan, Realisation, WantedMean};
pub use error::SweepError;
pub use folder::{TABLE_FILE, replace_fields};
pub use friction::FrictionSummary;
pub use job::JobError;
pub use kept::Kept;
pub use leakage::LeakageSummary;
pub use levels::LevelMean;
pub use lists::{Loads, Seeds};
pub use merge::{Merged, merge};
pub use number_or_text::number_or_text;
pub use origin::MapOrigin;
pub use plan::{ControlKind, FileMark, MAX_ROWS, PlannedSurface, SweepPlan, SweepRow};
pub use problems::{RowProblem, RowProblems};
pub use results::{RowResults, SolvedRow};
pub use row::Row;
pub use row_solver::{RowError, RowSolver, RunError, Workers};
pub use shard::{Shard, SweepShape};
pub use shear::ShearSummary;
pub use summary::{PathDifference, SecondBody, SolveContext, Summary, to_json};
pub use surfaces::{SurfaceError, SweptContact, SweptSurface};
pub use sweep::Sweep;
pub use table::{n_not_converged, to_csv};
pub use warning::{Warning, WarningCode};
