//! A run of the benchmark, scene by scene, repeat by repeat, mesh by mesh.
//!
//! Our solves and those of the peers take turns.

use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use rc_figures::repository;

use super::child;
use super::measure::Outcome;
use super::peers::{PEERS, Peer, Question};
use super::record::{Family, Row};
use super::scenes::Scene;
use super::setting::{LARGEST_UNIFORM, MESHES, Setting, of_peer, typed};

/// Total seconds of a case after which it is not repeated.
const ENOUGH: f64 = 40.0;

/// The coarsest mesh of the peers: every second point of our coarsest mesh.
///
/// From it, the peers' users state the errors of the next mesh.
const COARSEST_OF_PEERS: usize = MESHES[0] / 2;

/// Smallest ratio of times on a mesh and on the next coarser one.
const GROWTH: f64 = 5.0;

/// Limits of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    /// Maximum number of repeats of a case. Cases above [`ENOUGH`] seconds have fewer.
    pub(super) repeats: usize,
    /// Longest expected solve of a peer that is still run (s). The limit of a peer with one thread is half of it.
    pub(super) peer_seconds: f64,
}

/// Measurements of a run.
#[derive(Debug, Default)]
pub(super) struct Measurements {
    pub(super) rows: Vec<Row>,
    /// Name and version of each peer that ran.
    pub(super) peers: BTreeMap<String, String>,
    /// Seconds of the whole run.
    pub(super) seconds: f64,
}

/// The program that solves a case.
#[derive(Clone, Copy, Debug)]
enum Solver {
    Ours(Setting),
    /// Index of the peer, and its tolerance.
    Peer(usize, Option<f64>),
}

/// A future line of the result.
struct Case {
    family: Family,
    elements_per_wave: usize,
    solver: Solver,
    outcomes: Vec<Outcome>,
    /// Whether the case is left out: a peer's case that would take too long, or that failed.
    dropped: bool,
}

impl Case {
    fn new(family: Family, elements_per_wave: usize, solver: Solver) -> Self {
        Self { family, elements_per_wave, solver, outcomes: Vec::new(), dropped: false }
    }

    fn is_done(&self) -> bool {
        self.dropped || self.outcomes.iter().map(|outcome| outcome.seconds).sum::<f64>() > ENOUGH
    }
}

/// Measures one scene, with the peers if `python` has them.
///
/// A peer that fails is reported and left out.
///
/// # Errors
/// When a solve of ours fails.
pub(super) fn run(plan: Plan, scene: &Scene, python: Option<&Path>, found: &mut Measurements) -> Result<()> {
    let start = Instant::now();
    let mut peers: Vec<Option<Peer>> = Vec::new();
    if let Some(python) = python {
        peers.extend(PEERS.iter().map(|kind| tell(Peer::start(python, kind))));
    }
    for (kind, peer) in PEERS.iter().zip(&peers) {
        found.peers.extend(peer.iter().map(|peer| (kind.name.to_owned(), peer.version.clone())));
    }
    let heights = Heights::of(scene)?;
    let mut cases = cases(scene, !peers.is_empty());
    for _ in 0..plan.repeats {
        for i in 0..cases.len() {
            cases[i].dropped |= is_too_long(&cases, i, plan.peer_seconds);
            if !cases[i].is_done() {
                solve(scene, &mut cases[i], &mut peers, &heights)?;
            }
        }
    }
    let rows = cases.iter().filter_map(|case| Row::of(scene, &case.family, case.elements_per_wave, &case.outcomes));
    found.rows.extend(rows);
    found.seconds += start.elapsed().as_secs_f64();
    Ok(())
}

/// Whether a peer's case that has not begun would take too long.
fn is_too_long(cases: &[Case], i: usize, peer_seconds: f64) -> bool {
    let Solver::Peer(peer, _) = cases[i].solver else { return false };
    let patience = if PEERS[peer].is_serial { 0.5 * peer_seconds } else { peer_seconds };
    cases[i].outcomes.is_empty() && expected(cases, i) > patience
}

/// The cases of a scene, ordered by mesh.
///
/// Cases under comparison then run at about the same time.
fn cases(scene: &Scene, with_peers: bool) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut mesh = if with_peers { COARSEST_OF_PEERS } else { MESHES[0] };
    while MESHES.contains(&mesh) || (with_peers && scene.side(mesh) <= LARGEST_UNIFORM) {
        if MESHES.contains(&mesh) {
            let settings = Setting::of_mesh(scene, mesh).into_iter();
            cases.extend(settings.map(|setting| Case::new(Family::ours(&setting), mesh, Solver::Ours(setting))));
        }
        if with_peers && scene.side(mesh) <= LARGEST_UNIFORM {
            for (i, kind) in PEERS.iter().enumerate() {
                cases.extend(kind.tolerances.iter().map(|tolerance| {
                    let text = tolerance.map_or_else(|| "default".to_owned(), typed);
                    let number = tolerance.map(|tolerance| of_peer(tolerance, mesh));
                    Case::new(Family::peer(kind.name, &text), mesh, Solver::Peer(i, number))
                }));
            }
        }
        mesh *= 2;
    }
    cases
}

