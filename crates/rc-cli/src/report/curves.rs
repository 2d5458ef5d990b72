//! The page of a sweep: area-load and load-penetration curves.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::page::{Page, Text, Tile, made};
use super::{percolation, sweep_command};
use crate::error::CliError;
use rc_core::quantity::{Scale, count, digits, engineering};
use rc_sweep::{TABLE_FILE, WarningCode};

/// Units of keys that may be varied.
const UNITS: [(&str, &str); 12] = [
    ("hardness", "Pa"),
    ("e_star", "Pa"),
    ("young", "Pa"),
    ("young2", "Pa"),
    ("force", "N"),
    ("cell", "m"),
    ("cell_y", "m"),
    ("rms", "m"),
    ("layer_thickness", "m"),
    ("radius", "m"),
    ("wavelength", "m"),
    ("wave_amplitude", "m"),
];

/// The columns of `sweep.csv` that the page uses, in SI units.
#[derive(Clone, Debug, Deserialize)]
struct Row {
    /// Name of the scene, with the varied keys and their values.
    #[serde(default)]
    scene: String,
    /// The same in the words of the page.
    #[serde(skip)]
    label: String,
    seed: Option<u64>,
    control_value: f64,
    control: String,
    status: String,
    mean_pressure: f64,
    penetration: f64,
    area_fraction: f64,
    area_fraction_error: f64,
    mean_gap: f64,
    contact_stiffness: Option<f64>,
    #[serde(default)]
    contact_conductance: Option<f64>,
    #[serde(default)]
    conductance: Option<f64>,
    #[serde(default)]
    permeance_x: Option<f64>,
    #[serde(default)]
    permeance_y: Option<f64>,
    /// Codes of the warnings, with blanks between them.
    #[serde(default)]
    warnings: Option<String>,
    wall_seconds: f64,
}

/// The data of a page of a sweep, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Curves {
    scenes: Vec<SceneCurves>,
    heads: Vec<&'static str>,
    rows: Vec<Vec<String>>,
    note: &'static str,
    /// Sentence about the end of percolation, for a sweep with flows.
    percolation: Option<String>,
}

/// The curves of one scene.
#[derive(Clone, Debug, Serialize)]
struct SceneCurves {
    /// Name of the scene; empty if there is only one.
    name: String,
    /// One curve for each seed.
    seeds: Vec<Vec<Point>>,
    /// Means over the seeds at the loads that all seeds have.
    mean: Vec<Point>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
struct Point {
    pressure: f64,
    area: f64,
    penetration: f64,
    gap: f64,
    /// Stiffness; not finite in full contact.
    stiffness: Option<f64>,
    /// Conductance per conductivity (1/m); not finite in full contact.
    conductance: Option<f64>,
    /// Conductance for the given conductivities, in their unit per metre.
    of_bodies: Option<f64>,
    /// Mean permeance of both axes (m³), if flows were computed.
    permeance: Option<f64>,
}

/// The page of the sweep in `folder`, whose journal has `settings`.
///
/// # Errors
/// [`CliError::Input`] when `sweep.csv` does not have the format of a sweep, or has no rows.
pub(super) fn page(folder: &Path, settings: Option<&Value>) -> Result<Page<Curves>, CliError> {
    let rows = read(&folder.join(TABLE_FILE))?;
    let scenes: Vec<SceneCurves> = groups(&rows, |row| &row.scene).into_iter().map(SceneCurves::of).collect();
    let surfaces: usize = scenes.iter().map(|scene| scene.seeds.len()).sum();
    let (status, good) = status(&rows, settings);
    let text = settings.and_then(|settings| serde_json::to_string_pretty(settings).ok());
    let files = text.map(|text| Text { title: "Settings of the sweep", text }).into_iter().collect();
    Ok(Page {
        title: format!("Sweep: {}", folder.file_name().unwrap_or(folder.as_os_str()).display()),
        subtitle: format!(
            "{} on {}, at prescribed {}s",
            count(rows.len(), "row"),
            count(surfaces, "surface"),
            rows[0].control
        ),
        status,
        good,
        warnings: warnings(&rows),
        tiles: tiles(&rows),
        commands: settings.map_or_else(Vec::new, sweep_command::commands),
        files,
        made: made(),
        kind: "sweep",
        body: table(scenes, &rows),
    })
}

/// One line for each code of a warning, with the number of its rows.
fn warnings(rows: &[Row]) -> Vec<String> {
    let codes = |row: &Row| row.warnings.clone().unwrap_or_default();
    let has = |row: &&Row, code: WarningCode| codes(row).split(' ').any(|found| found == code.name());
    let told = |code: WarningCode| {
        let n = rows.iter().filter(|row| has(row, code)).count();
        (n > 0).then(|| format!("{code}: {} ({n} of {})", code.meaning(), count(rows.len(), "row")))
    };
    WarningCode::ALL.into_iter().filter_map(told).collect()
}

fn read(path: &Path) -> Result<Vec<Row>, CliError> {
    let fail = |cause: csv::Error| CliError::in_file(path, format_args!("not a table of rc sweep: {cause}"));
    let mut reader = csv::Reader::from_path(path).map_err(fail)?;
    let heads = reader.headers().map_err(fail)?.clone();
    let row = |record: csv::StringRecord| -> Result<Row, csv::Error> {
        let row: Row = record.deserialize(Some(&heads))?;
        let varied = varied(&heads, &record);
        let named = |words: fn(&str, &str) -> String| {
            let parts = varied.iter().map(|(key, value)| words(key, value));
            [row.scene.clone()].into_iter().chain(parts).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
        };
        let (scene, label) = (named(|key, value| format!("{key} {value}")), named(in_words));
        Ok(Row { scene, label, ..row })
    };
    let rows: Vec<Row> = reader.records().map(|record| row(record?)).collect::<Result<_, _>>().map_err(fail)?;
    if rows.is_empty() { Err(CliError::in_file(path, "has no rows")) } else { Ok(rows) }
}

/// The varied keys of a row with their values. They are between load and status.
fn varied<'a>(heads: &'a csv::StringRecord, record: &'a csv::StringRecord) -> Vec<(&'a str, &'a str)> {
    let cells = heads.iter().zip(record).skip_while(|(head, _)| *head != "control_value").skip(1);
    cells.take_while(|(head, _)| *head != "status").collect()
}

