//! Deliberate faults in the sources.
//!
//! A fault is found by the reduced set, or else by the tests of its crate.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};

use rc_figures::{Table, repository};

/// Folders of the workspace that are not copied: history and results.
const RESULTS: &[&str] = &[".git", "figures", "rc-result", "target"];

/// Time after which a mutant counts as found, because it hangs.
const LONGEST: Duration = Duration::from_secs(900);

/// A change of one place in the sources.
#[derive(Clone, Debug)]
struct Mutation {
    name: String,
    file: String,
    original: String,
    mutated: String,
}

/// Outcome of a mutation.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Outcome {
    /// The reduced set and the tests passed, so nothing noticed the fault.
    Missed,
    /// These rows failed.
    Failed(HashSet<String>),
    /// The reduced set passed, and this test of the crate failed.
    Tested(String),
    /// The run did not end, or ended without a table.
    Broken(&'static str),
    /// The mutation does not compile, and its entry in the list has to be corrected.
    NotCompiled,
}

impl Outcome {
    fn text(&self) -> String {
        match self {
            Self::Missed => "missed".into(),
            Self::Failed(rows) if rows.len() == 1 => "1 row fails".into(),
            Self::Failed(rows) => format!("{} rows fail", rows.len()),
            Self::Tested(test) => format!("test {test} fails"),
            Self::Broken(how) => (*how).into(),
            Self::NotCompiled => "does not compile".into(),
        }
    }

    fn is_found(&self) -> bool {
        matches!(self, Self::Failed(_) | Self::Tested(_) | Self::Broken(_))
    }
}

/// Builds and stresses each selected mutation in a copy of the workspace.
///
/// A mutation is selected when its name contains one of `only` (separated by commas). If the mutation makes no further
/// row fail, the tests of its crate run too. The result is `mutations.csv` in `out`. The build is kept in
/// `target/mutations`, so that each mutation is one incremental build.
///
/// # Errors
/// When the unchanged sources or a mutation do not compile.
#[expect(clippy::print_stdout, reason = "the result of the command")]
pub fn run(only: Option<&str>, out: &Path) -> Result<()> {
    let copy = Copy::new()?;
    fs::create_dir_all(out).with_context(|| format!("could not make {}; give another --out", out.display()))?;
    let known = match copy.stress()? {
        Outcome::Missed => HashSet::new(),
        Outcome::Failed(rows) => rows,
        other => bail!("the sources as they are cannot be stressed: {}", other.text()),
    };
    println!("without a mutation {} rows fail; they are not counted", known.len());
    let (mut lines, mut outcomes) = (Vec::new(), Vec::new());
    for mutation in mutations()?.iter().filter(|mutation| mutation.is_asked_for(only)) {
        let outcome = copy.with(mutation, || copy.outcome(mutation, &known))?;
        println!("{}: {}", mutation.name, outcome.text());
        let [name, text] = [mutation.name.clone(), outcome.text()].map(|text| text.replace(',', ";"));
        lines.push(vec![name, mutation.file.clone(), text]);
        let table = Table::new("mutations", &["mutation", "file", "outcome"], lines.iter().cloned());
        fs::write(out.join("mutations.csv"), table.csv).context("could not write mutations.csv")?;
        outcomes.push(outcome);
    }
    println!("{} of {} mutations found", outcomes.iter().filter(|outcome| outcome.is_found()).count(), outcomes.len());
    ensure!(!outcomes.contains(&Outcome::NotCompiled), "some mutations do not compile: mend mutations.toml");
    Ok(())
}

/// The mutations in `mutations.toml`.
fn mutations() -> Result<Vec<Mutation>> {
    let table: toml::Table = include_str!("mutations.toml").parse().context("mutations.toml")?;
    let list = table.get("mutation").and_then(toml::Value::as_array).context("no [[mutation]]")?;
    let mutation = |value: &toml::Value| {
        let text = |key: &str| {
            let text = value.get(key).and_then(toml::Value::as_str);
            text.map(str::to_owned).with_context(|| format!("a mutation without `{key}`: {value}"))
        };
        let (name, file) = (text("name")?, text("file")?);
        Ok(Mutation { name, file, original: text("original")?, mutated: text("mutated")? })
    };
    list.iter().map(mutation).collect()
}

impl Mutation {
    fn is_asked_for(&self, only: Option<&str>) -> bool {
        only.is_none_or(|only| only.split(',').any(|part| self.name.contains(part.trim())))
    }

    /// The crate that the file is in.
    fn package(&self) -> Result<&str> {
        let folder = self.file.strip_prefix("crates/").and_then(|rest| rest.split('/').next());
        folder.with_context(|| format!("{} is not in a crate: mend mutations.toml", self.file))
    }

    /// The text of the file with the fault.
    fn applied(&self, text: &str) -> Result<String> {
        let count = text.matches(&self.original).count();
        if count != 1 {
            bail!("`{}` occurs {count} times in {}, not once: mend mutations.toml", self.original, self.file);
        }
        Ok(text.replace(&self.original, &self.mutated))
    }
}

/// A copy of the workspace.
struct Copy {
    folder: tempfile::TempDir,
    /// Folder of the build.
    target: PathBuf,
}

impl Copy {
    fn new() -> Result<Self> {
        let folder = tempfile::tempdir().context("a temporary folder")?;
        copy_workspace(folder.path())?;
        Ok(Self { folder, target: repository::root().join("target/mutations") })
    }

    /// Runs `work` while the mutation is in the sources.
    fn with<T>(&self, mutation: &Mutation, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let file = self.folder.path().join(&mutation.file);
        let text = fs::read_to_string(&file).with_context(|| format!("could not read {}", file.display()))?;
        let written = || format!("could not write {}", file.display());
        fs::write(&file, mutation.applied(&text)?).with_context(written)?;
        let result = work();
        fs::write(&file, text).with_context(written)?;
        result
    }

