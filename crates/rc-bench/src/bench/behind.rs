//! The comparisons in which rc is not ahead, as sentences.
//!
//! They are computed from the lines of the run, so that they stay true.

use super::levels::{Asked, Choice, Comparison, Ratio, Results, levels};
use super::readings::Reading;
use super::tables::{EQUAL_MESHES, equal_ratios, percent, ratio};

/// Ratio of times below which a comparison is listed.
const LISTED: f64 = 2.0;

/// Text behind a ratio when the error that the peer states is wrong.
const WRONG: &str = ", what the peer states is wrong";

/// Comparisons of one kind that are not clearly in our favour.
///
/// `what` names the kind. The lists have the names of the scenes.
struct Behind {
    what: String,
    /// Scenes in which a peer is faster, or only a peer reaches the error.
    slower: Vec<String>,
    /// Scenes in which a peer takes less than twice our time.
    close: Vec<String>,
    /// Number of all scenes that were compared.
    n_compared: usize,
}

impl Behind {
    fn of<'a>(what: String, comparisons: impl Iterator<Item = (&'a str, Comparison)>) -> Self {
        let mut found = Self { what, slower: Vec::new(), close: Vec::new(), n_compared: 0 };
        for (scene, comparison) in comparisons {
            found.n_compared += usize::from(comparison != Comparison::Nothing);
            let (of, wrong) = match comparison {
                Comparison::PeerAlone { holds } => {
                    found.slower.push(format!("{scene} (a peer alone{})", if holds { "" } else { WRONG }));
                    continue;
                }
                Comparison::Ratio(of) => (of, ""),
                Comparison::Wrong(of) => (of, WRONG),
                Comparison::Nothing => continue,
            };
            let cell = format!("{scene} ({}{wrong})", ratio(of));
            if of.value < 1.0 && !of.at_least {
                found.slower.push(cell);
            } else if of.value < LISTED {
                found.close.push(cell);
            }
        }
        found
    }

    /// A line of the list; empty when we are ahead everywhere.
    fn line(&self) -> String {
        let part =
            |words: &str, scenes: &[String]| (!scenes.is_empty()).then(|| format!("{words} {}", scenes.join(", ")));
        let parts = [part("slower in", &self.slower), part("less than twice as fast in", &self.close)];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        if parts.is_empty() { String::new() } else { format!("- {}: {}.\n", self.what, parts.join("; ")) }
    }
}

/// Every comparison of the tables.
fn comparisons(results: &Results<'_>) -> Vec<Behind> {
    let mut all = Vec::new();
    for (choice, how) in [(Choice::Stated, "stated"), (Choice::Hindsight, "by hindsight")] {
        for (quantity, level) in levels() {
            for reading in Reading::ALL.into_iter().filter(|reading| reading.applies_to(quantity)) {
                let asked = Asked { quantity, level, choice };
                let what = format!("{} to {}, {how}, beside {}", quantity.name(), percent(level), reading.peers());
                let scenes = results.scenes().into_iter();
                all.push(Behind::of(what, scenes.map(|scene| (scene, results.compare(scene, asked, reading)))));
            }
        }
    }
    for (name, pick) in [("adaptive, `love`", 0), ("uniform, `spectral`", 1)] {
        let cells: Vec<(String, f64)> = EQUAL_MESHES
            .into_iter()
            .flat_map(|scene| equal_ratios(results, scene))
            .filter_map(|(cell, ratios)| Some((cell, ratios[pick]?)))
            .collect();
        let cells = cells
            .iter()
            .map(|(cell, value)| (cell.as_str(), Comparison::Ratio(Ratio { value: *value, at_least: false })));
        all.push(Behind::of(format!("equal meshes, {name}"), cells));
    }
    all
}

/// Every comparison in which a peer is faster, or takes less than twice our time.
pub(super) fn list(results: &Results<'_>) -> String {
    let lines: String = comparisons(results).iter().map(Behind::line).collect();
    if lines.is_empty() { "In every comparison a peer takes at least twice our time.\n".to_owned() } else { lines }
}

