//! Studies of measured maps.

use pyo3::prelude::*;
use rc_cli::study::{StudyOutcome, of_words};

use crate::errors::raised;
use crate::running::{Ended, GRACE, Run, run};

/// The record of a study as JSON, and the warnings of its rows.
///
/// `words` are the arguments of `rc study`. After a signal, no further row is begun.
#[pyfunction]
pub(crate) fn study(py: Python<'_>, words: Vec<String>, threads: Option<usize>) -> PyResult<(String, Vec<String>)> {
    let threads = rc_cli::run::threads::checked(threads).map_err(raised)?.unwrap_or(0);
    let words: Vec<_> = words.into_iter().map(Into::into).collect();
    let how = Run { threads, end: None, progress: None, grace: GRACE };
    let (ended, _) = run(py, how, move |watched| of_words(&words, watched))?;
    match ended {
        Ended::Done { value, early: None } => {
            let StudyOutcome { record, warnings } = value.map_err(raised)?;
            Ok((record, warnings))
        }
        Ended::Done { early: Some(early), .. } | Ended::Left { early, .. } => Err(early),
    }
}