    /// Rows of the reduced set that find the mutation, or else a failed test.
    ///
    /// Rows in `known` fail without the mutation and do not count. The tests are those of the crate.
    fn outcome(&self, mutation: &Mutation, known: &HashSet<String>) -> Result<Outcome> {
        match self.stress()? {
            Outcome::Failed(rows) if rows.is_subset(known) => self.test(mutation.package()?),
            Outcome::Failed(rows) => Ok(Outcome::Failed(&rows - known)),
            Outcome::Missed => self.test(mutation.package()?),
            other => Ok(other),
        }
    }

    /// A command of cargo in the copy.
    ///
    /// Its profile makes builds fast rather than runs, since each mutation runs once, for two minutes at most.
    fn cargo(&self) -> Command {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo
            .current_dir(self.folder.path())
            .env("CARGO_TARGET_DIR", &self.target)
            .envs([("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1"), ("CARGO_PROFILE_RELEASE_DEBUG", "false")])
            .env("CARGO_PROFILE_RELEASE_INCREMENTAL", "true");
        cargo
    }

    /// Builds the copy and runs its reduced set.
    #[expect(clippy::print_stderr, reason = "why a mutation does not compile")]
    fn stress(&self) -> Result<Outcome> {
        let out = self.folder.path().join("stress");
        if out.exists() {
            fs::remove_dir_all(&out).context("results of the mutation before")?;
        }
        let build = self.cargo().args(["build", "--quiet", "--release", "--package", "xtask"]).output();
        let build = build.context("could not start cargo")?;
        if !build.status.success() {
            eprintln!("{}", String::from_utf8_lossy(&build.stderr));
            return Ok(Outcome::NotCompiled);
        }
        let mut run = Command::new(self.target.join("release/xtask"))
            .args(["stress", "--quick", "--out"])
            .arg(&out)
            .current_dir(self.folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .context("could not start the mutation")?;
        let started = Instant::now();
        while run.try_wait()?.is_none() {
            if started.elapsed() > LONGEST {
                run.kill()?;
                run.wait()?;
                return Ok(Outcome::Broken("does not end"));
            }
            sleep(Duration::from_millis(100));
        }
        let Ok(table) = fs::read_to_string(out.join("stress-rows.csv")) else {
            return Ok(Outcome::Broken("ends without a table"));
        };
        let failed: HashSet<String> = table.lines().filter(|line| line.ends_with(",fail")).map(scene_of).collect();
        Ok(if failed.is_empty() { Outcome::Missed } else { Outcome::Failed(failed) })
    }

    /// Runs the tests of a crate.
    #[expect(clippy::print_stderr, reason = "why a mutation does not compile")]
    fn test(&self, package: &str) -> Result<Outcome> {
        let run = self.cargo().args(["test", "--release", "--package", package]).output();
        let run = run.context("could not start cargo")?;
        if run.status.success() {
            return Ok(Outcome::Missed);
        }
        let text = String::from_utf8_lossy(&run.stdout);
        let failed = text.lines().find_map(|line| line.strip_prefix("test ")?.strip_suffix(" ... FAILED"));
        if failed.is_none() {
            eprintln!("{}", String::from_utf8_lossy(&run.stderr));
        }
        Ok(failed.map_or(Outcome::NotCompiled, |test| Outcome::Tested(format!("{package} {test}"))))
    }
}

/// Group, scene and property of a line of the table, which name the row.
fn scene_of(line: &str) -> String {
    line.split(',').take(3).collect::<Vec<_>>().join(", ")
}

/// Copies the workspace without history and results.
fn copy_workspace(to: &Path) -> Result<()> {
    copy_folder(&repository::root(), to, RESULTS)
}

/// Copies a folder without its entries in `without`.
fn copy_folder(from: &Path, to: &Path, without: &[&str]) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| format!("could not list {}", from.display()))? {
        let entry = entry?;
        let (name, target) = (entry.file_name(), to.join(entry.file_name()));
        if without.iter().any(|result| *result == name) {
            continue;
        }
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target, &[])?;
        } else {
            fs::copy(entry.path(), &target).with_context(|| format!("could not copy {}", entry.path().display()))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_has_every_source_and_no_results() {
        let copy = tempfile::tempdir().expect("a temporary folder");
        copy_workspace(copy.path()).expect("a copy");
        for module in ["crates/rc-figures/src/all.rs", "xtask/src/stress.rs", "crates/rc-cli/src/main.rs", "Cargo.lock"]
        {
            assert!(copy.path().join(module).is_file(), "no {module}");
        }
        assert!(!copy.path().join("target").exists() && !copy.path().join(".git").exists());
    }

    #[test]
    fn every_mutation_changes_one_place_of_the_sources() {
        let mutations = mutations().expect("a list of mutations");
        assert!(mutations.len() >= 20, "only {} mutations", mutations.len());
        for mutation in mutations {
            let text = fs::read_to_string(repository::root().join(&mutation.file)).expect("a source file");
            let applied = mutation.applied(&text).expect("one place");
            assert!(applied != text, "{} changes nothing", mutation.name);
        }
    }

    #[test]
    fn every_mutation_has_a_row() {
        let page = include_str!("mutations.md");
        for Mutation { name, .. } in mutations().expect("a list of mutations") {
            let rows = page.lines().filter(|line| line.starts_with(&format!("| {name} | "))).count();
            assert_eq!(rows, 1, "rows of \"{name}\" in mutations.md");
        }
    }
}
