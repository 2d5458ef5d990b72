//! The tables of the benchmark, as Markdown.

use rc_figures::numeric::median;
use toml::Table as Toml;

use super::markdown::{cell, megabytes, percent, spread, table, time};
use super::peers::PEERS;
use super::record::{OURS, Spread};
use super::scale::{Part, ScaleRow};
use super::scenes::{SCENES, Scene};
use super::times::{Asked, LEVELS, Ratio, Reached, Results};

/// Table of times to a stated error: ours, and each peer's with its ratio to ours.
pub(super) fn times(results: &Results<'_>) -> String {
    let mut head = vec!["stated error below".to_owned(), "rc".to_owned()];
    head.extend(PEERS.into_iter().flat_map(|kind| [kind.title.to_owned(), "ratio".to_owned()]));
    let reached = |of: Reached, how: &str| {
        let seconds = cell(of.seconds.is_finite().then_some(of.seconds), time);
        if of.n > 0 { format!("{seconds}{how} ({}, {})", of.n, of.n_true) } else { cell(None, time) }
    };
    let line = |asked: Asked| {
        let ours = results.ours(asked);
        let mut cells = vec![format!("{}, {}", asked.0.name(), percent(asked.1)), reached(ours, "")];
        for kind in PEERS {
            let (peer, to_ours) = results.peer(kind.name, asked);
            cells.extend([reached(peer, &format!(" {}", peer.reading.letter())), cell(to_ours, ratio)]);
        }
        cells
    };
    table(&head, LEVELS.map(line))
}

fn ratio(Ratio { value, is_bound }: Ratio) -> String {
    let sign = if is_bound { "> " } else { "" };
    // Ratios near 1 have more digits, since these decide who is faster.
    let digits = match value {
        0.95..1.05 => 2,
        ..9.95 => 1,
        _ => 0,
    };
    format!("{sign}{value:.digits$}")
}

/// The scenes of the table of equal meshes: the paper's, and the one with most contact.
const EQUAL_SCENES: [Scene; 2] = [SCENES[0], SCENES[5]];

/// Its meshes.
pub(super) const EQUAL_MESHES: [f64; 4] = [4.0, 8.0, 16.0, 32.0];

/// Table of times on equal meshes, to the tolerance that all but one certify.
pub(super) fn equal_meshes(results: &Results<'_>) -> String {
    let families = [(OURS, "uniform", "spectral"), (OURS, "adaptive", "love")]
        .into_iter()
        .chain(PEERS.map(|kind| (kind.name, "uniform", "spectral")));
    let line = |(scene, mesh): (Scene, f64)| {
        let times = families.clone().map(|(program, method, kernel)| {
            let of = |tolerance| results.on_mesh(scene.name, (program, method, kernel, 0, tolerance), mesh);
            cell(of("1e-6").or_else(|| of("default")), time)
        });
        [format!("{}, λ_min/{mesh}, {}²", scene.name, scene.side(mesh))].into_iter().chain(times).collect()
    };
    let titles = ["scene, mesh, grid", "rc, uniform", "rc, adaptive"].into_iter().chain(PEERS.map(|kind| kind.title));
    let scenes = EQUAL_SCENES.into_iter().filter(|scene| results.scenes().contains(&scene.name));
    let meshes = scenes.flat_map(|scene| EQUAL_MESHES.map(|mesh| (scene, mesh)));
    table(&titles.collect::<Vec<_>>(), meshes.map(line))
}

/// A sentence about the spread of the times of a case.
pub(super) fn spreads(results: &Results<'_>) -> String {
    let rows = results.rows.iter().filter(|row| row.repeats > 1);
    let Some(most) = rows.clone().map(|row| row.repeats).max() else {
        return "Each case was solved once.\n".to_owned();
    };
    let spread = median(rows.map(|row| (row.seconds_max - row.seconds_min) / row.seconds).collect());
    format!(
        "Each case was solved up to {most} times. The slowest and the fastest time of a case differ by {:.0} % of the median, in the \
         median case.\n",
        100.0 * spread
    )
}

/// Our lines of grids of several sizes, with all threads.
fn of_grids(rows: &[ScaleRow]) -> impl Iterator<Item = &ScaleRow> {
    let of_grids = rows.iter().filter(|row| row.part == Part::Grids && row.program == OURS);
    of_grids.filter(|row| rows.iter().all(|other| other.side != row.side || other.threads <= row.threads))
}

fn times_of(row: &ScaleRow) -> String {
    let times = spread(Spread { median: row.seconds, min: row.seconds_min, max: row.seconds_max });
    // A single solve is not a median.
    if row.repeats > 1 { times } else { format!("{times} (once)") }
}

