//! `cargo xtask bench`: run time against the stated error, of rc and of other programs.

mod child;
mod counts;
mod documents;
mod extrapolation;
mod machine;
mod make_reference;
mod markdown;
mod measure;
mod peers;
mod picture;
mod readings;
mod record;
mod reference;
mod rounds;
mod scale;
mod scenes;
mod setting;
mod steps;
mod tables;
mod times;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use rc_figures::repository;
use rc_plot::save_png;

pub use child::work;
pub use counts::{accept, check};
pub use documents::check as check_documents;
pub use make_reference::run as make_reference;
pub use scenes::Scene;

use peers::{ASPHER, PEERS, PeerKind};
use picture::TimeAgainstError;
use record::Row;
use reference::References;
use rounds::{Limits, Peers};
use scale::{Part, ScaleRow};
use times::Results;

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
}

/// Settings of the other programs.
#[derive(Clone, Debug)]
pub struct PeerParams {
    /// A Python that has the peers.
    pub python: PathBuf,
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

/// Measures, prints and saves, scene by scene.
///
/// # Errors
/// When a peer of a run to archive does not start, a solve of ours fails, after the others are saved, or a file cannot
/// be written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn measure(params: &Params) -> Result<()> {
    let (references, start) = (References::read()?, Instant::now());
    let python = params.peers.as_ref().map(|peers| peers.python.as_path());
    let peer_seconds = params.peers.as_ref().map_or(0.0, |peers| peers.seconds);
    let limits = Limits { repeats: params.repeats.max(1), peer_seconds };
    let versions = versions(&Peers::start(python, &PEERS), &PEERS, params.archive)?;
    let (mut rows, mut n_failed) = (Vec::<Row>::new(), 0);
    for &scene in &params.scenes {
        // A new process of each peer for each scene, as each of our solves has a new one.
        let mut peers = Peers::start(python, &PEERS);
        let mut cases = rounds::cases(scene, python.is_some());
        n_failed += rounds::run(&mut cases, limits, &mut peers);
        rows.extend(cases.iter().filter_map(Row::of));
        let machine = machine::description(&versions, start.elapsed().as_secs_f64())?;
        save(&params.out, ["bench.csv", "bench.toml"], [record::to_csv(&rows)?, toml::to_string(&machine)?])?;
    }
    let results = Results { rows: &rows, references: &references };
    println!("{}\n{}\n{}", tables::times(&results), tables::equal_meshes(&results), tables::spreads(&results));
    draw(&params.out.join("bench.png"), results)?;
    ensure!(n_failed == 0, "{n_failed} solves failed, see above; the others are in {}", params.out.display());
    if params.archive { archive(&params.out) } else { Ok(()) }
}

/// Measures, prints and saves time and memory on large grids.
///
/// Times are by number of threads and by contact area. `quick` selects small scenes.
///
/// # Errors
/// When the peer of a run to archive does not start, a solve fails, after the others are saved, or a file cannot be
/// written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn measure_scale(params: &Params, quick: bool) -> Result<()> {
    let start = Instant::now();
    let python = params.peers.as_ref().map(|peers| peers.python.as_path());
    let mut peers = Peers::start(python, &[ASPHER]);
    // A peer that fails later is still one of the programs of the run.
    let versions = versions(&peers, &[ASPHER], params.archive)?;
    let limits = Limits { repeats: params.repeats.max(1), peer_seconds: f64::INFINITY };
    let (mut rows, mut n_failed) = (Vec::<ScaleRow>::new(), 0);
    for (part, mut cases) in [(Part::Grids, scale::grids(quick)), (Part::Contact, scale::loads(quick))] {
        n_failed += rounds::run(&mut cases, limits, &mut peers);
        rows.extend(cases.iter().filter_map(|case| ScaleRow::of(part, case)));
    }
    println!("{}\n{}", tables::grids(&rows), tables::contact(&rows));
    let machine = machine::description(&versions, start.elapsed().as_secs_f64())?;
    save(&params.out, ["scale.csv", "scale.toml"], [record::to_csv(&rows)?, toml::to_string(&machine)?])?;
    ensure!(n_failed == 0, "{n_failed} solves failed, see above; the others are in {}", params.out.display());
    if params.archive {
        copy(&params.out, [("scale.csv", documents::SCALE), ("scale.toml", documents::SCALE_MACHINE)])?;
        documents::update()?;
    }
    Ok(())
}

/// Measures, prints and, if `archive`, archives where the time of solves goes.
///
/// # Errors
/// When a solve fails, or a file cannot be written.
pub fn measure_steps(archive: bool) -> Result<()> {
    steps::measure(archive)?;
    if archive { documents::update() } else { Ok(()) }
}

/// Name and version of each peer that started.
///
/// # Errors
/// When one of `kinds` did not start, and the run is to be archived.
fn versions(peers: &Peers, kinds: &[PeerKind], archive: bool) -> Result<BTreeMap<String, String>> {
    let versions = peers.versions();
    let missing: Vec<&str> = kinds.iter().map(|kind| kind.name).filter(|&name| !versions.contains_key(name)).collect();
    ensure!(!archive || missing.is_empty(), "--archive needs --peers and a Python that has {}", missing.join(", "));
    Ok(versions)
}

/// Writes text files into the folder `out`.
fn save(out: &Path, names: [&str; 2], texts: [String; 2]) -> Result<()> {
    fs::create_dir_all(out).with_context(|| format!("could not make {}; give another --out", out.display()))?;
    names.iter().zip(texts).try_for_each(|(name, text)| record::write(&out.join(name), &text))
}

/// Makes the run in `out` the archived one.
fn archive(out: &Path) -> Result<()> {
    copy(out, [("bench.csv", documents::BENCH), ("bench.toml", documents::MACHINE)])?;
    update_documents()
}

fn copy(out: &Path, files: [(&str, &str); 2]) -> Result<()> {
    for (name, to) in files {
        let to = repository::root().join(to);
        fs::copy(out.join(name), &to).with_context(|| format!("could not write {}", to.display()))?;
    }
    Ok(())
}

/// Rewrites the tables in the documents and the picture from the archived runs.
///
/// # Errors
/// When a file is missing or not as expected, or cannot be written.
pub fn update_documents() -> Result<()> {
    let text = fs::read_to_string(repository::root().join(documents::BENCH)).context(documents::BENCH)?;
    let (rows, references) = (record::from_csv(&text, documents::BENCH)?, References::read()?);
    draw(&repository::root().join("docs/images/bench.png"), Results { rows: &rows, references: &references })?;
    documents::update()
}

fn draw(path: &Path, results: Results<'_>) -> Result<()> {
    save_png(&TimeAgainstError(results), path).with_context(|| format!("could not draw {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_without_all_peers_is_not_archived() {
        let none = Peers::start(None, &PEERS);
        let error = versions(&none, &PEERS, true).expect_err("no peer started").to_string();
        assert!(error.contains("aspher, tamaas, contactmechanics"), "{error}");
        assert!(versions(&none, &PEERS, false).is_ok_and(|versions| versions.is_empty()));
    }
}
