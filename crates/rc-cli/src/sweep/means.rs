//! Means of the contact area over the seeds of a sweep, as text.

use rc_core::quantity::{digits, engineering};
use rc_sweep::{Cells, SweepRows};
use serde_json::Value;

use crate::curves::columns::unit_of;
use crate::curves::means::Mean;
use crate::text;

/// Minimum number of seeds of a mean. The standard deviation of two values is hardly known.
const FEWEST: usize = 3;

/// Maximum number of lines.
const MOST: usize = 20;

/// A line for each problem that was solved for several seeds; empty if there is none.
pub(super) fn over_seeds(rows: &SweepRows) -> String {
    let mut problems: Vec<(String, Vec<f64>)> = Vec::new();
    for cells in rows.values().filter(|cells| cells.contains_key("seed")) {
        if cells.get("status").is_some_and(|status| status == "not_converged") {
            continue;
        }
        let Some(area) = cells.get("area_fraction").and_then(Value::as_f64) else { continue };
        let name = problem(cells);
        match problems.iter_mut().find(|(other, _)| *other == name) {
            Some((_, areas)) => areas.push(area),
            None => problems.push((name, vec![area])),
        }
    }
    problems.retain(|(_, areas)| areas.len() >= FEWEST);
    let lines: String = problems.iter().take(MOST).map(|(name, areas)| line(name, areas)).collect();
    let more = problems.len().saturating_sub(MOST);
    lines + &if more > 0 { format!("  and {more} more\n") } else { String::new() }
}

/// What a row is, without its seed: scene, varied keys and load. They stand before its status.
fn problem(cells: &Cells) -> String {
    let control = cells.get("control").and_then(Value::as_str).unwrap_or("load");
    let number = |value: &Value| value.as_f64().map(|value| digits(value, 6));
    let text = |value: &Value| number(value).or(value.as_str().map(str::to_owned)).unwrap_or_else(|| value.to_string());
    let keys = cells.iter().take_while(|(key, _)| *key != "status").filter(|(key, _)| *key != "seed");
    let unit = if control == "penetration" { "m" } else { "Pa" };
    // The solid creeps under its mean pressure; the load in the first column is that of an elastic one.
    let constant = cells.get("mean_pressure").and_then(Value::as_f64).filter(|_| cells.contains_key("time"));
    let keys = keys.map(|(key, value)| match value.as_f64() {
        Some(load) if key == "control_value" => format!("{control} {}", engineering(constant.unwrap_or(load), unit)),
        Some(value) if !unit_of(key).is_empty() => format!("{key} {}", engineering(value, unit_of(key))),
        _ => format!("{key} {}", text(value)),
    });
    keys.collect::<Vec<_>>().join(", ")
}

/// The mean with its standard error, and the range.
fn line(name: &str, areas: &[f64]) -> String {
    let values: Vec<[f64; 2]> = areas.iter().map(|area| [*area, 0.0]).collect();
    let Some(mean) = Mean::of(&values) else { return String::new() };
    let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max]
        .map(|of| digits(100.0 * areas.iter().copied().fold(areas[0], of), 3));
    let mean = text::with_error(100.0 * mean.value, 100.0 * mean.error());
    format!("  {name}: contact area ({mean}) %, from {least} to {most} %, of {} seeds\n", areas.len())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn seeds_are_averaged_and_loads_are_not() {
        let row = |seed: u64, load: f64, area: f64| {
            let cells = json!({ "seed": seed, "control_value": load, "status": "converged", "control": "pressure", "area_fraction": area });
            cells.as_object().cloned().expect("cells")
        };
        let areas = [(1, 1e5, 0.01), (2, 1e5, 0.02), (3, 1e5, 0.03), (1, 2e5, 0.5), (2, 2e5, 0.5)];
        let rows: SweepRows =
            areas.into_iter().enumerate().map(|(i, (seed, load, area))| (i, row(seed, load, area))).collect();
        let expected = "  pressure 100 kPa: contact area (2.0 ± 0.6) %, from 1 to 3 %, of 3 seeds\n";
        assert_eq!(over_seeds(&rows), expected);
    }
}
