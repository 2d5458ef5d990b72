//! Loading and unloading of a plastic contact.

use rc_core::{Field, Silent};
use rc_solver::{ContactProblem, Control, Feature, History, Method, ProblemError, SolveError, SolveParams};

use crate::hardness::rough;

/// The loads, the last of which are unloading, at a hardness that a third of the contact reaches.
const LOAD: f64 = 5e-4;
const HARDNESS: f64 = 1.5e-2;

fn by(heights: &Field, hardness: f64, loads: &[f64], method: Method) -> Result<History<'static>, SolveError> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(1.0)).with_hardness(hardness);
    let found = problem.solve_history(loads, &SolveParams::default().by(method), &Silent)?;
    Ok(History { solution: found.solution.into_owned(), residual: found.residual })
}

fn solve(heights: &Field, loads: &[f64]) -> History<'static> {
    by(heights, HARDNESS, loads, Method::Uniform).expect("solvable")
}

fn rms(a: &Field, b: &Field) -> f64 {
    let squares = a.values().iter().zip(b.values()).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    (squares / a.values().len() as f64).sqrt()
}

#[test]
fn one_load_is_the_contact_of_today_and_leaves_its_overlap() {
    let heights = rough(2, 256, 16);
    for method in [Method::Uniform, Method::Adaptive] {
        let problem = ContactProblem::new(&heights, Control::MeanPressure(LOAD)).with_hardness(HARDNESS);
        let alone = problem.solve(&SolveParams::default().by(method), &Silent).expect("solvable");
        let found = by(&heights, HARDNESS, &[LOAD, 0.0], method).expect("solvable");
        assert_eq!(alone.info(), found.solution.info(), "{method}");
        assert!(alone.pressure() == found.solution.pressure(), "{method}");
        let plastic = alone.plastic_gap().values();
        assert!(plastic.iter().any(|w| *w > 0.0), "{method}: nothing is plastic");
        let left = heights.values().iter().zip(plastic).map(|(h, w)| h - w);
        assert!(found.residual.values().iter().copied().eq(left), "{method}");
    }
}

#[test]
fn a_second_time_the_same_load_is_borne_without_flow() {
    let heights = rough(2, 256, 16);
    for method in [Method::Uniform, Method::Adaptive] {
        let once = by(&heights, HARDNESS, &[LOAD], method).expect("solvable");
        let twice = by(&heights, HARDNESS, &[LOAD, 0.0, LOAD], method).expect("solvable");
        let (a, b) = (once.solution.observables(), twice.solution.observables());
        let flow = a.plastic.expect("hard").mean_gap;
        assert!(flow > 0.0 && b.plastic.expect("hard").mean_gap < 1e-3 * flow, "{method}: {flow}");
        // Both solutions are known to the energy error of 1 %, whose square is 1e-4.
        let pairs = [
            ("area by counting", a.area.cells, b.area.cells, 3e-3),
            ("rms pressure", a.rms_pressure, b.rms_pressure, 3e-4),
            ("open gap", a.mean_gap, b.mean_gap, 1e-3),
        ];
        for (name, first, again, tolerance) in pairs {
            assert!((again / first - 1.0).abs() < tolerance, "{method}: {name} {again} after {first}");
        }
        let change = rms(&once.residual, &twice.residual) / rms(&heights, &once.residual);
        assert!(change < 1e-2, "{method}: the second time changes the surface by {change} of the first");
    }
}

#[test]
fn unloading_is_elastic_and_stiffer_than_loading() {
    let heights = rough(2, 256, 16);
    let half = solve(&heights, &[0.5 * LOAD]);
    let down = solve(&heights, &[LOAD, 0.5 * LOAD]);
    let (loading, unloading) = (half.solution.observables(), down.solution.observables());
    let [up, flow] = [loading, unloading].map(|found| found.plastic.expect("hard").mean_gap);
    assert!(flow < 1e-3 * up, "unloading flows by {flow}, loading by {up}");
    assert!(unloading.area.cells > loading.area.cells, "{} after {}", unloading.area.cells, loading.area.cells);
    let [up, down] = [half.solution.stiffness(), down.solution.stiffness()];
    assert!(down > up, "stiffness {down} after {up}");
}

/// Where nothing is elastic, a load presses h down to the level whose area is σ0/H.
#[test]
fn without_elastic_contact_the_highest_summits_are_cut_off() {
    let heights = rough(3, 256, 8);
    let (hardness, area) = (2e-5, 0.1);
    let found = by(&heights, hardness, &[area * hardness, 0.0], Method::Uniform).expect("solvable");
    let mut sorted = heights.values().to_vec();
    sorted.sort_by(f64::total_cmp);
    let level = sorted[sorted.len() - (area * sorted.len() as f64) as usize];
    let cut = Field::new(heights.grid(), heights.values().iter().map(|h| h.min(level)).collect()).expect("heights");
    let removed = rms(&heights, &cut);
    let error = rms(&found.residual, &cut);
    // Elastic displacements are of the order of H times the size of contacts, 1e-2 of what is cut off.
    assert!(removed > 1e-5 && error < 0.02 * removed, "off by {error:e} where {removed:e} is cut off");
}

#[test]
fn neither_a_smaller_load_between_nor_half_the_load_before_changes_anything() {
    let heights = rough(2, 256, 16);
    let direct = solve(&heights, &[LOAD]);
    let between = solve(&heights, &[LOAD, 0.5 * LOAD, LOAD]);
    let steps = solve(&heights, &[0.5 * LOAD, LOAD]);
    let area = |found: &History<'_>| found.solution.area().cells;
    assert!((area(&between) / area(&direct) - 1.0).abs() < 3e-3, "{} for {}", area(&between), area(&direct));
    let removed = rms(&heights, &direct.residual);
    let [again, path] = [&between, &steps].map(|found| rms(&found.residual, &direct.residual) / removed);
    assert!(again < 1e-2, "{again}");
    // With w of half the load, the pressure of the whole load is still that of its heights: overlaps grow with the load,
    // and the second step adds what is left.
    assert!(path < 1e-2, "{path}");
    assert!((area(&steps) / area(&direct) - 1.0).abs() < 3e-3, "{} for {}", area(&steps), area(&direct));
    let flow = |found: &History<'_>| found.solution.observables().plastic.expect("hard").mean_gap;
    let parts = [flow(&solve(&heights, &[0.5 * LOAD])), flow(&steps)];
    let sum = parts[0] + parts[1];
    assert!(parts[0] > 0.0 && (sum / flow(&direct) - 1.0).abs() < 1e-2, "{parts:?} for {}", flow(&direct));
}

#[test]
fn wrong_loads_are_refused() {
    let heights = rough(1, 64, 4);
    for loads in [&[][..], &[0.0], &[1e-4, -1e-4], &[1e-4, f64::NAN], &[f64::INFINITY, 0.0]] {
        let refused = by(&heights, HARDNESS, loads, Method::Uniform).expect_err("no loads");
        assert!(matches!(refused, SolveError::Problem(ProblemError::MeanPressure { .. })), "{loads:?}: {refused}");
    }
    let refused = by(&heights, HARDNESS, &[1e-4, HARDNESS, 0.0], Method::Uniform).expect_err("too soft");
    assert!(matches!(refused, SolveError::Problem(ProblemError::TooSoft { .. })), "{refused}");
    let refused = by(&heights, HARDNESS, &[1e-4], Method::GaussSeidel).expect_err("no upper bound");
    assert!(matches!(refused, SolveError::Unsupported(refusal) if refusal.object == Feature::Hardness));
}
