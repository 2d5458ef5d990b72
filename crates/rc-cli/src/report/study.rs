//! The page of a study: the range of each result over the treatments, and all rows.

use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use rc_core::quantity::{count, digits, engineering};
use rc_sweep::Cells;
use serde::Serialize;
use serde_json::Value;

use super::page::{Command, Page, Text, Tile, made};
use crate::study::pictures::path_in;
use crate::study::ranges::{LoadRanges, Range};
use crate::study::record::{StudyRecord, takes_prefix, words};

/// Columns of the table of all rows: key, title and unit.
const COLUMNS: [(&str, &str, &str); 6] = [
    ("area_fraction", "contact area A/A0", ""),
    ("penetration", "penetration", "m"),
    ("mean_gap", "mean gap", "m"),
    ("max_pressure", "maximum pressure", "Pa"),
    ("contact_stiffness", "stiffness", "Pa/m"),
    ("rms_slope", "rms slope", ""),
];

/// Key of the contact area.
const AREA: &str = "area_fraction";

/// The data of a page of a study, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Body {
    loads: Vec<LoadTable>,
    heads: [&'static str; 7],
    pictures: Vec<Picture>,
    charts: Vec<RangeChart>,
    row_heads: Vec<&'static str>,
    rows: Vec<Vec<String>>,
    note: &'static str,
}

/// The contact of a treatment under the largest load, as a PNG in base64.
#[derive(Clone, Debug, Serialize)]
struct Picture {
    png: String,
    note: String,
}

/// The ranges at one load as a table.
#[derive(Clone, Debug, Serialize)]
struct LoadTable {
    name: String,
    rows: Vec<[String; 7]>,
}

/// A result against the load.
#[derive(Clone, Debug, Serialize)]
struct RangeChart {
    result: String,
    unit: &'static str,
    points: Vec<RangePoint>,
}

/// A result at one load: value, error of the mesh (0 if unknown), and range.
#[derive(Clone, Copy, Debug, Serialize)]
struct RangePoint {
    pressure: f64,
    value: f64,
    error: f64,
    low: f64,
    high: f64,
}

/// The page of `record`, which is in `folder`.
pub(super) fn page(folder: &Path, record: &StudyRecord) -> Page<Body> {
    let failed = record.rows.iter().filter(|row| row.get("status").is_some_and(|status| status == "not_converged"));
    let failed = failed.count();
    let status = if failed == 0 { "all converged".to_owned() } else { format!("{failed} not converged") };
    let path = Path::new(&record.source.file);
    let file = path.file_name().unwrap_or(path.as_os_str()).display();
    let steps = serde_json::to_string_pretty(&record.treatments).ok();
    Page {
        title: format!("Study: {file}"),
        subtitle: format!(
            "{file} under {}, at {}",
            count(record.treatments.len(), "treatment"),
            count(record.loads.len(), "pressure")
        ),
        status,
        good: failed == 0,
        warnings: record.skipped.iter().map(|one| format!("left out: {} ({})", one.treatment, one.reason)).collect(),
        tiles: record.loads.iter().filter_map(tile).collect(),
        commands: vec![Command {
            note: "In the folder where the study was started:".to_owned(),
            text: record.command.clone(),
        }],
        files: steps.map(|text| Text { title: "Steps of each treatment", text }).into_iter().collect(),
        made: made(),
        kind: "study",
        body: body(folder, record),
    }
}

/// The contact area at one load.
fn tile(load: &LoadRanges) -> Option<Tile> {
    let area = load.results.iter().find(|range| range.result == AREA)?;
    let percent = |value: f64| digits(100.0 * value, 3);
    let range = format!("{} – {} %", percent(area.treatment_low), percent(area.treatment_high));
    Some(Tile { name: "contact area", value: format!("{range} at {}", engineering(load.pressure, "Pa")) })
}

fn body(folder: &Path, record: &StudyRecord) -> Body {
    let table = |load: &LoadRanges| LoadTable {
        name: engineering(load.pressure, "Pa"),
        rows: load.results.iter().map(cells).collect(),
    };
    let first = record.loads.first().map_or(&[][..], |load| &load.results);
    Body {
        loads: record.loads.iter().map(table).collect(),
        heads: ["result", "as prepared", "mesh bar", "treatment_low", "by", "treatment_high", "by"],
        pictures: pictures(folder, record),
        charts: first.iter().map(|range| chart(record, range)).collect(),
        row_heads: ["treatment", "mean pressure"].into_iter().chain(COLUMNS.iter().map(|column| column.1)).collect(),
        rows: record.rows.iter().map(row).collect(),
        note: "Dots are the map as prepared, with the error of the mesh. Dashed lines are the least and the greatest result of all \
               treatments. Penetration, stiffness and conductance of a patch contain the indentation of the whole patch, and do \
               not count for a periodic map.",
    }
}

/// The contacts of the unchanged treatments and of those with the least and the greatest contact area.
///
/// Pictures that are not in `folder` are left out.
fn pictures(folder: &Path, record: &StudyRecord) -> Vec<Picture> {
    let load = record.loads.iter().max_by(|a, b| a.pressure.total_cmp(&b.pressure));
    let area = load.and_then(|load| load.results.iter().find(|range| range.result == AREA));
    let Some((base, area)) = record.treatments.first().zip(area) else { return Vec::new() };
    let wanted =
        [("", &base.treatment), ("least contact area: ", &area.low_by), ("greatest contact area: ", &area.high_by)];
    let shown = wanted.iter().enumerate().filter(|(i, (_, name))| wanted[..*i].iter().all(|(_, other)| other != name));
    let picture = |(_, (what, name)): (usize, &(&str, &String))| {
        let png = std::fs::read(path_in(folder, name)).ok()?;
        Some(Picture { png: STANDARD.encode(png), note: format!("{what}{name}") })
    };
    shown.filter_map(picture).collect()
}

fn cells(range: &Range) -> [String; 7] {
    let of = |value| words(value, range.si_unit());
    [
        range.result.replace('_', " "),
        of(range.value),
        range.mesh_error.map_or_else(|| "–".to_owned(), of),
        of(range.treatment_low),
        range.low_by.clone(),
        of(range.treatment_high),
        range.high_by.clone(),
    ]
}

fn chart(record: &StudyRecord, of: &Range) -> RangeChart {
    let point = |load: &LoadRanges| {
        let range = load.results.iter().find(|range| range.result == of.result)?;
        Some(RangePoint {
            pressure: load.pressure,
            value: range.value,
            error: range.mesh_error.unwrap_or(0.0),
            low: range.treatment_low,
            high: range.treatment_high,
        })
    };
    let points = record.loads.iter().filter_map(point).collect();
    let name = of.result.replace('_', " ");
    // The script puts a prefix before a unit.
    match of.si_unit() {
        unit if takes_prefix(unit) => RangeChart { result: name, unit, points },
        unit => RangeChart { result: format!("{name} ({unit})"), unit: "", points },
    }
}

fn row(cells: &Cells) -> Vec<String> {
    let of = |key: &str, unit| {
        cells.get(key).and_then(Value::as_f64).map_or_else(|| "–".to_owned(), |value| words(value, unit))
    };
    let name = |key: &str| cells.get(key).and_then(Value::as_str);
    let treatment = name("treatment").unwrap_or_default();
    let treatment = match name("same_as") {
        Some(other) => format!("{treatment} (same map as {other}, solved once)"),
        None => treatment.to_owned(),
    };
    let values = COLUMNS.iter().map(|(key, _, unit)| of(key, unit));
    [treatment, of("control_value", "Pa")].into_iter().chain(values).collect()
}
