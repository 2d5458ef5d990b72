//! `cargo xtask challenge`: the surface of the Contact-Mechanics Challenge, without adhesion.

use std::path::PathBuf;

use anyhow::{Context, Result};
use rc_figures::challenge::{Large, Params, Source};
use rc_figures::{Challenge, repository, run_one};

use crate::figures;

/// Computes area, gap, stiffness and patches of the Contact-Mechanics Challenge's surface.
///
/// The problem is without adhesion; docs/benchmarks.md explains the results.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// File of the distributed Fourier coefficients, as text, instead of a generated surface.
    ///
    /// The surface is scaled to an rms slope of 1.
    #[arg(long, value_name = "FILE")]
    spectrum: Option<PathBuf>,
    /// Changes the sign of the distributed heights. The points that touch first must be high.
    #[arg(long, requires = "spectrum")]
    flip: bool,
    /// Solves one load on this many elements per side instead of the curve.
    ///
    /// 65536, as in the published reference, takes minutes and 6 GB.
    #[arg(long, value_name = "SIDE", num_args = 0..=1, default_missing_value = "65536", conflicts_with = "quick")]
    large: Option<usize>,
    /// Archives this run: tables in `data/runs/challenge/`, and the picture in `docs/images/`.
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
    let table = Large::compute(&params, side)?.table();
    println!("{}", table.aligned());
    let out = if args.archive { &repository::root().join("data/runs/challenge") } else { out };
    std::fs::create_dir_all(out).with_context(|| format!("could not make {}", out.display()))?;
    let path = out.join("challenge-large.csv");
    std::fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))
}
