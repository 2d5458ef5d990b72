//! The published areas, from `data/gfmd.csv`.

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

    #[test]
    fn areas_rise_and_the_second_set_is_below_the_first() {
        let all = all().expect("numbers");
        assert!(all.len() == 14 && all.windows(2).all(|two| two[0].load < two[1].load && two[0].first < two[1].first));
        assert!(all.iter().all(|one| one.second.is_none_or(|second| second < one.first && second > 0.9 * one.first)));
    }
}
