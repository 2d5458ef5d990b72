//! Times to a stated error, which the benchmark compares.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use rc_figures::numeric::median;

use super::readings::{Reading, stated};
use super::record::{Family, OURS, Row};
use super::reference::{Quantity, References};

/// A quantity and a relative error that a program shall state.
pub(super) type Asked = (Quantity, f64);

/// The errors of the table.
pub(super) const LEVELS: [Asked; 9] = [
    (Quantity::Area, 3e-2),
    (Quantity::Area, 1e-2),
    (Quantity::Area, 3e-3),
    (Quantity::Area, 1e-3),
    (Quantity::RmsPressure, 1e-2),
    (Quantity::RmsPressure, 1e-3),
    (Quantity::RmsPressure, 1e-4),
    (Quantity::MeanGap, 1e-3),
    (Quantity::MeanGap, 1e-4),
];

/// The results of a run with the reference values.
#[derive(Clone, Copy)]
pub(super) struct Results<'a> {
    pub(super) rows: &'a [Row],
    pub(super) references: &'a References,
}

/// A program's fastest way to state an error below a level in one scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) seconds: f64,
    /// Whether the true error is below the level too.
    pub(super) is_true: bool,
}

/// A program's times to a stated error over all scenes, by its best setting in each scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reached {
    pub(super) reading: Reading,
    /// Median seconds; infinite if the error is not reached in half of the scenes.
    pub(super) seconds: f64,
    /// Number of scenes in which the error is stated, and of those in which it is true.
    pub(super) n: usize,
    pub(super) n_true: usize,
}

/// Ratio of a peer's time to ours, a median over the scenes in which we reach the error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ratio {
    pub(super) value: f64,
    /// Whether it is a lower bound.
    ///
    /// It is one when the peer did not reach the error in one of the scenes below the median.
    pub(super) is_bound: bool,
}

impl<'a> Results<'a> {
    /// Names of the scenes, in the order of the lines.
    pub(super) fn scenes(&self) -> Vec<&'a str> {
        let mut scenes: Vec<&str> = Vec::new();
        for row in self.rows {
            if !scenes.contains(&row.scene.as_str()) {
                scenes.push(&row.scene);
            }
        }
        scenes
    }

    fn of(&self, scene: &str, program: &str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.scene == scene && row.program == program)
    }

    fn found(&self, scene: &str, program: &str, (quantity, level): Asked, reading: Reading) -> Option<Found> {
        let families = families(self.of(scene, program)).into_values();
        let stated = families.flat_map(|rows| stated(&rows, quantity, reading));
        let fastest = stated.filter(|one| one.error <= level).min_by(|a, b| a.seconds.total_cmp(&b.seconds))?;
        let error = self.references.error(scene, quantity, fastest.value)?;
        Some(Found { seconds: fastest.seconds, is_true: error.abs() <= level })
    }

    fn reached(&self, program: &str, asked: Asked, reading: Reading) -> Reached {
        let found: Vec<Option<Found>> =
            self.scenes().into_iter().map(|scene| self.found(scene, program, asked, reading)).collect();
        let seconds = found.iter().map(|found| found.map_or(f64::INFINITY, |found| found.seconds)).collect();
        let n = found.iter().flatten().count();
        let n_true = found.iter().flatten().filter(|found| found.is_true).count();
        Reached { reading, seconds: median(seconds), n, n_true }
    }

    /// Our times to a stated error.
    pub(super) fn ours(&self, asked: Asked) -> Reached {
        self.reached(OURS, asked, Reading::Reported)
    }

    /// The times of a peer, and their ratio to ours, in the way to read its results with the smallest median time.
    ///
    /// The ratio is absent when we do not reach the error in any scene, or when the peer did not run.
    pub(super) fn peer(&self, program: &str, asked: Asked) -> (Reached, Option<Ratio>) {
        let readings = Reading::ALL.into_iter().filter(|reading| reading.applies_to(asked.0));
        let all = readings.map(|reading| {
            let ratio = self.ratio(program, asked, reading);
            let reached = self.reached(program, asked, reading);
            (reached.seconds, ratio.map_or(f64::INFINITY, |ratio| ratio.value), (reached, ratio))
        });
        let best = all.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        best.map_or_else(|| (self.reached(program, asked, Reading::Reported), None), |(_, _, best)| best)
    }

    fn ratio(&self, program: &str, asked: Asked, reading: Reading) -> Option<Ratio> {
        let ratio = |scene: &str| {
            let ours = self.found(scene, OURS, asked, Reading::Reported)?.seconds;
            let peer = self.found(scene, program, asked, reading);
            // A mesh finer than the finest one that ran would have taken longer than the finest one.
            let longest = self.of(scene, program).map(Row::total_seconds).reduce(f64::max)?;
            Some((peer.map_or(longest, |found| found.seconds) / ours, peer.is_none()))
        };
        let ratios: Vec<(f64, bool)> = self.scenes().into_iter().filter_map(ratio).collect();
        let value = median(ratios.iter().map(|(value, _)| *value).collect());
        let is_bound = ratios.iter().any(|(ratio, is_bound)| *is_bound && *ratio <= value);
        (!ratios.is_empty()).then_some(Ratio { value, is_bound })
    }

    /// Seconds of a program on one mesh of a scene, to a tolerance that all programs but one certify.
    pub(super) fn on_mesh(&self, scene: &str, family: Family<'_>, elements_per_wave: f64) -> Option<f64> {
        let mut rows = self.of(scene, family.0);
        let row =
            rows.find(|row| row.family() == family && (row.elements_per_wave - elements_per_wave).abs() < 1e-9)?;
        Some(row.total_seconds())
    }
}