/// A varied key with its value, such as `hardness = 5 MPa`.
fn in_words(key: &str, value: &str) -> String {
    let unit = UNITS.iter().find(|(name, _)| *name == key).map(|(_, unit)| *unit);
    let value = match (value.parse::<f64>(), unit) {
        (Ok(number), Some(unit)) => engineering(number, unit),
        (Ok(number), None) => number.to_string(),
        (Err(_), _) => value.to_owned(),
    };
    format!("{} = {value}", key.replace('_', " "))
}

/// A sentence about the rows, and whether all planned rows exist and converged.
///
/// Rows of an interrupted sweep, of other shards, and under loads that a surface cannot take are missing.
fn status(rows: &[Row], settings: Option<&Value>) -> (String, bool) {
    let surfaces = settings.and_then(|settings| settings["surfaces"].as_array());
    let loads = |surface: &Value| surface["loads"].as_array().map_or(0, Vec::len);
    let planned = surfaces.map_or(rows.len(), |surfaces| surfaces.iter().map(loads).sum());
    let failed = rows.iter().filter(|row| row.status == "not_converged").count();
    if failed > 0 {
        (format!("{failed} not converged"), false)
    } else if rows.len() < planned {
        (format!("{} of {planned} rows", rows.len()), false)
    } else {
        ("all converged".to_owned(), true)
    }
}

/// Runs of rows with the same key.
fn groups<K: PartialEq>(rows: &[Row], key: impl Fn(&Row) -> &K) -> Vec<&[Row]> {
    rows.chunk_by(|a, b| key(a) == key(b)).collect()
}

impl SceneCurves {
    fn of(rows: &[Row]) -> Self {
        let seeds: Vec<Vec<Point>> =
            groups(rows, |row| &row.seed).into_iter().map(|rows| rows.iter().map(Point::of).collect()).collect();
        let mut loads: Vec<f64> = rows.iter().map(|row| row.control_value).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        let at = |load: f64| -> Vec<Point> {
            rows.iter().filter(|row| row.control_value.total_cmp(&load).is_eq()).map(Point::of).collect()
        };
        // A mean over a part of the seeds would jump where the curve of a seed ends.
        let of_all = loads.into_iter().map(at).filter(|points| points.len() == seeds.len());
        let mean = of_all.map(|points| Point::mean(&points)).collect();
        Self { name: rows.first().map(|row| row.label.clone()).unwrap_or_default(), seeds, mean }
    }
}

impl Point {
    fn of(row: &Row) -> Self {
        Self {
            pressure: row.mean_pressure,
            area: row.area_fraction,
            penetration: row.penetration,
            gap: row.mean_gap,
            stiffness: row.contact_stiffness,
            conductance: row.contact_conductance,
            of_bodies: row.conductance,
            permeance: row.permeance_x.zip(row.permeance_y).map(|(x, y)| 0.5 * (x + y)),
        }
    }

