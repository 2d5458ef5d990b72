//! `cargo xtask figures`: every figure of the paper in one run, compared with the archived one or archived itself.

use std::time::Instant;

use anyhow::{Context, Result, bail};

use super::archive::{self, Run};
use super::{Figure, Preset, fig1, fig2, fig3, fig4, fig5, fig6, fig7, fig8, report, write};
use crate::reproduction;

/// Draws every figure of the paper.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figures: super::Args,
    /// Compares every table with the archived run in `data/runs/paper/`; a difference is an error.
    #[arg(long, conflicts_with = "quick")]
    check: bool,
    /// Makes this run the archived one: tables to `data/runs/paper/`, pictures to `docs/images/`, numbers into
    /// `docs/reproduction.md`.
    #[arg(long, conflicts_with_all = ["quick", "check"])]
    archive: bool,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let mut all = All { args: &args.figures, run: Run::start(args.figures.preset()) };
    all.compute::<fig1::Fig1>()?;
    all.compute::<fig2::Fig2>()?;
    all.compute::<fig3::Fig3>()?;
    all.compute::<fig4::Fig4>()?;
    // Fig. 5 and 7 are drawn from one sweep.
    let fig5 = all.compute::<fig5::Fig5>()?;
    all.compute::<fig6::Fig6>()?;
    all.add(|params| Ok(fig7::Fig7::of(params, fig5.into_sweep())))?;
    all.compute::<fig8::Fig8>()?;
    let run = all.run;
    run.save(&args.figures.out)?;
    if args.check {
        let differences = run.differences(&archive::folder())?;
        if !differences.is_empty() {
            bail!("{} tables differ from the archived run:\n{}", differences.len(), differences.join("\n"));
        }
    }
    if args.archive {
        run.save(&archive::folder())?;
        run.save_tables(&archive::folder())?;
        archive::copy_pictures(&args.figures.out)?;
        reproduction::update()?;
    }
    Ok(())
}

/// The figures so far.
struct All<'a> {
    args: &'a super::Args,
    run: Run,
}

impl All<'_> {
    fn preset(&self) -> Preset {
        self.args.preset()
    }

    fn compute<F: Figure>(&mut self) -> Result<F> {
        self.add(|params| F::compute(params))
    }

    /// Makes, writes and records one figure.
    fn add<F: Figure>(&mut self, make: impl FnOnce(&F::Params) -> Result<F>) -> Result<F> {
        let params = F::params(self.preset())?;
        let start = Instant::now();
        let figure = make(&params).with_context(|| format!("{} with {params:?}", F::NAME))?;
        let seconds = start.elapsed().as_secs_f64();
        report(&figure, &write(&figure, &self.args.out)?);
        self.run.add(&figure, &params, seconds);
        Ok(figure)
    }
}
