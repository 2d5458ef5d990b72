//! The tables in README.md and the guide, made from the files in `data/bench/`.

use anyhow::{Context, Result, bail};
use rc_figures::blocks;
use rc_figures::repository::Sources;

use super::record::{Row, from_csv};
use super::reference::{REFERENCE, References};
use super::scale::ScaleRow;
use super::steps::{STEPS, archived};
use super::tables::{equal_meshes, grids, machine, sentence, spreads, times};
use super::times::Results;

/// The documents that have blocks of the benchmark.
const DOCUMENTS: [&str; 3] = ["README.md", "docs/benchmarks.md", "docs/faq.md"];
/// The lines of the archived run.
pub(super) const BENCH: &str = "data/bench/bench.csv";
/// Description of the machine of the archived run.
pub(super) const MACHINE: &str = "data/bench/bench.toml";
/// The archived run of large grids: its lines, and below a description of its machine.
pub(super) const SCALE: &str = "data/bench/scale.csv";
pub(super) const SCALE_MACHINE: &str = "data/bench/scale.toml";

/// The names of the blocks.
const BLOCKS: [&str; 7] =
    ["bench-times", "bench-equal", "bench-machine", "bench-steps", "scale-grids", "scale-sentence", "scale-machine"];

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
        "bench-steps" => archived(source(STEPS)?)?,
        "scale-grids" => grids(&scale),
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
    use crate::bench::peers::{ASPHER, PEERS};
    use crate::bench::readings::Reading;
    use crate::bench::record::tests::rows;
    use crate::bench::record::{OURS, to_csv};
    use crate::bench::reference::Quantity;
    use crate::bench::scale::tests::rows as scale_rows;
    use crate::bench::tables::EQUAL_MESHES;
    use crate::bench::times::LEVELS;

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
        let steps = "side,method,step,part,seconds,memory_seconds\n256,uniform,heights,0.1,0.02,\n".to_owned();
        let files = files.into_iter().chain([(SCALE_MACHINE, machine), (STEPS, steps)]);
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

    /// The statements of "Where rc is not ahead" in docs/benchmarks.md, and the numbers of docs/paper/paper.md.
    #[test]
    fn the_archived_run_bears_the_statements_of_the_documents() {
        let sources = repository::read_sources(&repository::root()).expect("the repository");
        let references = References::from_text(&sources[REFERENCE]).expect("the references");
        let rows: Vec<Row> = from_csv(&sources[BENCH], BENCH).expect("the archived run");
        let results = Results { rows: &rows, references: &references };
        // Of the fastest peer.
        let ratio = |asked| {
            let ratios = PEERS.into_iter().filter_map(|kind| results.peer(kind.name, asked).1);
            ratios.map(|ratio| ratio.value).reduce(f64::min).unwrap_or(f64::NAN)
        };
        // What rc states hardly sooner.
        let loose = (Quantity::Area, 3e-3);
        assert!(LEVELS.into_iter().all(|asked| ratio(asked) > 1.0), "a peer is ahead");
        let hardly: Vec<_> = LEVELS.into_iter().filter(|&asked| ratio(asked) < 1.3).collect();
        assert_eq!(hardly, [loose]);
        let aspher = results.peer(ASPHER.name, loose).0;
        assert_eq!((aspher.reading, aspher.n - aspher.n_true), (Reading::Published, 9));
        // Equal meshes.
        let ahead = |method, kernel| {
            let meshes = ["paper", "heavy"].into_iter().flat_map(|scene| EQUAL_MESHES.map(|mesh| (scene, mesh)));
            let is_ahead = |&(scene, mesh): &(&str, f64)| {
                let of = |program, method, kernel| results.on_mesh(scene, (program, method, kernel, 0, "1e-6"), mesh);
                let ours_and_theirs = of(OURS, method, kernel).zip(of(ASPHER.name, "uniform", "spectral"));
                ours_and_theirs.is_some_and(|(ours, theirs)| theirs < ours)
            };
            meshes.filter(is_ahead).collect::<Vec<_>>()
        };
        assert_eq!(ahead("adaptive", "love"), [("heavy", 8.0)]);
        assert_eq!(ahead("uniform", "spectral"), []);
        // The paper.
        let paper = sources["docs/paper/paper.md"].split_whitespace().collect::<Vec<_>>().join(" ");
        let area = (Quantity::Area, 1e-3);
        let [gap, pressure] = [Quantity::MeanGap, Quantity::RmsPressure].map(|quantity| ratio((quantity, 1e-3)));
        for sentence in [
            format!("over ten problems is {:.0} ms", 1e3 * results.ours(area).seconds),
            format!("needs {:.1} times as long", ratio(area)),
            format!("these ratios are {gap:.1} and {pressure:.1}"),
        ] {
            assert!(paper.contains(&sentence), "docs/paper/paper.md does not say '{sentence}'");
        }
    }
}