    fn mean(points: &[Self]) -> Self {
        let mean = |of: &dyn Fn(&Self) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
        let finite = |of: &dyn Fn(&Self) -> Option<f64>| {
            Some(mean(&|point| of(point).unwrap_or(f64::INFINITY))).filter(|value| value.is_finite())
        };
        Self {
            pressure: mean(&|point| point.pressure),
            area: mean(&|point| point.area),
            penetration: mean(&|point| point.penetration),
            gap: mean(&|point| point.gap),
            stiffness: finite(&|point| point.stiffness),
            conductance: finite(&|point| point.conductance),
            of_bodies: finite(&|point| point.of_bodies),
            permeance: finite(&|point| point.permeance),
        }
    }
}

fn tiles(rows: &[Row]) -> Vec<Tile> {
    let range = |of: fn(&Row) -> f64| {
        rows.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let from_to = |of, unit| {
        let (low, high) = range(of);
        let scale = Scale::of(high, unit);
        format!("{} – {} {}", digits(low / scale.factor, 3), digits(high / scale.factor, 3), scale.unit())
    };
    let (low, high) = range(|row| 100.0 * row.area_fraction);
    let seconds: f64 = rows.iter().map(|row| row.wall_seconds).sum();
    vec![
        Tile { name: "rows", value: rows.len().to_string() },
        Tile { name: "mean pressure", value: from_to(|row| row.mean_pressure, "Pa") },
        Tile { name: "contact area", value: format!("{} – {} %", digits(low, 3), digits(high, 3)) },
        Tile { name: "penetration", value: from_to(|row| row.penetration, "m") },
        Tile { name: "time of all rows", value: format!("{} s", digits(seconds, 3)) },
    ]
}

fn table(scenes: Vec<SceneCurves>, rows: &[Row]) -> Curves {
    let several = scenes.len() > 1;
    let cells = |row: &Row| {
        let mut cells = if several { vec![row.label.clone()] } else { Vec::new() };
        cells.extend([
            row.seed.map_or_else(|| "–".to_owned(), |seed| seed.to_string()),
            engineering(row.mean_pressure, "Pa"),
            engineering(row.penetration, "m"),
            format!("{} ± {}", digits(100.0 * row.area_fraction, 4), digits(100.0 * row.area_fraction_error, 1)),
            engineering(row.mean_gap, "m"),
            row.contact_stiffness.map_or_else(|| "infinite".to_owned(), |value| engineering(value, "Pa/m")),
            row.status.replace('_', " "),
        ]);
        cells
    };
    let name = if rows.iter().any(|row| row.label != row.scene) { "variation" } else { "scene" };
    let mut heads = if several { vec![name] } else { Vec::new() };
    heads.extend(["seed", "mean pressure", "penetration", "contact area (%)", "mean gap", "stiffness", "status"]);
    let flows = rows.iter().filter_map(|row| {
        let key = (row.scene.clone(), row.seed);
        Some((key, row.area_fraction, [row.permeance_x?, row.permeance_y?]))
    });
    Curves {
        percolation: percolation::note(flows.collect()),
        scenes,
        heads,
        rows: rows.iter().map(cells).collect(),
        note: "Thin lines are single surfaces. Thick lines with dots are means over the surfaces, at loads that all surfaces have. \
               Penetration is counted from first touch. Linear axes begin at zero, but logarithmic ones do not.",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_over_seeds_under_equal_loads() {
        let row = |seed, load: f64, area| Row {
            scene: String::new(),
            label: String::new(),
            seed: Some(seed),
            control_value: load,
            control: "pressure".to_owned(),
            status: "converged".to_owned(),
            mean_pressure: load,
            penetration: 2.0 * load,
            area_fraction: area,
            area_fraction_error: 0.0,
            mean_gap: 1.0,
            contact_stiffness: (seed == 1).then_some(3.0),
            contact_conductance: Some(load),
            conductance: None,
            permeance_x: Some(4.0 - load),
            permeance_y: None,
            warnings: None,
            wall_seconds: 0.0,
        };
        let rows = [row(1, 1.0, 0.1), row(1, 2.0, 0.2), row(2, 1.0, 0.3), row(2, 2.0, 0.6)];
        let curves = SceneCurves::of(&rows);
        assert_eq!(curves.seeds.len(), 2);
        let areas: Vec<f64> = curves.mean.iter().map(|point| point.area).collect();
        assert!((areas[0] - 0.2).abs() < 1e-15 && (areas[1] - 0.4).abs() < 1e-15, "{areas:?}");
        assert_eq!((curves.mean[0].penetration, curves.mean[0].stiffness), (2.0, None));
        // One seed does not have the second load, so there is no mean at that load.
        let curves = SceneCurves::of(&[row(1, 1.0, 0.1), row(1, 2.0, 0.2), row(2, 1.0, 0.3)]);
        assert_eq!((curves.seeds[0].len(), curves.seeds[1].len(), curves.mean.len()), (2, 1, 1));
    }
}
