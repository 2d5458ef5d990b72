//! Rules for snapshots: reviewed by a person, and each with its test.

use rc_figures::repository::{Sources, has_extension};

/// Checks that no snapshot waits for review, and that a test names each.
pub(super) fn check(sources: &Sources) -> Vec<String> {
    let code: Vec<&String> =
        sources.iter().filter(|(path, _)| has_extension(path, "rs")).map(|(_, text)| text).collect();
    let complaint = |path: &String| {
        let name = path.rsplit('/').next().unwrap_or(path).strip_suffix(".snap");
        let is_named = |name: &str| code.iter().any(|text| text.contains(&format!("\"{name}\"")));
        match name {
            None => path
                .ends_with(".snap.new")
                .then(|| format!("{path}: waits for review; accept it with `cargo insta review`, or delete it")),
            Some(name) => {
                (!is_named(name)).then(|| format!("{path}: no test names it; delete it, or restore its test"))
            }
        }
    };
    sources.keys().filter_map(complaint).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapshots_that_wait_or_have_no_test_are_found() {
        let complaints = |snapshot: &str| {
            let files = [("a/src/fig4.rs", "snap(\"fig4-summary\", table)"), (snapshot, "a,b\n")];
            check(&files.map(|(path, text)| (path.to_owned(), text.to_owned())).into()).len()
        };
        let found = ["a/fig4-summary.snap", "a/fig4-other.snap", "a/fig4-summary.snap.new"].map(complaints);
        assert_eq!(found, [0, 1, 1]);
    }
}
