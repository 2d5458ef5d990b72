//! `cargo xtask bench`: run time against error, ours and that of other programs.

mod child;
mod counts;
mod documents;
mod extrapolation;
mod levels;
mod machine;
mod make_reference;
mod measure;
mod peers;
mod picture;
mod python;
mod record;
mod reference;
mod round;
mod scenes;
mod setting;

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use rc_plot::{save_png, save_svg};

use crate::figures::Table;
use crate::repository;
pub(crate) use documents::check as check_documents;
use levels::Results;
use picture::ErrorAgainstTime;
use reference::{Quantity, Reading, References};
use round::{Found, Plan};
use scenes::{SCENES, Scene};

/// Scenes, repeats and patience of `--quick`.
const QUICK: (&[&str], usize, f64) = (&["waves-16", "hurst-0.3-light"], 2, 0.3);

/// Measures run time against error on ten fixed scenes, by every method, and with --peers that of other programs.
///
/// Errors are against `data/bench/reference.csv`. Run it on an idle machine. docs/benchmarks.md explains the results.
#[derive(clap::Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags")]
pub(crate) struct Args {
    /// Two small scenes only.
    #[arg(long)]
    quick: bool,
    /// Only these scenes, separated by commas.
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    scenes: Vec<String>,
    /// Also ASPHER, Tamaas and ContactMechanics, in a Python environment under `target/` that is made from PyPI when needed.
    #[arg(long)]
    peers: bool,
    /// A Python that has the peers, instead of that environment.
    #[arg(long, value_name = "PATH", requires = "peers")]
    python: Option<PathBuf>,
    /// Solves of each case, of which the median counts.
    #[arg(long, default_value_t = 3)]
    repeats: usize,
    /// A peer's solves that are expected to take longer are left out.
    #[arg(long, value_name = "SECONDS", default_value_t = 12.0, requires = "peers")]
    peer_seconds: f64,
    /// Folder for the table and the picture.
    #[arg(long, value_name = "DIR", default_value_os_t = repository::root().join("figures"), hide_default_value = true)]
    out: PathBuf,
    /// Makes this run the archived one: `data/bench/`, `docs/images/`, and the tables in the documents.
    #[arg(long, conflicts_with_all = ["quick", "scenes"])]
    archive: bool,
    /// Instead of measuring: rewrites the tables in the documents from the archived run.
    #[arg(long, group = "instead")]
    tables: bool,
    /// Instead of measuring: compares counts of operations with the stored ones; a change is an error.
    #[arg(long, group = "instead")]
    check: bool,
    /// Instead of measuring: stores the counts of operations.
    #[arg(long, group = "instead")]
    accept: bool,
    /// Instead of measuring: computes the reference values again.
    #[arg(long, group = "instead")]
    make_reference: bool,
    /// Instead of measuring: saves the heights of each scene here, as paper-2048.npy for instance (cell side 1), for other programs.
    #[arg(long, value_name = "DIR", group = "instead")]
    peer_heights: Option<PathBuf>,
    /// Work for a process that the benchmark starts itself.
    #[arg(long, hide = true, group = "instead")]
    job: Option<String>,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    match args {
        Args { job: Some(job), .. } => child::work(job),
        Args { check: true, .. } => counts::check(),
        Args { accept: true, .. } => counts::accept(),
        Args { tables: true, .. } => documents::update(),
        Args { make_reference: true, .. } => make_reference::run(&chosen(args)?),
        Args { peer_heights: Some(folder), .. } => save_heights(folder, &chosen(args)?),
        _ => measure(args),
    }
}

/// The scenes that are asked for.
fn chosen(args: &Args) -> Result<Vec<Scene>> {
    match (args.scenes.is_empty(), args.quick) {
        (false, _) => args.scenes.iter().map(|name| Scene::named(name)).collect(),
        (true, true) => QUICK.0.iter().map(|name| Scene::named(name)).collect(),
        (true, false) => Ok(SCENES.to_vec()),
    }
}

