//! The tables in README.md and docs/benchmarks.md, from `data/bench/`.

use std::fs;

use anyhow::{Context, Result};
use rc_core::quantity::digits;
use rc_figures::blocks;
use rc_figures::repository::{self, Sources};
use toml::Table as Toml;

use super::levels::{LEVELS, Ratio, Results};
use super::record::{Row, from_csv};
use super::reference::{Quantity, REFERENCE, Reading, References};
use super::scenes::{SCENES, Scene};

/// The documents with blocks of ours.
const DOCUMENTS: [&str; 2] = ["README.md", "docs/benchmarks.md"];
/// The lines of the archived run.
pub(super) const BENCH: &str = "data/bench/bench.csv";
/// Its machine.
pub(super) const MACHINE: &str = "data/bench/bench.toml";

/// Rewrites the tables in the documents.
///
/// # Errors
/// When a file is missing or not as expected.
pub fn update() -> Result<()> {
    let sources = repository::read_sources(&repository::root())?;
    for document in DOCUMENTS {
        let text = render(document, &sources).map_err(anyhow::Error::msg)?;
        let path = repository::root().join(document);
        fs::write(&path, text).with_context(|| format!("could not write {}", path.display()))?;
    }
    Ok(())
}

/// Complains when a document has other numbers than the archived run.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let complaint = |document: &str| match render(document, sources) {
        Ok(text) if sources.get(document) == Some(&text) => None,
        Ok(_) => Some(format!("{document} has other numbers than {BENCH}; run `cargo xtask bench --tables`")),
        Err(complaint) => Some(complaint),
    };
    DOCUMENTS.into_iter().filter_map(complaint).collect()
}

/// A document with its blocks filled in.
fn render(document: &str, sources: &Sources) -> Result<String, String> {
    let source = |path: &str| {
        let text = sources.get(path).map(String::as_str);
        text.ok_or_else(|| format!("{path} is missing; `cargo xtask bench --archive` makes it"))
    };
    blocks::fill(document, sources, |name| {
        let rows: Vec<Row> = from_csv(source(BENCH)?, BENCH).map_err(|error| format!("{error:#}"))?;
        let references = References::from_text(source(REFERENCE)?).map_err(|error| format!("{error:#}"))?;
        let results = Results { rows: &rows, references: &references };
        match name {
            "bench" => Ok(times(&results)),
            "bench-machine" => machine(source(MACHINE)?),
            "bench-scenes" => scenes(&references),
            "bench-scene" => Ok(scene(&results, SCENES[0].name)),
            "bench-equal" => {
                Ok(EQUAL_HEAD.to_owned() + &EQUAL_MESHES.map(|scene| equal_meshes(&results, scene)).concat())
            }
            _ => Err(format!(
                "{document}: no numbers are called `{name}`; there are bench, bench-equal, bench-machine, bench-scenes, bench-scene"
            )),
        }
    })
}

/// Scenes of the table of equal meshes, and its tolerance.
const EQUAL_MESHES: [&str; 3] = ["paper", "waves-128", "heavy"];
const EQUAL_TOLERANCE: &str = "1e-6";
const EQUAL_HEAD: &str = "| scene, elements | fastest peer | its time, memory | over ours: adaptive, `love`; memory | \
                          uniform, `spectral`; memory |\n|---|---|---|---|---|\n";

/// In a table, where there is nothing.
const NONE: &str = "\u{2013}";

/// An error level, as people write it.
fn percent(level: f64) -> String {
    format!("{} %", digits(100.0 * level, 3))
}

fn milliseconds(seconds: f64) -> String {
    if seconds < 1.0 { format!("{} ms", digits(1e3 * seconds, 3)) } else { format!("{} s", digits(seconds, 3)) }
}

fn ratio(ratio: Ratio) -> String {
    let sign = if ratio.at_least { "> " } else { "" };
    // One digit behind the point only where it decides who is faster.
    let digits = usize::from(ratio.value < 9.95);
    format!("{sign}{:.digits$}", ratio.value)
}

