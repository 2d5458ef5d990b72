//! The tables of the benchmark, as Markdown.

use rc_core::quantity::digits;
use rc_figures::numeric::median;

use super::levels::{Asked, Choice, Found, Ratio, Results, levels};
use super::readings::Reading;
use super::record::{Row, Spread};
use super::reference::{Quantity, REFERENCE, References};
use super::scenes::{SCENES, Scene};

/// Content of a cell of a table without a value.
pub(super) const NONE: &str = "\u{2013}";

/// An error level as a percentage.
pub(super) fn percent(level: f64) -> String {
    format!("{} %", digits(100.0 * level, 3))
}

pub(super) fn time(seconds: f64) -> String {
    if seconds < 1.0 { format!("{} ms", digits(1e3 * seconds, 3)) } else { format!("{} s", digits(seconds, 3)) }
}

/// A median, with the fastest and slowest if there are several times.
pub(super) fn spread(Spread { median, min, max }: Spread) -> String {
    if min < max { format!("{} ({} to {})", time(median), time(min), time(max)) } else { time(median) }
}

pub(super) fn megabytes(memory: Option<f64>) -> String {
    memory.map_or_else(|| NONE.to_owned(), |memory| format!("{memory:.0} MB"))
}

pub(super) fn ratio(ratio: Ratio) -> String {
    let sign = if ratio.at_least { "> " } else { "" };
    // Ratios near 1 and 2 have more digits, since these decide who is faster, and who is twice as fast.
    let digits = match ratio.value {
        0.95..1.05 | 1.95..2.05 => 2,
        ..9.95 => 1,
        _ => 0,
    };
    format!("{sign}{:.digits$}", ratio.value)
}

/// Table of times to an error, ours and the fastest peer's, over all scenes.
pub(super) fn times(results: &Results<'_>, choice: Choice) -> String {
    let ours = match choice {
        Choice::Stated => "rc, median (scenes; error bars that hold)",
        Choice::Hindsight => "rc, median (scenes)",
    };
    let readings = Reading::ALL.map(Reading::name).join(" | ");
    let head = format!(
        "| error below | {ours} | fastest peer's time / ours, median and minimum: {readings} |\n|---|---|---|---|---|---|\n"
    );
    let n_scenes = results.scenes().len();
    let line = |(quantity, level): (Quantity, f64)| {
        let asked = Asked { quantity, level, choice };
        let found = results.our_answers(asked);
        let n = found.len();
        let held = match choice {
            Choice::Stated => format!("; {}", found.iter().filter(|found| found.holds).count()),
            Choice::Hindsight => String::new(),
        };
        let seconds = median(found.iter().map(|found| found.seconds).collect());
        let ours = if n > 0 { time(seconds) } else { NONE.to_owned() };
        let cell = |reading: Reading| {
            let ratios = results.ratios(asked, reading).filter(|_| reading.applies_to(quantity));
            ratios.map_or_else(|| NONE.to_owned(), |[least, median]| format!("{}, {}", ratio(median), ratio(least)))
        };
        let cells = Reading::ALL.map(cell).join(" | ");
        format!("| {}, {} | {ours} ({n} of {n_scenes}{held}) | {cells} |\n", quantity.name(), percent(level))
    };
    head + &levels().map(line).collect::<String>()
}

/// The rows of the short table.
const SHORT: [(Quantity, f64); 5] = [
    (Quantity::Area, 3e-2),
    (Quantity::Area, 1e-2),
    (Quantity::Area, 1e-3),
    (Quantity::RmsPressure, 1e-3),
    (Quantity::MeanGap, 1e-3),
];

/// Table of times to a stated error in five rows.
///
/// A row has our median time, and the median ratio of the fastest peer's time to ours.
pub(super) fn short(results: &Results<'_>) -> String {
    let head = "| error below | time of rc | ratio of the fastest peer's time to ours, results as reported | the same ratio, results corrected or extrapolated to the peers' advantage |\n\
                |---|---|---|---|\n";
    let line = |(quantity, level): (Quantity, f64)| {
        let asked = Asked { quantity, level, choice: Choice::Stated };
        let ours: Vec<f64> = results.our_answers(asked).iter().map(|found| found.seconds).collect();
        let ours = if ours.is_empty() { NONE.to_owned() } else { time(median(ours)) };
        let medians = |readings: &[Reading]| {
            let readings = readings.iter().filter(|reading| reading.applies_to(quantity));
            let ratios = readings.filter_map(|&reading| results.ratios(asked, reading).map(|[_, median]| median));
            let best = ratios.min_by(|a, b| a.value.total_cmp(&b.value));
            best.map_or_else(|| NONE.to_owned(), ratio)
        };
        let (reported, best) = (medians(&[Reading::Reported]), medians(&Reading::ALL));
        format!("| {}, {} | {ours} | {reported} | {best} |\n", quantity.name(), percent(level))
    };
    head.to_owned() + &SHORT.map(line).concat()
}

