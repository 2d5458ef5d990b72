//! `cargo xtask gfmd`: comparison with a published reference with many longest waves in the cell.

use std::path::PathBuf;

use anyhow::{Context, Result};
use rc_figures::{Figure as _, Gfmd, beside, run_one};

use crate::figures;

/// Compares area, stress, mean gap and energy with the published GFMD reference; docs/gfmd.md.
///
/// It takes minutes and 2 GB without --quick.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Archives this run: tables, picture and numbers of the document.
    ///
    /// They are in `data/runs/gfmd/`, `docs/images/` and `docs/gfmd.md`.
    #[arg(long, conflicts_with = "quick")]
    archive: bool,
    /// Folder Data of the published files, for tables of their results beside ours.
    ///
    /// The results are energy, mean gap and stress.
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let (preset, out) = (args.figure.preset(), &args.figure.out);
    let figure: Gfmd = run_one(preset, &Gfmd::params(preset)?, out, args.archive)?;
    let tables = args.data.as_deref().map(|data| beside(&figure, data)).transpose()?;
    for table in tables.into_iter().flatten() {
        println!("{}\n{}", table.name, table.aligned());
        let path = out.join(format!("gfmd-{}.csv", table.name));
        std::fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))?;
    }
    Ok(())
}
