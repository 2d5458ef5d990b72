//! `cargo xtask bench`: run time against error, of rc and of other programs.

mod behind;
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
mod readings;
mod record;
mod reference;
mod round;
mod scale;
mod scenes;
mod setting;
mod tables;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use rc_figures::{Table, repository};
use rc_plot::{save_png, save_svg};

pub use child::work;
pub use counts::{accept, check};
pub use documents::{check as check_documents, update as update_documents};
pub use make_reference::run as make_reference;
pub use scenes::Scene;

use levels::{Choice, Results};
use picture::ErrorAgainstTime;
use record::Row;
use reference::{Quantity, References};
use round::{Measurements, Plan};
use scale::tables as scale_tables;

/// Scenes, repeats and peers of a run, and the folder of its results.
#[derive(Clone, Debug)]
pub struct Params {
    /// The scenes that are solved.
    pub scenes: Vec<Scene>,
    /// Number of solves of each case. The result is their median.
    pub repeats: usize,
    /// The other programs, if they take part.
    pub peers: Option<PeerParams>,
    /// Folder for the table and the picture.
    pub out: PathBuf,
    /// Whether this run becomes the archived one.
    pub archive: bool,
    /// Whether scenes that a previous run has saved in `out` are skipped.
    pub resume: bool,
}

/// Settings of the other programs.
#[derive(Clone, Debug)]
pub struct PeerParams {
    /// A Python that has the peers. Without it, an environment is made from PyPI when needed.
    pub python: Option<PathBuf>,
    /// Longest expected solve of a peer (s); longer ones are left out.
    pub seconds: f64,
}

/// The scenes with these names, or all scenes if `names` is empty.
///
/// # Errors
/// When no scene has a name.
pub fn scenes<T: AsRef<str>>(names: &[T]) -> Result<Vec<Scene>> {
    if names.is_empty() {
        return Ok(scenes::SCENES.to_vec());
    }
    names.iter().map(|name| Scene::named(name.as_ref())).collect()
}

/// Saves the heights of each scene on its meshes in `folder`, with cell side 1.
///
/// The name of a file is for instance `paper-2048.npy`.
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

/// Measures, prints and saves, scene by scene.
///
/// # Errors
/// When a solve of ours fails, or a file cannot be written.
pub fn measure(params: &Params) -> Result<()> {
    let references = References::read()?;
    let python = params.peers.as_ref().and_then(interpreter);
    let peer_seconds = params.peers.as_ref().map_or(0.0, |peers| peers.seconds);
    let plan = Plan { repeats: params.repeats.max(1), peer_seconds };
    let mut found = if params.resume { measured_before(&params.out)? } else { Measurements::default() };
    for scene in &params.scenes {
        if found.rows.iter().all(|row| row.scene != scene.name) {
            round::run(plan, scene, python.as_deref(), &mut found)?;
            save(&params.out, &found)?;
        }
    }
    // A resumed run may have its scenes in another order.
    found.rows.sort_by_key(|row| params.scenes.iter().position(|scene| scene.name == row.scene));
    found.rows.retain(|row| params.scenes.iter().any(|scene| scene.name == row.scene));
    let results = Results { rows: &found.rows, references: &references };
    report(&results);
    draw(&params.out, results)?;
    save(&params.out, &found)?;
    if params.archive { archive(&params.out) } else { Ok(()) }
}

/// Measures, prints and saves time and memory on large grids.
///
/// Times are by number of threads and by contact area. `quick` selects small scenes.
///
/// # Errors
/// When a solve fails, after the others are saved, or a file cannot be written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn measure_scale(params: &Params, quick: bool) -> Result<()> {
    let python = params.peers.as_ref().and_then(interpreter);
    let run = scale::run(params.repeats.max(1), quick, python.as_deref());
    let rows = &run.rows;
    println!("{}\n{}\n{}", scale_tables::grids(rows), scale_tables::threads(rows), scale_tables::contact(rows));
    let peers = run.peer.into_iter().map(|version| (peers::ASPHER.name.to_owned(), version)).collect();
    let machine = toml::to_string(&machine::description(&peers, run.seconds)?)?;
    let csv = record::to_csv(rows)?;
    make_folder(&params.out)?;
    record::write(&params.out.join("scale.csv"), &csv)?;
    record::write(&params.out.join("scale.toml"), &machine)?;
    if run.n_failed > 0 {
        bail!("{} solves failed, see above; the others are in {}", run.n_failed, params.out.display());
    }
    if params.archive {
        record::write(&repository::root().join(documents::SCALE), &csv)?;
        record::write(&repository::root().join(documents::SCALE_MACHINE), &machine)?;
        documents::update()?;
    }
    Ok(())
}

