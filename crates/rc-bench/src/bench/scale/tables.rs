//! The tables of large grids, as Markdown.

use super::row::{Part, ScaleRow};
use crate::bench::record::{OURS, Spread};
use crate::bench::tables::{NONE, megabytes, percent, spread, time};

fn times(row: &ScaleRow) -> String {
    let times = spread(Spread { median: row.seconds, min: row.seconds_min, max: row.seconds_max });
    // A single solve is not a median.
    if row.repeats > 1 { times } else { format!("{times} (once)") }
}

/// Our lines of grids of several sizes, with all threads.
fn ours(rows: &[ScaleRow]) -> impl Iterator<Item = &ScaleRow> {
    let of_grids = rows.iter().filter(|row| row.part == Part::Grids && row.program == OURS);
    of_grids.filter(|row| rows.iter().all(|other| other.side != row.side || other.threads <= row.threads))
}

fn peer<'a>(rows: &'a [ScaleRow], beside: &ScaleRow) -> Option<&'a ScaleRow> {
    rows.iter().find(|row| row.part == Part::Grids && row.side == beside.side && row.program != OURS)
}

/// Table of large grids, with the peer's times where it ran.
pub(in crate::bench) fn grids(rows: &[ScaleRow]) -> String {
    let head = "| N, grid | iterations | applications of L | elements evaluated | time | memory | ASPHER: time | memory | its time / ours |\n\
                |---|---|---|---|---|---|---|---|---|\n";
    let line = |row: &ScaleRow| {
        let count = |count: Option<u64>| count.map_or_else(|| NONE.to_owned(), |count| count.to_string());
        let evaluated = row.cells_evaluated.map_or_else(|| NONE.to_owned(), |part| format!("{:.0} %", 100.0 * part));
        let peer = peer(rows, row).map_or_else(
            || format!("{NONE} | {NONE} | {NONE}"),
            |peer| format!("{} | {} | {:.1}", times(peer), megabytes(peer.memory_mb), peer.seconds / row.seconds),
        );
        let (iterations, applications) = (count(row.iterations), count(row.applications));
        let (waves, side, memory) = (row.waves, row.side, megabytes(row.memory_mb));
        format!(
            "| {waves}, {side}² | {iterations} | {applications} | {evaluated} | {} | {memory} | {peer} |\n",
            times(row)
        )
    };
    head.to_owned() + &ours(rows).map(line).collect::<String>()
}

/// A sentence about the paper's larger surface; `None` when it was not run.
pub(in crate::bench) fn sentence(rows: &[ScaleRow]) -> Option<String> {
    let row = ours(rows).find(|row| row.waves == 128)?;
    let (side, memory, threads) = (row.side, megabytes(row.memory_mb), row.threads);
    Some(format!(
        "The paper's larger surface (shortest wave λ/128, {side} x {side} elements) takes {} and {memory} on {threads} threads. It was solved \
         by the adaptive method, with `--tolerance {}`.\n",
        time(row.seconds),
        row.tolerance
    ))
}

/// Table of times by number of threads.
pub(in crate::bench) fn threads(rows: &[ScaleRow]) -> String {
    let head = "| N, grid | threads | time | speed-up |\n|---|---|---|---|\n";
    let of_grids = rows.iter().filter(|row| row.part == Part::Grids && row.program == OURS);
    let line = |row: &ScaleRow| {
        let is_one = |one: &&ScaleRow| {
            one.part == Part::Grids && one.side == row.side && one.program == OURS && one.threads == 1
        };
        let one = rows.iter().find(is_one)?;
        let ScaleRow { waves, side, threads, .. } = row;
        Some(format!("| {waves}, {side}² | {threads} | {} | {:.2} |\n", times(row), one.seconds / row.seconds))
    };
    head.to_owned() + &of_grids.filter_map(line).collect::<String>()
}

/// Table of times of both methods by the area in contact.
pub(in crate::bench) fn contact(rows: &[ScaleRow]) -> String {
    let of = |method: &'static str| rows.iter().filter(move |row| row.part == Part::Contact && row.method == method);
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let line = |name: &str, cell: &dyn Fn(&ScaleRow) -> String, method| {
        row([name.to_owned()].into_iter().chain(of(method).map(cell)).collect())
    };
    let head = line("contact (counted)", &|row| percent(row.area_counted), "adaptive");
    let ruler = row(of("adaptive").map(|_| "---".to_owned()).chain(["---".to_owned()]).collect());
    head + &ruler + &line("adaptive", &times, "adaptive") + &line("uniform", &times, "uniform")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::scale::tests::rows;

    #[test]
    fn tables_have_ours_with_all_threads_beside_the_peer() {
        let table = grids(&rows());
        let expected =
            "| 128, 4096² | 14 | 24 | 18 % | 2 s (1.8 s to 2.4 s) | 53 MB | 60 s (54 s to 72 s) | 53 MB | 30.0 |";
        assert!(table.contains(expected) && table.lines().count() == 4, "{table}");
        assert!(table.contains("| 512, 16384² |") && table.contains("| \u{2013} | \u{2013} | \u{2013} |"), "{table}");
        let sentence = sentence(&rows()).expect("N = 128");
        assert!(sentence.contains("4096 x 4096 elements) takes 2 s and 53 MB on 2 threads"), "{sentence}");
        assert_eq!(super::sentence(&rows()[3..]), None);
    }

    #[test]
    fn threads_and_loads_have_their_tables() {
        let table = threads(&rows());
        assert!(table.contains("| 128, 4096² | 2 | 2 s (1.8 s to 2.4 s) | 1.50 |"), "{table}");
        assert!(!table.contains("16384"), "without one thread there is no speed-up: {table}");
        let mut rows = rows();
        let table = contact(&rows);
        assert_eq!(table.lines().next(), Some("| contact (counted) | 7 % |"), "{table}");
        assert!(table.contains("| uniform | 250 ms (450 ms to 600 ms) |"), "{table}");
        rows[4].repeats = 1;
        assert!(contact(&rows).contains("(once)"));
    }
}
