//! The tables in README.md and the guide, made from the files in `data/bench/`.

use anyhow::{Context, Result, bail};
use rc_figures::blocks;
use rc_figures::repository::Sources;

use super::record::{Row, from_csv};
use super::reference::{REFERENCE, References};
use super::scale::ScaleRow;
use super::tables::{contact, equal_meshes, grids, machine, sentence, spreads, times};
use super::times::Results;

/// The documents that have blocks of the benchmark.
const DOCUMENTS: [&str; 4] = ["README.md", "docs/benchmarks.md", "docs/faq.md", "docs/adaptive-mesh.md"];
/// The lines of the archived run.
pub(super) const BENCH: &str = "data/bench/bench.csv";
/// Description of the machine of the archived run.
pub(super) const MACHINE: &str = "data/bench/bench.toml";
/// The archived run of large grids: its lines, and below a description of its machine.
pub(super) const SCALE: &str = "data/bench/scale.csv";
pub(super) const SCALE_MACHINE: &str = "data/bench/scale.toml";

/// The names of the blocks.
const BLOCKS: [&str; 7] =
    ["bench-times", "bench-equal", "bench-machine", "scale-grids", "scale-contact", "scale-sentence", "scale-machine"];

/// Rewrites the tables in the documents.
///
/// # Errors
/// When a file is missing or not as expected.
pub(super) fn update() -> Result<()> {
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
    blocks::fill(document, sources, |name| block(name, sources).map_err(|error| format!("{error:#}")))
        .map_err(|error| format!("{document}: {error}"))
}

fn block(name: &str, sources: &Sources) -> Result<String> {
    let source = |path: &str| {
        let text = sources.get(path).map(String::as_str);
        text.with_context(|| format!("{path} is missing; `cargo xtask bench --peers --archive` makes it"))
    };
    let references = References::from_text(source(REFERENCE)?)?;
    let rows: Vec<Row> = from_csv(source(BENCH)?, BENCH)?;
    let scale: Vec<ScaleRow> = from_csv(source(SCALE)?, SCALE)?;
    let results = Results { rows: &rows, references: &references };
    Ok(match name {
        "bench-times" => times(&results),
        "bench-equal" => equal_meshes(&results),
        "bench-machine" => machine(&source(MACHINE)?.parse()?) + "\n" + &spreads(&results),
        "scale-grids" => grids(&scale),
        "scale-contact" => contact(&scale),
        "scale-sentence" => sentence(&scale).unwrap_or_default(),
        "scale-machine" => machine(&source(SCALE_MACHINE)?.parse()?),
        _ => bail!("no numbers are called `{name}`; there are {}", BLOCKS.join(", ")),
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use rc_figures::blocks::{BEGIN, END};
    use rc_figures::repository;

    use super::*;
    use crate::bench::record::tests::rows;
    use crate::bench::record::to_csv;
    use crate::bench::scale::tests::rows as scale_rows;

    /// Every block in each document, and the archived files.
    fn sources() -> Sources {
        let blocks: Vec<String> =
            BLOCKS.iter().map(|name| format!("before {BEGIN}{name} -->stale{END} after")).collect();
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
        let unknown = format!("{BEGIN}scale-nothing -->{END}");
        let readme = sources.insert("README.md".to_owned(), unknown).expect("a document");
        assert!(check(&sources)[0].contains("`scale-nothing`"), "{:?}", check(&sources));
        sources.insert("README.md".to_owned(), readme);
        sources.remove(BENCH);
        assert!(check(&sources)[0].contains("--archive"));
    }
}