/// Time to an error, ours and the fastest peer's, over all scenes.
pub(super) fn times(results: &Results<'_>) -> String {
    let head = "| error below | rc, median (scenes) | fastest peer's time over ours, as it reports: median, least | with its \
                area corrected by hand: median, least |\n|---|---|---|---|\n";
    let n_scenes = results.scenes().len();
    let line = |(quantity, level): (Quantity, f64)| {
        let (seconds, n) = results.our_time(quantity, level);
        let ours = if n > 0 { milliseconds(seconds) } else { NONE.to_owned() };
        let cell = |reading| {
            let ratios = results.ratios(quantity, reading, level);
            ratios.map_or_else(|| NONE.to_owned(), |[least, median]| format!("{}, {}", ratio(median), ratio(least)))
        };
        // Only areas are counted.
        let corrected = if quantity == Quantity::Area { cell(Reading::Best) } else { String::new() };
        let as_reported = cell(Reading::Counted);
        let (name, error) = (quantity.name(), percent(level));
        format!("| {name}, {error} | {ours} ({n} of {n_scenes}) | {as_reported} | {corrected} |\n")
    };
    head.to_owned() + &levels().map(line).collect::<String>()
}

/// Every error that is asked for.
fn levels() -> impl Iterator<Item = (Quantity, f64)> {
    LEVELS.into_iter().flat_map(|(quantity, levels)| levels.iter().map(move |&level| (quantity, level)))
}

/// What is solved, and the reference values.
fn scenes(references: &References) -> Result<String, String> {
    let head = "| scene | N | H | seed | σ0/E* | A/A0 | rms pressure / E* | Δ/λ |\n|---|---|---|---|---|---|---|---|\n";
    let line = |scene: &Scene| {
        let value = |quantity| {
            let row = references.row(scene.name, quantity);
            let row = row.ok_or_else(|| format!("{REFERENCE} has no {} of {}", quantity.name(), scene.name))?;
            Ok(format!("{} ± {}", digits(row.value, 7), digits(row.uncertainty, 1)))
        };
        let values = Quantity::COMPARED.into_iter().map(value).collect::<Result<Vec<_>, String>>()?.join(" | ");
        let Scene { name, waves, hurst, seed, load } = scene;
        Ok(format!("| {name} | {waves} | {hurst} | {seed} | {load:e} | {values} |\n"))
    };
    Ok(head.to_owned() + &SCENES.iter().map(line).collect::<Result<String, String>>()?)
}

/// Which setting reaches an error in which time, for one scene; for peers the same.
fn scene(results: &Results<'_>, scene: &str) -> String {
    let head = "| error below | rc | time | fastest peer, as it reports | time | corrected by hand | time |\n\
                |---|---|---|---|---|---|---|\n";
    let line = |(quantity, level): (Quantity, f64)| {
        let cells = |ours, reading| {
            let row = results.fastest(results.of(scene, ours), (quantity, reading), level);
            let found = |row| format!("{} | {}", setting(row), milliseconds(row.total_seconds()));
            row.map_or_else(|| "not reached | ".to_owned(), found)
        };
        let corrected = if quantity == Quantity::Area { cells(false, Reading::Best) } else { " | ".to_owned() };
        let (ours, as_reported) = (cells(true, Reading::Best), cells(false, Reading::Counted));
        format!("| {}, {} | {ours} | {as_reported} | {corrected} |\n", quantity.name(), percent(level))
    };
    head.to_owned() + &levels().map(line).collect::<String>()
}

/// Our time beside the fastest peer's on the same mesh, both certified to the same tolerance.
fn equal_meshes(results: &Results<'_>, scene: &str) -> String {
    let same = |row: &&Row| row.tolerance == EQUAL_TOLERANCE && row.border_level == 0;
    let line = |peer: &Row| {
        let ours = |method: &str, kernel: &str| {
            let row = results.of(scene, true).filter(same).find(|row| {
                row.elements_per_wave == peer.elements_per_wave && row.method == method && row.kernel == kernel
            });
            let cell = |row: &Row| format!("{:.1}, {}", peer.seconds / row.total_seconds(), memory(row));
            row.map_or_else(|| NONE.to_owned(), cell)
        };
        let (adaptive, uniform) = (ours("adaptive", "love"), ours("uniform", "spectral"));
        let Row { elements_per_wave, program, seconds, .. } = peer;
        let (time, memory) = (milliseconds(*seconds), memory(peer));
        format!("| {scene}, λ_min/{elements_per_wave} | {program} | {time}, {memory} | {adaptive} | {uniform} |\n")
    };
    // Fastest first, of which each mesh keeps one.
    let mut peers: Vec<&Row> = results.of(scene, false).filter(same).collect();
    peers.sort_by(|a, b| a.elements_per_wave.cmp(&b.elements_per_wave).then(a.seconds.total_cmp(&b.seconds)));
    peers.dedup_by_key(|row| row.elements_per_wave);
    peers.into_iter().map(line).collect()
}

