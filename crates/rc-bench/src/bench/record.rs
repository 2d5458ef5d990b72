//! The lines of `data/bench/bench.csv`.
//!
//! A line is one solve of one scene by one program. Its times are medians of the repeats.

use std::path::Path;

use anyhow::{Context, Result};
use rc_figures::numeric::median;
use serde::{Deserialize, Serialize};

use super::rounds::Case;
use super::setting::typed;

/// One line of the file. Columns for which a program has no value are empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    pub(super) scene: String,
    /// `rc` or the name of a peer.
    pub(super) program: String,
    pub(super) method: String,
    pub(super) kernel: String,
    pub(super) border_level: usize,
    pub(super) elements_per_wave: f64,
    pub(super) tolerance: String,
    pub(super) status: String,
    pub(super) iterations: Option<u64>,
    pub(super) applications: Option<u64>,
    pub(super) elements: Option<u64>,
    pub(super) repeats: usize,
    /// Median seconds of the solve alone; then the fastest and the slowest.
    pub(super) seconds: f64,
    pub(super) seconds_min: f64,
    pub(super) seconds_max: f64,
    /// Median seconds of the evaluation of the observables.
    pub(super) observables_seconds: f64,
    /// Peak memory minus the peak memory of the program without a problem.
    pub(super) memory_mb: Option<f64>,
    pub(super) area_counted: f64,
    /// Edges between elements in and out of contact, times the area of the smallest element.
    pub(super) perimeter: f64,
    /// Best estimate of the area; a peer has only its count.
    pub(super) area: Option<f64>,
    /// Error of `area` as the program states it. The other fields `…_bar` are alike.
    pub(super) area_bar: Option<f64>,
    pub(super) rms_pressure: f64,
    pub(super) rms_pressure_bar: Option<f64>,
    pub(super) mean_gap: f64,
    pub(super) mean_gap_bar: Option<f64>,
}

/// Name of this program among the others.
pub(super) const OURS: &str = "rc";

/// Properties that distinguish the lines of one scene, other than the mesh.
///
/// They are program, method, kernel, border level and tolerance.
pub(super) type Family<'a> = (&'a str, &'a str, &'a str, usize, &'a str);

impl Row {
    /// The line of a case; `None` without a solve.
    ///
    /// The results are those of the first solve, since all solves give the same.
    pub(super) fn of(case: &Case) -> Option<Self> {
        let Case { scene, peer, setting, outcomes, .. } = case;
        let first = outcomes.first()?;
        let n_smallest = (scene.side(setting.smallest()) as f64).powi(2);
        let Spread { median: seconds, min, max } = Spread::of(outcomes.iter().map(|one| one.seconds));
        let bar = |bar: Option<f64>| bar.map(|bar| rounded(bar, 3));
        let takes_tolerance = peer.is_none_or(|kind| kind.takes_tolerance);
        Some(Self {
            scene: scene.name.to_owned(),
            program: peer.map_or(OURS, |kind| kind.name).to_owned(),
            method: setting.method().name().to_owned(),
            kernel: setting.kernel.kernel().name().to_owned(),
            border_level: setting.border_level,
            elements_per_wave: setting.elements_per_wave,
            tolerance: if takes_tolerance { typed(setting.tolerance) } else { "default".to_owned() },
            status: first.status.clone(),
            iterations: first.iterations,
            applications: first.applications,
            elements: first.elements,
            repeats: outcomes.len(),
            seconds: rounded(seconds, 4),
            seconds_min: rounded(min, 4),
            seconds_max: rounded(max, 4),
            observables_seconds: rounded(median(outcomes.iter().map(|one| one.observables_seconds).collect()), 4),
            memory_mb: first.memory_mb.map(|memory| rounded(memory, 3)),
            area_counted: rounded(first.area_counted, 9),
            perimeter: rounded(first.edges as f64 / n_smallest, 9),
            area: first.area.map(|area| rounded(area, 9)),
            area_bar: bar(first.area_bar),
            rms_pressure: rounded(first.rms_pressure, 9),
            rms_pressure_bar: bar(first.rms_pressure_bar),
            mean_gap: rounded(first.mean_gap, 9),
            mean_gap_bar: bar(first.mean_gap_bar),
        })
    }

    pub(super) fn family(&self) -> Family<'_> {
        (&self.program, &self.method, &self.kernel, self.border_level, &self.tolerance)
    }

    /// Seconds of an answer: the solve, and the evaluation of the observables.
    pub(super) fn total_seconds(&self) -> f64 {
        self.seconds + self.observables_seconds
    }
}

/// Median and range of the times of repeated solves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spread {
    pub(super) median: f64,
    pub(super) min: f64,
    pub(super) max: f64,
}

impl Spread {
    /// The spread of times; NaN and an empty range without times.
    pub(super) fn of(seconds: impl Iterator<Item = f64>) -> Self {
        let all: Vec<f64> = seconds.collect();
        let (min, max) = all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &s| (l.min(s), h.max(s)));
        Self { median: median(all), min, max }
    }
}

/// `value` with `digits` significant digits.
pub(super) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1)).parse().unwrap_or(value)
}

