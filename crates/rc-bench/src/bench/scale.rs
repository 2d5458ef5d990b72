//! `cargo xtask bench --scale`: time and memory on large grids.
//!
//! Times are by number of threads and by area in contact.

pub(super) mod row;
pub(super) mod tables;

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use rc_solver::{Method, Tolerance};

use self::row::{Part, ScaleRow};
use super::child;
use super::measure::Outcome;
use super::peers::{ASPHER, Peer, Question};
use super::record::{OURS, Spread, rounded};
use super::round::{Heights, tell};
use super::scenes::{SCALE_SCENES, SCENES, Scene};
use super::setting::{CERTIFIED, KernelName, Setting, of_peer, typed};

/// Total seconds of a case after which it is not repeated.
const ENOUGH: f64 = 60.0;

/// One problem with one program and one number of threads.
struct Case {
    part: Part,
    scene: Scene,
    setting: Setting,
    threads: usize,
    by_peer: bool,
    outcomes: Vec<Outcome>,
}

impl Case {
    fn is_done(&self) -> bool {
        self.outcomes.iter().map(|outcome| outcome.seconds).sum::<f64>() > ENOUGH
    }

    fn row(&self) -> Option<ScaleRow> {
        let Self { part, scene, setting, threads, by_peer, outcomes } = self;
        let first = outcomes.first()?;
        let spread = Spread::of(outcomes.iter().map(|one| one.seconds + one.observables_seconds));
        let method = if *by_peer { Method::Uniform } else { setting.method };
        Some(ScaleRow {
            part: *part,
            waves: scene.waves,
            load: scene.load,
            side: scene.side(setting.elements_per_wave),
            program: if *by_peer { ASPHER.name } else { OURS }.to_owned(),
            method: method.name().to_owned(),
            threads: *threads,
            tolerance: typed(setting.tolerance),
            status: first.status.clone(),
            iterations: first.iterations,
            applications: first.applications,
            cells_evaluated: first.cells_evaluated.map(|part| rounded(part, 3)),
            area_counted: rounded(first.area_counted, 6),
            repeats: outcomes.len(),
            seconds: rounded(spread.median, 4),
            seconds_min: rounded(spread.min, 4),
            seconds_max: rounded(spread.max, 4),
            memory_mb: first.memory_mb.map(|memory| rounded(memory, 3)),
        })
    }
}

/// Elements for the shortest wave: `FINE` on grids of several sizes, `COARSE` for several loads.
const FINE: usize = 32;
const COARSE: usize = 16;

/// Largest grid of a peer, and of solves with fewer threads than the machine has.
const LARGEST_COMPARED: usize = 4096;

/// The cases, by scene; `quick` selects the two smallest scenes.
fn cases(quick: bool, with_peer: bool) -> Vec<Case> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let named = |names: &[&str]| -> Vec<Scene> {
        let scenes = SCENES.into_iter().chain(SCALE_SCENES);
        let mut found: Vec<Scene> = scenes.filter(|scene| names.contains(&scene.name)).collect();
        // Coarse grids are first. Only then is the peak memory of a peer's process that of its last solve.
        found.sort_by_key(|scene| scene.waves);
        found
    };
    let grids: &[&str] =
        if quick { &["waves-16", "waves-32"] } else { &["paper", "waves-128", "waves-512", "waves-1024"] };
    let mut cases = Vec::new();
    let mut add = |part, scene, setting, threads, by_peer| {
        cases.push(Case { part, scene, setting, threads, by_peer, outcomes: Vec::new() });
    };
    for scene in named(grids) {
        let is_compared = scene.side(FINE) <= LARGEST_COMPARED;
        let setting = Setting::adaptive(0, FINE, if is_compared { CERTIFIED } else { Tolerance::DEFAULT });
        for threads in thread_counts(all).into_iter().filter(|&threads| is_compared || threads == all) {
            add(Part::Grids, scene, setting, threads, false);
        }
        if is_compared && with_peer {
            add(Part::Grids, scene, setting, all, true);
        }
    }
    let pressed = SCALE_SCENES.into_iter().filter(|scene| scene.waves == SCENES[0].waves).chain([SCENES[0]]);
    let mut loads: Vec<Scene> = if quick { named(&["waves-16"]) } else { pressed.collect() };
    loads.sort_by(|a, b| a.load.total_cmp(&b.load));
    for scene in loads {
        add(Part::Contact, scene, Setting::adaptive(0, COARSE, Tolerance::DEFAULT), all, false);
        add(Part::Contact, scene, Setting::uniform(KernelName::Love, COARSE, Tolerance::DEFAULT), all, false);
    }
    cases
}

/// Numbers of threads: 1, 2, 4, ... and all.
fn thread_counts(all: usize) -> Vec<usize> {
    let powers = std::iter::successors(Some(1), |threads| Some(2 * threads));
    powers.take_while(|&threads| threads < all).chain([all]).collect()
}

