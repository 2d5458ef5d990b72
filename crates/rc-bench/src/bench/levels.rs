//! Time to an error, the measure that the benchmark compares.

use rc_figures::numeric::median;
use std::collections::BTreeMap;

use super::readings::{Answer, Reading, answers};
use super::record::{Family, OURS, Row};
use super::reference::{Quantity, References};

/// The error levels of each quantity.
const LEVELS: [(Quantity, &[f64]); 3] = [
    (Quantity::Area, &[3e-2, 1e-2, 3e-3, 1e-3]),
    (Quantity::RmsPressure, &[1e-2, 1e-3, 1e-4]),
    (Quantity::MeanGap, &[1e-3, 1e-4]),
];

/// Every quantity with each of its error levels.
pub(super) fn levels() -> impl Iterator<Item = (Quantity, f64)> {
    LEVELS.into_iter().flat_map(|(quantity, levels)| levels.iter().map(move |&level| (quantity, level)))
}

/// Which setting of a program is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Choice {
    /// The fastest setting that states an error below the level. A user can choose in this way.
    Stated,
    /// The fastest setting whose true error is below the level from this mesh on. The error of all finer meshes is
    /// below the level too. Only the reference value shows this.
    Hindsight,
}

/// An error level of a quantity, and the choice of the setting.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) quantity: Quantity,
    /// Relative error to reach.
    pub(super) level: f64,
    pub(super) choice: Choice,
}

/// The fastest answer that reaches a level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found<'a> {
    pub(super) row: &'a Row,
    pub(super) seconds: f64,
    /// Whether the true error is below the level.
    pub(super) holds: bool,
}

/// The results of a run with the reference values.
#[derive(Clone, Copy)]
pub(super) struct Results<'a> {
    pub(super) rows: &'a [Row],
    pub(super) references: &'a References,
}

/// Ratio of a peer's time to ours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ratio {
    pub(super) value: f64,
    /// Whether the ratio is a lower bound.
    ///
    /// It is one when no peer reached the level within its time and grids.
    pub(super) at_least: bool,
}

/// Our time and the fastest peer's time in one scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Comparison {
    /// Both reach the level, or we alone.
    Ratio(Ratio),
    /// Both state an error below the level, but the peer's true error is above it.
    Wrong(Ratio),
    /// Only a peer reaches the level. `holds` tells whether its true error is below the level.
    PeerAlone { holds: bool },
    /// Nobody reaches the level, or no peer ran.
    Nothing,
}

impl<'a> Results<'a> {
    /// The lines of one scene, either ours or the peers'.
    pub(super) fn of<'s>(&self, scene: &'s str, ours: bool) -> impl Iterator<Item = &'a Row> + use<'a, 's> {
        self.rows.iter().filter(move |row| row.scene == scene && (row.program == OURS) == ours)
    }

    /// Our fastest answer that reaches the level in one scene.
    pub(super) fn ours(&self, scene: &str, asked: Asked) -> Option<Found<'a>> {
        self.fastest(self.of(scene, true), asked, Reading::Reported)
    }

    /// The peers' fastest answer that reaches the level in one scene.
    pub(super) fn peers(&self, scene: &str, asked: Asked, reading: Reading) -> Option<Found<'a>> {
        self.fastest(self.of(scene, false), asked, reading)
    }

    fn fastest(&self, rows: impl Iterator<Item = &'a Row>, asked: Asked, reading: Reading) -> Option<Found<'a>> {
        let families = families(rows).into_values();
        let found = families.flat_map(|rows| self.found(&answers(&rows, asked.quantity, reading), asked));
        found.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
    }

    /// The answers of one family that reach the level.
    fn found(&self, answers: &[Answer<'a>], asked: Asked) -> Vec<Found<'a>> {
        let Asked { quantity, level, choice } = asked;
        let holds = |answer: &Answer<'_>| {
            let error = self.references.error(&answer.row.scene, quantity, answer.value);
            error.is_some_and(|error| error.abs() <= level)
        };
        let finest_first = answers.iter().rev();
        match choice {
            Choice::Hindsight => {
                // A coarse mesh whose error is small by accident does not count.
                let good = finest_first.take_while(|answer| holds(answer));
                good.map(|answer| Found { row: answer.row, seconds: answer.seconds, holds: true }).collect()
            }
            Choice::Stated => {
                let stated = finest_first.filter_map(|answer| Some((answer, answer.stated?)));
                let below = stated.filter(|(_, stated)| stated.error <= level);
                below
                    .map(|(answer, stated)| Found { row: answer.row, seconds: stated.seconds, holds: holds(answer) })
                    .collect()
            }
        }
    }

    /// Comparison of the times to an error, with the best setting of both sides.
    pub(super) fn compare(&self, scene: &str, asked: Asked, reading: Reading) -> Comparison {
        let (ours, peer) = (self.ours(scene, asked), self.peers(scene, asked, reading));
        // A mesh finer than the finest one that ran would have taken longer than the finest one.
        let finest = families(self.of(scene, false)).into_values().filter_map(|rows| Some(rows.last()?.seconds));
        let ratio = |seconds: f64, ours: Found<'_>, at_least| Ratio { value: seconds / ours.seconds, at_least };
        match (ours, peer, finest.min_by(f64::total_cmp)) {
            (None, Some(found), _) => Comparison::PeerAlone { holds: found.holds },
            (Some(ours), Some(found), _) if !found.holds => Comparison::Wrong(ratio(found.seconds, ours, false)),
            (Some(ours), Some(found), _) => Comparison::Ratio(ratio(found.seconds, ours, false)),
            (Some(ours), None, Some(finest)) => Comparison::Ratio(ratio(finest, ours, true)),
            _ => Comparison::Nothing,
        }
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

    /// Our answers in all scenes where we have one.
    pub(super) fn our_answers(&self, asked: Asked) -> Vec<Found<'a>> {
        self.scenes().into_iter().filter_map(|scene| self.ours(scene, asked)).collect()
    }

    /// Smallest and median ratio over the scenes.
    ///
    /// The median is a lower bound when it, or a ratio that is at most as large, is one.
    pub(super) fn ratios(&self, asked: Asked, reading: Reading) -> Option<[Ratio; 2]> {
        let ratio = |scene| match self.compare(scene, asked, reading) {
            Comparison::Ratio(ratio) | Comparison::Wrong(ratio) => Some(ratio),
            Comparison::PeerAlone { .. } | Comparison::Nothing => None,
        };
        let ratios: Vec<Ratio> = self.scenes().into_iter().filter_map(ratio).collect();
        let smallest = ratios.iter().copied().min_by(|a, b| a.value.total_cmp(&b.value))?;
        let value = median(ratios.iter().map(|ratio| ratio.value).collect());
        let at_least = ratios.iter().any(|ratio| ratio.at_least && ratio.value <= value);
        Some([smallest, Ratio { value, at_least }])
    }

    /// Number of answers with a stated error, and number of correct statements.
    ///
    /// A statement is correct when the true error is not above it. The answers are ours or the peers'.
    pub(super) fn statements(&self, ours: bool, quantity: Quantity, reading: Reading) -> (usize, usize) {
        let holds = |answer: &Answer<'_>| {
            let error = self.references.error(&answer.row.scene, quantity, answer.value)?;
            Some(error.abs() <= answer.stated?.error)
        };
        let all = self.scenes().into_iter().flat_map(|scene| families(self.of(scene, ours)).into_values());
        let held: Vec<bool> = all
            .flat_map(|rows| answers(&rows, quantity, reading).iter().filter_map(holds).collect::<Vec<_>>())
            .collect();
        (held.len(), held.iter().filter(|&&held| held).count())
    }
}

