//! The realisations of a mean: their scenes and their results.
//!
//! A realisation is solved as `rc solve` does with its seed and grid.

use rc_sweep::{Cells, ControlKind, Realisation, RowError, RowResults, SolvedRow};

use super::problems::{RowScenes, SceneContact, SceneProblems};
use super::results::{self, Results};
use super::surfaces::SweptSurface;
use crate::error::CliError;
use crate::scene::keys::SurfaceKeys;
use crate::scene::loaded::LoadedSurface;
use crate::scene::resolve::{self, ContactSetup};
use crate::scene::values::GridSpec;

/// The realisations of a surface.
pub(super) struct Realisations<'a> {
    pub(super) surface: &'a SweptSurface,
    pub(super) control: ControlKind,
}

impl RowScenes<Realisation> for Realisations<'_> {
    fn load(&self, row: &Realisation) -> Result<LoadedSurface, CliError> {
        let keys = self.surface.setup.keys.clone();
        // A surface on one grid may be a rectangle.
        let own = keys.grid.filter(|grid| grid.nx.max(grid.ny) == row.side);
        let grid = own.or(Some(GridSpec::square(row.side)));
        let keys = SurfaceKeys { seed: Some(row.seed), grid, ..keys };
        resolve::surface(keys)?.load()
    }

    fn contact(&self, row: &Realisation) -> Result<ContactSetup, CliError> {
        self.surface.contact(self.control, row.load)
    }
}

/// The results of realisations.
pub(super) struct MeanResults<'a> {
    pub(super) control: ControlKind,
    pub(super) results: Results<'a>,
}

impl<S: RowScenes<Realisation>> RowResults<SceneProblems<'_, S>, Realisation> for MeanResults<'_> {
    fn cells(
        &self,
        _row: &Realisation,
        surface: &LoadedSurface,
        contact: &SceneContact,
        solved: SolvedRow,
    ) -> Result<Cells, CliError> {
        // Realisations have no order.
        self.results.cells(0, (surface, contact), solved, None)
    }

    fn failed(&self, row: &Realisation, error: CliError) -> RowError<CliError> {
        results::failed(error, || row.describe(self.control))
    }

    fn row_kept(&self) {
        self.results.row_kept();
    }

    fn should_stop(&self) -> bool {
        self.results.should_stop()
    }
}
