//! Time to an error: what the benchmark is about.

use rc_figures::numeric::median;
use std::collections::BTreeMap;

use super::record::{Family, OURS, Row};
use super::reference::{Quantity, Reading, References};

/// The errors that are asked for, by quantity.
pub(super) const LEVELS: [(Quantity, &[f64]); 2] =
    [(Quantity::Area, &[3e-2, 1e-2, 3e-3, 1e-3]), (Quantity::RmsPressure, &[1e-2, 1e-3, 1e-4])];

/// The results of a run with their references.
#[derive(Clone, Copy)]
pub(super) struct Results<'a> {
    pub(super) rows: &'a [Row],
    pub(super) references: &'a References,
}

/// How many times longer a peer takes than we do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ratio {
    pub(super) value: f64,
    /// No peer got there in its time and grids: the true ratio is greater.
    pub(super) at_least: bool,
}

impl<'a> Results<'a> {
    /// The lines of one scene by whether they are ours.
    pub(super) fn of(&self, scene: &'a str, ours: bool) -> impl Iterator<Item = &'a Row> + use<'a> {
        self.rows.iter().filter(move |row| row.scene == scene && (row.program == OURS) == ours)
    }

    /// The fastest of `rows` (one scene) whose error is at most `level`, and stays so on all finer meshes of its family: a
    /// coarse mesh that is right by accident does not count.
    pub(super) fn fastest(
        &self,
        rows: impl Iterator<Item = &'a Row>,
        (quantity, reading): (Quantity, Reading),
        level: f64,
    ) -> Option<&'a Row> {
        let good = |row: &&Row| self.error(row, quantity, reading).is_some_and(|error| error.abs() <= level);
        let reached = families(rows).into_values().flat_map(|family| family.into_iter().rev().take_while(good));
        reached.min_by(|a, b| a.total_seconds().total_cmp(&b.total_seconds()))
    }

    pub(super) fn error(&self, row: &Row, quantity: Quantity, reading: Reading) -> Option<f64> {
        self.references.error(row, quantity, reading)
    }

    /// The fastest peer's time to an error over ours, both in the best of their settings; ours by our best estimate. `None`
    /// when we do not reach it, or no peer ran.
    pub(super) fn ratio(&self, scene: &'a str, quantity: Quantity, peers: Reading, level: f64) -> Option<Ratio> {
        let ours = self.fastest(self.of(scene, true), (quantity, Reading::Best), level)?.total_seconds();
        let peer = self.fastest(self.of(scene, false), (quantity, peers), level);
        // A finer mesh than the finest that ran would have taken longer than that.
        let finest = families(self.of(scene, false)).into_values().filter_map(|rows| Some(rows.last()?.seconds));
        let (seconds, at_least) = match peer {
            Some(row) => (row.seconds, false),
            None => (finest.min_by(f64::total_cmp)?, true),
        };
        Some(Ratio { value: seconds / ours, at_least })
    }

    /// The scenes of the run, in order.
    pub(super) fn scenes(&self) -> Vec<&'a str> {
        let mut scenes: Vec<&str> = Vec::new();
        for row in self.rows {
            if scenes.last() != Some(&row.scene.as_str()) {
                scenes.push(&row.scene);
            }
        }
        scenes
    }

    /// Our median time over the scenes to an error, and the number of scenes where it is reached.
    pub(super) fn our_time(&self, quantity: Quantity, level: f64) -> (f64, usize) {
        let reached = |scene| self.fastest(self.of(scene, true), (quantity, Reading::Best), level);
        let times: Vec<f64> = self.scenes().into_iter().filter_map(reached).map(Row::total_seconds).collect();
        let n = times.len();
        (median(times), n)
    }

    /// Least and median ratio over the scenes. The median is a bound when any ratio below or at it is.
    pub(super) fn ratios(&self, quantity: Quantity, peers: Reading, level: f64) -> Option<[Ratio; 2]> {
        let ratios = self.scenes().into_iter().filter_map(|scene| self.ratio(scene, quantity, peers, level));
        let ratios: Vec<Ratio> = ratios.collect();
        let smallest = ratios.iter().copied().min_by(|a, b| a.value.total_cmp(&b.value))?;
        let value = median(ratios.iter().map(|ratio| ratio.value).collect());
        let at_least = ratios.iter().any(|ratio| ratio.at_least && ratio.value <= value);
        Some([smallest, Ratio { value, at_least }])
    }
}

/// Lines by family, each by mesh, coarsest first.
pub(super) fn families<'a>(rows: impl Iterator<Item = &'a Row>) -> BTreeMap<Family, Vec<&'a Row>> {
    let mut families: BTreeMap<Family, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        families.entry(row.family()).or_default().push(row);
    }
    for rows in families.values_mut() {
        rows.sort_by_key(|row| row.elements_per_wave);
    }
    families
}

#[cfg(test)]
pub(super) mod tests {
    use rc_solver::Tolerance;

    use super::*;
    use crate::bench::record::tests::outcome;
    use crate::bench::reference::tests::references;
    use crate::bench::scenes::SCENES;
    use crate::bench::setting::Setting;

    /// Lines of the first scene, where the area should be 0.07: ours at three meshes, a peer at two.
    pub(in crate::bench) fn rows() -> Vec<Row> {
        let family = |mesh| Family::ours(&Setting::adaptive(0, mesh, Tolerance::Auto));
        let ours = [(4, 0.5, 0.07), (8, 1.0, 0.0714), (16, 4.0, 0.07035)];
        let ours = ours.map(|(mesh, seconds, area)| {
            Row::of(&SCENES[0], &family(mesh), mesh, &[outcome(seconds, Some(area))]).expect("one repeat")
        });
        let peer = [(4, 30.0, 0.09), (8, 90.0, 0.0721)].map(|(mesh, seconds, counted)| {
            let family = Family::peer("tamaas", "1e-6");
            let mut row = Row::of(&SCENES[0], &family, mesh, &[outcome(seconds, None)]).expect("one repeat");
            (row.area_counted, row.observables_seconds) = (counted, 0.0);
            row
        });
        ours.into_iter().chain(peer).collect()
    }

    #[test]
    fn a_coarse_mesh_that_is_right_by_accident_does_not_count() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let results = Results { rows: &rows, references: &references };
        let fastest = |level| {
            let row = results.fastest(results.of("paper", true), (Quantity::Area, Reading::Best), level);
            row.map(|row| row.elements_per_wave)
        };
        assert_eq!([3e-2, 1e-2, 1e-3].map(fastest), [Some(4), Some(16), None]);
    }

    #[test]
    fn ratios_are_bounds_where_no_peer_arrives() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let results = Results { rows: &rows, references: &references };
        let ratio = |level| results.ratio("paper", Quantity::Area, Reading::Counted, level);
        // 90 s against 0.5 s and the evaluation; then nothing finer ran.
        assert_eq!(ratio(3e-2), Some(Ratio { value: 90.0 / 0.75, at_least: false }));
        assert_eq!(ratio(1e-2), Some(Ratio { value: 90.0 / 4.25, at_least: true }));
        assert_eq!(ratio(1e-3), None);
        assert_eq!(results.our_time(Quantity::Area, 3e-2), (0.75, 1));
        assert_eq!(results.ratios(Quantity::Area, Reading::Counted, 1e-2).map(|[smallest, _]| smallest), ratio(1e-2));
    }
}