/// Table of the scenes with their reference values.
///
/// # Errors
/// When a scene has no reference value.
pub(super) fn scenes(references: &References) -> Result<String, String> {
    let head = "| scene | N | H | seed | σ0/E* | A/A0 | rms pressure / E* | Δ/λ |\n|---|---|---|---|---|---|---|---|\n";
    let line = |scene: &Scene| {
        let value = |quantity| {
            let row = references.row(scene.name, quantity);
            let row = row.ok_or_else(|| format!("{REFERENCE} has no {} of {}", quantity.name(), scene.name))?;
            Ok(format!("{} ± {}", digits(row.value, 7), rounded_up(row.stated_uncertainty())))
        };
        let values = Quantity::COMPARED.into_iter().map(value).collect::<Result<Vec<_>, String>>()?.join(" | ");
        let Scene { name, waves, hurst, seed, load } = scene;
        Ok(format!("| {name} | {waves} | {hurst} | {seed} | {load:e} | {values} |\n"))
    };
    Ok(head.to_owned() + &SCENES.iter().map(line).collect::<Result<String, String>>()?)
}

/// The value rounded up to one significant digit.
fn rounded_up(value: f64) -> String {
    let unit = 10_f64.powf(value.log10().floor());
    digits((value / unit).ceil() * unit, 1)
}

/// Table of one scene: the fastest setting for each error, with its time.
///
/// It has our settings and the peers'.
pub(super) fn scene(results: &Results<'_>, scene: &str, choice: Choice) -> String {
    let head = "| error below | rc | time | fastest peer, as reported | time | fastest peer, read in any way | time |\n\
                |---|---|---|---|---|---|---|\n";
    let line = |(quantity, level): (Quantity, f64)| {
        let asked = Asked { quantity, level, choice };
        let cells = |found: Option<Found<'_>>, reading: Reading| {
            let how = if reading == Reading::Reported { String::new() } else { format!(", {}", reading.name()) };
            let found = found.map(|found| format!("{}{how} | {}", setting(found.row), time(found.seconds)));
            found.unwrap_or_else(|| "not reached | ".to_owned())
        };
        let (ours, as_reported) = (results.ours(scene, asked), results.peers(scene, asked, Reading::Reported));
        let readings = Reading::ALL.into_iter().filter(|reading| reading.applies_to(quantity));
        let all = readings.filter_map(|reading| Some((results.peers(scene, asked, reading)?, reading)));
        let best = all.min_by(|(a, _), (b, _)| a.seconds.total_cmp(&b.seconds));
        let best = best.map_or_else(|| cells(None, Reading::Reported), |(found, reading)| cells(Some(found), reading));
        let (ours, reported) = (cells(ours, Reading::Reported), cells(as_reported, Reading::Reported));
        format!("| {}, {} | {ours} | {reported} | {best} |\n", quantity.name(), percent(level))
    };
    head.to_owned() + &levels().map(line).collect::<String>()
}

/// Table of how often the true error exceeds the stated error, over all meshes.
pub(super) fn statements(results: &Results<'_>) -> String {
    let quantities = [Quantity::Area, Quantity::RmsPressure, Quantity::MeanGap];
    let names = quantities.map(Quantity::name).join(" | ");
    let head = format!("| stated by | {names} |\n|---|---|---|---|\n");
    let line = |name: &str, ours: bool, reading: Reading| {
        let cell = |quantity| {
            let (n, n_held) = results.statements(ours, quantity, reading);
            let none = n == 0 || !reading.applies_to(quantity);
            if none { NONE.to_owned() } else { format!("{:.0} % of {n}", 100.0 * n_held as f64 / n as f64) }
        };
        format!("| {name} | {} |\n", quantities.map(cell).join(" | "))
    };
    let peers = Reading::ALL.map(|reading| line(&format!("peers' users, {}", reading.name()), false, reading));
    head + &line("rc, error bars of the summary", true, Reading::Reported) + &peers.concat()
}