/// Expected seconds of a case, from the next coarser mesh of its family.
///
/// They are 0 on the two coarsest meshes, since the first solve of a process takes longer than others. They are
/// infinite when the coarser mesh was left out.
fn expected(cases: &[Case], i: usize) -> f64 {
    let is_coarser = |case: &&Case| case.family == cases[i].family && case.elements_per_wave > COARSEST_OF_PEERS;
    let coarser = cases[..i].iter().rfind(is_coarser);
    coarser.map_or(0.0, |case| case.outcomes.first().map_or(f64::INFINITY, |first| GROWTH * first.seconds))
}

fn solve(scene: &Scene, case: &mut Case, peers: &mut [Option<Peer>], heights: &Heights) -> Result<()> {
    match case.solver {
        Solver::Ours(setting) => case.outcomes.push(child::solve(scene, &setting, None)?),
        Solver::Peer(i, tolerance) => {
            let Some(peer) = &mut peers[i] else {
                case.dropped = true;
                return Ok(());
            };
            // A surface is not sampled so coarsely that its shortest waves are lost.
            let stride = MESHES[0].div_ceil(case.elements_per_wave);
            let path = heights.on(scene, stride * case.elements_per_wave)?;
            let question = Question { heights: &path, stride, load: scene.load, tolerance };
            match tell(peer.solve(&question).context(PEERS[i].name)) {
                Some(outcome) => case.outcomes.push(outcome),
                // The state of the peer is unknown, so it is not used again.
                None => peers[i] = None,
            }
        }
    }
    Ok(())
}

/// The value of `result`, or `None` after printing what went wrong with a peer.
///
/// The run goes on without the peer.
#[expect(clippy::print_stderr, reason = "a peer is left out")]
pub(super) fn tell<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| eprintln!("left out: {error:#}")).ok()
}

/// Files of heights for the peers, which exist as long as this value.
pub(super) struct Heights(PathBuf);

impl Heights {
    /// Makes a folder for the heights of `scene`.
    ///
    /// # Errors
    /// When the folder cannot be made.
    pub(super) fn of(scene: &Scene) -> Result<Self> {
        let folder = repository::root().join("target/bench-heights").join(scene.name);
        fs::create_dir_all(&folder).with_context(|| format!("could not make {}", folder.display()))?;
        Ok(Self(folder))
    }

    /// The file of heights of one mesh, which is written at its first use.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub(super) fn on(&self, scene: &Scene, elements_per_wave: usize) -> Result<PathBuf> {
        let path = self.0.join(format!("{elements_per_wave}.npy"));
        if !path.exists() {
            child::save_heights(scene, scene.side(elements_per_wave), &path)?;
        }
        Ok(path)
    }
}

impl Drop for Heights {
    fn drop(&mut self) {
        // Files that are left behind only take space under `target/`.
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::tests::outcome;
    use crate::bench::scenes::SCENES;

    #[test]
    fn peers_go_on_to_finer_grids_than_ours_and_only_if_they_take_part() {
        let small = Scene::named("waves-16").expect("a scene of the table");
        let (with, without) = (cases(&small, true), cases(&small, false));
        assert!(without.iter().all(|case| matches!(case.solver, Solver::Ours(_))));
        let finest = with.iter().map(|case| case.elements_per_wave).max();
        assert_eq!(finest, Some(LARGEST_UNIFORM / small.waves));
        assert_eq!(with.iter().map(|case| case.elements_per_wave).min(), Some(COARSEST_OF_PEERS));
        assert_eq!(without.iter().map(|case| case.elements_per_wave).min(), Some(MESHES[0]));
        assert_eq!(cases(&SCENES[3], true).iter().map(|case| case.elements_per_wave).max(), Some(32));
    }

    #[test]
    fn a_case_that_will_take_too_long_is_foreseen() {
        let mut cases = cases(&SCENES[0], true);
        let family = Family::peer("tamaas", "1e-6");
        let at: Vec<usize> = (0..cases.len()).filter(|&i| cases[i].family == family).collect();
        assert!(expected(&cases, at[0]).abs() < 1e-15 && expected(&cases, at[1]).abs() < 1e-15);
        cases[at[1]].outcomes.push(outcome(2.0, None));
        assert!((expected(&cases, at[2]) - 2.0 * GROWTH).abs() < 1e-12);
        assert!(expected(&cases, at[3]).is_infinite());
        // Tamaas uses one thread, so its limit of 10 s corresponds to 20 s of the others.
        assert!(is_too_long(&cases, at[2], 4.0 * GROWTH - 0.1) && !is_too_long(&cases, at[2], 4.0 * GROWTH + 0.1));
        cases[at[1]].outcomes.push(outcome(ENOUGH, None));
        assert!(cases[at[1]].is_done() && !cases[at[2]].is_done());
    }
}
