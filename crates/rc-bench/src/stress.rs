//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

mod audit;
mod extremes;
mod heights;
mod meshes;
mod row;
mod scene;
mod sliding;
mod solved;

use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use rc_figures::{Preset, Table};

use row::{Row, Rows, guarded};

/// Makes the lines of one or more groups.
type MakeRows = fn(Preset) -> Result<Vec<Row>>;

const GROUPS: [(&str, MakeRows); 3] =
    [("extremes", extremes::rows), ("meshes", meshes::rows), ("sliding", sliding::rows)];

/// Runs the scenes, writes the table into `folder`, and prints a line for each group.
///
/// With `only`, it takes groups whose name contains it.
///
/// # Errors
/// When no group is called so, a row fails, or a file cannot be written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn run(preset: Preset, only: Option<&str>, folder: &Path) -> Result<()> {
    let names = GROUPS.map(|(name, _)| name);
    if let Some(only) = only {
        let is_known = names.iter().any(|name| name.contains(only));
        ensure!(is_known, "no group is called '{only}'; there are {}", names.join(", "));
    }
    let started = Instant::now();
    // A panic becomes a row of the table, so its message is not printed.
    std::panic::set_hook(Box::new(|_| {}));
    let rows = rows(preset, only);
    let path = folder.join("stress-rows.csv");
    fs::create_dir_all(folder).and_then(|()| fs::write(&path, table(&rows).csv)).context(path.display().to_string())?;
    println!("{}\n{}", path.display(), groups(&rows).aligned());
    println!("{} rows, {:.0} s", rows.len(), started.elapsed().as_secs_f64());
    check(&rows)
}

fn rows(preset: Preset, only: Option<&str>) -> Vec<Row> {
    let chosen = GROUPS.into_iter().filter(|(name, _)| only.is_none_or(|only| name.contains(only)));
    let rows = chosen.map(|(name, make)| {
        guarded(|| make(preset)).unwrap_or_else(|error| {
            let mut failed = Rows::of(name);
            failed.holds("all scenes", "can be solved", "solutions", format!("{error:#}"), false);
            failed.finish()
        })
    });
    rows.flatten().collect()
}

/// Checks that every row passes. The error has a sentence for each row that fails.
fn check(rows: &[Row]) -> Result<()> {
    let failed = rows.iter().filter(|row| !row.passed);
    let sentence = |Row { group, scene, property, expected, obtained, .. }: &Row| {
        format!("{group}, {scene}, {property}: expected {expected}, obtained {obtained}")
    };
    let sentences: Vec<String> = failed.map(sentence).collect();
    ensure!(sentences.is_empty(), "{} rows failed:\n{}", sentences.len(), sentences.join("\n"));
    Ok(())
}

fn table(rows: &[Row]) -> Table {
    let line = |row: &Row| {
        let result = if row.passed { "pass" } else { "fail" };
        let names = [row.group, &row.scene, row.property, &row.expected, &row.obtained, result];
        names.map(str::to_owned).to_vec()
    };
    Table::new("rows", &["group", "scene", "property", "expected", "obtained", "result"], rows.iter().map(line))
}

/// Numbers of rows and of failed rows of each group.
fn groups(rows: &[Row]) -> Table {
    let mut groups: Vec<(&str, usize, usize)> = Vec::new();
    for row in rows {
        let failed = usize::from(!row.passed);
        match groups.iter_mut().find(|(name, ..)| *name == row.group) {
            Some((_, n, n_failed)) => (*n, *n_failed) = (*n + 1, *n_failed + failed),
            None => groups.push((row.group, 1, failed)),
        }
    }
    let line = |(name, n, n_failed): (&str, usize, usize)| vec![name.to_owned(), n.to_string(), n_failed.to_string()];
    Table::new("groups", &["group", "rows", "failed"], groups.into_iter().map(line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reduced_set_passes() {
        let rows = rows(Preset::Quick, None);
        check(&rows).expect("every row passes");
        assert!(rows.len() >= 1500, "only {} rows", rows.len());
        assert_eq!(table(&rows).csv.lines().count(), rows.len() + 1);
    }

    #[test]
    fn an_unknown_group_is_refused() {
        let error = run(Preset::Quick, Some("mesh-free"), Path::new("nowhere")).expect_err("no such group").to_string();
        assert!(error.contains("'mesh-free'") && error.contains("extremes, meshes, sliding"), "{error}");
    }

    #[test]
    fn a_row_that_fails_is_named() {
        let mut failing = Rows::of("meshes");
        failing.at_most("a scene", "load by audit", f64::NAN, 1e-6);
        let rows = failing.finish();
        let text = check(&rows).expect_err("NaN is above every bound").to_string();
        assert!(text.contains("meshes, a scene, load by audit: expected <= 1.000e-6, obtained NaN"), "{text}");
        assert!(groups(&rows).csv.ends_with("meshes,1,1\n"));
    }
}
