//! `cargo xtask stress`: hard scenes against the properties that every solution must have.

mod agreement;
mod audit;
mod commands;
mod extremes;
mod faults;
mod heights;
mod invariances;
mod kernels;
mod long_runs;
mod mutate;
mod picture;
mod row;
mod scene;
mod solved;

use std::time::Instant;

use anyhow::{Result, bail};
use plotters::prelude::DrawingBackend;
use rc_plot::{Area, Picture, PictureError};

use crate::figures::{self, Figure, Preset, Table};
use row::{Row, Rows, guarded};

/// Stresses the solvers, kernels and operators on purpose: one line for each scene and property, a picture of all, and an
/// error when a line fails.
#[derive(clap::Args)]
// Its own name beside that of the arguments it flattens.
#[group(id = "stress")]
pub(crate) struct Args {
    #[command(flatten)]
    figure: figures::Args,
    /// Only groups whose name contains this.
    #[arg(long, value_name = "NAME")]
    only: Option<String>,
    /// Puts faults into a copy of the sources, one at a time, and counts the rows of the reduced set that fail (with --only, the
    /// faults whose name contains it). Hours.
    #[arg(long)]
    mutate: bool,
    /// Prints a number that depends on every bit of one solution, for comparison between processes.
    #[arg(long, value_name = "SCENE", hide = true)]
    fingerprint: Option<usize>,
}

/// What is stressed.
#[derive(Clone, Debug)]
pub(crate) struct Params {
    preset: Preset,
    only: Option<String>,
}

/// The table.
#[derive(Clone, Debug)]
pub(crate) struct Stress {
    rows: Vec<Row>,
}

/// A set of groups, by name, and what makes its lines.
type Part = (&'static str, fn(Preset) -> Result<Vec<Row>>);

const PARTS: &[Part] = &[
    ("extremes", extremes::rows),
    ("invariances", invariances::rows),
    ("agreement", agreement::rows),
    ("kernels", kernels::rows),
    ("faults", faults::rows),
    ("rc solve", commands::rows),
    ("long runs", long_runs::rows),
];

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    if let Some(scene) = args.fingerprint {
        println!("{:016x}", long_runs::fingerprint(scene)?);
        return Ok(());
    }
    if args.mutate {
        return mutate::run(args.only.as_deref(), &args.figure.out);
    }
    let started = Instant::now();
    // Panics are rows of the table; what they print would be in its way.
    std::panic::set_hook(Box::new(|_| {}));
    let params = Params { only: args.only.clone(), ..Stress::params(args.figure.preset())? };
    let stress = Stress::compute(&params)?;
    for file in figures::write(&stress, &args.figure.out)? {
        println!("{}", file.display());
    }
    println!("{}", stress.groups().aligned());
    let (n_rows, n_failed) = (stress.rows.len(), stress.failed().count());
    println!(
        "{n_rows} rows, {} passed, {n_failed} failed, {:.0} s",
        n_rows - n_failed,
        started.elapsed().as_secs_f64()
    );
    if n_failed > 0 {
        bail!("{}", stress.complaint());
    }
    Ok(())
}

impl Stress {
    fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.passed)
    }

    /// The lines that failed, one sentence each.
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

    /// How each group fared.
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
        Ok(Params { preset, only: None })
    }

    fn compute(params: &Params) -> Result<Self> {
        let mut rows = Vec::new();
        for &(name, make) in PARTS {
            if params.only.as_ref().is_none_or(|only| name.contains(only.as_str())) {
                rows.extend(guarded(|| make(params.preset)).unwrap_or_else(|error| {
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
    fn the_command_line_is_well_formed() {
        use clap::Args as _;
        Args::augment_args(clap::Command::new("stress")).debug_assert();
    }

    #[test]
    fn the_reduced_set_passes_and_can_be_drawn() {
        let params = Stress::params(Preset::Quick).expect("constants");
        let stress = Stress::compute(&params).expect("scenes that can be made");
        assert!(stress.failed().next().is_none(), "{}", stress.complaint());
        assert!(stress.rows.len() >= 300, "only {} rows", stress.rows.len());
        let folder = tempfile::tempdir().expect("a temporary folder");
        let files = figures::write(&stress, folder.path()).expect("the table is written");
        for file in files {
            let length = file.metadata().expect("a written file").len();
            assert!(length > 100, "{} has only {length} bytes", file.display());
        }
    }
}
