//! Rounds of solves, in which our solves and those of the peers take turns.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use rc_figures::repository;
use rc_solver::Tolerance;

use super::child;
use super::machine::all_threads;
use super::measure::Outcome;
use super::peers::{PEERS, Peer, PeerKind, Question};
use super::scenes::Scene;
use super::setting::{KernelName, LARGEST_UNIFORM, MESHES, Setting, of_peer};

/// Total seconds of a case after which it is not solved again.
const ENOUGH: f64 = 60.0;

/// Meshes of the peers. Their users state the errors of a mesh from the mesh of elements twice as large.
const MESHES_OF_PEERS: [f64; 13] = [2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 24.0, 32.0, 64.0, 128.0];

/// The coarsest mesh that a surface is sampled on. Coarser meshes have every second of its points.
const COARSEST_SAMPLED: f64 = 3.0;

/// Finest mesh that is solved without an expectation of the time: the first solve of a process takes longer than others.
const UNEXPECTED: f64 = 4.0;

/// Smallest ratio of times on a mesh and on that of elements twice as large.
const GROWTH: f64 = 5.0;

/// Limits of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Maximum number of solves of a case. Cases above [`ENOUGH`] seconds have fewer.
    pub(super) repeats: usize,
    /// Longest expected solve of a peer that is still run (s). The limit of a peer with one thread is half of it.
    pub(super) peer_seconds: f64,
}

/// One problem for one program.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) scene: Scene,
    /// The peer that solves it; `None` for our own solves.
    pub(super) peer: Option<PeerKind>,
    /// The setting. Peers have the uniform grid, and take mesh and tolerance only.
    pub(super) setting: Setting,
    pub(super) threads: usize,
    pub(super) outcomes: Vec<Outcome>,
    /// Whether the case is left out: it failed, or would take too long.
    dropped: bool,
}

impl Case {
    /// A solve of ours.
    pub(super) fn ours(scene: Scene, setting: Setting, threads: usize) -> Self {
        Self { scene, peer: None, setting, threads, outcomes: Vec::new(), dropped: false }
    }

    /// A solve of a peer, with all threads.
    pub(super) fn of_peer(scene: Scene, kind: PeerKind, elements_per_wave: f64, tolerance: Tolerance) -> Self {
        let setting = Setting::uniform(KernelName::Spectral, elements_per_wave, tolerance);
        Self { peer: Some(kind), ..Self::ours(scene, setting, all_threads()) }
    }

    fn is_done(&self) -> bool {
        self.dropped || self.outcomes.iter().map(|outcome| outcome.seconds).sum::<f64>() > ENOUGH
    }

    /// Whether the case is another mesh of the same program with the same setting.
    fn is_like(&self, other: &Self) -> bool {
        let name = |case: &Self| case.peer.map(|kind| case.scene.name.to_owned() + kind.name);
        name(self) == name(other) && self.setting.tolerance == other.setting.tolerance
    }
}

/// The cases of a scene on all meshes, ordered by mesh.
///
/// Cases under comparison then run at about the same time.
pub(super) fn cases(scene: Scene, with_peers: bool) -> Vec<Case> {
    let mut cases = Vec::new();
    for mesh in MESHES {
        let settings = Setting::of_mesh(&scene, mesh).into_iter();
        cases.extend(settings.map(|setting| Case::ours(scene, setting, all_threads())));
    }
    for mesh in MESHES_OF_PEERS.into_iter().filter(|&mesh| with_peers && scene.side(mesh) <= LARGEST_UNIFORM) {
        for kind in PEERS {
            cases.extend(kind.tolerances.iter().map(|&tolerance| Case::of_peer(scene, kind, mesh, tolerance)));
        }
    }
    cases.sort_by(|a, b| a.setting.elements_per_wave.total_cmp(&b.setting.elements_per_wave));
    cases
}

/// Solves all cases in rounds.
///
/// A case that fails is reported, and the others go on. Returns the number of our cases that failed.
pub(super) fn run(cases: &mut [Case], limits: Limits, peers: &mut Peers) -> usize {
    let mut n_failed = 0;
    for _ in 0..limits.repeats {
        for i in 0..cases.len() {
            cases[i].dropped |= !peers.can_solve(&cases[i]) || is_too_long(cases, i, limits.peer_seconds);
            if cases[i].is_done() {
                continue;
            }
            let outcome = tell(peers.solve(&cases[i]));
            cases[i].dropped = outcome.is_none();
            n_failed += usize::from(outcome.is_none() && cases[i].peer.is_none());
            cases[i].outcomes.extend(outcome);
        }
    }
    n_failed
}

/// Whether a peer's case that has not begun would take too long.
fn is_too_long(cases: &[Case], i: usize, peer_seconds: f64) -> bool {
    let Some(kind) = cases[i].peer else { return false };
    let patience = if kind.is_serial { 0.5 * peer_seconds } else { peer_seconds };
    cases[i].outcomes.is_empty() && expected(cases, i) > patience
}