/// Scenes of the table of equal meshes. The tolerance and the coarsest mesh of the table follow.
pub(super) const EQUAL_MESHES: [&str; 3] = ["paper", "waves-128", "heavy"];
pub(super) const EQUAL_TOLERANCE: &str = "1e-6";
const COARSEST_EQUAL: usize = 4;

/// Table of our time and the fastest peer's on equal meshes of some scenes.
///
/// All solves are certified to the same tolerance.
pub(super) fn equal_meshes(results: &Results<'_>, scenes: &[&str]) -> String {
    let head = "| scene, elements | fastest peer | its time, memory | adaptive, `love`: peer's time / ours; our time, memory | \
                uniform, `spectral`: the same |\n|---|---|---|---|---|\n";
    let line = |equal: &Equal<'_>| {
        let cells = equal.ours.map(|row| {
            let cell = |row: &Row| {
                let seconds = spread(total(row));
                let value = equal.peer.seconds / row.total_seconds();
                format!("{}; {seconds}, {}", ratio(Ratio { value, at_least: false }), megabytes(row.memory_mb))
            };
            row.map_or_else(|| NONE.to_owned(), cell)
        });
        let peer =
            format!("{} | {}, {}", equal.peer.program, spread(total(equal.peer)), megabytes(equal.peer.memory_mb));
        format!("| {} | {peer} | {} |\n", equal.name(), cells.join(" | "))
    };
    head.to_owned() + &scenes.iter().flat_map(|scene| equal(results, scene)).map(|row| line(&row)).collect::<String>()
}

/// Ratios of times for each line of [`equal_meshes`], of the adaptive and the uniform method.
pub(super) fn equal_ratios(results: &Results<'_>, scene: &str) -> Vec<(String, [Option<f64>; 2])> {
    let of = |equal: Equal<'_>| {
        (equal.name(), equal.ours.map(|row| row.map(|row| equal.peer.seconds / row.total_seconds())))
    };
    equal(results, scene).into_iter().map(of).collect()
}

/// The fastest peer on a mesh, and our solves, at least one.
struct Equal<'a> {
    peer: &'a Row,
    /// Our adaptive and uniform solves.
    ours: [Option<&'a Row>; 2],
}

impl Equal<'_> {
    fn name(&self) -> String {
        format!("{}, λ_min/{}", self.peer.scene, self.peer.elements_per_wave)
    }
}

fn equal<'a>(results: &Results<'a>, scene: &str) -> Vec<Equal<'a>> {
    let same = |row: &&Row| {
        row.tolerance == EQUAL_TOLERANCE && row.border_level == 0 && row.elements_per_wave >= COARSEST_EQUAL
    };
    // The fastest peer is first, and only the first is kept for each mesh.
    let mut peers: Vec<&Row> = results.of(scene, false).filter(same).collect();
    peers.sort_by(|a, b| a.elements_per_wave.cmp(&b.elements_per_wave).then(a.seconds.total_cmp(&b.seconds)));
    peers.dedup_by_key(|row| row.elements_per_wave);
    let ours = |mesh: usize, method: &str, kernel: &str| {
        let mut rows = results.of(scene, true).filter(same);
        rows.find(|row| row.elements_per_wave == mesh && row.method == method && row.kernel == kernel)
    };
    let beside = |peer: &'a Row| {
        let mesh = peer.elements_per_wave;
        Equal { peer, ours: [ours(mesh, "adaptive", "love"), ours(mesh, "uniform", "spectral")] }
    };
    peers.into_iter().map(beside).filter(|equal| equal.ours.iter().any(Option::is_some)).collect()
}

/// Seconds of a solve and the evaluation of the observables. The spread of the latter is small and left out.
fn total(row: &Row) -> Spread {
    let of = |seconds| seconds + row.observables_seconds;
    Spread { median: of(row.seconds), min: of(row.seconds_min), max: of(row.seconds_max) }
}

/// A sentence about the spread of the times of a case.
pub(super) fn spreads(results: &Results<'_>) -> String {
    let rows = results.rows.iter().filter(|row| row.repeats > 1);
    let mut all: Vec<f64> = rows.map(|row| (row.seconds_max - row.seconds_min) / row.seconds).collect();
    all.sort_by(f64::total_cmp);
    let Some(at) = all.len().checked_sub(1) else { return "Each case was solved once.\n".to_owned() };
    let repeats = results.rows.iter().map(|row| row.repeats);
    let (fewest, most) = (repeats.clone().min().unwrap_or(0), repeats.max().unwrap_or(0));
    let n = if fewest < most { format!("{fewest} to {most}") } else { most.to_string() };
    format!(
        "Each case was solved {n} times. The difference between the slowest and the fastest time, divided by the median, is {:.0} % in the \
         median case and below {:.0} % in nine of ten cases.\n",
        100.0 * all[at / 2],
        100.0 * all[9 * at / 10]
    )
}