/// Lines by family. Those of meshes that are halves of each other follow each other, from the coarsest to the finest.
fn families<'a>(rows: impl Iterator<Item = &'a Row>) -> BTreeMap<Family<'a>, Vec<&'a Row>> {
    let mut families: BTreeMap<Family<'_>, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        families.entry(row.family()).or_default().push(row);
    }
    for rows in families.values_mut() {
        let of_series = |row: &Row| row.elements_per_wave / row.elements_per_wave.log2().floor().exp2();
        let key = |row: &Row| [of_series(row), row.elements_per_wave];
        rows.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(Ordering::Equal));
    }
    families
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::tests::rows;
    use crate::bench::reference::tests::references;

    fn area(level: f64) -> Asked {
        (Quantity::Area, level)
    }

    #[test]
    fn what_is_stated_decides_and_may_be_wrong() {
        let (mut rows, references) = (rows(), references("paper", [0.07, 4e-3, 2.5]));
        // The bar of the middle mesh is too small: its area is wrong by 2 %.
        rows[1].area_bar = Some(1e-4);
        let results = Results { rows: &rows, references: &references };
        let ours = |level| {
            let Reached { seconds, n, n_true, .. } = results.ours(area(level));
            (seconds, n, n_true)
        };
        assert_eq!([3e-2, 3e-3, 1e-3].map(ours), [(0.75, 1, 1), (1.25, 1, 0), (f64::INFINITY, 0, 0)]);
    }

    #[test]
    fn peers_take_two_solves_and_ratios_are_bounds_where_they_do_not_arrive() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 2.5]));
        let results = Results { rows: &rows, references: &references };
        // The peer's two counts differ by 0.0179. The finer count has an error of 0.0021, and the time is that of both.
        let reached = |level| results.reached("tamaas", area(level), Reading::Reported);
        let counted = Reached { reading: Reading::Reported, seconds: 120.0, n: 1, n_true: 1 };
        assert_eq!((reached(0.25), reached(0.24).n), (counted, 0));
        // We take half a second and the evaluation. Without a finer mesh the peer would take more than 90 s.
        let ratio = |level| results.ratio("tamaas", area(level), Reading::Reported);
        assert_eq!(ratio(0.25), Some(Ratio { value: 120.0 / 0.75, is_bound: false }));
        assert_eq!(ratio(0.03), Some(Ratio { value: 90.0 / 0.75, is_bound: true }));
        assert_eq!((ratio(1e-3), results.ratio("aspher", area(0.25), Reading::Reported)), (None, None));
    }

    #[test]
    fn a_peer_is_read_in_the_way_that_is_fastest() {
        let (mut rows, references) = (rows(), references("paper", [0.07, 4e-3, 2.5]));
        // With the published constant both meshes have the same area, so the coarser pair is enough.
        let same = |row: &Row, area: f64| area + super::super::readings::PUBLISHED * row.perimeter;
        (rows[3].area_counted, rows[4].area_counted) = (same(&rows[3], 0.07), same(&rows[4], 0.07));
        let results = Results { rows: &rows, references: &references };
        let (reached, ratio) = results.peer("tamaas", area(1e-2));
        assert_eq!((reached.reading, reached.n, reached.n_true), (Reading::Published, 1, 1));
        assert_eq!(ratio, Some(Ratio { value: 120.0 / 0.75, is_bound: false }));
        assert_eq!(results.on_mesh("paper", rows[4].family(), 8.0), Some(90.0));
    }
}
