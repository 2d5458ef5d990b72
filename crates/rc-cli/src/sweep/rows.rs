//! The rows of a sweep: their scenes and their results.

use rc_sweep::memory::Budget;
use rc_sweep::{Cells, RowError, RowResults, SolvedRow, Sweep, SweepRow};

use super::problems::{RowScenes, SceneContact, SceneProblems};
use super::results::{self, Results};
use super::surfaces::Surfaces;
use crate::error::CliError;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::ContactSetup;

impl RowScenes<SweepRow> for Surfaces {
    fn load(&self, row: &SweepRow) -> Result<LoadedSurface, CliError> {
        self.surface(row).load_within(Budget::new(self.run.memory_limit))
    }

    fn contact(&self, row: &SweepRow) -> Result<ContactSetup, CliError> {
        self.contact_of(row)
    }
}

/// The results of the rows of a sweep.
pub(super) struct SweepResults<'a, S> {
    pub(super) sweep: &'a Sweep,
    pub(super) scenes: &'a S,
    pub(super) results: Results<'a>,
}

impl<S: RowScenes<SweepRow>> RowResults<SceneProblems<'_, S>> for SweepResults<'_, S> {
    fn cells(
        &self,
        row: &SweepRow,
        surface: &LoadedSurface,
        contact: &SceneContact,
        solved: SolvedRow,
    ) -> Result<Cells, CliError> {
        self.scenes.see(row, &solved.solution)?;
        let folder = self.sweep.fields_folder(row.index);
        self.results.cells(row.index, (surface, contact), solved, folder.as_deref())
    }

    fn failed(&self, row: &SweepRow, error: CliError) -> RowError<CliError> {
        results::failed(error, || self.sweep.plan().describe(row))
    }

    fn row_kept(&self) {
        self.results.row_kept();
    }

    fn should_stop(&self) -> bool {
        self.results.should_stop()
    }
}