/// Measurements of a run on large grids.
#[derive(Debug, Default)]
pub(super) struct ScaleRun {
    pub(super) rows: Vec<ScaleRow>,
    /// Version of the peer, if it ran.
    pub(super) peer: Option<String>,
    /// Number of solves that failed and were reported.
    pub(super) n_failed: usize,
    /// Seconds of the whole run.
    pub(super) seconds: f64,
}

/// Solves every case up to `repeats` times, the peer's only if `python` has it.
///
/// `quick` selects small scenes.
pub(super) fn run(repeats: usize, quick: bool, python: Option<&Path>) -> ScaleRun {
    let start = Instant::now();
    let mut peer = python.and_then(|python| tell(Peer::start(python, &ASPHER)));
    let mut cases = cases(quick, peer.is_some());
    let mut n_failed = 0;
    for round in 0..repeats {
        // A case that failed is not solved again.
        for case in cases.iter_mut().filter(|case| !case.is_done() && case.outcomes.len() == round) {
            let outcome = tell(solve(case, peer.as_mut()));
            n_failed += usize::from(outcome.is_none());
            case.outcomes.extend(outcome);
        }
    }
    ScaleRun {
        rows: cases.iter().filter_map(Case::row).collect(),
        peer: peer.map(|peer| peer.version.clone()),
        n_failed,
        seconds: start.elapsed().as_secs_f64(),
    }
}

fn solve(case: &Case, peer: Option<&mut Peer>) -> Result<Outcome> {
    let Case { scene, setting, threads, by_peer, .. } = case;
    if !by_peer {
        return child::solve(scene, setting, Some(*threads));
    }
    let heights = Heights::of(scene)?;
    let path = heights.on(scene, setting.elements_per_wave)?;
    let peer = peer.context("a case of a peer that did not start")?;
    let tolerance = Some(of_peer(setting.tolerance, setting.elements_per_wave));
    peer.solve(&Question { heights: &path, stride: 1, load: scene.load, tolerance })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Lines of two grids and of two loads.
    ///
    /// One of the grids has a peer and two numbers of threads.
    pub(in crate::bench) fn rows() -> Vec<ScaleRow> {
        let row = |part, waves: usize, program: &str, threads, seconds| ScaleRow {
            part,
            waves,
            load: 8.9e-4,
            side: 32 * waves,
            program: program.to_owned(),
            method: if program == OURS { "adaptive" } else { "uniform" }.to_owned(),
            threads,
            tolerance: "1e-6".to_owned(),
            status: "converged".to_owned(),
            iterations: Some(14),
            applications: Some(24),
            cells_evaluated: (program == OURS).then_some(0.18),
            area_counted: 0.07,
            repeats: 5,
            seconds,
            seconds_min: 0.9 * seconds,
            seconds_max: 1.2 * seconds,
            memory_mb: Some(53.0),
        };
        let contact = row(Part::Contact, 64, OURS, 2, 0.5);
        let uniform = ScaleRow { method: "uniform".to_owned(), seconds: 0.25, ..contact.clone() };
        vec![
            row(Part::Grids, 128, OURS, 1, 3.0),
            row(Part::Grids, 128, OURS, 2, 2.0),
            row(Part::Grids, 128, ASPHER.name, 2, 60.0),
            row(Part::Grids, 512, OURS, 2, 30.0),
            contact,
            uniform,
        ]
    }

    #[test]
    fn cases_are_those_that_are_promised() {
        let cases = cases(false, true);
        let sides = |by_peer| {
            let of = cases.iter().filter(|case| case.part == Part::Grids && case.by_peer == by_peer);
            let mut sides: Vec<usize> = of.map(|case| case.scene.side(case.setting.elements_per_wave)).collect();
            sides.dedup();
            sides
        };
        assert_eq!((sides(false), sides(true)), (vec![2048, 4096, 16384, 32768], vec![2048, 4096]));
        let loads: Vec<f64> =
            cases.iter().filter(|case| case.part == Part::Contact).map(|case| case.scene.load).collect();
        assert!(loads.len() == 14 && loads.is_sorted(), "{loads:?}");
        assert_eq!([1, 2, 3, 8].map(|all| thread_counts(all).len()), [1, 2, 3, 4]);
    }

    #[test]
    fn a_case_has_its_line_when_it_was_solved() {
        let mut case = super::cases(true, false).remove(0);
        assert!(case.row().is_none());
        let outcome = |seconds| crate::bench::record::tests::outcome(seconds, Some(0.07));
        case.outcomes = [3.0, 1.0, 2.0].map(outcome).to_vec();
        let row = case.row().expect("a solved case");
        // The evaluation of the observables takes a quarter of a second each time.
        let times = [row.seconds, row.seconds_min, row.seconds_max];
        assert!(times.iter().zip([2.25, 1.25, 3.25]).all(|(a, b)| (a - b).abs() < 1e-12), "{row:?}");
        assert!(row.repeats == 3 && row.side == 32 * row.waves && !case.is_done(), "{row:?}");
    }
}
