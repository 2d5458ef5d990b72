//! The archived run of the figures.
//!
//! It has the tables, the parameters, the version and the times.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result};
use rc_sweep::memory;
use toml::{Table as Toml, Value};

use crate::{Figure, Preset, Table, repository};

/// File with the parameters of a run.
pub(crate) const RUN_FILE: &str = "run.toml";

/// Folder of the archived run `name`.
pub(crate) fn folder(name: &str) -> PathBuf {
    repository::root().join("data/runs").join(name)
}

/// A run of all figures.
pub(crate) struct Run {
    preset: Preset,
    start: Instant,
    figures: Vec<Record>,
}

/// One figure of a run.
struct Record {
    name: &'static str,
    parameters: String,
    seconds: f64,
    tables: Vec<Table>,
}

impl Run {
    pub(crate) fn start(preset: Preset) -> Self {
        Self { preset, start: Instant::now(), figures: Vec::new() }
    }

    pub(crate) fn add<F: Figure>(&mut self, figure: &F, params: &F::Params, seconds: f64) {
        let (parameters, tables) = (format!("{params:?}"), figure.tables());
        self.figures.push(Record { name: F::NAME, parameters, seconds, tables });
    }

    /// File names and tables of the figure.
    fn tables(&self) -> impl Iterator<Item = (String, &Table)> {
        let named = |record: &'static str, table: &Table| format!("{record}-{}.csv", table.name);
        self.figures
            .iter()
            .flat_map(move |record| record.tables.iter().map(move |table| (named(record.name, table), table)))
    }

    /// Writes the tables and the parameters of the run into `folder`.
    pub(crate) fn save(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).with_context(|| format!("could not make {}", folder.display()))?;
        let path = folder.join(RUN_FILE);
        fs::write(&path, toml::to_string(&self.description()?)?)
            .with_context(|| format!("could not write {}", path.display()))
    }

    /// Writes every table into `folder`.
    pub(crate) fn save_tables(&self, folder: &Path) -> Result<()> {
        for (name, table) in self.tables() {
            let path = folder.join(name);
            fs::write(&path, &table.csv).with_context(|| format!("could not write {}", path.display()))?;
        }
        Ok(())
    }

    /// Copies the pictures of the figures in `from` to `docs/images/`.
    pub(crate) fn copy_pictures(&self, from: &Path) -> Result<()> {
        let to = repository::root().join("docs/images");
        for record in &self.figures {
            let name = format!("{}.png", record.name);
            fs::copy(from.join(&name), to.join(&name))
                .with_context(|| format!("could not copy {name} to docs/images/"))?;
        }
        Ok(())
    }

    /// Differences from the tables in `folder`, one sentence for each table.
    pub(crate) fn differences(&self, folder: &Path) -> Result<Vec<String>> {
        let mut differences = Vec::new();
        for (name, table) in self.tables() {
            let path = folder.join(&name);
            let archived = fs::read_to_string(&path).with_context(|| {
                format!("no archived table {}; `cargo xtask figures --archive` writes it", path.display())
            })?;
            let difference = table.comparison.difference(&archived, &table.csv);
            differences.extend(difference.map(|difference| format!("{name}: {difference}")));
        }
        Ok(differences)
    }

    fn description(&self) -> Result<Toml> {
        let mut run = Toml::new();
        run.insert("version".into(), version()?.into());
        run.insert("preset".into(), format!("{:?}", self.preset).to_lowercase().into());
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        run.insert("threads".into(), Value::Integer(threads as i64));
        run.insert("seconds".into(), tenths(self.start.elapsed().as_secs_f64()));
        if let Some(seconds) = processor_seconds() {
            run.insert("processor_seconds".into(), tenths(seconds));
        }
        if let Some(bytes) = memory::peak() {
            run.insert("peak_memory_megabytes".into(), Value::Integer((bytes / 1_000_000) as i64));
        }
        let figures = self.figures.iter().map(|record| {
            let seconds = ("seconds".to_owned(), tenths(record.seconds));
            let parameters = ("parameters".to_owned(), record.parameters.clone().into());
            (record.name.to_owned(), Value::Table([seconds, parameters].into_iter().collect()))
        });
        run.insert("figures".into(), Value::Table(figures.collect()));
        Ok(run)
    }
}

/// Seconds, rounded to one decimal.
fn tenths(seconds: f64) -> Value {
    Value::Float((10.0 * seconds).round() / 10.0)
}

/// Processor time of this process over all threads (s).
///
/// Unlike the elapsed time, it tells the cost of the run on a machine that does other things too.
#[cfg(unix)]
fn processor_seconds() -> Option<f64> {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeValLike as _;
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    let milliseconds = usage.user_time().num_milliseconds() + usage.system_time().num_milliseconds();
    Some(1e-3 * milliseconds as f64)
}

#[cfg(not(unix))]
fn processor_seconds() -> Option<f64> {
    None
}

/// The version in the root manifest.
///
/// # Errors
/// When the manifest does not have a version.
pub fn version() -> Result<String> {
    let manifest: Toml = include_str!("../../../Cargo.toml").parse()?;
    let version = manifest.get("workspace").and_then(|workspace| workspace.get("package")?.get("version")?.as_str());
    Ok(version.context("Cargo.toml has no workspace.package.version; add it")?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fig2;

    fn quick() -> Run {
        let params = Fig2::params(Preset::Quick).expect("no paper values are needed");
        let figure = Fig2::compute(&params).expect("coefficients cannot fail");
        let mut run = Run::start(Preset::Quick);
        run.add(&figure, &params, 1.0);
        run
    }

    #[test]
    fn a_run_agrees_with_itself_and_not_with_other_numbers() {
        let (run, folder) = (quick(), tempfile::tempdir().expect("a temporary folder"));
        run.save_tables(folder.path()).expect("the tables are written");
        assert_eq!(run.differences(folder.path()).expect("archived tables"), Vec::<String>::new());
        let path = folder.path().join("fig2-summary.csv");
        let text = fs::read_to_string(&path).expect("an archived table");
        fs::write(&path, text.replacen("1.250000e-1", "1.350000e-1", 1)).expect("a changed table");
        let differences = run.differences(folder.path()).expect("archived tables");
        assert!(differences.len() == 1 && differences[0].starts_with("fig2-summary.csv: line 2"), "{differences:?}");
        fs::remove_file(&path).expect("a table that is gone");
        assert!(format!("{:#}", run.differences(folder.path()).expect_err("no table")).contains("--archive"));
    }

    #[test]
    fn a_run_says_what_it_was() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        quick().save(folder.path()).expect("the description is written");
        let text = fs::read_to_string(folder.path().join(RUN_FILE)).expect("a description");
        let run: Toml = text.parse().expect("TOML");
        assert_eq!(run["preset"].as_str(), Some("quick"));
        assert!(
            run["figures"]["fig2"]["parameters"].as_str().is_some_and(|text| text.starts_with("Params {")),
            "{text}"
        );
    }
}
