//! Figures that are computed, and archived, one at a time.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};

use crate::archive::Run;
use crate::figure::{Figure, Preset, report, write};
use crate::{blocks, repository};

/// Computes one figure and writes it into `folder`.
///
/// With `archive`, this run becomes the archived one of the figure. Its tables go to `data/runs/NAME/`, its picture to
/// `docs/images/`, and its numbers into the documents.
///
/// # Errors
/// When the figure cannot be computed, or a file cannot be written.
pub fn run_one<F: Figure>(preset: Preset, params: &F::Params, folder: &Path, archive: bool) -> Result<F> {
    let (mut run, start) = (Run::start(preset), Instant::now());
    let figure = F::compute(params).with_context(|| format!("{} with {params:?}", F::NAME))?;
    run.add(&figure, params, start.elapsed().as_secs_f64());
    report(&figure, &write(&figure, folder)?);
    if archive {
        let archived = repository::root().join("data/runs").join(F::NAME);
        run.save(&archived)?;
        run.save_tables(&archived)?;
        run.copy_pictures(folder)?;
        blocks::update()?;
    }
    Ok(figure)
}
