//! The values that the paper prints, read from `data/paper.csv`.

use anyhow::{Context, Result};

const VALUES: &str = include_str!("../../../data/paper.csv");

/// The value called `name`, in the unit that the file gives.
///
/// # Errors
/// When the file does not have the name, or its value is not a number.
pub(crate) fn value(name: &str) -> Result<f64> {
    let row = VALUES.lines().map(|line| line.split(',')).find(|cells| cells.clone().next() == Some(name));
    let cell = row.and_then(|mut cells| cells.nth(1));
    let cell = cell.with_context(|| format!("data/paper.csv has no `{name}`; add the line"))?;
    cell.parse().with_context(|| format!("`{name}` in data/paper.csv is {cell}; write a number"))
}

/// The two numbers of waves N of the paper's rough surfaces.
///
/// # Errors
/// As [`value`].
pub(crate) fn both_waves() -> Result<[usize; 2]> {
    Ok([value("waves_a")? as usize, value("waves_b")? as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_is_a_number_with_unit_and_place() {
        for line in VALUES.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            assert_eq!(cells.len(), 5, "{line}");
            assert!(value(cells[0]).is_ok_and(f64::is_finite), "{line}");
            assert!(cells[2..4].iter().all(|cell| !cell.is_empty()), "{line}");
        }
    }

    #[test]
    fn the_ratio_of_areas_is_that_of_the_printed_ones() {
        let of = |name| value(name).expect("a printed value");
        assert!((of("area_ratio") - of("area_fraction_b") / of("area_fraction_a")).abs() < 5e-5);
    }

    #[test]
    fn an_unknown_name_is_an_error_that_names_it() {
        assert!(format!("{:#}", value("colour").expect_err("no such value")).contains("`colour`"));
    }
}
