//! `cargo xtask gfmd`: comparison with a published reference with many longest waves in the cell.

use anyhow::Result;
use rc_figures::{Figure as _, Gfmd, run_one};

use crate::figures;

/// Compares area, stress, mean gap and energy with the published GFMD reference; docs/benchmarks.md.
///
/// It takes minutes and 2 GB without --quick.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Archives this run: tables in `data/runs/gfmd/`, and the picture in `docs/images/`.
    #[arg(long, conflicts_with = "quick")]
    archive: bool,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let preset = args.figure.preset();
    run_one::<Gfmd>(preset, &Gfmd::params(preset)?, &args.figure.out, args.archive)?;
    Ok(())
}
