//! Guard against regressions: counts of operations, which, unlike times, do not depend on the machine.
//!
//! The stored counts are ceilings. Fewer operations pass, and more fail.

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};

use rc_figures::repository;
use rc_solver::{LevelInfo, Tolerance};

use super::measure::solve;
use super::record::{from_csv, to_csv, write};
use super::scenes::Scene;
use super::setting::{KernelName, Setting};

/// File of the counts.
const COUNTS: &str = "data/bench/counts.csv";

/// Counts of one solve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct CountRow {
    scene: String,
    setting: String,
    /// Iterations, and applications of L and of the preconditioner, on all levels.
    iterations: usize,
    applications: usize,
    preconditionings: usize,
    /// Iterations on the finest level.
    fine_iterations: usize,
    fine_applications: usize,
}

/// The solves whose operations are counted.
///
/// They are small scenes with each method and kernel, several border levels, and both kinds of tolerance.
fn cases() -> [(&'static str, Setting); 15] {
    let (auto, default) = (Tolerance::Auto, Tolerance::DEFAULT);
    [
        ("waves-16", Setting::uniform(KernelName::Spectral, 16, auto)),
        ("waves-16", Setting::uniform(KernelName::Love, 16, default)),
        ("waves-16", Setting::adaptive(0, 32, default)),
        ("waves-16", Setting::adaptive(1, 8, Tolerance::Relative(1e-8))),
        ("waves-16", Setting::adaptive(3, 8, auto)),
        ("hurst-0.3-light", Setting::adaptive(0, 16, default)),
        ("hurst-0.3-light", Setting::adaptive(2, 8, auto)),
        ("waves-32", Setting::uniform(KernelName::Spectral, 8, auto)),
        ("waves-32", Setting::adaptive(0, 16, auto)),
        ("hurst-0.5", Setting::adaptive(2, 8, auto)),
        ("hurst-0.3", Setting::adaptive(0, 16, default)),
        ("heavy", Setting::uniform(KernelName::Love, 8, default)),
        ("heavy", Setting::adaptive(1, 8, auto)),
        ("paper", Setting::adaptive(0, 8, default)),
        ("paper", Setting::adaptive(1, 8, auto)),
    ]
}

fn count((scene, setting): (&str, Setting)) -> Result<CountRow> {
    let info = solve(&Scene::named(scene)?, &setting)?.info;
    let on_all = |of: fn(&LevelInfo) -> usize| info.levels.iter().map(of).sum();
    Ok(CountRow {
        scene: scene.to_owned(),
        // Cells of the table have no commas.
        setting: setting.to_string().replace(',', ""),
        iterations: on_all(|level| level.iterations),
        applications: on_all(|level| level.operator_applications),
        preconditionings: on_all(|level| level.preconditioner_applications),
        fine_iterations: info.fine_iterations(),
        fine_applications: info.fine_operator_applications(),
    })
}

impl CountRow {
    /// The counts that are above their ceilings, one sentence each.
    fn above(&self, ceiling: &Self) -> Vec<String> {
        let counts = [
            ("iterations", self.iterations, ceiling.iterations),
            ("applications", self.applications, ceiling.applications),
            ("preconditionings", self.preconditionings, ceiling.preconditionings),
            ("fine iterations", self.fine_iterations, ceiling.fine_iterations),
            ("fine applications", self.fine_applications, ceiling.fine_applications),
        ];
        let line = |(what, now, most)| format!("{}, {}: {now} {what}, at most {most} pass", self.scene, self.setting);
        counts.into_iter().filter(|(_, now, most)| now > most).map(line).collect()
    }
}

/// What does not pass, one sentence each: counts above their ceilings, and solves without a ceiling.
fn complaints(rows: &[CountRow], stored: &[CountRow]) -> Vec<String> {
    let same = |a: &CountRow, b: &CountRow| (&a.scene, &a.setting) == (&b.scene, &b.setting);
    let of_row = |row: &CountRow| match stored.iter().find(|stored| same(stored, row)) {
        Some(ceiling) => row.above(ceiling),
        None => vec![format!("{}, {} is not in {COUNTS}", row.scene, row.setting)],
    };
    rows.iter().flat_map(of_row).collect()
}

/// Counts again and compares with the stored counts.
///
/// # Errors
/// When a count is above the stored one. The text names each, and says how to accept it.
pub fn check() -> Result<()> {
    let text = std::fs::read_to_string(repository::root().join(COUNTS))
        .with_context(|| format!("could not read {COUNTS}; `cargo xtask bench --accept` makes it"))?;
    let rows: Vec<CountRow> = cases().into_iter().map(count).collect::<Result<_>>()?;
    let complaints = complaints(&rows, &from_csv::<CountRow>(&text, COUNTS)?);
    ensure!(
        complaints.is_empty(),
        "{} counts of operations are above their ceilings in {COUNTS} (fewer operations pass, more fail):\n{}\nIf they \
         are meant, `cargo xtask bench --accept` stores the present counts; say in the commit why.",
        complaints.len(),
        complaints.join("\n")
    );
    Ok(())
}

/// Stores the present counts.
///
/// # Errors
/// When a solve fails or the file cannot be written.
pub fn accept() -> Result<()> {
    let rows: Vec<CountRow> = cases().into_iter().map(count).collect::<Result<_>>()?;
    write(&repository::root().join(COUNTS), &to_csv(&rows)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_of_operations_are_at_most_the_stored_ones() {
        if let Err(error) = check() {
            panic!("{error:#}");
        }
    }

    #[test]
    fn fewer_operations_pass_and_more_fail() {
        let row = count(("waves-16", Setting::adaptive(1, 8, Tolerance::Auto))).expect("a solved scene");
        assert!(row.iterations > 0 && row.applications > row.iterations, "{row:?}");
        let faster = CountRow { iterations: row.iterations - 1, ..row.clone() };
        assert_eq!(faster.above(&row), Vec::<String>::new());
        let slower = row.above(&faster);
        assert!(slower.len() == 1 && slower[0].starts_with("waves-16, adaptive love border level 1"), "{slower:?}");
        assert!(complaints(&[row], &[])[0].contains("is not in"));
    }
}
