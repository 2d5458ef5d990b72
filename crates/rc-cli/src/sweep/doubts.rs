//! Warnings of the rows of a sweep, told once for all rows.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use rc_core::quantity::count;
use rc_sweep::{Warning, WarningCode};

use super::surfaces::Surfaces;
use crate::error::CliError;
use crate::scene::keys::RunKeys;
use crate::solve::solved::ProblemSetup;
use crate::warnings::shown;
use rc_sweep::memory::Budget;

/// The warnings of the rows that were solved, from any thread.
#[derive(Debug, Default)]
pub(super) struct Doubts(Mutex<BTreeMap<WarningCode, Doubt>>);

/// The rows with one code.
#[derive(Debug)]
struct Doubt {
    /// The first row with this code, and its text. It does not depend on the order in which rows are solved.
    first: (usize, String),
    n_rows: usize,
}

impl Doubts {
    /// Notes the warnings of a row.
    pub(super) fn note(&self, row: usize, warnings: &[Warning]) {
        let mut codes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for (i, warning) in warnings.iter().enumerate() {
            let of_row = || (row, warning.text.clone());
            let doubt = codes.entry(warning.code).or_insert_with(|| Doubt { first: of_row(), n_rows: 0 });
            // A row may have a code twice.
            if warnings[..i].iter().all(|other| other.code != warning.code) {
                doubt.n_rows += 1;
            }
            if row < doubt.first.0 {
                doubt.first = of_row();
            }
        }
    }

    /// One warning for each code.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let codes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let told = |(code, doubt): (&WarningCode, &Doubt)| {
            let rows = if doubt.n_rows > 1 { format!(" ({})", count(doubt.n_rows, "row")) } else { String::new() };
            Warning::new(*code, format!("{}{rows}", doubt.first.1))
        };
        codes.iter().map(told).collect()
    }

    /// Prints the warnings of all rows, or makes an error of them with `--strict`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn tell(&self, run: &RunKeys) -> Result<(), CliError> {
        let warnings = self.warnings();
        shown::tell(&warnings, run);
        shown::refuse(&warnings, run.strict, "; the rows are kept")
    }
}

/// Refuses doubtful surfaces and loads with `--strict`, before the first row.
///
/// # Errors
/// [`CliError::Input`], also for a map that cannot be read.
pub(super) fn refuse_early(surfaces: &Surfaces) -> Result<(), CliError> {
    if !surfaces.run.strict {
        return Ok(());
    }
    for swept in surfaces.all() {
        let surface = swept.setup.load_within(Budget::new(surfaces.run.memory_limit))?;
        for contact in swept.contacts(surfaces.control()) {
            let contact = contact?;
            let kernel = contact.kernel()?;
            let budget = Budget::UNLIMITED;
            let problem = ProblemSetup { surface: &surface, contact: &contact, kernel: &*kernel, budget };
            shown::refuse(&problem.warnings(), true, "; nothing was solved or written")?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_is_that_of_the_first_row() {
        let doubts = Doubts::default();
        let load = |text: &str| Warning::new(WarningCode::Load, text);
        doubts.note(3, &[load("third"), load("third again")]);
        doubts.note(1, &[load("first")]);
        let warnings = doubts.warnings();
        assert_eq!(warnings, [load("first (2 rows)")]);
    }
}
