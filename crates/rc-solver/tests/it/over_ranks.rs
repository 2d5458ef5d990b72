//! Results that ranks hand to each other.

use std::convert::Infallible;
use std::f64::consts::TAU;

use rc_comm::{Ranks, run_threads};
use rc_core::{Field, Grid, Silent};
use rc_solver::{ContactProblem, Control, Method, Solution, SolveParams};

fn wave() -> Field {
    // The rows are handed out in several bands.
    let grid = Grid::square(2048).expect("a grid");
    Field::from_fn(grid, |at| 1e-3 * ((TAU * at.x).cos() + (TAU * at.y).cos()))
}

fn solve(heights: &Field, ranks: Ranks) -> Solution<'_> {
    let problem = ContactProblem::new(heights, Control::MeanPressure(2e-6)).over(ranks);
    problem.solve(&SolveParams::default().by(Method::Adaptive), &Silent).expect("solvable")
}

/// The pressures that are handed to this rank.
fn rows(solution: &Solution<'_>) -> Vec<f64> {
    let mut values = Vec::new();
    let Ok(()) = solution.pressure_rows(|_, rows| {
        values.extend_from_slice(rows);
        Ok::<_, Infallible>(())
    });
    values
}

#[test]
fn a_rank_that_takes_no_more_does_not_hold_up_the_others() {
    let heights = wave();
    let expected = rows(&solve(&heights, Ranks::alone()));
    let of_rank = |ranks: Ranks| {
        let solution = solve(&heights, ranks);
        let mut calls = 0;
        let mut fail = || {
            calls += 1;
            Err(calls)
        };
        let ended = [solution.each_element(|_| fail()), solution.pressure_rows(|_, _| fail())];
        (ended, calls, rows(&solution))
    };
    let found = run_threads(2, of_rank).expect("all ranks end");
    assert!(found[0] == ([Err(1), Err(2)], 2, expected), "{:?}", (found[0].0, found[0].1));
    assert!(found[1] == ([Ok(()); 2], 0, Vec::new()), "{:?}", (found[1].0, found[1].1));
}

#[test]
fn the_first_rank_gets_the_rows_of_a_kept_field_too() {
    let heights = wave();
    let of_rank = |ranks: Ranks| {
        let solution = solve(&heights, ranks);
        let kept = solution.pressure().values().to_vec();
        (kept, rows(&solution))
    };
    let found = run_threads(2, of_rank).expect("all ranks end");
    assert!(found[0].0 == found[0].1 && found[1].0 == found[0].0 && found[1].1.is_empty());
}
