//! `cargo xtask bench`: run time against the stated error, of rc and of other programs.

use std::path::PathBuf;

use anyhow::Result;
use rc_bench::bench::{self, Params, PeerParams, Scene};
use rc_figures::repository;

/// Scenes, repeats and longest solve of a peer (s) with `--quick`.
const QUICK: (&[&str], usize, f64) = (&["waves-16", "hurst-0.3-light"], 2, 0.3);

/// Measures run time against the stated error on ten fixed scenes, by every method.
///
/// With --peers it also measures other programs. `data/bench/reference.csv` says which stated errors are true. Run it
/// on an idle machine. docs/benchmarks.md explains the results.
#[derive(clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags")]
pub(crate) struct Args {
    /// Only two small scenes.
    #[arg(long)]
    quick: bool,
    /// Only these scenes, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    scenes: Vec<String>,
    /// Also measures ASPHER, Tamaas and ContactMechanics.
    ///
    /// The guide says how to install them.
    #[arg(long)]
    peers: bool,
    /// A Python that has the peers, instead of that in `target/bench-peers/`.
    #[arg(long, value_name = "PATH", requires = "peers", default_value_os_t = peers(), hide_default_value = true)]
    python: PathBuf,
    /// Number of solves of each case. The result is their median.
    #[arg(long, default_value_t = 5, conflicts_with = "quick")]
    repeats: usize,
    /// Longest expected solve of a peer; longer ones are left out.
    ///
    /// Peers that use one thread have half of it.
    #[arg(long, value_name = "SECONDS", default_value_t = 12.0, requires = "peers", conflicts_with = "quick")]
    peer_seconds: f64,
    /// Folder for the table and the picture.
    #[arg(long, value_name = "DIR", default_value_os_t = repository::root().join("figures"), hide_default_value = true)]
    out: PathBuf,
    /// Archives this run in `data/bench/`, `docs/images/` and the tables of the documents. Needs all peers.
    #[arg(long, conflicts_with_all = ["quick", "scenes", "tables", "check", "accept", "make_reference"])]
    archive: bool,
    /// Instead of errors: time, memory and iterations on grids up to 32768² (6 GB).
    ///
    /// Times are by number of threads and by contact area. With --peers ASPHER is measured too.
    #[arg(long, conflicts_with = "scenes", group = "instead")]
    scale: bool,
    /// Instead of errors: the part of each step in the time of a solve.
    #[arg(long, group = "instead")]
    steps: bool,
    /// Instead of measuring: rewrites the tables in the documents, and the picture, from the archived run.
    #[arg(long, group = "instead")]
    tables: bool,
    /// Instead of measuring: compares counts of operations with the stored counts. Fewer pass, more fail.
    #[arg(long, group = "instead")]
    check: bool,
    /// Instead of measuring: stores the counts of operations.
    #[arg(long, group = "instead")]
    accept: bool,
    /// Instead of measuring: computes the reference values again.
    #[arg(long, group = "instead")]
    make_reference: bool,
    /// Work for a process that the benchmark starts itself.
    #[arg(long, hide = true, group = "instead")]
    job: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    match args {
        Args { job: Some(job), .. } => bench::work(job),
        Args { scale: true, .. } => bench::measure_scale(&params(args)?, args.quick),
        Args { steps: true, archive, .. } => bench::measure_steps(*archive),
        Args { check: true, .. } => bench::check(),
        Args { accept: true, .. } => bench::accept(),
        Args { tables: true, .. } => bench::update_documents(),
        Args { make_reference: true, .. } => bench::make_reference(&chosen(args)?),
        _ => bench::measure(&params(args)?),
    }
}

/// The Python of the environment that the guide makes.
fn peers() -> PathBuf {
    repository::root().join("target/bench-peers/bin/python")
}

/// The scenes that `args` selects.
fn chosen(args: &Args) -> Result<Vec<Scene>> {
    if args.scenes.is_empty() && args.quick { bench::scenes(QUICK.0) } else { bench::scenes(&args.scenes) }
}

fn params(args: &Args) -> Result<Params> {
    let (repeats, seconds) = if args.quick { (QUICK.1, QUICK.2) } else { (args.repeats, args.peer_seconds) };
    Ok(Params {
        scenes: chosen(args)?,
        repeats,
        peers: args.peers.then(|| PeerParams { python: args.python.clone(), seconds }),
        out: args.out.clone(),
        archive: args.archive,
    })
}