/// Method, kernel, mesh and tolerance of a line.
fn setting(row: &Row) -> String {
    let Row { program, method, kernel, border_level, elements_per_wave, tolerance, .. } = row;
    let how = match (program.as_str(), *border_level) {
        ("rc", 0) => format!("{method}, {kernel}"),
        ("rc", level) => format!("{method}, border level {level}"),
        (peer, _) => peer.to_owned(),
    };
    format!("{how}, λ_min/{elements_per_wave}, {tolerance}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::levels::tests::rows;
    use crate::bench::reference::tests::references;

    #[test]
    fn bounds_are_marked_and_levels_that_are_not_reached_too() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let results = Results { rows: &rows, references: &references };
        let table = times(&results, Choice::Hindsight);
        assert!(table.contains("| area, 3 % | 750 ms (1 of 1) | 120, 120 |"), "{table}");
        assert!(table.contains("| area, 1 % | 4.25 s (1 of 1) | > 21, > 21 |"), "{table}");
        assert!(table.contains("| area, 0.1 % | \u{2013} (0 of 1) | \u{2013} |"), "{table}");
        // Our bars are 1 %. The middle mesh has a true error of 2 %, so it does not count as the fastest.
        let table = times(&results, Choice::Stated);
        assert!(table.contains("| area, 3 % | 750 ms (1 of 1; 1) | > 120, > 120 |"), "{table}");
        let table = short(&results);
        assert!(table.contains("| area, 3 % | 750 ms | > 120 | > 120 |"), "{table}");
        assert!(table.contains("| area, 0.1 % | \u{2013} | \u{2013} | \u{2013} |"), "{table}");
        let table = scene(&results, "paper", Choice::Hindsight);
        assert!(table.contains("| area, 1 % | adaptive, love, λ_min/16, auto | 4.25 s | not reached |"), "{table}");
        let table = statements(&results);
        assert!(table.contains("| rc, error bars of the summary | 67 % of 3 | 100 % of 3 | \u{2013} |"), "{table}");
    }

    #[test]
    fn equal_meshes_keep_the_fastest_peer() {
        let references = references("paper", [0.07, 4e-3, 1.0]);
        let mut rows: Vec<Row> =
            rows().into_iter().map(|row| Row { tolerance: EQUAL_TOLERANCE.to_owned(), ..row }).collect();
        // A slower peer on one of the meshes is left out, and so are meshes that only peers have.
        let slower = Row { program: "slower".to_owned(), seconds: 31.0, ..rows[3].clone() };
        let coarser = Row { elements_per_wave: 2, ..rows[3].clone() };
        let finer = Row { elements_per_wave: 64, ..rows[3].clone() };
        rows.extend([slower, coarser, finer]);
        (rows[3].seconds_min, rows[3].seconds_max) = (29.0, 33.0);
        let table = equal_meshes(&Results { rows: &rows, references: &references }, &["paper"]);
        assert_eq!(table.lines().count(), 4, "{table}");
        assert!(table.contains("| paper, λ_min/4 | tamaas | 30 s (29 s to 33 s), 12 MB | 40; 750 ms"), "{table}");
        assert!(!table.contains("slower"), "{table}");
    }

    #[test]
    fn printed_uncertainties_are_not_below_the_stated_ones() {
        let cases = [(9.668e-6, "1e-5"), (2.1e-4, "0.0003"), (3e-6, "3e-6"), (8.0001e-8, "9e-8")];
        for (value, expected) in cases {
            assert_eq!(rounded_up(value), expected, "{value:e}");
        }
        let table = scenes(&References::read().expect("the file of the repository")).expect("every scene");
        // The areas of the two kernels differ by 9.7e-6 in the first scene.
        assert!(table.contains("| 0.0700858 ± 1e-5 |"), "{table}");
    }

    #[test]
    fn the_spread_of_times_is_told() {
        let references = references("paper", [0.07, 4e-3, 1.0]);
        let row = |max| Row { repeats: 5, seconds: 2.0, seconds_min: 1.9, seconds_max: max, ..rows().remove(0) };
        let rows = [row(2.1), row(2.2), row(2.3)];
        let text = spreads(&Results { rows: &rows, references: &references });
        assert!(text.contains("solved 5 times") && text.contains("is 15 % in the median case"), "{text}");
    }
}
