//! A run of the benchmark: scene by scene, repeat by repeat, mesh by mesh, ours and the peers in turns.

use anyhow::{Context, Result};
use std::fs;
use std::path::{Path, PathBuf};

use rc_figures::repository;

use super::child;
use super::measure::Outcome;
use super::peers::{PEERS, Peer};
use super::record::{Family, Row};
use super::scenes::Scene;
use super::setting::{LARGEST_UNIFORM, MESHES, Setting, of_peer, typed};

/// Seconds after which a case is not repeated again.
const ENOUGH: f64 = 10.0;

/// How much longer the next mesh takes, at least.
const GROWTH: f64 = 5.0;

/// How much is run.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    pub(super) scenes: Vec<Scene>,
    /// Most repeats of a case; those above [`ENOUGH`] seconds have fewer.
    pub(super) repeats: usize,
    /// Longest solve of a peer that is expected to be worth its time.
    pub(super) peer_seconds: f64,
}

/// What a run measured.
#[derive(Debug, Default)]
pub(super) struct Measurements {
    pub(super) rows: Vec<Row>,
    /// Name and version of each peer that ran.
    pub(super) peers: Vec<(String, String)>,
}

/// Who solves a case.
#[derive(Clone, Copy, Debug)]
enum Solver {
    Ours(Setting),
    /// Index of the peer, and its tolerance.
    Peer(usize, Option<f64>),
}

/// One line of the result on its way.
struct Case {
    family: Family,
    elements_per_wave: usize,
    solver: Solver,
    outcomes: Vec<Outcome>,
    /// A peer's case that would take too long, or failed.
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

/// Runs the plan; peers only with an interpreter that has them.
///
/// # Errors
/// When a solve of ours fails; a peer that fails is reported and left out.
pub(super) fn run(plan: &Plan, python: Option<&Path>) -> Result<Measurements> {
    let mut found = Measurements::default();
    for scene in &plan.scenes {
        let mut peers: Vec<Option<Peer>> = Vec::new();
        if let Some(python) = python {
            peers.extend(PEERS.iter().map(|kind| tell(Peer::start(python, kind))));
        }
        for (kind, peer) in PEERS.iter().zip(&peers) {
            let known = found.peers.iter().any(|(name, _)| name == kind.name);
            found.peers.extend(peer.iter().filter(|_| !known).map(|peer| (kind.name.to_owned(), peer.version.clone())));
        }
        let heights = Heights::of(scene)?;
        let mut cases = cases(scene, !peers.is_empty());
        for _ in 0..plan.repeats {
            for i in 0..cases.len() {
                if let Solver::Peer(..) = cases[i].solver
                    && cases[i].outcomes.is_empty()
                    && expected(&cases, i) > plan.peer_seconds
                {
                    cases[i].dropped = true;
                }
                if !cases[i].is_done() {
                    solve(scene, &mut cases[i], &mut peers, &heights)?;
                }
            }
        }
        let rows = cases.iter().filter_map(|case| Row::of(scene, &case.family, case.elements_per_wave, &case.outcomes));
        found.rows.extend(rows);
    }
    Ok(found)
}

/// The cases of a scene by mesh, so that what is compared runs at about the same time.
fn cases(scene: &Scene, with_peers: bool) -> Vec<Case> {
    let mut cases = Vec::new();
    let mut mesh = MESHES[0];
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

/// Seconds that a case will take, from the next coarser mesh of its family: 0 on the coarsest, infinite where that was
/// left out.
fn expected(cases: &[Case], i: usize) -> f64 {
    let coarser = cases[..i].iter().rfind(|case| case.family == cases[i].family);
    coarser.map_or(0.0, |case| case.outcomes.first().map_or(f64::INFINITY, |first| GROWTH * first.seconds))
}

fn solve(scene: &Scene, case: &mut Case, peers: &mut [Option<Peer>], heights: &Heights) -> Result<()> {
    match case.solver {
        Solver::Ours(setting) => case.outcomes.push(child::solve(scene, &setting)?),
        Solver::Peer(i, tolerance) => {
            let Some(peer) = &mut peers[i] else {
                case.dropped = true;
                return Ok(());
            };
            let path = heights.on(scene, case.elements_per_wave)?;
            match tell(peer.solve(&path, scene.load, tolerance).context(PEERS[i].name)) {
                Some(outcome) => case.outcomes.push(outcome),
                // What it was doing is unknown, so it is not asked again.
                None => peers[i] = None,
            }
        }
    }
    Ok(())
}

/// Says what went wrong with a peer; the run goes on without it.
#[expect(clippy::print_stderr, reason = "a peer is left out")]
fn tell<T>(result: Result<T>) -> Option<T> {
    result.inspect_err(|error| eprintln!("left out: {error:#}")).ok()
}

/// Files of heights for the peers, as long as this lives.
struct Heights(PathBuf);

impl Heights {
    fn of(scene: &Scene) -> Result<Self> {
        let folder = repository::root().join("target/bench-heights").join(scene.name);
        fs::create_dir_all(&folder).with_context(|| format!("could not make {}", folder.display()))?;
        Ok(Self(folder))
    }

    fn on(&self, scene: &Scene, elements_per_wave: usize) -> Result<PathBuf> {
        let path = self.0.join(format!("{elements_per_wave}.npy"));
        if !path.exists() {
            child::save_heights(scene, scene.side(elements_per_wave), &path)?;
        }
        Ok(path)
    }
}

impl Drop for Heights {
    fn drop(&mut self) {
        // Left behind, they only take room under `target/`.
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
        assert_eq!(cases(&SCENES[3], true).iter().map(|case| case.elements_per_wave).max(), Some(32));
    }

    #[test]
    fn a_case_that_will_take_too_long_is_foreseen() {
        let mut cases = cases(&SCENES[0], true);
        let family = Family::peer("tamaas", "1e-6");
        let at: Vec<usize> = (0..cases.len()).filter(|&i| cases[i].family == family).collect();
        assert!(expected(&cases, at[0]).abs() < 1e-15);
        cases[at[0]].outcomes.push(outcome(2.0, None));
        assert!((expected(&cases, at[1]) - 2.0 * GROWTH).abs() < 1e-12);
        assert!(expected(&cases, at[2]).is_infinite());
        cases[at[0]].outcomes.push(outcome(9.0, None));
        assert!(cases[at[0]].is_done() && !cases[at[1]].is_done());
    }
}
