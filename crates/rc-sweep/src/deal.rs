//! Distribution of rows to shards by their expected cost.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use serde::{Deserialize, Serialize};

use crate::shard::{Shard, SweepShape};

/// Minimum cost of a shard, in costs of the heaviest surface, for whole surfaces.
///
/// If shards have a lower cost, they get single rows.
const SMALLEST_PART: u128 = 10;

/// Distribution of the rows of a sweep to shards.
///
/// All processes that know the shape and the costs obtain the same distribution. The default has no costs and deals
/// load by load, as in the first journals of shards.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Deal {
    scenes: Vec<SceneCosts>,
}

/// Expected costs of the rows of one scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct SceneCosts {
    /// Number of surfaces of the scene.
    surfaces: usize,
    /// Processor time (µs) of each load, the same for all surfaces of the scene.
    costs: Vec<u64>,
}

/// Rows that one shard solves together.
#[derive(Clone, Copy)]
struct Portion {
    cost: u128,
    first: usize,
    rows: usize,
}

impl Deal {
    /// A distribution by processor time.
    ///
    /// Each scene has a number of surfaces, and the seconds of each load, the same for all its surfaces. `None` means
    /// unknown, and is replaced by the mean of the known values. Values are rounded to two digits, so that processors
    /// whose values differ in the last digit obtain the same distribution.
    pub(crate) fn by_cost(scenes: Vec<(usize, Vec<Option<f64>>)>) -> Self {
        let known: Vec<f64> = scenes.iter().flat_map(|(_, seconds)| seconds.iter().flatten().copied()).collect();
        let mean = if known.is_empty() { 1.0 } else { known.iter().sum::<f64>() / known.len() as f64 };
        let scene = |(surfaces, seconds): (usize, Vec<Option<f64>>)| {
            let costs = seconds.into_iter().map(|value| rounded(value.unwrap_or(mean))).collect();
            SceneCosts { surfaces, costs }
        };
        Self { scenes: scenes.into_iter().map(scene).collect() }
    }

    /// Whether rows are dealt load by load.
    pub(crate) fn is_by_load(&self) -> bool {
        self.scenes.is_empty()
    }

    /// Whether the distribution fits a sweep of this shape.
    pub(crate) fn fits(&self, shape: SweepShape) -> bool {
        let surfaces = self.scenes.iter().fold(0_usize, |sum, scene| sum.saturating_add(scene.surfaces));
        let loads = |scene: &SceneCosts| scene.costs.len() == shape.loads;
        self.is_by_load() || surfaces == shape.surfaces && self.scenes.iter().all(loads)
    }

    /// The rows of `shard`, in order.
    pub(crate) fn rows(&self, shard: Shard, shape: SweepShape) -> Vec<usize> {
        if shard.count == 1 || shape.rows() == 0 {
            return (0..shape.rows()).collect();
        }
        if self.is_by_load() {
            let place = |row: &usize| row % shape.loads * shape.surfaces + row / shape.loads;
            return (0..shape.rows()).filter(|row| place(row) % shard.count == shard.index - 1).collect();
        }
        let mut portions = self.portions(shard.count);
        portions.sort_by_key(|portion| (Reverse(portion.cost), portion.first));
        // If there are more shards than portions, some are empty.
        let mut shards: BinaryHeap<Reverse<(u128, usize)>> =
            (1..=shard.count.min(portions.len())).map(|index| Reverse((0, index))).collect();
        let mut rows = Vec::new();
        for portion in portions {
            let Some(Reverse((load, index))) = shards.pop() else { break };
            shards.push(Reverse((load.saturating_add(portion.cost), index)));
            if index == shard.index {
                rows.extend(portion.first..portion.first + portion.rows);
            }
        }
        rows.sort_unstable();
        rows
    }

    /// The portions that are dealt: whole surfaces, or single rows.
    ///
    /// The loads of a surface share its heights, so whole surfaces are preferred. They must be small enough for shards
    /// of equal cost.
    fn portions(&self, count: usize) -> Vec<Portion> {
        let sum = |scene: &SceneCosts| scene.costs.iter().map(|&cost| u128::from(cost)).sum::<u128>();
        let heaviest = self.scenes.iter().map(sum).max().unwrap_or(0);
        let all = self.scenes.iter().map(|scene| sum(scene).saturating_mul(scene.surfaces as u128));
        let all = all.fold(0_u128, u128::saturating_add);
        let whole = heaviest.saturating_mul(SMALLEST_PART).saturating_mul(count as u128) <= all;
        let (mut portions, mut first) = (Vec::new(), 0);
        for scene in &self.scenes {
            for _ in 0..scene.surfaces {
                let loads = scene.costs.len();
                if whole {
                    portions.push(Portion { cost: sum(scene), first, rows: loads });
                } else {
                    let row = |(load, &cost)| Portion { cost: u128::from(cost), first: first + load, rows: 1 };
                    portions.extend(scene.costs.iter().enumerate().map(row));
                }
                first += loads;
            }
        }
        portions
    }
}

