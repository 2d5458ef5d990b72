//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

mod agreement;
mod audit;
mod commands;
mod extremes;
mod faults;
mod flows;
mod hardness;
mod heights;
mod invariances;
mod kernels;
mod light;
mod long_runs;
mod meshes;
mod picture;
mod row;
mod scene;
mod solids;
mod solved;

use std::path::Path;
use std::time::Instant;

use anyhow::{Result, ensure};
use plotters::prelude::DrawingBackend;
use rc_figures::{Figure, Preset, Table, write};
use rc_plot::{Area, Picture, PictureError};

pub use commands::{Refusal, RunRc};
use row::{Row, Rows, guarded};

/// Selection of the scenes.
#[derive(Clone, Debug)]
pub struct Params {
    /// The full set, or the reduced one.
    pub preset: Preset,
    /// Part of the names of the groups that run; all groups if it is absent.
    pub only: Option<String>,
    /// The command line `rc`; without it, the group `rc solve` is left out.
    pub rc: Option<RunRc>,
}

/// The stress table.
#[derive(Clone, Debug)]
pub struct Stress {
    rows: Vec<Row>,
}

/// Makes the lines of one or more groups.
type MakeRows = fn(&Params) -> Result<Vec<Row>>;

const GROUPS: &[(&str, MakeRows)] = &[
    ("extremes", |params| extremes::rows(params.preset)),
    ("light contacts", |params| light::rows(params.preset)),
    ("meshes", |params| meshes::rows(params.preset)),
    ("invariances", |params| invariances::rows(params.preset)),
    ("hardness", |params| hardness::rows(params.preset)),
    ("agreement", |params| agreement::rows(params.preset)),
    ("kernels", |params| kernels::rows(params.preset)),
    ("layers and patches", |params| solids::rows(params.preset)),
    ("faults", |params| faults::rows(params.preset)),
    ("flows", |params| flows::rows(params.preset)),
    ("rc solve", |params| params.rc.map_or_else(|| Ok(Vec::new()), |rc| commands::rows(params.preset, rc))),
    ("long runs", |params| long_runs::rows(params.preset)),
];

/// Prints a number that depends on every bit of a solution, for comparison between processes.
///
/// `scene` is the index of a scene of the long runs.
///
/// # Errors
/// When the scene does not exist.
#[expect(clippy::print_stdout, reason = "the answer")]
pub fn print_fingerprint(scene: usize) -> Result<()> {
    println!("{:016x}", long_runs::fingerprint(scene)?);
    Ok(())
}

/// Runs the scenes and writes the tables and the picture into `folder`.
///
/// It also prints a line for each group.
///
/// # Errors
/// When a row fails, or a file cannot be written.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn run(params: &Params, folder: &Path) -> Result<()> {
    let started = Instant::now();
    // A panic becomes a row of the table, so its message is not printed.
    std::panic::set_hook(Box::new(|_| {}));
    let stress = Stress::compute(params)?;
    for file in write(&stress, folder)? {
        println!("{}", file.display());
    }
    println!("{}", stress.groups().aligned());
    let (n_rows, n_failed) = (stress.rows.len(), stress.failed().count());
    println!(
        "{n_rows} rows, {} passed, {n_failed} failed, {:.0} s",
        n_rows - n_failed,
        started.elapsed().as_secs_f64()
    );
    stress.check()
}

impl Stress {
    /// Checks that every row passes.
    ///
    /// # Errors
    /// When a row fails. The text has a sentence for each row that fails.
    pub fn check(&self) -> Result<()> {
        ensure!(self.failed().next().is_none(), "{}", self.complaint());
        Ok(())
    }

    /// Number of rows.
    #[must_use]
    pub fn n_rows(&self) -> usize {
        self.rows.len()
    }

    fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.passed)
    }

    /// The rows that failed, one sentence each.
    fn complaint(&self) -> String {
        let sentence = |row: &Row| {
            format!(
                "{}, {}, {}: expected {}, obtained {}",
                row.group, row.scene, row.property, row.expected, row.obtained
            )
        };
        let lines: Vec<String> = self.failed().map(sentence).collect();
        format!("{} rows failed:\n{}", lines.len(), lines.join("\n"))
    }

    /// Names of groups in the order of the table.
    fn group_names(&self) -> Vec<&'static str> {
        let mut names: Vec<&'static str> = Vec::new();
        for row in &self.rows {
            if !names.contains(&row.group) {
                names.push(row.group);
            }
        }
        names
    }

    /// Table of the results of each group.
    fn groups(&self) -> Table {
        let line = |name: &&'static str| {
            let of_group: Vec<&Row> = self.rows.iter().filter(|row| row.group == *name).collect();
            let passed = of_group.iter().filter(|row| row.passed).count();
            vec![
                (*name).to_owned(),
                of_group.len().to_string(),
                passed.to_string(),
                (of_group.len() - passed).to_string(),
            ]
        };
        Table::new("groups", &["group", "rows", "passed", "failed"], self.group_names().iter().map(line))
    }
}

impl Figure for Stress {
    const NAME: &'static str = "stress";
    type Params = Params;

    fn params(preset: Preset) -> Result<Params> {
        Ok(Params { preset, only: None, rc: None })
    }

    fn compute(params: &Params) -> Result<Self> {
        let mut rows = Vec::new();
        for &(name, make) in GROUPS {
            if params.only.as_ref().is_none_or(|only| name.contains(only.as_str())) {
                rows.extend(guarded(|| make(params)).unwrap_or_else(|error| {
                    let mut failed = Rows::of(name);
                    failed.holds("all scenes", "can be compared", "solutions", format!("{error:#}"), false);
                    failed.finish()
                }));
            }
        }
        Ok(Self { rows })
    }

    fn tables(&self) -> Vec<Table> {
        let header = ["group", "scene", "property", "expected", "obtained", "result"];
        let line = |row: &Row| {
            let result = if row.passed { "pass" } else { "fail" };
            let property = row.property.to_owned();
            vec![
                row.group.to_owned(),
                row.scene.clone(),
                property,
                row.expected.clone(),
                row.obtained.clone(),
                result.to_owned(),
            ]
        };
        vec![Table::new("rows", &header, self.rows.iter().map(line)), self.groups()]
    }
}

impl Picture for Stress {
    fn size(&self) -> (u32, u32) {
        picture::size(&self.rows, &self.group_names())
    }

    fn draw<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        picture::draw(area, &self.rows, &self.group_names())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reduced_set_passes_and_can_be_drawn() {
        let params = Stress::params(Preset::Quick).expect("constants");
        let stress = Stress::compute(&params).expect("scenes that can be made");
        stress.check().expect("every row passes");
        assert!(stress.rows.len() >= 300, "only {} rows", stress.rows.len());
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = write(&stress, folder.path()).expect("the table is written");
        for file in files {
            let length = file.metadata().expect("a written file").len();
            assert!(length > 100, "{} has only {length} bytes", file.display());
        }
    }
}
