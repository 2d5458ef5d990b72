//! Dependencies between crates are the arrows of ARCHITECTURE.md.

use rc_figures::repository::Sources;
use toml::{Table, Value};

/// The crates that each library may use.
///
/// A crate that is not listed may use nothing until ARCHITECTURE.md gives it an arrow.
const ARROWS: &[(&str, &[&str])] = &[
    ("rc-core", &[]),
    ("rc-comm", &[]),
    ("rc-fft", &["rc-core"]),
    ("rc-fractal", &["rc-core", "rc-fft"]),
    ("rc-heights", &["rc-core"]),
    ("rc-kernel", &["rc-core"]),
    ("rc-leakage", &["rc-core"]),
    ("rc-quadtree", &["rc-core"]),
    ("rc-theory", &["rc-core"]),
    ("rc-solver", &["rc-comm", "rc-core", "rc-fft", "rc-kernel", "rc-quadtree"]),
    ("rc-plot", &["rc-core"]),
    ("rc-sweep", &["rc-core", "rc-solver"]),
];

/// Crates that may use every library, and further crates that they may use.
const ABOVE_THE_LIBRARIES: &[(&str, &[&str])] = &[
    ("rc-figures", &[]),
    ("rc-bench", &["rc-figures"]),
    ("rc-cli", &[]),
    ("rc-py", &["rc-cli"]),
    ("xtask", &["rc-figures", "rc-bench", "rc-cli"]),
    ("rc-tests", &["rc-figures", "rc-bench", "rc-cli"]),
    ("rc-mpi", &["rc-cli"]),
    ("rc-fuzz", &["rc-figures", "rc-bench", "rc-cli"]),
];

/// Checks the arrows of every crate.
///
/// Dependencies of tests count. If only a test needs an arrow, the test belongs into `tests/`.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    let arrows = |(path, manifest): (&str, Table)| -> Vec<String> {
        let name = manifest["package"]["name"].as_str().unwrap_or_default();
        if allows(name, "").is_none() {
            return vec![format!("{path}: `{name}` has no arrows; add it to {PLACES}")];
        }
        let is_member = |used: &str| used == "xtask" || used.starts_with("rc-");
        let forbidden = |used: &String| is_member(used) && allows(name, used) != Some(true);
        let complaint = |used| format!("{path}: {name} -> {used} is no arrow; move what needs it, or change {PLACES}");
        dependencies(&manifest).into_iter().filter(forbidden).map(complaint).collect()
    };
    manifests(sources).flat_map(arrows).collect()
}

const PLACES: &str = "ARCHITECTURE.md and xtask/src/tidy/crates.rs";

/// Whether `name` may use `dependency`; `None` if `name` is not listed.
fn allows(name: &str, dependency: &str) -> Option<bool> {
    let of = |list: &'static [(&str, &[&str])]| list.iter().find(|(crate_name, _)| *crate_name == name);
    let listed = of(ARROWS).map(|(_, uses)| uses.contains(&dependency));
    listed.or_else(|| {
        let (_, uses) = of(ABOVE_THE_LIBRARIES)?;
        Some(uses.contains(&dependency) || ARROWS.iter().any(|(library, _)| *library == dependency))
    })
}

/// The manifests of crates with their paths. Cargo itself refuses one that is not TOML.
fn manifests(sources: &Sources) -> impl Iterator<Item = (&str, Table)> {
    let manifests = sources.iter().filter(|(path, _)| path.ends_with("/Cargo.toml"));
    manifests.filter_map(|(path, text)| Some((path.as_str(), text.parse().ok()?)))
}

/// Names of all dependencies of a manifest, on any system, without those names by which its code may call them.
fn dependencies(manifest: &Table) -> Vec<String> {
    let systems = manifest.get("target").and_then(Value::as_table).into_iter().flat_map(Table::values);
    let tables = systems.filter_map(Value::as_table).chain([manifest]);
    let sections = ["dependencies", "dev-dependencies", "build-dependencies"];
    let in_table = |table: &Table| sections.map(|section| table.get(section).and_then(Value::as_table).cloned());
    let name = |(name, of): (String, Value)| of.get("package").and_then(Value::as_str).unwrap_or(&name).to_owned();
    tables.flat_map(in_table).flatten().flatten().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(name: &str, section: &str, dependency: &str) -> Sources {
        let manifest = format!("[package]\nname = \"{name}\"\n[{section}]\n{dependency}.workspace = true\n");
        [("a/Cargo.toml".to_owned(), manifest)].into()
    }

    #[test]
    fn forbidden_arrows_and_crates_without_arrows_are_found() {
        for (name, dependency) in [("rc-solver", "rc-core"), ("rc-solver", "rayon"), ("xtask", "rc-cli")] {
            assert_eq!(check(&sources(name, "dependencies", dependency)), Vec::<String>::new());
        }
        for (name, dependency) in
            [("rc-solver", "rc-fractal"), ("rc-theory", "xtask"), ("rc-bench", "rc-cli"), ("rc-new", "rayon")]
        {
            for section in ["dependencies", "dev-dependencies", "build-dependencies", "target.'cfg(unix)'.dependencies"]
            {
                assert_eq!(check(&sources(name, section, dependency)).len(), 1, "{name} -> {dependency}");
            }
            let renamed = format!("other.package = \"{dependency}\"\nother");
            assert_eq!(check(&sources(name, "dependencies", &renamed)).len(), 1, "{name} -> {dependency}, renamed");
        }
    }
}
