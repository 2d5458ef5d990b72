//! `cargo xtask challenge`: the surface of the Contact-Mechanics Challenge, without adhesion.

use std::path::PathBuf;

use anyhow::{Context, Result};
use rc_figures::challenge::{Large, Params, Source, archive_large};
use rc_figures::{Challenge, run_one};

use crate::figures;

/// Computes area, gap, stiffness and patches of the Contact-Mechanics Challenge's surface, without adhesion;
/// docs/challenge.md
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// The distributed Fourier coefficients, as text, instead of a generated surface; scaled to an rms slope of 1.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
    /// High and low of the distributed surface change places: what touches first must be high.
    #[arg(long, requires = "spectrum")]
    flip: bool,
    /// One load on this many elements per side instead of the curve: 65536, the published reference's, takes minutes
    /// and 12 GB.
    #[arg(long, value_name = "SIDE", num_args = 0..=1, default_missing_value = "65536", conflicts_with = "quick")]
    large: Option<usize>,
    /// Makes this run the archived one: tables to `data/runs/challenge/`, the picture to `docs/images/`, numbers into
    /// `docs/challenge.md`.
    #[arg(long, conflicts_with_all = ["quick", "spectrum"])]
    archive: bool,
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let (preset, out) = (args.figure.preset(), &args.figure.out);
    let source = args.spectrum.clone().map(|path| Source::File { path, is_flipped: args.flip });
    let params = Params::with_source(preset, source)?;
    let Some(side) = args.large else {
        run_one::<Challenge>(preset, &params, out, args.archive)?;
        return Ok(());
    };
    let large = Large::compute(&params, side)?;
    let table = large.table();
    println!("{}", table.aligned());
    std::fs::create_dir_all(out).with_context(|| format!("could not make {}", out.display()))?;
    let path = out.join("challenge-large.csv");
    std::fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))?;
    if args.archive { archive_large(&large) } else { Ok(()) }
}