/// Expected seconds of a peer's case, from the next coarser mesh.
///
/// They are 0 on the coarsest meshes, and infinite when the coarser mesh was left out.
fn expected(cases: &[Case], i: usize) -> f64 {
    let mesh = |case: &Case| case.setting.elements_per_wave;
    if mesh(&cases[i]) <= UNEXPECTED {
        return 0.0;
    }
    let Some(coarser) = cases[..i].iter().rfind(|case| case.is_like(&cases[i])) else { return 0.0 };
    let growth = GROWTH.powf((mesh(&cases[i]) / mesh(coarser)).log2());
    coarser.outcomes.first().map_or(f64::INFINITY, |first| growth * first.seconds)
}

/// The peers that run, and files of heights for them.
pub(super) struct Peers {
    running: BTreeMap<&'static str, Peer>,
    folder: PathBuf,
}

impl Peers {
    /// Starts peers that `python` has; none without it.
    pub(super) fn start(python: Option<&Path>, kinds: &[PeerKind]) -> Self {
        let start = |kind: &PeerKind| Some((kind.name, tell(Peer::start(python?, kind))?));
        let folder = repository::root().join("target/bench-heights");
        Self { running: kinds.iter().filter_map(start).collect(), folder }
    }

    /// Name and version of each peer.
    pub(super) fn versions(&self) -> BTreeMap<String, String> {
        self.running.iter().map(|(name, peer)| ((*name).to_owned(), peer.version.clone())).collect()
    }

    fn can_solve(&self, case: &Case) -> bool {
        case.peer.is_none_or(|kind| self.running.contains_key(kind.name))
    }

    fn solve(&mut self, case: &Case) -> Result<Outcome> {
        let Case { scene, peer, setting, .. } = case;
        let Some(kind) = peer else { return child::solve(scene, *setting, case.threads) };
        // A surface is not sampled so coarsely that its shortest waves are lost.
        let stride = (COARSEST_SAMPLED / setting.elements_per_wave).ceil() as usize;
        let heights = self.heights(scene, scene.side(stride as f64 * setting.elements_per_wave))?;
        let peer = self.running.get_mut(kind.name).context("the peer is not running")?;
        let tolerance = kind.takes_tolerance.then(|| of_peer(setting.tolerance, setting.elements_per_wave));
        let answer = peer.solve(&Question { heights: &heights, stride, load: scene.load, tolerance });
        if answer.is_err() {
            // The state of the peer is unknown, so it is not used again.
            self.running.remove(kind.name);
        }
        answer.with_context(|| kind.name)
    }

    /// The file of heights of one mesh, which is written at its first use.
    fn heights(&self, scene: &Scene, side: usize) -> Result<PathBuf> {
        fs::create_dir_all(&self.folder).with_context(|| format!("could not make {}", self.folder.display()))?;
        let path = self.folder.join(format!("{}-{side}.npy", scene.name));
        if !path.exists() {
            child::save_heights(scene, side, &path)?;
        }
        Ok(path)
    }
}

impl Drop for Peers {
    fn drop(&mut self) {
        // Files that are left behind only take space under `target/`.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// The value of `result`, or `None` after printing what went wrong.
#[expect(clippy::print_stderr, reason = "a case is left out")]
pub(super) fn tell<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| eprintln!("left out: {error:#}")).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::peers::TAMAAS;
    use crate::bench::record::tests::outcome;
    use crate::bench::scenes::SCENES;

    #[test]
    fn peers_go_on_to_finer_grids_than_ours_and_only_if_they_take_part() {
        let small = Scene::named("waves-16").expect("a scene of the table");
        let meshes = |scene, with_peers| {
            let meshes = cases(scene, with_peers).into_iter().map(|case| case.setting.elements_per_wave);
            [meshes.clone().fold(f64::INFINITY, f64::min), meshes.fold(0.0, f64::max)].map(|mesh| mesh.to_string())
        };
        assert!(cases(small, false).iter().all(|case| case.peer.is_none()));
        assert_eq!(meshes(small, true), ["2", "128"]);
        assert_eq!(meshes(small, false), ["2.25", "32"]);
        assert_eq!(meshes(SCENES[3], true), ["2", "32"]);
    }

    #[test]
    fn a_case_that_will_take_too_long_is_foreseen() {
        let mut cases = cases(SCENES[0], true);
        let is_tamaas = |case: &Case| case.peer.is_some_and(|kind| kind.name == TAMAAS.name);
        let at: Vec<usize> = (0..cases.len()).filter(|&i| is_tamaas(&cases[i])).collect();
        // Two, three, four, five and six elements for the shortest wave.
        assert!(at[..3].iter().all(|&i| expected(&cases, i).abs() < 1e-15));
        cases[at[2]].outcomes.push(outcome(2.0, None));
        let expectation = 2.0 * GROWTH.powf(1.25_f64.log2());
        assert!((expected(&cases, at[3]) - expectation).abs() < 1e-12);
        assert!(expected(&cases, at[4]).is_infinite());
        // Tamaas uses one thread, so its limit is half of that of the others.
        let limit = 2.0 * expectation;
        assert!(is_too_long(&cases, at[3], limit - 0.1) && !is_too_long(&cases, at[3], limit + 0.1));
        cases[at[2]].outcomes.push(outcome(ENOUGH, None));
        assert!(cases[at[2]].is_done() && !cases[at[3]].is_done());
    }
}
