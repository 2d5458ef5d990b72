//! `cargo xtask figures`: every figure of the paper in one run.
//!
//! The run is compared with the archived one, or replaces it.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::archive::{self, Run};
use crate::figure::{Figure, Preset, report, write};
use crate::{blocks, fig1, fig2, fig3, fig4, fig5, fig6, fig7, fig8, statements};

/// Use of the archived run in `data/runs/paper/`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Archive {
    /// The archived run is not read.
    Ignored,
    /// Every table is compared with the archived one. A difference is an error.
    Compared,
    /// This run replaces it: tables, pictures in `docs/images/`, and numbers in `docs/reproduction.md`.
    Replaced,
}

/// Computes and writes every figure of the paper into `folder`.
///
/// # Errors
/// When a figure cannot be computed or written, or differs from the archived run.
pub fn run(preset: Preset, folder: &Path, archive: Archive) -> Result<()> {
    let mut all = All { preset, folder, run: Run::start(preset) };
    all.compute::<fig1::Fig1>()?;
    all.compute::<fig2::Fig2>()?;
    all.compute::<fig3::Fig3>()?;
    all.compute::<fig4::Fig4>()?;
    // Fig. 5 and 7 are drawn from one sweep.
    let fig5 = all.compute::<fig5::Fig5>()?;
    all.compute::<fig6::Fig6>()?;
    all.add(|params| Ok(fig7::Fig7::of(params, fig5.into_sweep())))?;
    all.compute::<fig8::Fig8>()?;
    all.compute::<statements::Statements>()?;
    let run = all.run;
    run.save(folder)?;
    match archive {
        Archive::Ignored => Ok(()),
        Archive::Compared => compare(&run),
        Archive::Replaced => replace(&run, folder),
    }
}

fn compare(run: &Run) -> Result<()> {
    let differences = run.differences(&archive::folder())?;
    if !differences.is_empty() {
        bail!("{} tables differ from the archived run:\n{}", differences.len(), differences.join("\n"));
    }
    Ok(())
}

fn replace(run: &Run, folder: &Path) -> Result<()> {
    run.save(&archive::folder())?;
    run.save_tables(&archive::folder())?;
    run.copy_pictures(folder)?;
    blocks::update()
}

/// The figures that are computed so far.
struct All<'a> {
    preset: Preset,
    folder: &'a Path,
    run: Run,
}

impl All<'_> {
    fn compute<F: Figure>(&mut self) -> Result<F> {
        self.add(|params| F::compute(params))
    }

    /// Computes, writes and records one figure.
    fn add<F: Figure>(&mut self, make: impl FnOnce(&F::Params) -> Result<F>) -> Result<F> {
        let params = F::params(self.preset)?;
        let start = Instant::now();
        let figure = make(&params).with_context(|| format!("{} with {params:?}", F::NAME))?;
        let seconds = start.elapsed().as_secs_f64();
        report(&figure, &write(&figure, self.folder)?);
        self.run.add(&figure, &params, seconds);
        Ok(figure)
    }
}

#[cfg(test)]
mod tests {
    use std::process::{Command, Output};

    /// Runs the tests of the reduced figures in a process with these vector instructions.
    fn reviewed_with(instructions: &str) -> Output {
        let tests = std::env::current_exe().expect("this program");
        let mut command = Command::new(tests);
        command.args(["as_reviewed", "--test-threads=1"]).env("RC_SIMD", instructions).env("INSTA_UPDATE", "no");
        command.output().expect("the tests are run")
    }

    /// Solves, compares and draws every reduced figure with fewer vector instructions.
    ///
    /// This stands in for other processors. The tests of the figures themselves use all vector instructions of the
    /// present processor.
    #[test]
    fn figures_are_the_same_with_fewer_vector_instructions() {
        for instructions in ["scalar", "sse"] {
            let Output { status, stdout, .. } = reviewed_with(instructions);
            let report = String::from_utf8_lossy(&stdout);
            assert!(status.success(), "RC_SIMD={instructions}:\n{report}");
            assert_eq!(report.matches("... ok").count(), 11, "RC_SIMD={instructions}:\n{report}");
        }
        // An unknown value fails, which shows that the variable is read.
        let Output { status, stdout, .. } = reviewed_with("mmx");
        let report = String::from_utf8_lossy(&stdout);
        assert!(!status.success() && report.contains("RC_SIMD is mmx"), "{report}");
    }
}
