//! The published numbers, from `data/gfmd.csv` and `data/gfmd-stress.csv`.

use anyhow::{Context, Result};

const VALUES: &str = include_str!("../../../../data/gfmd.csv");

/// Published A/A0 at one load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Published {
    /// Mean pressure σ0/E*.
    pub(super) load: f64,
    /// A/A0 of the first set. The standard deviation of one of its surfaces follows.
    pub(super) first: f64,
    pub(super) deviation: f64,
    /// A/A0 of the second set, which ends before full contact.
    pub(super) second: Option<f64>,
}

/// The published areas of all loads, lightest first.
///
/// # Errors
/// When a cell is not a number.
pub(super) fn all() -> Result<Vec<Published>> {
    VALUES.lines().skip(1).map(|line| one(line).with_context(|| format!("`{line}` in data/gfmd.csv"))).collect()
}

fn one(line: &str) -> Result<Published> {
    let cells: Vec<&str> = line.split(',').collect();
    let cell = |column: usize| cells.get(column).copied().context("a cell is missing");
    let number = |column: usize| -> Result<f64> { Ok(cell(column)?.parse()?) };
    let second = if cell(3)?.is_empty() { None } else { Some(number(3)?) };
    Ok(Published { load: number(0)?, first: number(1)?, deviation: number(2)?, second })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers of a table; `None` for empty cells.
    fn rows(csv: &str) -> Vec<Vec<Option<f64>>> {
        csv.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().ok()).collect()).collect()
    }

    #[test]
    fn areas_rise_and_the_second_set_is_below_the_first() {
        let all = all().expect("numbers");
        assert!(all.len() == 14 && all.windows(2).all(|two| two[0].load < two[1].load && two[0].first < two[1].first));
        assert!(all.iter().all(|one| one.second.is_none_or(|second| second < one.first && second > 0.9 * one.first)));
    }

    /// What docs/benchmarks.md says about located areas and the second set.
    #[test]
    fn the_archived_areas_are_as_published() {
        let ours = rows(include_str!("../../../../data/runs/gfmd/gfmd-areas.csv"));
        assert_eq!(ours.len(), 14);
        let mut n_compared = 0;
        for (ours, published) in ours.iter().zip(all().expect("numbers")) {
            assert_eq!(ours[0], Some(published.load));
            let Some(second) = published.second else { continue };
            n_compared += 1;
            let difference = ours[1].expect("an area") / second - 1.0;
            let claim = match published.load {
                5e-3..0.03 => -0.015..-0.0095,
                0.04.. => -0.01..0.01,
                _ => -0.04..0.0,
            };
            assert!(claim.contains(&difference), "{difference} at {}", published.load);
        }
        assert_eq!(n_compared, 12, "loads of the second set");
    }

    /// What docs/benchmarks.md says about energy and mean gap of the archived run.
    #[test]
    fn the_archived_energy_and_gap_are_as_published() {
        let ours = rows(include_str!("../../../../data/runs/gfmd/gfmd-curve.csv"));
        assert_eq!(ours.len(), 14);
        for (ours, published) in ours.iter().zip(rows(VALUES)) {
            let (load, gap, energy) = (ours[0].expect("a load"), ours[2].expect("a gap"), ours[4].expect("an energy"));
            assert_eq!(published[0], Some(load));
            let (of_reference, deviation) = (published[4].expect("an energy"), published[5].expect("its s.d."));
            let bound = if load < 0.065 { deviation } else { 0.01 * of_reference };
            assert!((energy - of_reference).abs() < bound, "energy {energy} against {of_reference} at {load}");
            // The files do not say whether a gap is the middle of its bin or its lower end, half a bin below.
            let (Some(low), Some(high)) = (published[6], published[7]) else { continue };
            match load {
                1e-4 => assert!(gap > high && gap < 1.04 * high, "{gap} at the lightest load"),
                1e-3..0.02 => assert!((low..high).contains(&gap), "gap {gap} between {low} and {high} at {load}"),
                _ => assert!(gap < low && gap > 0.94 * low, "gap {gap} and {low} at {load}"),
            }
        }
    }

    /// What docs/benchmarks.md says about the stress of the archived run.
    #[test]
    fn the_archived_stress_is_as_published() {
        let ours = rows(include_str!("../../../../data/runs/gfmd/gfmd-stress.csv"));
        let ours: Vec<[f64; 3]> = ours.iter().map(|row| [0, 1, 2].map(|i| row[i].expect("a number"))).collect();
        // Loads, ranges of the stress, and the largest relative difference there.
        let claims = [(0.025, 0.08..0.32, 0.081), (0.113, 0.08..0.4, 0.06), (0.24, 0.1..0.46, 0.035)];
        let mut n_compared = 0;
        for row in rows(include_str!("../../../../data/gfmd-stress.csv")) {
            let [load, stress, published] = [0, 1, 2].map(|i| row[i].expect("a number"));
            let (_, range, bound) =
                claims.iter().find(|claim| load.total_cmp(&claim.0).is_eq()).expect("a load of a claim");
            let ours = ours.iter().filter(|row| row[0].total_cmp(&load).is_eq()).collect::<Vec<_>>();
            let pair = ours.windows(2).find(|two| (two[0][1]..two[1][1]).contains(&stress));
            let Some([a, b]) = pair.filter(|_| range.contains(&stress)) else { continue };
            let density = a[2] + (b[2] - a[2]) * (stress - a[1]) / (b[1] - a[1]);
            assert!((density / published - 1.0).abs() < *bound, "{density} against {published}: {stress} at {load}");
            n_compared += 1;
        }
        assert!(n_compared >= 18, "{n_compared} stresses compared");
    }
}
