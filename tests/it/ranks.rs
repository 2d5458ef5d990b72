//! One solve over several ranks, which must give the digits of one rank.

use std::convert::Infallible;
use std::panic;
use std::sync::{Arc, Mutex};

use rc_comm::{LostRank, Ranks, run_threads};
use rc_core::{Event, Field, Grid, HeightField, Observer, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_solver::{
    Checkpoint, ContactElement, ContactProblem, Control, Feature, Method, Solution, SolveError, SolveParams,
};

/// The results of a solution that one rank has.
///
/// They are its elements, its rows of pressure and gap, and everything else as text with all digits.
#[derive(Clone, Debug, PartialEq)]
struct Told {
    elements: Vec<[u64; 4]>,
    rows: [Vec<u64>; 2],
    text: String,
}

impl Told {
    fn of(solution: &Solution<'_>) -> Self {
        let bits = |ContactElement { centre, side, pressure }| [centre.x, centre.y, side, pressure].map(f64::to_bits);
        let elements = solution.elements().expect("a mesh").map(bits).collect();
        let counts = [solution.n_elements(), solution.n_evaluated(), solution.n_proven()];
        let observables = (solution.observables(), solution.stiffness(), solution.status());
        let text = format!("{:?} {counts:?} {observables:?}", solution.info());
        let mut rows = [Vec::new(), Vec::new()];
        let [pressure, gap] = &mut rows;
        let put = |all: &mut Vec<u64>, rows: &[f64]| {
            all.extend(rows.iter().map(|value| value.to_bits()));
            Ok::<_, Infallible>(())
        };
        let Ok(()) = solution.own_pressure_rows(|_, rows| put(pressure, rows));
        let Ok(()) = solution.own_gap_rows(|_, rows| put(gap, rows));
        Self { elements, rows, text }
    }

    /// Fails unless the parts of the ranks add up to this result.
    #[track_caller]
    fn assert_is_of(&self, parts: &[Self]) {
        let n = parts.len();
        assert!(parts.iter().all(|part| part.elements.len() < self.elements.len()), "each of {n} ranks has a part");
        for (rank, part) in parts.iter().enumerate() {
            assert_eq!(part.text, self.text, "rank {rank} of {n}");
        }
        assert!(parts.iter().flat_map(|part| &part.elements).eq(&self.elements), "elements of {n} ranks");
        for field in 0..2 {
            assert!(parts.iter().flat_map(|part| &part.rows[field]).eq(&self.rows[field]), "rows of {n} ranks");
        }
    }
}

/// The paper's surface on a grid, under a load or penetration.
struct Scene {
    surface: Surface,
    grid: Grid,
    control: Control,
    params: SolveParams,
}

impl Scene {
    fn new(waves: usize, side: usize, control: Control) -> Self {
        let surface = Surface::new(&SpectrumParams::paper(waves, 1)).expect("a surface");
        let params = SolveParams::to_tolerance(1e-6).by(Method::Adaptive);
        Self { surface, grid: Grid::square(side).expect("a grid"), control, params }
    }

    fn problem(&self, ranks: Ranks) -> ContactProblem<'_> {
        ContactProblem::new(self.surface.on(self.grid), self.control).over(ranks)
    }

    fn told(&self, ranks: Ranks) -> Told {
        Told::of(&self.problem(ranks).solve(&self.params, &Silent).expect("a solution"))
    }

    /// Fails unless the solution is the same, bit by bit, on 1, 2 and 4 ranks.
    fn assert_same_digits(&self) {
        let alone = self.told(Ranks::alone());
        assert!(alone.elements.len() > 1000, "{} elements", alone.elements.len());
        for size in [2, 4] {
            alone.assert_is_of(&run_threads(size, |ranks| self.told(ranks)).expect("all ranks end"));
        }
    }
}

#[test]
fn digits_do_not_depend_on_the_number_of_ranks_at_64_waves() {
    Scene::new(64, 1024, Control::MeanPressure(8.9e-4)).assert_same_digits();
    Scene::new(64, 1024, Control::Penetration(1.4e-3)).assert_same_digits();
}

#[test]
fn digits_do_not_depend_on_the_number_of_ranks_at_128_waves() {
    Scene::new(128, 2048, Control::MeanPressure(8.9e-4)).assert_same_digits();
    Scene::new(128, 2048, Control::Penetration(1.4e-3)).assert_same_digits();
}

/// Bytes in memory.
#[derive(Default)]
struct Kept(Mutex<Vec<u8>>);

