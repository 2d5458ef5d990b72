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
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use rc_figures::{Table, repository};
use rc_plot::{save_png, save_svg};

pub use child::work;
pub use counts::{accept, check};
pub use documents::{check as check_documents, update as update_documents};
pub use make_reference::run as make_reference;
pub use scenes::Scene;

use levels::Results;
use picture::ErrorAgainstTime;
use reference::{Quantity, Reading, References};
use round::{Measurements, Plan};

/// What is measured, and where the results go.
#[derive(Clone, Debug)]
pub struct Params {
    /// The scenes.
    pub scenes: Vec<Scene>,
    /// Solves of each case, of which the median counts.
    pub repeats: usize,
    /// Other programs that take part.
    pub peers: Option<PeerParams>,
    /// Folder for the table and the picture.
    pub out: PathBuf,
    /// Whether this run becomes the archived one.
    pub archive: bool,
}

/// How the other programs take part.
#[derive(Clone, Debug)]
pub struct PeerParams {
    /// A Python that has them, instead of an environment that is made from PyPI when needed.
    pub python: Option<PathBuf>,
    /// Solves that are expected to take longer (s) are left out.
    pub seconds: f64,
}

/// The scenes with these names, or all without any.
///
/// # Errors
/// When there is no scene of a name.
pub fn scenes<T: AsRef<str>>(names: &[T]) -> Result<Vec<Scene>> {
    if names.is_empty() {
        return Ok(scenes::SCENES.to_vec());
    }
    names.iter().map(|name| Scene::named(name.as_ref())).collect()
}

/// Saves the heights of each scene on its meshes in `folder`, as paper-2048.npy for instance (cell side 1).
///
/// # Errors
/// When a file cannot be written.
pub fn save_heights(folder: &Path, scenes: &[Scene]) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("could not make {}", folder.display()))?;
    for scene in scenes {
        let meshes = setting::MESHES.into_iter().map(|mesh| scene.side(mesh));
        for side in meshes.filter(|&side| side <= setting::LARGEST_UNIFORM) {
            child::save_heights(scene, side, &folder.join(format!("{}-{side}.npy", scene.name)))?;
        }
    }
    Ok(())
}

/// Measures, prints and saves.
///
/// # Errors
/// When a solve of ours fails, or a file cannot be written.
pub fn measure(params: &Params) -> Result<()> {
    let references = References::read()?;
    let python = params.peers.as_ref().and_then(interpreter);
    let peer_seconds = params.peers.as_ref().map_or(0.0, |peers| peers.seconds);
    let plan = Plan { scenes: params.scenes.clone(), repeats: params.repeats.max(1), peer_seconds };
    let start = Instant::now();
    let found = round::run(&plan, python.as_deref())?;
    let seconds = start.elapsed().as_secs_f64();
    report(&Results { rows: &found.rows, references: &references });
    save(params, &found, &references, seconds)
}

/// The interpreter with the peers; when there is none, the run goes on without them.
#[expect(clippy::print_stderr, reason = "peers are left out")]
fn interpreter(peers: &PeerParams) -> Option<PathBuf> {
    let found = python::interpreter(peers.python.as_deref());
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
fn save(params: &Params, found: &Measurements, references: &References, seconds: f64) -> Result<()> {
    fs::create_dir_all(&params.out)
        .with_context(|| format!("could not make {}; give another --out", params.out.display()))?;
    let (csv, machine) =
        (record::to_csv(&found.rows)?, toml::to_string(&machine::description(&found.peers, seconds)?)?);
    record::write(&params.out.join("bench.csv"), &csv)?;
    record::write(&params.out.join("bench.toml"), &machine)?;
    let results = Results { rows: &found.rows, references };
    let Some(&scene) = results.scenes().first() else { return Ok(()) };
    let picture = ErrorAgainstTime { results, scene };
    let (svg, png) = (params.out.join("bench.svg"), params.out.join("bench.png"));
    save_svg(&picture, &svg).with_context(|| format!("could not draw {}", svg.display()))?;
    save_png(&picture, &png).with_context(|| format!("could not draw {}", png.display()))?;
    if params.archive {
        let root = repository::root();
        record::write(&root.join(documents::BENCH), &csv)?;
        record::write(&root.join(documents::MACHINE), &machine)?;
        for name in ["bench.svg", "bench.png"] {
            let to = root.join("docs/images").join(name);
            fs::copy(params.out.join(name), &to).with_context(|| format!("could not write {}", to.display()))?;
        }
        documents::update()?;
    }
    Ok(())
}
