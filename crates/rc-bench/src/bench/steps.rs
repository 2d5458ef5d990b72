//! `cargo xtask bench --steps`: where the time of a solve goes, beside the time that memory takes.

use std::time::Instant;

use anyhow::{Context, Result};
use rayon::prelude::*;
use rc_core::{Grid, HeightField as _, Silent};
use rc_figures::repository;
use rc_solver::{ContactProblem, LevelInfo, SolveParams, Step, record_steps};
use serde::{Deserialize, Serialize};

use super::markdown::{cell, percent, table, time};
use super::record::{from_csv, rounded, to_csv, write};
use super::scenes::{SCALE_SCENES, SCENES, Scene};

/// Lines of the archived run.
pub(super) const STEPS: &str = "data/bench/steps.csv";

/// The scenes, and elements of their grids for the shortest wave: 256², 2048² and 16384².
const CASES: [(Scene, f64); 3] = [(SCENES[0], 4.0), (SCENES[0], 32.0), (SCALE_SCENES[0], 32.0)];

/// Solves of each case. The fastest is recorded.
const REPEATS: usize = 3;

/// Numbers of each array for the bandwidth.
const ARRAY: usize = 1 << 24;

/// Bytes of the vectors of one element that a step reads and writes once: on a direction (the preconditioned residual,
/// the direction, its displacement, whether the element is active), and in the preconditioner (the residual, the
/// displacement for the next direction, whether it is active).
const DIRECTION_BYTES: f64 = (4 + 8 + 4 + 1) as f64;
const PRECONDITIONER_BYTES: f64 = (8 + 4 + 1) as f64;

/// One step of one solve.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct StepRow {
    side: usize,
    method: String,
    step: String,
    /// Part of the time of the solve, and this time (s).
    part: f64,
    seconds: f64,
    /// Seconds in which memory passes the vectors of the step once in each of its applications on the finest level.
    memory_seconds: Option<f64>,
}

/// Measures and prints the steps of all cases. With `archive`, it saves them for the documents.
///
/// # Errors
/// When a solve fails or a file cannot be written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(super) fn measure(archive: bool) -> Result<()> {
    let bandwidth = bandwidth();
    let mut rows = Vec::new();
    for (scene, elements_per_wave) in CASES {
        rows.extend(steps_of(&scene, elements_per_wave, bandwidth)?);
    }
    println!("{}", as_markdown(&rows));
    println!("Memory passes {:.1} GB/s, with all threads.", 1e-9 * bandwidth);
    if archive {
        write(&repository::root().join(STEPS), &to_csv(&rows)?)?;
    }
    Ok(())
}

/// The steps of the fastest of several solves, and the rest.
fn steps_of(scene: &Scene, elements_per_wave: f64, bandwidth: f64) -> Result<Vec<StepRow>> {
    let (surface, side) = (scene.surface()?, scene.side(elements_per_wave));
    let grid = Grid::square(side)?;
    let mut fastest: Option<(f64, Vec<StepRow>)> = None;
    for _ in 0..REPEATS {
        let start = Instant::now();
        let problem = ContactProblem::new(surface.on(grid), scene.control());
        let (solution, steps) = record_steps(|| problem.solve(&SolveParams::default(), &Silent));
        let solution = solution.with_context(|| format!("scene {} on {side}²", scene.name))?;
        let seconds = start.elapsed().as_secs_f64();
        if fastest.as_ref().is_some_and(|(least, _)| *least <= seconds) {
            continue;
        }
        let n_elements = solution.n_evaluated() as f64;
        let finest = solution.info().levels.last().context("a solve has a level")?;
        let method = solution.method().name().to_owned();
        let row = |step: &str, of_step: f64, memory_seconds: Option<f64>| StepRow {
            side,
            method: method.clone(),
            step: step.to_owned(),
            part: rounded(of_step / seconds, 3),
            seconds: rounded(seconds, 4),
            memory_seconds: memory_seconds.map(|seconds| rounded(seconds, 3)),
        };
        let steps = Step::ALL.into_iter().zip(steps.map(|step| step.as_secs_f64()));
        let rest = seconds - steps.clone().map(|(_, seconds)| seconds).sum::<f64>();
        let mut rows: Vec<StepRow> = steps
            .map(|(step, seconds)| row(step.name(), seconds, bytes(step, finest).map(|b| b * n_elements / bandwidth)))
            .collect();
        rows.push(row(REST, rest, None));
        fastest = Some((seconds, rows));
    }
    fastest.map(|(_, rows)| rows).context("no solve")
}

const REST: &str = "the rest: vectors, levels, certificate";

/// Bytes of an element in all applications of a step on the finest level.
fn bytes(step: Step, finest: &LevelInfo) -> Option<f64> {
    match step {
        Step::Directions => Some(DIRECTION_BYTES * finest.iterations as f64),
        Step::Preconditioner => Some(PRECONDITIONER_BYTES * finest.preconditioner_applications as f64),
        _ => None,
    }
}

/// Bytes that memory passes in a second, by a + s b of large arrays with all threads.
fn bandwidth() -> f64 {
    let (a, b, mut sum) = (vec![1.0_f64; ARRAY], vec![2.0_f64; ARRAY], vec![0.0_f64; ARRAY]);
    let pass = |_: usize| {
        let start = Instant::now();
        sum.par_chunks_mut(1 << 14).zip(a.par_chunks(1 << 14)).zip(b.par_chunks(1 << 14)).for_each(|((sum, a), b)| {
            for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
                *sum = a + 0.5 * b;
            }
        });
        start.elapsed().as_secs_f64()
    };
    let least = (0..REPEATS + 2).map(pass).fold(f64::INFINITY, f64::min);
    (3 * size_of::<f64>() * ARRAY) as f64 / least
}

/// Table of the archived run.
pub(super) fn archived(text: &str) -> Result<String> {
    Ok(as_markdown(&from_csv::<StepRow>(text, STEPS)?))
}

fn as_markdown(rows: &[StepRow]) -> String {
    let mut sides: Vec<&StepRow> = rows.iter().collect();
    sides.dedup_by_key(|row| row.side);
    let title = |row: &&StepRow| format!("{}², {}, {}", row.side, row.method, time(row.seconds));
    let head: Vec<String> = ["step".to_owned()].into_iter().chain(sides.iter().map(title)).collect();
    let of = |side: usize, step: &str| rows.iter().find(|row| row.side == side && row.step == step);
    let in_cell = |row: Option<&StepRow>| {
        let memory = row.and_then(|row| Some(row.memory_seconds? / row.seconds));
        let memory = memory.map_or_else(String::new, |part| format!(" ({})", percent(part)));
        cell(row, |row| percent(row.part)) + &memory
    };
    let line = |step: &str| {
        let cells = sides.iter().map(|row| in_cell(of(row.side, step)));
        [step.to_owned()].into_iter().chain(cells).collect()
    };
    table(&head, Step::ALL.into_iter().map(Step::name).chain([REST]).map(line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_of_a_solve_add_up_and_are_listed_once() {
        let scene = Scene::named("waves-16").expect("a scene of the table");
        let rows = steps_of(&scene, 16.0, 1e10).expect("a solve");
        let sum: f64 = rows.iter().map(|row| row.part).sum();
        assert!((sum - 1.0).abs() < 5e-3, "{rows:?}");
        let measured = rows.iter().filter(|row| row.part > 0.0).count();
        assert!(measured >= 5, "{rows:?}");
        assert_eq!(as_markdown(&rows).lines().count(), 2 + rows.len());
    }
}