impl Checkpoint for Kept {
    fn read(&self, offset: u64, len: usize) -> Option<Vec<u8>> {
        let bytes = self.0.lock().expect("no rank has ended while it wrote");
        bytes.get(offset as usize..offset as usize + len).map(<[u8]>::to_vec)
    }

    fn replace(&self, pieces: &mut dyn Iterator<Item = Vec<u8>>) {
        let all = pieces.flatten().collect();
        *self.0.lock().expect("no rank has ended while it wrote") = all;
    }
}

/// An observer that counts levels and ends its rank when the level after `last` begins.
struct EndAfter {
    last: usize,
    levels: Mutex<usize>,
}

impl Observer for EndAfter {
    fn notify(&self, event: &Event) {
        if let Event::Level { .. } = event {
            let mut levels = self.levels.lock().expect("this rank has not ended");
            *levels += 1;
            if *levels > self.last {
                panic::resume_unwind(Box::new("no more power"));
            }
        }
    }
}

#[test]
fn a_run_whose_rank_has_ended_goes_on_from_the_last_level_on_other_ranks() {
    let scene = Scene::new(64, 1024, Control::MeanPressure(8.9e-4));
    let kept: Arc<Kept> = Arc::default();
    let counter = EndAfter { last: usize::MAX, levels: Mutex::new(0) };
    let alone = Told::of(&scene.problem(Ranks::alone()).solve(&scene.params, &counter).expect("a solution"));
    let n_levels = *counter.levels.lock().expect("all levels");
    let ended = run_threads(3, |ranks| {
        // Rank 1 ends when the finest level begins.
        let last = if ranks.rank() == 1 { n_levels - 1 } else { usize::MAX };
        let observer = EndAfter { last, levels: Mutex::new(0) };
        let checkpoint: Arc<dyn Checkpoint> = kept.clone();
        scene.problem(ranks).kept_in(checkpoint).solve(&scene.params, &observer).map(|solution| solution.n_elements())
    });
    assert!(matches!(ended, Err(LostRank { rank: 1, size: 3 })), "{ended:?}");
    for size in [1, 2] {
        let parts = run_threads(size, |ranks| {
            let observer = EndAfter { last: usize::MAX, levels: Mutex::new(0) };
            let checkpoint: Arc<dyn Checkpoint> = kept.clone();
            let problem = scene.problem(ranks).kept_in(checkpoint);
            let told = Told::of(&problem.solve(&scene.params, &observer).expect("a solution"));
            assert_eq!(*observer.levels.lock().expect("all levels"), 1, "only the finest level was left");
            told
        });
        let parts = parts.expect("all ranks end");
        if size == 1 {
            assert_eq!(parts, std::slice::from_ref(&alone));
        } else {
            alone.assert_is_of(&parts);
        }
    }
}

#[test]
fn what_only_one_rank_solves_is_refused_over_several() {
    let scene = Scene::new(16, 256, Control::MeanPressure(8.9e-4));
    let refused = |params: SolveParams, grid: usize, expected: fn(&SolveError) -> bool| {
        let grid = Grid::square(grid).expect("a grid");
        let results = run_threads(2, |ranks| {
            let problem = ContactProblem::new(scene.surface.on(grid), scene.control).over(ranks);
            problem.solve(&params, &Silent).map(|solution| solution.n_elements())
        });
        for result in results.expect("all ranks end") {
            assert!(result.as_ref().is_err_and(expected), "{result:?}");
        }
    };
    let over_ranks =
        |error: &SolveError| matches!(error, SolveError::Unsupported(refusal) if refusal.object == Feature::Ranks);
    refused(scene.params.by(Method::Uniform), 256, over_ranks);
    refused(SolveParams { border_level: 1, ..scene.params }, 256, over_ranks);
    refused(scene.params, 251, over_ranks);
}

#[test]
fn digits_of_a_map_in_a_long_cell_do_not_depend_on_the_number_of_ranks() {
    let rough = Surface::new(&SpectrumParams::paper(32, 2)).expect("a surface");
    let rough = rough.sample(Grid::square(1024).expect("a grid"));
    let [nx, ny] = [1024, 256];
    let grid = Grid::in_cell(nx, ny, 0.25).expect("a grid");
    let map = Field::new(grid, rough.values()[..nx * ny].to_vec()).expect("a value for each element");
    let params = SolveParams::to_tolerance(1e-6).by(Method::Adaptive);
    let solve = |ranks: Ranks| {
        let problem = ContactProblem::new(&map, Control::MeanPressure(8.9e-4)).over(ranks);
        Told::of(&problem.solve(&params, &Silent).expect("a solution"))
    };
    solve(Ranks::alone()).assert_is_of(&run_threads(3, solve).expect("all ranks end"));
}
