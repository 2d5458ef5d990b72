//! `cargo xtask fig1` to `fig8`, `figures` and `reproduction`.
//!
//! Other commands that write tables with a picture are here too.

use std::path::PathBuf;

use anyhow::Result;
use rc_figures::all::{self, Archive};
use rc_figures::{Figure, Preset, blocks, repository};

/// Folder and size of a figure.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Folder for the tables (CSV) and pictures (SVG, PNG).
    #[arg(long, value_name = "DIR", default_value_os_t = repository::root().join("figures"), hide_default_value = true)]
    pub(crate) out: PathBuf,
    /// Computes small surfaces, as the tests do, instead of the paper's.
    #[arg(long)]
    quick: bool,
}

impl Args {
    /// The preset that the arguments select.
    pub(crate) fn preset(&self) -> Preset {
        if self.quick { Preset::Quick } else { Preset::Full }
    }
}

/// Computes one figure and writes it.
pub(crate) fn run<F: Figure>(args: &Args) -> Result<()> {
    rc_figures::run::<F>(args.preset(), &args.out)
}

/// Draws every figure of the paper.
#[derive(clap::Args)]
pub(crate) struct AllArgs {
    #[command(flatten)]
    figures: Args,
    /// Compares every table with the archived run in `data/runs/paper/`. A difference is an error.
    #[arg(long, conflicts_with = "quick")]
    check: bool,
    /// Archives this run: tables, pictures and the numbers of the document.
    ///
    /// They are in `data/runs/paper/`, `docs/images/` and `docs/reproduction.md`.
    #[arg(long, conflicts_with_all = ["quick", "check"])]
    archive: bool,
}

pub(crate) fn run_all(args: &AllArgs) -> Result<()> {
    let archive = match (args.check, args.archive) {
        (true, _) => Archive::Compared,
        (_, true) => Archive::Replaced,
        _ => Archive::Ignored,
    };
    all::run(args.figures.preset(), &args.figures.out, archive)
}

/// Rewrites the numbers of docs/reproduction.md from the archived runs of figures
///
/// Every `--archive` of a figure does this too.
#[derive(clap::Args)]
pub(crate) struct ReproductionArgs {}

pub(crate) fn run_reproduction(_args: &ReproductionArgs) -> Result<()> {
    blocks::update()
}
