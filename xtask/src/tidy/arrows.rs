//! The allowed dependencies between crates: the arrows of ARCHITECTURE.md.

use rc_figures::repository::Sources;
use toml::{Table, Value};

use super::complaint::Complaint;

/// The crates that each crate may use.
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
    ("rc-mpi", &["rc-cli"]),
];

/// Whether `name` may use `dependency`; `None` if `name` is not listed.
fn allows(name: &str, dependency: &str) -> Option<bool> {
    let of = |list: &'static [(&str, &[&str])]| list.iter().find(|(crate_name, _)| *crate_name == name);
    let listed = of(ARROWS).map(|(_, uses)| uses.contains(&dependency));
    listed.or_else(|| {
        let (_, uses) = of(ABOVE_THE_LIBRARIES)?;
        Some(uses.contains(&dependency) || ARROWS.iter().any(|(library, _)| *library == dependency))
    })
}

/// Checks the manifest of every member.
///
/// Dependencies of tests count. If only a test needs an arrow, the test belongs into `tests/`.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let manifests = sources.iter().filter(|(path, _)| path.ends_with("/Cargo.toml"));
    manifests.flat_map(|(path, text)| check_manifest(path, text)).collect()
}

fn check_manifest(path: &str, text: &str) -> Vec<Complaint> {
    let manifest: Table = match text.parse() {
        Ok(manifest) => manifest,
        Err(error) => return vec![format!("{path} is not TOML: {error}; correct the manifest")],
    };
    let name = manifest.get("package").and_then(|package| package.get("name")).and_then(Value::as_str).unwrap_or("");
    if allows(name, "").is_none() {
        return vec![format!(
            "{path}: `{name}` has no arrows; add it to ARCHITECTURE.md and to ARROWS in xtask/src/tidy/arrows.rs"
        )];
    }
    let used = ["dependencies", "dev-dependencies", "build-dependencies"].into_iter().flat_map(|section| {
        let dependencies = manifest.get(section).and_then(Value::as_table);
        dependencies.into_iter().flat_map(Table::keys).map(move |dependency| (section, dependency))
    });
    let forbidden = used.filter(|(_, dependency)| is_member(dependency) && allows(name, dependency) != Some(true));
    let complaint = |(section, dependency)| {
        format!(
            "{path} [{section}]: {name} -> {dependency} is not an arrow of ARCHITECTURE.md; move what needs it to tests/ or \
             xtask/, or redraw the arrow there and in xtask/src/tidy/arrows.rs"
        )
    };
    forbidden.map(complaint).collect()
}

fn is_member(dependency: &str) -> bool {
    dependency == "xtask" || dependency.starts_with("rc-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_allowed_arrow_passes() {
        let manifest = "[package]\nname = \"rc-solver\"\n[dependencies]\nrc-core.workspace = true\nrayon = \"1\"\n";
        assert_eq!(check_manifest("crates/rc-solver/Cargo.toml", manifest), Vec::<String>::new());
    }

    #[test]
    fn a_forbidden_arrow_is_found_even_when_only_tests_use_it() {
        for section in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let manifest = format!("[package]\nname = \"rc-solver\"\n[{section}]\nrc-fractal.workspace = true\n");
            let complaints = check_manifest("crates/rc-solver/Cargo.toml", &manifest);
            assert_eq!(complaints.len(), 1, "{complaints:?}");
            assert!(complaints[0].contains("rc-solver -> rc-fractal"), "{complaints:?}");
        }
    }

    #[test]
    fn nothing_depends_on_the_task_runner_or_on_the_command_line() {
        for (name, dependency) in [
            ("rc-theory", "xtask"),
            ("rc-theory", "rc-cli"),
            ("rc-bench", "rc-cli"),
            ("rc-cli", "rc-figures"),
            ("xtask", "rc-tests"),
        ] {
            let manifest = format!("[package]\nname = \"{name}\"\n[dependencies]\n{dependency}.workspace = true\n");
            assert_eq!(check_manifest("Cargo.toml", &manifest).len(), 1, "{name} -> {dependency}");
        }
    }

    #[test]
    fn a_member_without_arrows_is_found() {
        let complaints = check_manifest("crates/rc-new/Cargo.toml", "[package]\nname = \"rc-new\"\n");
        assert!(complaints[0].contains("no arrows"), "{complaints:?}");
    }
}