fn save_heights(folder: &PathBuf, scenes: &[Scene]) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("could not make {}", folder.display()))?;
    for scene in scenes {
        let meshes = setting::MESHES.into_iter().map(|mesh| scene.side(mesh));
        for side in meshes.filter(|&side| side <= setting::LARGEST_UNIFORM) {
            child::save_heights(scene, side, &folder.join(format!("{}-{side}.npy", scene.name)))?;
        }
    }
    Ok(())
}

fn measure(args: &Args) -> Result<()> {
    let references = References::read()?;
    let python = if args.peers { interpreter(args) } else { None };
    let (repeats, peer_seconds) =
        if args.quick { (QUICK.1, QUICK.2) } else { (args.repeats.max(1), args.peer_seconds) };
    let plan = Plan { scenes: chosen(args)?, repeats, peer_seconds };
    let start = Instant::now();
    let found = round::run(&plan, python.as_deref())?;
    let seconds = start.elapsed().as_secs_f64();
    report(&Results { rows: &found.rows, references: &references });
    save(args, &found, &references, seconds)
}

/// The interpreter with the peers; when there is none, the run goes on without them.
#[expect(clippy::print_stderr, reason = "peers are left out")]
fn interpreter(args: &Args) -> Option<PathBuf> {
    let found = python::interpreter(args.python.as_deref());
    found.inspect_err(|error| eprintln!("peers are skipped: {error:#}")).ok()
}

/// Prints every line with its errors, and the table of times.
#[expect(clippy::print_stdout, reason = "the result of the command")]
fn report(results: &Results<'_>) {
    let header = [
        "scene",
        "program",
        "method",
        "kernel",
        "border",
        "mesh",
        "tolerance",
        "iterations",
        "seconds",
        "observables",
        "MB",
        "area_counted",
        "area",
        "rms_pressure",
        "penetration",
    ];
    let rows = results.rows.iter().map(|row| {
        let error = |quantity, reading| {
            results.error(row, quantity, reading).map_or_else(|| "-".to_owned(), |error| format!("{error:+.1e}"))
        };
        vec![
            row.scene.clone(),
            row.program.clone(),
            row.method.clone(),
            row.kernel.clone(),
            row.border_level.to_string(),
            row.elements_per_wave.to_string(),
            row.tolerance.clone(),
            row.iterations.map_or_else(|| "-".to_owned(), |n| n.to_string()),
            format!("{:.4}", row.seconds),
            format!("{:.4}", row.observables_seconds),
            row.memory_mb.map_or_else(|| "-".to_owned(), |memory| format!("{memory:.0}")),
            error(Quantity::Area, Reading::Counted),
            error(Quantity::Area, Reading::Best),
            error(Quantity::RmsPressure, Reading::Best),
            error(Quantity::Penetration, Reading::Best),
        ]
    });
    println!("{}", Table::new("bench", &header, rows).aligned());
    println!("{}", documents::times(results));
}

/// Writes the lines, the machine and the picture.
fn save(args: &Args, found: &Found, references: &References, seconds: f64) -> Result<()> {
    fs::create_dir_all(&args.out)
        .with_context(|| format!("could not make {}; give another --out", args.out.display()))?;
    let (csv, machine) =
        (record::to_csv(&found.rows)?, toml::to_string(&machine::description(&found.peers, seconds)?)?);
    record::write(&args.out.join("bench.csv"), &csv)?;
    record::write(&args.out.join("bench.toml"), &machine)?;
    let results = Results { rows: &found.rows, references };
    let Some(&scene) = results.scenes().first() else { return Ok(()) };
    let picture = ErrorAgainstTime { results, scene };
    let (svg, png) = (args.out.join("bench.svg"), args.out.join("bench.png"));
    save_svg(&picture, &svg).with_context(|| format!("could not draw {}", svg.display()))?;
    save_png(&picture, &png).with_context(|| format!("could not draw {}", png.display()))?;
    if args.archive {
        let root = repository::root();
        record::write(&root.join(documents::BENCH), &csv)?;
        record::write(&root.join(documents::MACHINE), &machine)?;
        for name in ["bench.svg", "bench.png"] {
            let to = root.join("docs/images").join(name);
            fs::copy(args.out.join(name), &to).with_context(|| format!("could not write {}", to.display()))?;
        }
        documents::update()?;
    }
    Ok(())
}
