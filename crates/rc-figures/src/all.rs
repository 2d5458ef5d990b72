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
    all.add(&fig7::Fig7::params(preset)?, |params| Ok(fig7::Fig7::of(params, fig5.into_sweep())))?;
    all.compute::<fig8::Fig8>()?;
    all.compute::<statements::Statements>()?;
    let run = all.run;
    run.save(folder)?;
    match archive {
        Archive::Ignored => Ok(()),
        Archive::Compared => compare(&run),
        Archive::Replaced => replace(&run, &archive::folder("paper"), folder),
    }
}

fn compare(run: &Run) -> Result<()> {
    let differences = run.differences(&archive::folder("paper"))?;
    if !differences.is_empty() {
        bail!("{} tables differ from the archived run:\n{}", differences.len(), differences.join("\n"));
    }
    Ok(())
}

/// Makes `run`, with its pictures in `folder`, the archived one.
fn replace(run: &Run, archived: &Path, folder: &Path) -> Result<()> {
    run.save(archived)?;
    run.save_tables(archived)?;
    run.copy_pictures(folder)?;
    blocks::update()
}

/// Computes one figure and writes it into `folder`.
///
/// With `archive`, this run becomes the archived one of the figure. Its tables go to `data/runs/NAME/`, its picture to
/// `docs/images/`, and its numbers into the pages.
///
/// # Errors
/// When the figure cannot be computed, or a file cannot be written.
pub fn run_one<F: Figure>(preset: Preset, params: &F::Params, folder: &Path, archive: bool) -> Result<F> {
    let mut all = All { preset, folder, run: Run::start(preset) };
    let figure = all.add(params, F::compute)?;
    if archive {
        replace(&all.run, &archive::folder(F::NAME), folder)?;
    }
    Ok(figure)
}

/// The figures that are computed so far.
struct All<'a> {
    preset: Preset,
    folder: &'a Path,
    run: Run,
}

impl All<'_> {
    fn compute<F: Figure>(&mut self) -> Result<F> {
        self.add(&F::params(self.preset)?, F::compute)
    }

    /// Computes, writes and records one figure.
    fn add<F: Figure>(&mut self, params: &F::Params, make: impl FnOnce(&F::Params) -> Result<F>) -> Result<F> {
        let start = Instant::now();
        let figure = make(params).with_context(|| format!("{} with {params:?}", F::NAME))?;
        let seconds = start.elapsed().as_secs_f64();
        report(&figure, &write(&figure, self.folder)?);
        self.run.add(&figure, params, seconds);
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