/// Lines by family. The lines of a family go from the coarsest mesh to the finest.
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

    /// Lines of the first scene: ours on three meshes, a peer's on two.
    ///
    /// The true area is 0.07.
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

    fn area(level: f64, choice: Choice) -> Asked {
        Asked { quantity: Quantity::Area, level, choice }
    }

    #[test]
    fn a_coarse_mesh_that_is_right_by_accident_does_not_count() {
        let (rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let results = Results { rows: &rows, references: &references };
        let fastest =
            |level| results.ours("paper", area(level, Choice::Hindsight)).map(|found| found.row.elements_per_wave);
        assert_eq!([3e-2, 1e-2, 1e-3].map(fastest), [Some(4), Some(16), None]);
    }

    #[test]
    fn what_is_stated_decides_and_may_be_wrong() {
        let (mut rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        // The bar of the middle mesh is too small: its area is wrong by 2 %.
        rows[1].area_bar = Some(1e-4);
        let results = Results { rows: &rows, references: &references };
        let fastest = |level| {
            let found = results.ours("paper", area(level, Choice::Stated));
            found.map(|found| (found.row.elements_per_wave, found.holds))
        };
        assert_eq!([3e-2, 3e-3, 1e-3].map(fastest), [Some((4, true)), Some((8, false)), None]);
        assert_eq!(results.statements(true, Quantity::Area, Reading::Reported), (3, 2));
        // The peer's two counts differ by 0.0179. The finer count has an error of 0.0021, and the time is that of both.
        let peer = |level| results.peers("paper", area(level, Choice::Stated), Reading::Reported);
        let compare = |level| results.compare("paper", area(level, Choice::Stated), Reading::Reported);
        assert_eq!(compare(0.25), Comparison::Ratio(Ratio { value: 120.0 / 0.75, at_least: false }));
        let found = peer(0.25).expect("a quarter");
        assert!((found.seconds - 120.0).abs() < 1e-9 && found.holds && peer(0.24).is_none(), "{found:?}");
        assert_eq!(results.statements(false, Quantity::Area, Reading::Reported), (1, 1));
    }

    #[test]
    fn ratios_are_bounds_where_no_peer_arrives() {
        let (mut rows, references) = (rows(), references("paper", [0.07, 4e-3, 1.0]));
        let compare = |rows: &[Row], level| {
            let results = Results { rows, references: &references };
            results.compare("paper", area(level, Choice::Hindsight), Reading::Reported)
        };
        // The peer's finest mesh took 90 s, and we take 0.5 s and the evaluation. No finer mesh ran.
        let ratio = |value, at_least| Comparison::Ratio(Ratio { value, at_least });
        assert_eq!(compare(&rows, 3e-2), ratio(90.0 / 0.75, false));
        assert_eq!(compare(&rows, 1e-2), ratio(90.0 / 4.25, true));
        assert_eq!(compare(&rows, 1e-3), Comparison::Nothing);
        let results = Results { rows: &rows, references: &references };
        let asked = area(1e-2, Choice::Hindsight);
        let smallest = results.ratios(asked, Reading::Reported).map(|[smallest, _]| smallest);
        assert_eq!(smallest, Some(Ratio { value: 90.0 / 4.25, at_least: true }));
        rows[4].area_counted = 0.07001;
        assert_eq!(compare(&rows, 1e-3), Comparison::PeerAlone { holds: true });
    }
}