/// The interpreter that has the peers; `None` if it cannot be made.
///
/// The run then goes on without peers.
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
        "fastest",
        "slowest",
        "observables",
        "MB",
        "area_counted",
        "area",
        "rms_pressure",
        "penetration",
    ];
    let rows = results.rows.iter().map(|row| {
        let error = |quantity, value| {
            let error = results.references.error(&row.scene, quantity, value);
            error.map_or_else(|| "-".to_owned(), |error| format!("{error:+.1e}"))
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
            format!("{:.4}", row.seconds_min),
            format!("{:.4}", row.seconds_max),
            format!("{:.4}", row.observables_seconds),
            row.memory_mb.map_or_else(|| "-".to_owned(), |memory| format!("{memory:.0}")),
            error(Quantity::Area, row.area_counted),
            row.area.map_or_else(|| "-".to_owned(), |area| error(Quantity::Area, area)),
            error(Quantity::RmsPressure, row.rms_pressure),
            error(Quantity::Penetration, row.mean_gap),
        ]
    });
    println!("{}", Table::new("bench", &header, rows).aligned());
    println!("stated:\n{}\n", tables::times(results, Choice::Stated));
    println!("by hindsight:\n{}\n", tables::times(results, Choice::Hindsight));
    println!("{}\n{}\n{}", tables::statements(results), behind::list(results), tables::spreads(results));
}

fn make_folder(out: &Path) -> Result<()> {
    fs::create_dir_all(out).with_context(|| format!("could not make {}; give another --out", out.display()))
}

/// Names of the files of a run.
const LINES: &str = "bench.csv";
const RUN: &str = "bench.toml";

/// Writes the lines and the machine.
fn save(out: &Path, found: &Measurements) -> Result<()> {
    make_folder(out)?;
    let machine = toml::to_string(&machine::description(&found.peers, found.seconds)?)?;
    record::write(&out.join(LINES), &record::to_csv(&found.rows)?)?;
    record::write(&out.join(RUN), &machine)
}

/// The measurements that an interrupted run has saved; empty when it has saved nothing.
///
/// # Errors
/// When a file does not have the format of this version.
fn measured_before(out: &Path) -> Result<Measurements> {
    let [lines, run] = [LINES, RUN].map(|name| fs::read_to_string(out.join(name)).unwrap_or_default());
    let rows: Vec<Row> = record::from_csv(&lines, LINES)?;
    let run: toml::Table = run.parse().with_context(|| format!("{RUN} is not as `cargo xtask bench` writes it"))?;
    let peers = run.get("peers").and_then(toml::Value::as_table).into_iter().flatten();
    let peers = peers.map(|(name, version)| (name.clone(), version.as_str().unwrap_or("?").to_owned())).collect();
    let seconds = run.get("seconds").and_then(toml::Value::as_integer).unwrap_or(0) as f64;
    Ok(Measurements { rows, peers, seconds })
}

/// Draws the results of the first scene.
fn draw(out: &Path, results: Results<'_>) -> Result<()> {
    let Some(&scene) = results.scenes().first() else { return Ok(()) };
    make_folder(out)?;
    let picture = ErrorAgainstTime { results, scene };
    let (svg, png) = (out.join("bench.svg"), out.join("bench.png"));
    save_svg(&picture, &svg).with_context(|| format!("could not draw {}", svg.display()))?;
    save_png(&picture, &png).with_context(|| format!("could not draw {}", png.display()))
}

/// Makes the run in `out` the archived one.
fn archive(out: &Path) -> Result<()> {
    let pictures = ["bench.svg", "bench.png"].map(|name| (name, format!("docs/images/{name}")));
    let lines = [(LINES, documents::BENCH.to_owned()), (RUN, documents::MACHINE.to_owned())];
    for (name, to) in lines.into_iter().chain(pictures) {
        let to = repository::root().join(to);
        fs::copy(out.join(name), &to).with_context(|| format!("could not write {}", to.display()))?;
    }
    documents::update()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupted_run_is_read_back() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        assert!(measured_before(folder.path()).expect("nothing yet").rows.is_empty());
        let peers = [("tamaas".to_owned(), "2.9.0".to_owned())].into();
        let found = Measurements { rows: levels::tests::rows(), peers, seconds: 12.0 };
        save(folder.path(), &found).expect("a saved run");
        let read = measured_before(folder.path()).expect("its own output");
        assert_eq!((read.rows, read.peers), (found.rows, found.peers));
        assert!((read.seconds - found.seconds).abs() < 1e-12);
        fs::write(folder.path().join(LINES), "scene,program\npaper,rc\n").expect("a written file");
        assert!(measured_before(folder.path()).is_err());
    }
}
