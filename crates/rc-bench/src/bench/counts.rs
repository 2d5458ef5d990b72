//! Guard against regressions: counts of operations, which, unlike times, do not depend on the machine.

use anyhow::{Context, Result, bail};
use serde::{Deserialize, Serialize};

use rc_figures::repository;
use rc_solver::Tolerance;

use super::measure::solve;
use super::record::{from_csv, to_csv, write};
use super::scenes::Scene;
use super::setting::{KernelName, Setting};

/// File of the counts.
const COUNTS: &str = "data/bench/counts.csv";

/// Allowed relative change of the number of elements. On another processor an element at an edge of contact may flip.
const SAME_ELEMENTS: f64 = 1e-3;

/// Counts of one solve, summed over all levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct CountRow {
    scene: String,
    setting: String,
    levels: usize,
    iterations: usize,
    /// Applications of L.
    applications: usize,
    /// Applications of the preconditioner.
    preconditionings: usize,
    /// Iterations on the finest level.
    fine_iterations: usize,
    fine_applications: usize,
    /// Elements in contact.
    elements: usize,
}

/// The solves whose operations are counted.
///
/// They are small scenes with each method and kernel, several border levels, and both kinds of tolerance.
fn cases() -> Vec<(&'static str, Setting)> {
    let (auto, default) = (Tolerance::Auto, Tolerance::DEFAULT);
    vec![
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

fn count((scene, setting): &(&str, Setting)) -> Result<CountRow> {
    let solved = solve(&Scene::named(scene)?, setting)?;
    let levels = &solved.info.levels;
    Ok(CountRow {
        scene: (*scene).to_owned(),
        // Cells of the table have no commas.
        setting: setting.to_string().replace(',', ""),
        levels: levels.len(),
        iterations: levels.iter().map(|level| level.iterations).sum(),
        applications: levels.iter().map(|level| level.operator_applications).sum(),
        preconditionings: levels.iter().map(|level| level.preconditioner_applications).sum(),
        fine_iterations: solved.info.fine_iterations(),
        fine_applications: solved.info.fine_operator_applications(),
        elements: solved.n_in_contact,
    })
}

impl CountRow {
    /// Names of the counts that differ from the stored ones.
    fn changes(&self, stored: &Self) -> Vec<String> {
        let exact = [
            ("levels", stored.levels, self.levels),
            ("iterations", stored.iterations, self.iterations),
            ("applications", stored.applications, self.applications),
            ("preconditionings", stored.preconditionings, self.preconditionings),
            ("fine iterations", stored.fine_iterations, self.fine_iterations),
            ("fine applications", stored.fine_applications, self.fine_applications),
        ];
        let mut changed: Vec<_> = exact.into_iter().filter(|(_, before, now)| before != now).collect();
        let allowed = SAME_ELEMENTS * stored.elements as f64;
        if stored.elements.abs_diff(self.elements) as f64 > allowed {
            changed.push(("elements", stored.elements, self.elements));
        }
        let line = |(what, before, now)| format!("{}, {}: {before} {what} became {now}", self.scene, self.setting);
        changed.into_iter().map(line).collect()
    }
}

/// Differences from the stored counts, one sentence each.
fn differences(rows: &[CountRow], stored: &[CountRow]) -> Vec<String> {
    let same = |a: &CountRow, b: &CountRow| (&a.scene, &a.setting) == (&b.scene, &b.setting);
    let changes = rows.iter().flat_map(|row| match stored.iter().find(|stored| same(stored, row)) {
        Some(stored) => row.changes(stored),
        None => vec![format!("{}, {} is not in {COUNTS}", row.scene, row.setting)],
    });
    let gone = stored.iter().filter(|stored| !rows.iter().any(|row| same(row, stored)));
    changes.chain(gone.map(|row| format!("{}, {} is no longer counted", row.scene, row.setting))).collect()
}

/// Counts again and compares with the stored counts.
///
/// # Errors
/// When a count has changed. The text names every change, and says how to accept it.
pub fn check() -> Result<()> {
    let path = repository::root().join(COUNTS);
    let text = std::fs::read_to_string(&path)
        .with_context(|| format!("could not read {COUNTS}; `cargo xtask bench --accept` makes it"))?;
    let rows: Vec<CountRow> = cases().iter().map(count).collect::<Result<_>>()?;
    let differences = differences(&rows, &from_csv::<CountRow>(&text, COUNTS)?);
    if !differences.is_empty() {
        bail!(
            "{} counts of operations changed:\n{}\nIf that is meant, `cargo xtask bench --accept` stores the new ones; say in \
             the commit why.",
            differences.len(),
            differences.join("\n")
        );
    }
    Ok(())
}

/// Stores the present counts.
///
/// # Errors
/// When a solve fails or the file cannot be written.
pub fn accept() -> Result<()> {
    let rows: Vec<CountRow> = cases().iter().map(count).collect::<Result<_>>()?;
    write(&repository::root().join(COUNTS), &to_csv(&rows)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operation_counts_are_as_stored() {
        if let Err(error) = check() {
            panic!("{error:#}");
        }
    }

    #[test]
    fn a_change_names_its_scene_and_a_flipped_element_is_none() {
        let row = count(&("waves-16", Setting::adaptive(1, 8, Tolerance::Auto))).expect("a solved scene");
        assert!(row.iterations > 0 && row.applications > row.iterations && row.elements > 100, "{row:?}");
        let flipped = CountRow { elements: row.elements + row.elements / 2000, ..row.clone() };
        assert_eq!(flipped.changes(&row), Vec::<String>::new());
        let slower = CountRow { iterations: row.iterations + 1, elements: 2 * row.elements, ..row.clone() };
        let changes = slower.changes(&row);
        assert!(changes.len() == 2 && changes[0].starts_with("waves-16, adaptive love border level 1"), "{changes:?}");
        let (none, stored) = (differences(&[], std::slice::from_ref(&row)), differences(&[row], &[]));
        assert!(none[0].contains("no longer") && stored[0].contains("is not in"), "{none:?}, {stored:?}");
    }
}