/// Number of comparisons, number with a faster peer, and number with a close peer.
///
/// A peer is faster when it takes less time than we do. It is close when it takes less than twice our time.
fn counts(all: &[Behind]) -> [usize; 3] {
    let count = |of: fn(&Behind) -> usize| all.iter().map(of).sum::<usize>();
    [count(|b| b.n_compared), count(|b| b.slower.len()), count(|b| b.close.len())]
}

/// The counts in one sentence.
pub(super) fn count(results: &Results<'_>) -> String {
    let [n, slower, close] = counts(&comparisons(results));
    format!(
        "[Benchmarks](docs/benchmarks.md#where-rc-is-not-ahead) has {n} comparisons, also with other errors and on equal meshes. \
         In {slower} of them, the fastest peer is faster than rc. In {close} more, it takes less than twice our time.\n"
    )
}

/// The counts, and the kinds of comparisons that we lose most often.
pub(super) fn summary(results: &Results<'_>) -> String {
    let all = comparisons(results);
    let [n, slower, close] = counts(&all);
    let mut worst: Vec<&Behind> = all.iter().filter(|behind| !behind.slower.is_empty()).collect();
    worst.sort_by_key(|behind| std::cmp::Reverse(behind.slower.len()));
    let kind = |b: &&Behind| format!("- {}: {} of {}", b.what, b.slower.len(), b.n_compared);
    let kinds: Vec<String> = worst.iter().take(KINDS).map(kind).collect();
    let most = if kinds.is_empty() {
        String::new()
    } else {
        format!(" It is faster most often in these:\n\n{}", kinds.join("\n"))
    };
    format!(
        "Each combination of an error, a scene or mesh, and a way to read the peers' results is one comparison. In {slower} of {n} comparisons the \
         fastest peer is faster. In {close} more it takes less than twice our time.{most}\n"
    )
}

/// Number of kinds of comparisons that the summary names.
const KINDS: usize = 3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::levels::tests::rows;
    use crate::bench::reference::tests::references;

    #[test]
    fn comparisons_that_are_lost_are_listed_and_counted() {
        let (mut rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let listed = |rows: &[_]| list(&Results { rows, references: &references });
        // Only lines of areas are looked at. The peer's pressures and gaps are the same on both meshes, so only the
        // peer states an error of them, which is zero.
        let slower = |text: &str| text.lines().any(|line| line.starts_with("- area") && line.contains("slower"));
        assert!(!slower(&listed(&rows)), "{}", listed(&rows));
        // The peer takes 0.5 s, we take 0.75 s, and the peer's area is right.
        (rows[3].seconds, rows[3].area_counted, rows[4].area_counted) = (0.5, 0.0705, 0.0701);
        let text = listed(&rows);
        let expected = "- area to 1 %, by hindsight, beside peers as they report: slower in paper (0.1).";
        assert!(text.contains(expected), "{text}");
        let summary = summary(&Results { rows: &rows, references: &references });
        assert!(summary.contains("fastest peer is faster.") && summary.contains("\n- rms pressure to"), "{summary}");
    }

    #[test]
    fn a_bound_below_one_is_close_and_a_peer_alone_is_faster() {
        let at_least = |value| Comparison::Ratio(Ratio { value, at_least: true });
        let cases = [
            ("a", at_least(0.9)),
            ("b", at_least(2.1)),
            ("c", Comparison::PeerAlone { holds: true }),
            ("d", Comparison::Nothing),
        ];
        let behind = Behind::of("x".to_owned(), cases.into_iter());
        assert_eq!(behind.line(), "- x: slower in c (a peer alone); less than twice as fast in a (> 0.9).\n");
        assert_eq!(behind.n_compared, 3);
        let wrong = [("a", Comparison::PeerAlone { holds: false })];
        let text = Behind::of("x".to_owned(), wrong.into_iter()).line();
        assert_eq!(text, "- x: slower in a (a peer alone, what the peer states is wrong).\n");
    }
}