fn memory(row: &Row) -> String {
    row.memory_mb.map_or_else(|| NONE.to_owned(), |memory| format!("{memory:.0} MB"))
}

/// How a line was made.
fn setting(row: &Row) -> String {
    let Row { program, method, kernel, border_level, elements_per_wave, tolerance, .. } = row;
    let how = match (program.as_str(), *border_level) {
        ("rc", 0) => format!("{method}, {kernel}"),
        ("rc", level) => format!("{method}, border level {level}"),
        (peer, _) => peer.to_owned(),
    };
    format!("{how}, λ_min/{elements_per_wave}, {tolerance}")
}

/// One line about the machine and the programs.
fn machine(text: &str) -> Result<String, String> {
    let run: Toml = text.parse().map_err(|error| format!("{MACHINE}: {error}"))?;
    let cell = |key: &str| run.get(key).map_or_else(|| "?".to_owned(), |value| value.to_string().replace('"', ""));
    let peers = run.get("peers").and_then(toml::Value::as_table).into_iter().flatten();
    let peers: Vec<String> =
        peers.map(|(name, version)| format!("{name} {}", version.as_str().unwrap_or("?"))).collect();
    let against = if peers.is_empty() { "no peers".to_owned() } else { peers.join(", ") };
    Ok(format!(
        "rc {} ({}), {}; {}, {} threads, {}; {} s in all.\n",
        cell("version"),
        cell("compiler"),
        against,
        cell("processor"),
        cell("threads"),
        cell("system"),
        cell("seconds")
    ))
}

#[cfg(test)]
mod tests {
    use rc_figures::blocks::{BEGIN, END};

    use super::*;
    use crate::bench::levels::tests::rows;
    use crate::bench::record::to_csv;
    use crate::bench::reference::tests::references;

    #[test]
    fn bounds_are_marked_and_levels_that_are_not_reached_too() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let results = Results { rows: &rows, references: &references };
        let table = times(&results);
        assert!(table.contains("| area, 3 % | 750 ms (1 of 1) | 120, 120 |"), "{table}");
        assert!(table.contains("| area, 1 % | 4.25 s (1 of 1) | > 21, > 21 |"), "{table}");
        assert!(table.contains("| area, 0.1 % | \u{2013} (0 of 1) | \u{2013} |"), "{table}");
        let mut rows = results.rows.to_vec();
        for row in &mut rows {
            row.tolerance = EQUAL_TOLERANCE.to_owned();
        }
        // A slower peer on one of the meshes is not shown.
        let slower = Row { program: "slower".to_owned(), seconds: 31.0, ..rows[3].clone() };
        rows.insert(3, slower);
        let table = equal_meshes(&Results { rows: &rows, references: &references }, "paper");
        assert_eq!(table.lines().count(), 2, "{table}");
        assert!(table.starts_with("| paper, λ_min/4 | tamaas | 30 s") && !table.contains("slower"), "{table}");
        let table = scene(&results, "paper");
        assert!(table.contains("| area, 1 % | adaptive, love, λ_min/16, auto | 4.25 s | not reached |"), "{table}");
    }

    #[test]
    fn documents_are_compared_with_the_archived_run() {
        let bench = to_csv(&rows()).expect("plain values");
        let document = format!("before {BEGIN}bench -->stale{END} after {BEGIN}bench-machine -->{END}");
        let reference = fs::read_to_string(repository::root().join(REFERENCE)).expect("the references");
        let machine = "version = \"0.1.0\"\nthreads = 2\n[peers]\ntamaas = \"2.9.0\"\n";
        let files = [(BENCH, bench.as_str()), (MACHINE, machine), (REFERENCE, &reference)];
        let files = files.into_iter().chain(DOCUMENTS.map(|path| (path, document.as_str())));
        let mut sources: Sources = files.map(|(path, text)| (path.to_owned(), text.to_owned())).collect();
        assert_eq!(check(&sources).len(), 2);
        for path in DOCUMENTS {
            let text = render(path, &sources).expect("all files are there");
            assert!(text.contains("tamaas 2.9.0") && text.contains("error below"), "{text}");
            sources.insert(path.to_owned(), text);
        }
        assert_eq!(check(&sources), Vec::<String>::new());
        sources.remove(BENCH);
        assert!(check(&sources)[0].contains("--archive"));
    }
}
