//! The tables in README.md and the guide, made from the files in `data/bench/`.

use anyhow::Result;
use rc_figures::blocks;
use rc_figures::repository::Sources;
use toml::Table as Toml;

use super::behind;
use super::levels::{Choice, Results};
use super::record::{Row, from_csv};
use super::reference::{REFERENCE, References};
use super::scale::row::ScaleRow;
use super::scale::tables as scale;
use super::scenes::SCENES;
use super::tables::{EQUAL_MESHES, equal_meshes, scene, scenes, short, spreads, statements, times};

/// The documents that have blocks of the benchmark.
const DOCUMENTS: [&str; 4] = ["README.md", "docs/benchmarks.md", "docs/faq.md", "docs/adaptive-mesh.md"];
/// The lines of the archived run.
pub(super) const BENCH: &str = "data/bench/bench.csv";
/// Description of the machine of the archived run.
pub(super) const MACHINE: &str = "data/bench/bench.toml";
/// The archived run of large grids: its lines, and below a description of its machine.
pub(super) const SCALE: &str = "data/bench/scale.csv";
pub(super) const SCALE_MACHINE: &str = "data/bench/scale.toml";

/// Rewrites the tables in the documents.
///
/// # Errors
/// When a file is missing or not as expected.
pub fn update() -> Result<()> {
    blocks::rewrite(DOCUMENTS, render)
}

/// Complaints about documents whose numbers differ from the archived run.
#[must_use]
pub fn check(sources: &Sources) -> Vec<String> {
    let cure = format!("{BENCH}; run `cargo xtask bench --tables`");
    let complaint = |document: &str| blocks::complaint(document, sources, render(document, sources), &cure);
    DOCUMENTS.into_iter().filter_map(complaint).collect()
}

/// A document with its blocks filled in.
fn render(document: &str, sources: &Sources) -> Result<String, String> {
    blocks::fill(document, sources, |name| match name.strip_prefix("scale-") {
        Some(name) => scale_block(name, sources),
        None => bench_block(name, sources),
    })
    .map_err(|error| format!("{document}: {error}"))
}

fn source<'a>(sources: &'a Sources, path: &str, how: &str) -> Result<&'a str, String> {
    let text = sources.get(path).map(String::as_str);
    text.ok_or_else(|| format!("{path} is missing; `cargo xtask bench {how}` makes it"))
}

/// A block with numbers of the archived run.
fn bench_block(name: &str, sources: &Sources) -> Result<String, String> {
    let source = |path| source(sources, path, "--peers --archive");
    let rows: Vec<Row> = from_csv(source(BENCH)?, BENCH).map_err(|error| format!("{error:#}"))?;
    let references = References::from_text(source(REFERENCE)?).map_err(|error| format!("{error:#}"))?;
    let results = Results { rows: &rows, references: &references };
    let first = SCENES[0].name;
    match name {
        "bench-short" => Ok(short(&results)),
        "bench-stated" => Ok(times(&results, Choice::Stated)),
        "bench-hindsight" => Ok(times(&results, Choice::Hindsight)),
        "bench-statements" => Ok(statements(&results)),
        "bench-behind" => Ok(behind::list(&results)),
        "bench-behind-summary" => Ok(behind::summary(&results)),
        "bench-behind-count" => Ok(behind::count(&results)),
        "bench-machine" => Ok(format!("{}\n{}", machine(source(MACHINE)?, MACHINE)?, spreads(&results))),
        "bench-scenes" => scenes(&references),
        "bench-scene-stated" => Ok(scene(&results, first, Choice::Stated)),
        "bench-scene-hindsight" => Ok(scene(&results, first, Choice::Hindsight)),
        "bench-equal" => Ok(equal_meshes(&results, &EQUAL_MESHES)),
        _ => Err(format!("no numbers are called `{name}`; there are {BENCH_BLOCKS}")),
    }
}

/// A block with numbers of the archived run of large grids.
fn scale_block(name: &str, sources: &Sources) -> Result<String, String> {
    let source = |path| source(sources, path, "--scale --peers --archive");
    let rows: Vec<ScaleRow> = from_csv(source(SCALE)?, SCALE).map_err(|error| format!("{error:#}"))?;
    match name {
        "grids" => Ok(scale::grids(&rows)),
        "sentence" => scale::sentence(&rows).ok_or_else(|| format!("{SCALE} has no grid of N = 128")),
        "threads" => Ok(scale::threads(&rows)),
        "contact" => Ok(scale::contact(&rows)),
        "machine" => machine(source(SCALE_MACHINE)?, SCALE_MACHINE),
        _ => Err(format!("no numbers are called `scale-{name}`; there are {SCALE_BLOCKS}")),
    }
}

const BENCH_BLOCKS: &str = "bench-short, bench-stated, bench-hindsight, bench-statements, bench-behind, bench-behind-summary, \
                            bench-behind-count, bench-machine, bench-scenes, bench-scene-stated, bench-scene-hindsight, bench-equal";
const SCALE_BLOCKS: &str = "scale-grids, scale-sentence, scale-threads, scale-contact, scale-machine";

/// One line about the machine and the programs.
fn machine(text: &str, path: &str) -> Result<String, String> {
    let run: Toml = text.parse().map_err(|error| format!("{path}: {error}"))?;
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
    use std::fs;

    use rc_figures::blocks::{BEGIN, END};
    use rc_figures::repository;

    use super::*;
    use crate::bench::levels::tests::rows;
    use crate::bench::record::to_csv;
    use crate::bench::scale::tests::rows as scale_rows;

    /// Every block in each document, and the archived files.
    fn sources() -> Sources {
        let names = BENCH_BLOCKS.split(", ").chain(SCALE_BLOCKS.split(", "));
        let blocks: Vec<String> = names.map(|name| format!("before {BEGIN}{name} -->stale{END} after")).collect();
        let document = blocks.join("\n");
        let reference = fs::read_to_string(repository::root().join(REFERENCE)).expect("the references");
        let machine = "version = \"0.1.0\"\nthreads = 2\n[peers]\ntamaas = \"2.9.0\"\n".to_owned();
        let bench = to_csv(&rows()).expect("plain values");
        let scale = to_csv(&scale_rows()).expect("plain values");
        let files = [(BENCH, bench), (MACHINE, machine.clone()), (REFERENCE, reference), (SCALE, scale)];
        let files = files.into_iter().chain([(SCALE_MACHINE, machine)]);
        let files = files.chain(DOCUMENTS.map(|path| (path, document.clone())));
        files.map(|(path, text)| (path.to_owned(), text)).collect()
    }

    #[test]
    fn documents_are_compared_with_the_archived_run() {
        let mut sources = sources();
        assert_eq!(check(&sources).len(), DOCUMENTS.len());
        for path in DOCUMENTS {
            let text = render(path, &sources).expect("all files are there");
            assert!(text.contains("tamaas 2.9.0") && text.contains("error below"), "{text}");
            sources.insert(path.to_owned(), text);
        }
        assert_eq!(check(&sources), Vec::<String>::new());
        sources.remove(BENCH);
        assert!(check(&sources)[0].contains("--archive"));
    }

    #[test]
    fn an_unknown_block_is_named() {
        let mut sources = sources();
        sources.insert("README.md".to_owned(), format!("{BEGIN}scale-nothing -->{END}"));
        assert!(check(&sources)[0].contains("`scale-nothing`"), "{:?}", check(&sources));
    }
}
