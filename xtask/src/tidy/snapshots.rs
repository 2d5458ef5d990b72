//! Rules for snapshots: small, with a test, and reviewed by a person.

use rc_figures::repository::{Sources, has_extension};

use super::complaint::Complaint;

/// Maximum size of a snapshot in bytes, so that a reviewer can read it.
const LARGEST: usize = 20 * 1024;

/// Checks the size and the test of every `.snap` file.
///
/// It also finds snapshots that wait for review.
pub(super) fn check(sources: &Sources) -> Vec<Complaint> {
    let mut complaints = Vec::new();
    for (path, text) in sources {
        if path.ends_with(".snap.new") {
            complaints.push(format!("{path}: waits for review; accept it with `cargo insta review`, or delete it"));
        }
        if !has_extension(path, "snap") {
            continue;
        }
        if text.len() > LARGEST {
            let n_bytes = text.len();
            complaints.push(format!("{path}: {n_bytes} bytes, more than {LARGEST}; snapshot a smaller case"));
        }
        if !has_test(path, sources) {
            complaints.push(format!("{path}: no test names this snapshot; delete the file, or restore its test"));
        }
    }
    complaints
}

/// Whether a Rust file contains the snapshot's name, or a test function has that name.
fn has_test(path: &str, sources: &Sources) -> bool {
    let file = path.rsplit('/').next().unwrap_or(path).trim_end_matches(".snap");
    let name = file.rsplit("__").next().unwrap_or(file);
    let (quoted, function) = (format!("\"{name}\""), format!("fn {name}("));
    sources.iter().any(|(path, text)| has_extension(path, "rs") && (text.contains(&quoted) || text.contains(&function)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SNAPSHOT: &str = "xtask/src/snapshots/xtask__tests__fig4-summary.snap";

    fn sources(test: &str, snapshot: &str) -> Sources {
        let files = [("xtask/src/fig4.rs", test), (SNAPSHOT, snapshot)];
        files.map(|(path, text)| (path.to_owned(), text.to_owned())).into()
    }

    #[test]
    fn a_snapshot_with_its_test_passes() {
        let sources = sources("snap(\"fig4-summary\", table)", "a,b\n");
        assert_eq!(check(&sources), Vec::<String>::new());
    }

    #[test]
    fn a_snapshot_without_a_test_is_found() {
        let complaints = check(&sources("snap(\"fig4-other\", table)", "a,b\n"));
        assert!(complaints[0].contains("no test names"), "{complaints:?}");
    }

    #[test]
    fn a_large_snapshot_is_found() {
        let text = "1,2\n".repeat(LARGEST / 4 + 1);
        let complaints = check(&sources("snap(\"fig4-summary\", table)", &text));
        assert!(complaints[0].contains("bytes"), "{complaints:?}");
    }

    #[test]
    fn a_snapshot_that_waits_for_review_is_found() {
        let sources = [(format!("{SNAPSHOT}.new"), String::new())].into();
        assert!(check(&sources)[0].contains("waits for review"), "{:?}", check(&sources));
    }
}