/// Records from CSV text; `name` is the file's name, for errors.
///
/// # Errors
/// When a line is not as expected. The text names the line.
pub(super) fn from_csv<T: for<'a> Deserialize<'a>>(text: &str, name: &str) -> Result<Vec<T>> {
    let records = csv::Reader::from_reader(text.as_bytes()).into_deserialize().collect::<Result<_, _>>();
    records.with_context(|| format!("{name} is not as `cargo xtask bench` writes it"))
}

/// Records as CSV text.
///
/// # Errors
/// Never for the records of this benchmark.
pub(super) fn to_csv<T: Serialize>(records: &[T]) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    records.iter().try_for_each(|record| writer.serialize(record))?;
    Ok(String::from_utf8(writer.into_inner()?)?)
}

/// Writes a text file and prints its name.
///
/// # Errors
/// Those of the file system.
#[expect(clippy::print_stdout, reason = "a result of the command")]
pub(super) fn write(path: &Path, text: &str) -> Result<()> {
    std::fs::write(path, text).with_context(|| format!("could not write {}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

#[cfg(test)]
pub(super) mod tests {
    use rc_solver::Tolerance;

    use super::*;
    use crate::bench::measure::Outcome;
    use crate::bench::peers::TAMAAS;
    use crate::bench::scenes::SCENES;
    use crate::bench::setting::Setting;

    /// An outcome of a solve that took `seconds`.
    pub(in crate::bench) fn outcome(seconds: f64, area: Option<f64>) -> Outcome {
        Outcome {
            status: "converged".to_owned(),
            iterations: Some(12),
            applications: None,
            elements: Some(100),
            seconds,
            observables_seconds: if area.is_some() { 0.25 } else { 0.0 },
            memory_mb: Some(12.3456),
            area_counted: 0.07,
            area,
            area_bar: area.map(|area| 0.01 * area),
            edges: 1000,
            rms_pressure: 4e-3,
            rms_pressure_bar: area.map(|_| 4e-6),
            mean_gap: 2.5,
            mean_gap_bar: None,
            cells_evaluated: None,
        }
    }

    /// Lines of the first scene: ours on three meshes, a peer's on two.
    ///
    /// The true area is 0.07.
    pub(in crate::bench) fn rows() -> Vec<Row> {
        let ours = [(4, 0.5, 0.07), (8, 1.0, 0.0714), (16, 4.0, 0.07035)].map(|(mesh, seconds, area)| {
            let mut case = Case::ours(SCENES[0], Setting::adaptive(0, mesh, Tolerance::Auto), 2);
            case.outcomes.push(outcome(seconds, Some(area)));
            Row::of(&case).expect("one repeat")
        });
        let peer = [(4.0, 30.0, 0.09), (8.0, 90.0, 0.0721)].map(|(mesh, seconds, counted)| {
            let mut case = Case::of_peer(SCENES[0], TAMAAS, mesh, Tolerance::Relative(1e-6));
            case.outcomes.push(Outcome { area_counted: counted, ..outcome(seconds, None) });
            Row::of(&case).expect("one repeat")
        });
        ours.into_iter().chain(peer).collect()
    }

    #[test]
    fn a_line_has_the_median_time_and_survives_csv() {
        let mut case = Case::ours(SCENES[0], Setting::adaptive(2, 8, Tolerance::Auto), 2);
        assert_eq!(Row::of(&case), None);
        case.outcomes.extend([3.0, 1.0, 2.0].map(|seconds| outcome(seconds, Some(0.068))));
        let row = Row::of(&case).expect("three repeats");
        assert_eq!((row.seconds, row.total_seconds(), row.area, row.memory_mb), (2.0, 2.25, Some(0.068), Some(12.3)));
        assert_eq!((row.seconds_min, row.seconds_max, row.repeats), (1.0, 3.0, 3));
        assert_eq!((row.area_bar, row.rms_pressure_bar, row.mean_gap_bar), (Some(6.8e-4), Some(4e-6), None));
        assert_eq!(row.family(), ("rc", "adaptive", "love", 2, "auto"));
        let text = to_csv(std::slice::from_ref(&row)).expect("plain values");
        assert_eq!(from_csv::<Row>(&text, "bench.csv").expect("its own output"), [row]);
        let broken = from_csv::<Row>(&text.replace("0.068", "much"), "bench.csv").err();
        assert!(broken.is_some_and(|error| error.to_string().contains("bench.csv")));
    }

    #[test]
    fn the_perimeter_is_that_of_the_smallest_elements() {
        let mut case = Case::ours(SCENES[0], Setting::adaptive(1, 4, Tolerance::Auto), 2);
        case.outcomes.push(outcome(1.0, None));
        assert_eq!(Row::of(&case).map(|row| row.perimeter), Some(rounded(1000.0 / 4.0 / 65536.0, 9)));
        assert_eq!((rows()[3].program.as_str(), rows()[3].tolerance.as_str()), ("tamaas", "1e-6"));
    }

    #[test]
    fn a_spread_is_median_fastest_and_slowest() {
        assert_eq!(Spread::of([3.0, 1.0, 2.0, 9.0].into_iter()), Spread { median: 2.5, min: 1.0, max: 9.0 });
        assert!(Spread::of(std::iter::empty()).median.is_nan());
    }
}