/// Table of large grids, with the time on one thread, and the peer's times where it ran.
pub(super) fn grids(rows: &[ScaleRow]) -> String {
    let head = [
        "N, grid",
        "iterations",
        "applications of L",
        "elements evaluated",
        "one thread",
        "all threads",
        "memory",
        "ASPHER, all threads",
        "memory",
        "ratio",
    ];
    let line = |row: &ScaleRow| {
        let beside = |is_other: &dyn Fn(&ScaleRow) -> bool| {
            rows.iter().find(|other| other.part == Part::Grids && other.side == row.side && is_other(other))
        };
        let peer = beside(&|other| other.program != OURS);
        let one = beside(&|other| other.program == OURS && other.threads == 1);
        vec![
            format!("{}, {}²", row.waves, row.side),
            cell(row.iterations, |n| n.to_string()),
            cell(row.applications, |n| n.to_string()),
            cell(row.cells_evaluated, |part| format!("{:.0} %", 100.0 * part)),
            cell(one, times_of),
            times_of(row),
            cell(row.memory_mb, megabytes),
            cell(peer, times_of),
            cell(peer.and_then(|peer| peer.memory_mb), megabytes),
            cell(peer, |peer| format!("{:.1}", peer.seconds / row.seconds)),
        ]
    };
    table(&head, of_grids(rows).map(line))
}

/// A sentence about the paper's larger surface; `None` when it was not run.
pub(super) fn sentence(rows: &[ScaleRow]) -> Option<String> {
    let row = of_grids(rows).find(|row| row.waves == 128)?;
    let (side, memory, threads) = (row.side, cell(row.memory_mb, megabytes), row.threads);
    Some(format!(
        "The paper's larger surface (shortest wave λ/128, {side} x {side} elements) takes {} and {memory} on {threads} threads. It was solved \
         by the adaptive method, with `--tolerance {}`.\n",
        time(row.seconds),
        row.tolerance
    ))
}

/// Table of times of both methods by the area in contact.
pub(super) fn contact(rows: &[ScaleRow]) -> String {
    let of = |method: &'static str| rows.iter().filter(move |row| row.part == Part::Contact && row.method == method);
    let areas = of("adaptive").map(|row| percent(row.area_counted));
    let head: Vec<String> = ["contact (counted)".to_owned()].into_iter().chain(areas).collect();
    let line = |method: &'static str| [method.to_owned()].into_iter().chain(of(method).map(times_of)).collect();
    table(&head, ["adaptive", "uniform"].map(line))
}

/// One line about the machine and the programs of a run.
pub(super) fn machine(run: &Toml) -> String {
    let text = |key: &str| run.get(key).map_or_else(|| "?".to_owned(), |value| value.to_string().replace('"', ""));
    let peers = run.get("peers").and_then(toml::Value::as_table).into_iter().flatten();
    let peers: Vec<String> =
        peers.map(|(name, version)| format!("{name} {}", version.as_str().unwrap_or("?"))).collect();
    let [version, compiler, processor, threads, system, seconds] =
        ["version", "compiler", "processor", "threads", "system", "seconds"].map(text);
    let peers = if peers.is_empty() { "no peers".to_owned() } else { peers.join(", ") };
    format!("rc {version} ({compiler}), {peers}; {processor}, {threads} threads, {system}; {seconds} s in all.\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::tests::rows;
    use crate::bench::reference::tests::references;
    use crate::bench::scale::tests::rows as scale_rows;

    #[test]
    fn bounds_are_marked_and_levels_that_are_not_reached_too() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 2.5]));
        let results = Results { rows: &rows, references: &references };
        let table = times(&results);
        assert!(table.contains("| area, 3 % | 750 ms (1, 1) | \u{2013} | \u{2013} | \u{2013} | > 120 |"), "{table}");
        assert!(table.contains("| area, 0.1 % | \u{2013} | \u{2013} |"), "{table}");
        // The peer's pressures are the same on both meshes.
        assert!(
            table.contains("| rms pressure, 1 % | 750 ms (1, 1) | \u{2013} | \u{2013} | 120 s R (1, 1) | 160 |"),
            "{table}"
        );
        let table = equal_meshes(&results);
        assert!(
            table.contains("| paper, λ_min/8, 512² | \u{2013} | \u{2013} | \u{2013} | 90 s | \u{2013} |"),
            "{table}"
        );
        assert!(spreads(&results).contains("solved once"));
    }

    #[test]
    fn large_grids_have_ours_with_all_threads_beside_the_peer() {
        let mut rows = scale_rows();
        let table = grids(&rows);
        let expected = "| 128, 4096² | 14 | 24 | 18 % | 3 s (2.7 s to 3.6 s) | 2 s (1.8 s to 2.4 s) | 53 MB | 60 s (54 s to 72 s) | 53 MB | 30.0 |";
        assert!(table.contains(expected) && table.lines().count() == 4, "{table}");
        assert!(
            table.contains("| 512, 16384² |") && table.ends_with("| \u{2013} | \u{2013} | \u{2013} |\n"),
            "{table}"
        );
        let sentence = sentence(&rows).expect("N = 128");
        assert!(sentence.contains("4096 x 4096 elements) takes 2 s and 53 MB on 2 threads"), "{sentence}");
        assert_eq!(super::sentence(&rows[3..]), None);
        let table = contact(&rows);
        assert_eq!(table.lines().next(), Some("| contact (counted) | 7 % |"), "{table}");
        assert!(table.contains("| uniform | 250 ms (450 ms to 600 ms) |"), "{table}");
        rows[4].repeats = 1;
        assert!(contact(&rows).contains("(once)"));
    }
}
