//! `cargo xtask bench --scale`: time and memory on large grids.
//!
//! Times are by number of threads and by area in contact.

use rc_solver::Tolerance;
use serde::{Deserialize, Serialize};

use super::machine::all_threads;
use super::peers::ASPHER;
use super::record::{OURS, Spread, rounded};
use super::rounds::Case;
use super::scenes::{SCALE_SCENES, SCENES, Scene};
use super::setting::{CERTIFIED, KernelName, Setting, typed};

/// One line of `data/bench/scale.csv`: a solve of one scene by one program with a given number of threads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ScaleRow {
    pub(super) part: Part,
    pub(super) waves: usize,
    /// σ0/E*.
    pub(super) load: f64,
    /// Elements along a side of the cell.
    pub(super) side: usize,
    pub(super) program: String,
    pub(super) method: String,
    pub(super) threads: usize,
    pub(super) tolerance: String,
    pub(super) status: String,
    pub(super) iterations: Option<u64>,
    pub(super) applications: Option<u64>,
    /// Fraction of the cells whose gap was computed.
    pub(super) cells_evaluated: Option<f64>,
    /// Area by counting, which is the same for every program.
    pub(super) area_counted: f64,
    pub(super) repeats: usize,
    /// Median seconds; then the fastest and the slowest. Our times include the evaluation of the observables.
    pub(super) seconds: f64,
    pub(super) seconds_min: f64,
    pub(super) seconds_max: f64,
    pub(super) memory_mb: Option<f64>,
}

/// The purpose of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Part {
    /// Several sizes of grids, with several numbers of threads.
    Grids,
    /// Several loads on one grid.
    Contact,
}

impl ScaleRow {
    /// The line of a case; `None` without a solve.
    pub(super) fn of(part: Part, case: &Case) -> Option<Self> {
        let Case { scene, peer, setting, threads, outcomes, .. } = case;
        let first = outcomes.first()?;
        let spread = Spread::of(outcomes.iter().map(|one| one.seconds + one.observables_seconds));
        Some(Self {
            part,
            waves: scene.waves,
            load: scene.load,
            side: scene.side(setting.elements_per_wave),
            program: peer.map_or(OURS, |kind| kind.name).to_owned(),
            method: setting.method().name().to_owned(),
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
const FINE: f64 = 32.0;
const COARSE: f64 = 16.0;

/// Largest grid of a peer, and of solves with fewer threads than the machine has.
const LARGEST_COMPARED: usize = 4096;

/// The cases on grids of several sizes; `quick` selects the two smallest scenes.
///
/// Coarse grids are first. Only then is the peak memory of a peer's process that of its last solve.
pub(super) fn grids(quick: bool) -> Vec<Case> {
    let names: &[&str] =
        if quick { &["waves-16", "waves-32"] } else { &["paper", "waves-128", "waves-512", "waves-1024"] };
    let mut cases = Vec::new();
    let scenes = SCENES.into_iter().chain(SCALE_SCENES).filter(|scene| names.contains(&scene.name));
    for scene in scenes {
        if scene.side(FINE) > LARGEST_COMPARED {
            cases.push(Case::ours(scene, Setting::adaptive(0, FINE, Tolerance::DEFAULT), all_threads()));
            continue;
        }
        let setting = Setting::adaptive(0, FINE, CERTIFIED);
        cases.extend(thread_counts(all_threads()).into_iter().map(|threads| Case::ours(scene, setting, threads)));
        cases.push(Case::of_peer(scene, ASPHER, FINE, CERTIFIED));
    }
    cases.sort_by_key(|case| case.scene.waves);
    cases
}

/// The cases of one surface under several loads, lightest first, by both methods.
pub(super) fn loads(quick: bool) -> Vec<Case> {
    let pressed = SCALE_SCENES.into_iter().filter(|scene| scene.waves == SCENES[0].waves).chain([SCENES[0]]);
    let mut loads: Vec<Scene> = if quick { vec![SCENES[8]] } else { pressed.collect() };
    loads.sort_by(|a, b| a.load.total_cmp(&b.load));
    let settings = [
        Setting::adaptive(0, COARSE, Tolerance::DEFAULT),
        Setting::uniform(KernelName::Love, COARSE, Tolerance::DEFAULT),
    ];
    loads.into_iter().flat_map(|scene| settings.map(|setting| Case::ours(scene, setting, all_threads()))).collect()
}

/// Numbers of threads: 1, 2, 4, ... and all.
fn thread_counts(all: usize) -> Vec<usize> {
    let powers = std::iter::successors(Some(1), |threads| Some(2 * threads));
    powers.take_while(|&threads| threads < all).chain([all]).collect()
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
        let sides = |by_peer| {
            let of = grids(false).into_iter().filter(|case| case.peer.is_some() == by_peer);
            let mut sides: Vec<usize> = of.map(|case| case.scene.side(case.setting.elements_per_wave)).collect();
            sides.dedup();
            sides
        };
        assert_eq!((sides(false), sides(true)), (vec![2048, 4096, 16384, 32768], vec![2048, 4096]));
        let loads: Vec<f64> = loads(false).into_iter().map(|case| case.scene.load).collect();
        assert!(loads.len() == 14 && loads.is_sorted(), "{loads:?}");
        assert_eq!([1, 2, 3, 8].map(|all| thread_counts(all).len()), [1, 2, 3, 4]);
    }

    #[test]
    fn a_case_has_its_line_when_it_was_solved() {
        let mut case = grids(true).remove(0);
        assert!(ScaleRow::of(Part::Grids, &case).is_none());
        let outcome = |seconds| crate::bench::record::tests::outcome(seconds, Some(0.07));
        case.outcomes = [3.0, 1.0, 2.0].map(outcome).to_vec();
        let row = ScaleRow::of(Part::Grids, &case).expect("a solved case");
        // The evaluation of the observables takes a quarter of a second each time.
        let times = [row.seconds, row.seconds_min, row.seconds_max];
        assert!(times.iter().zip([2.25, 1.25, 3.25]).all(|(a, b)| (a - b).abs() < 1e-12), "{row:?}");
        assert!(row.repeats == 3 && row.side == 32 * row.waves, "{row:?}");
    }
}
