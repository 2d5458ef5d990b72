//! What becomes of the rows of a sweep or a mean: cells, files, warnings and the bar.

use std::path::Path;
use std::time::Instant;

use rc_core::Observer;
use rc_sweep::{Cells, LeakageSummary, RowError, SolvedRow, replace_fields};

use super::bar::RowBar;
use super::creep::crept;
use super::doubts::Doubts;
use super::problems::SceneContact;
use crate::error::CliError;
use crate::run::stop::Stop;
use crate::scene::loaded::LoadedSurface;
use crate::scene::time_limit::TimeLimit;

/// What the results of all rows have in common.
pub(super) struct Results<'a> {
    /// Number of all threads.
    threads: usize,
    doubts: &'a Doubts,
    limit: Stop,
    /// Says when to stop, besides the limit.
    stop: Option<&'a dyn Observer>,
    bar: RowBar,
}

impl<'a> Results<'a> {
    /// Results with the number `threads` of all threads. Their time limit begins now.
    pub(super) fn new(threads: usize, doubts: &'a Doubts, limit: Option<TimeLimit>, bar: RowBar) -> Self {
        Self { threads, doubts, limit: Stop::at(Instant::now(), limit), stop: None, bar }
    }

    /// These results until `stop` says so.
    pub(super) fn until(self, stop: Option<&'a dyn Observer>) -> Self {
        Self { stop, ..self }
    }

    /// The cells of row `number`. With `folder`, its fields are in this folder when this returns.
    pub(super) fn cells(
        &self,
        number: usize,
        (surface, contact): (&LoadedSurface, &SceneContact),
        solved: SolvedRow,
        folder: Option<&Path>,
    ) -> Result<Cells, CliError> {
        let solved = contact.solved(surface, solved);
        let summary = solved.summary(self.threads);
        self.doubts.note(number, &summary.warnings);
        if let Some(folder) = folder {
            replace_fields(folder, || solved.write(folder, &summary))?;
        }
        let mut cells = summary.cells();
        if let Some(creep) = contact.setup.creep {
            crept(&mut cells, creep);
        }
        if contact.setup.keys.leakage {
            LeakageSummary::complete(&mut cells, contact.setup.keys.viscosity.is_some());
        }
        Ok(cells)
    }

    pub(super) fn row_kept(&self) {
        self.bar.one_more();
    }

    pub(super) fn should_stop(&self) -> bool {
        self.limit.reason().is_some() || self.stop.is_some_and(Observer::should_stop)
    }
}

/// Bad input refuses its row, which `describe` names. Any other error ends the sweep.
pub(super) fn failed(error: CliError, describe: impl FnOnce() -> String) -> RowError<CliError> {
    match error {
        CliError::Input(message) => RowError::Refused(CliError::input(format_args!("{}: {message}", describe()))),
        other => RowError::Failed(other),
    }
}