/// Seconds as whole microseconds, rounded to two digits, at least 1.
fn rounded(seconds: f64) -> u64 {
    let micros = (1e6 * seconds).clamp(1.0, 1e15);
    format!("{micros:.1e}").parse::<f64>().map_or(1, |micros| micros.round() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rows of each of `count` shards.
    fn dealt(deal: &Deal, shape: SweepShape, count: usize) -> Vec<Vec<usize>> {
        assert!(deal.fits(shape), "{deal:?}");
        let shards: Vec<Vec<usize>> = (1..=count).map(|index| deal.rows(Shard { index, count }, shape)).collect();
        let mut all: Vec<usize> = shards.concat();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..shape.rows()), "{shape:?} in {count}: not each row once");
        shards
    }

    fn spread(values: &[f64]) -> f64 {
        let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &v| (low.min(v), high.max(v)));
        high - low
    }

    #[test]
    fn without_costs_shards_share_the_rows_and_the_loads() {
        for (surfaces, loads, count) in [(7, 8, 8), (1, 24, 4), (8, 8, 8), (3, 5, 15), (4, 1, 3), (2, 3, 1)] {
            let shape = SweepShape { surfaces, loads };
            let shards = dealt(&Deal::default(), shape, count);
            let sums = shards.iter().map(|rows| (rows.len(), rows.iter().map(|row| row % loads).sum::<usize>()));
            let (sizes, weights): (Vec<usize>, Vec<usize>) = sums.unzip();
            let spread = |values: &[usize]| values.iter().max().unwrap_or(&0) - values.iter().min().unwrap_or(&0);
            assert!(spread(&sizes) <= 1, "{shape:?} in {count}: {sizes:?} rows");
            // Different sizes, and the order of the deal, cause up to one step of the load for each row.
            assert!(spread(&weights) <= sizes[0] + loads, "{shape:?} in {count}: loads {weights:?}");
        }
    }

    /// The costs of two shards differ by at most one row.
    ///
    /// The longest remaining row always goes to the shard with the lowest cost.
    #[test]
    fn with_costs_no_two_shards_differ_by_more_than_the_heaviest_portion() {
        let seconds = [0.01, 0.02, 0.05, 0.2, 1.0];
        let scenes = vec![(7, seconds.map(Some).to_vec()), (3, seconds.map(|s| Some(10.0 * s)).to_vec())];
        let deal = Deal::by_cost(scenes);
        let shape = SweepShape { surfaces: 10, loads: 5 };
        for count in [2, 3, 5, 8] {
            let cost = |row: usize| seconds[row % 5] * if row / 5 < 7 { 1.0 } else { 10.0 };
            let sums: Vec<f64> =
                dealt(&deal, shape, count).iter().map(|rows| rows.iter().map(|&row| cost(row)).sum()).collect();
            assert!(spread(&sums) <= 10.0, "{count} shards take {sums:?}");
        }
        let sums: Vec<usize> = dealt(&deal, shape, 50).iter().map(Vec::len).collect();
        assert_eq!(sums, [1; 50], "as many shards as rows have one each");
        assert!(deal.rows(Shard { index: 51, count: 51 }, shape).is_empty());
    }

    #[test]
    fn many_surfaces_are_dealt_whole() {
        let deal = Deal::by_cost(vec![(100, vec![Some(1.0), Some(2.0), Some(4.0)])]);
        for rows in dealt(&deal, SweepShape { surfaces: 100, loads: 3 }, 5) {
            assert_eq!(rows.len(), 60);
            assert!(rows.chunks(3).all(|loads| loads[0] % 3 == 0 && loads[2] == loads[0] + 2), "{rows:?}");
        }
    }

    #[test]
    fn costs_have_two_digits_and_unknown_ones_are_the_mean() {
        let costs = |seconds: Vec<Option<f64>>| Deal::by_cost(vec![(1, seconds)]).scenes[0].costs.clone();
        assert_eq!(costs(vec![Some(0.001_249_9), Some(3.0)]), [1200, 3_000_000]);
        assert_eq!(costs(vec![Some(1.0), None, Some(3.0)]), [1_000_000, 2_000_000, 3_000_000]);
        assert_eq!(costs(vec![None, None]), [1_000_000; 2]);
        assert_eq!(costs(vec![Some(0.0), Some(1e-9)]), [1; 2]);
    }

    #[test]
    fn costs_of_another_shape_and_absurd_ones_do_no_harm() {
        let deal = Deal { scenes: vec![SceneCosts { surfaces: usize::MAX, costs: vec![u64::MAX; 2] }] };
        assert!(!deal.fits(SweepShape { surfaces: 2, loads: 2 }));
        let deal = Deal { scenes: vec![SceneCosts { surfaces: 2, costs: vec![u64::MAX; 2] }] };
        let shape = SweepShape { surfaces: 2, loads: 2 };
        let empty = Deal { scenes: vec![SceneCosts { surfaces: usize::MAX, costs: Vec::new() }] };
        let shape_of_none = SweepShape { surfaces: usize::MAX, loads: 0 };
        assert!(empty.fits(shape_of_none) && empty.rows(Shard { index: 1, count: 2 }, shape_of_none).is_empty());
        assert!(deal.fits(shape) && !deal.fits(SweepShape { surfaces: 2, loads: 1 }));
        dealt(&deal, shape, 3);
        assert!(deal.rows(Shard { index: usize::MAX, count: usize::MAX }, shape).is_empty());
    }
}
