//! `sweep.csv` read back.

use std::path::Path;

use rc_core::quantity::engineering;
use rc_sweep::{Cells, RowPlace, TABLE_FILE, rows_in, settings_in};
use serde_json::Value;

use super::columns::{self, PRESSURE, Quantity, SWEPT};
use crate::error::CliError;

/// Units of keys that may be varied.
const UNITS: [(&str, &str); 19] = [
    ("pressure", "Pa"),
    ("penetration", "m"),
    ("speed", "m/s"),
    ("time", "s"),
    ("direction", "°"),
    ("relaxation_time", "s"),
    ("hardness", "Pa"),
    ("e_star", "Pa"),
    ("young", "Pa"),
    ("young2", "Pa"),
    ("force", "N"),
    ("cell", "m"),
    ("cell_y", "m"),
    ("rms", "m"),
    ("layer_thickness", "m"),
    ("substrate_young", "Pa"),
    ("radius", "m"),
    ("wavelength", "m"),
    ("wave_amplitude", "m"),
];

/// Columns that every row has a number in.
const NEEDED: [&str; 4] = ["control_value", "mean_pressure", "penetration", "area_fraction"];

/// A row of a sweep.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row {
    /// Name of the scene, with the varied keys and their values; empty if there is only one.
    pub(crate) scene: String,
    /// The same in the words of the page.
    pub(crate) label: String,
    pub(crate) seed: Option<u64>,
    /// Prescribed pressure (Pa) or penetration (m), or the speed (m/s) or time (s) that is varied.
    pub(crate) load: f64,
    /// `pressure`, `penetration`, `speed` or `time`.
    pub(crate) control: String,
    pub(crate) status: String,
    /// Codes of the warnings, with blanks between them.
    pub(crate) warnings: String,
    /// The numbers of the row by their columns, in SI units. Empty fields are null.
    pub(crate) cells: Cells,
    /// Where the row comes from, if the journal says so.
    pub(crate) place: Option<RowPlace>,
}

impl Row {
    /// The number in a column.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        columns::number(&self.cells, key)
    }

    /// The load with its unit.
    pub(crate) fn load_in_words(&self) -> String {
        engineering(self.load, unit_of_load(&self.control))
    }

    /// The name of scene and seed, if there is any.
    pub(crate) fn surface(&self) -> String {
        let seed = self.seed.map(|seed| format!("seed {seed}"));
        let parts = [self.label.clone(), seed.unwrap_or_default()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// The rows of a sweep, with the settings in its journal.
#[derive(Clone, Debug)]
pub(crate) struct SweepTable {
    /// At least one row, ordered by scene, seed and load.
    pub(crate) rows: Vec<Row>,
    pub(crate) settings: Option<Value>,
    /// What the quantities are drawn against.
    pub(crate) against: Quantity,
}

/// SI unit of the values that a control has.
pub(crate) fn unit_of_load(control: &str) -> &'static str {
    match control {
        "penetration" => "m",
        "pressure" => "Pa",
        swept => columns::unit_of(swept),
    }
}

impl SweepTable {
    /// Reads the table in `folder`, which may be the file of a table without a journal.
    ///
    /// # Errors
    /// [`CliError::Input`] when it does not have the format of a sweep, or has no rows.
    pub(crate) fn read(folder: &Path) -> Result<Self, CliError> {
        let path = if folder.is_file() { folder.to_owned() } else { folder.join(TABLE_FILE) };
        let fail = |cause: String| CliError::in_file(&path, format_args!("not a table of rc sweep: {cause}"));
        let mut reader = csv::Reader::from_path(&path).map_err(|cause| fail(cause.to_string()))?;
        let heads = reader.headers().map_err(|cause| fail(cause.to_string()))?.clone();
        let records = reader.records().collect::<Result<Vec<_>, _>>().map_err(|cause| fail(cause.to_string()))?;
        let axis = Axis::of(&heads, &records);
        let mut rows = Vec::new();
        for (number, record) in (2..).zip(&records) {
            rows.push(row(&heads, record, axis).map_err(|message| fail(format!("line {number}: {message}")))?);
        }
        if rows.is_empty() {
            return Err(CliError::in_file(&path, "has no rows"));
        }
        // A journal with more rows belongs to a sweep that goes on.
        let places = rows_in(folder).filter(|places| places.len() == rows.len()).unwrap_or_default();
        for (row, place) in rows.iter_mut().zip(places) {
            row.place = Some(place);
        }
        if axis.swept.is_some() {
            by_scene_and_seed(&mut rows);
        }
        Ok(Self { rows, settings: settings_in(folder), against: axis.swept.unwrap_or(PRESSURE) })
    }

    /// Runs of rows of the same scene.
    pub(crate) fn scenes(&self) -> Vec<&[Row]> {
        self.rows.chunk_by(|a, b| a.scene == b.scene).collect()
    }

    /// Runs of rows of the same scene and seed.
    pub(crate) fn surfaces(&self) -> Vec<&[Row]> {
        self.rows.chunk_by(|a, b| (&a.scene, a.seed) == (&b.scene, b.seed)).collect()
    }

    /// Whether a constant ratio is between the loads, of which there are at least three.
    ///
    /// The speed 0 does not count.
    pub(crate) fn is_geometric(&self) -> bool {
        let mut loads: Vec<f64> = self.rows.iter().map(|row| row.load).collect();
        if self.against != PRESSURE && loads.iter().any(|load| *load > 0.0) {
            loads.retain(|load| *load > 0.0);
        }
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        let ratios: Vec<f64> = loads.windows(2).map(|pair| pair[1] / pair[0]).collect();
        // Loads over decades may be round numbers, such as 1e5,2e5,5e5,1e6.
        let spread = if loads[loads.len() - 1] >= 9.9 * loads[0] { 0.35 } else { 0.02 };
        let is_equal = |ratio: &f64| (ratio.ln() / ratios[0].ln() - 1.0).abs() < spread;
        ratios.len() >= 2 && ratios[0].is_finite() && loads[0] > 0.0 && ratios.iter().all(is_equal)
    }
}

/// What the rows of a table differ in, besides scene, seed and varied keys.
#[derive(Clone, Copy)]
struct Axis {
    /// The varied key that takes the place of the load.
    swept: Option<Quantity>,
    /// Whether the loads differ too, and belong to the names of the scenes.
    names_loads: bool,
}

impl Axis {
    fn of(heads: &csv::StringRecord, records: &[csv::StringRecord]) -> Self {
        let are_several =
            |key: &str| records.iter().any(|record| text_of(heads, record, key) != text_of(heads, &records[0], key));
        let is_varied =
            |key: &str| records.first().is_some_and(|first| varied(heads, first).iter().any(|(name, _)| *name == key));
        let swept = SWEPT.into_iter().find(|one| is_varied(one.key()) && are_several(one.key()));
        // A time has its own load.
        let names_loads = swept.is_some_and(|one| one.name == "speed") && are_several("control_value");
        Self { swept, names_loads }
    }
}

/// Puts rows of a scene and seed together, in their order.
fn by_scene_and_seed(rows: &mut [Row]) {
    let mut scenes: Vec<(String, Option<u64>)> = Vec::new();
    let mut place = |row: &Row| {
        let key = (row.scene.clone(), row.seed);
        scenes.iter().position(|other| *other == key).unwrap_or_else(|| {
            scenes.push(key);
            scenes.len() - 1
        })
    };
    let places: Vec<usize> = rows.iter().map(&mut place).collect();
    // Scenes in the order of their first rows, and the seeds of a scene together.
    let first = |scene: &str| scenes.iter().position(|(other, _)| other == scene).unwrap_or_default();
    let mut order: Vec<(usize, usize, usize)> =
        places.iter().enumerate().map(|(i, &place)| (first(&scenes[place].0), place, i)).collect();
    order.sort_unstable();
    let sorted: Vec<Row> = order.into_iter().map(|(.., i)| std::mem::take(&mut rows[i])).collect();
    rows.iter_mut().zip(sorted).for_each(|(row, next)| *row = next);
}

fn text_of<'a>(heads: &csv::StringRecord, record: &'a csv::StringRecord, key: &str) -> &'a str {
    heads.iter().position(|head| head == key).and_then(|i| record.get(i)).unwrap_or_default()
}

fn row(heads: &csv::StringRecord, record: &csv::StringRecord, axis: Axis) -> Result<Row, String> {
    let text = |key: &str| text_of(heads, record, key);
    let value = |text: &str| text.parse::<f64>().map_or(Value::Null, Value::from);
    let cells: Cells = heads.iter().zip(record).map(|(head, text)| (head.to_owned(), value(text))).collect();
    if let Some(key) = NEEDED.iter().find(|key| columns::number(&cells, key).is_none()) {
        return Err(format!("no number in the column {key}"));
    }
    let swept = axis.swept.map(|one| one.key());
    let mut varied = varied(heads, record);
    varied.retain(|(key, _)| Some(*key) != swept);
    if axis.names_loads {
        varied.push((text("control"), text("control_value")));
    }
    let named = |words: fn(&str, &str) -> String| {
        let parts = varied.iter().map(|(key, value)| words(key, value));
        let scene = text("scene").to_owned();
        [scene].into_iter().chain(parts).filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    };
    let is_varied = |key: &String| varied.iter().any(|(name, _)| name == key);
    let load = columns::number(&cells, swept.unwrap_or("control_value")).unwrap_or_default();
    Ok(Row {
        scene: named(|key, value| format!("{key} {value}")),
        label: named(in_words),
        seed: text("seed").parse().ok(),
        load,
        control: swept.unwrap_or_else(|| text("control")).to_owned(),
        status: text("status").to_owned(),
        warnings: text("warnings").to_owned(),
        cells: cells
            .iter()
            .filter(|(key, _)| !is_varied(key))
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect(),
        place: None,
    })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_varied_speed_takes_the_place_of_the_load() {
        let text = "seed,control_value,speed,hardness,status,control,mean_pressure,penetration,area_fraction\n\
                    1,5.0,0.0,1e6,converged,pressure,5.0,1.0,0.3\n\
                    2,5.0,0.0,1e6,converged,pressure,5.0,1.0,0.3\n\
                    1,5.0,1.0,1e6,converged,pressure,5.0,1.0,0.1\n\
                    2,5.0,1.0,1e6,converged,pressure,5.0,1.0,0.1\n\
                    1,5.0,10.0,1e6,converged,pressure,5.0,1.0,0.2\n\
                    2,5.0,10.0,1e6,converged,pressure,5.0,1.0,0.2\n\
                    2,5.0,100.0,1e6,converged,pressure,5.0,1.0,0.2\n";
        let dir = tempfile::tempdir().expect("a temporary folder");
        std::fs::write(dir.path().join(TABLE_FILE), text).expect("a table");
        let table = SweepTable::read(dir.path()).expect("a sweep");
        assert_eq!((table.against.name, table.scenes().len(), table.is_geometric()), ("speed", 1, true));
        let found: Vec<_> = table.rows.iter().map(|row| (row.seed.unwrap_or_default(), row.load)).collect();
        assert_eq!(found, [(1, 0.0), (1, 1.0), (1, 10.0), (2, 0.0), (2, 1.0), (2, 10.0), (2, 100.0)]);
        assert_eq!((&*table.rows[0].label, &*table.rows[1].load_in_words()), ("hardness = 1 MPa", "1 m/s"));
        // Several loads are several curves.
        std::fs::write(dir.path().join(TABLE_FILE), text.replace("2,5.0,", "2,6.0,")).expect("a table");
        let table = SweepTable::read(dir.path()).expect("a sweep");
        let labels: Vec<_> = table.scenes().iter().map(|rows| rows[0].label.clone()).collect();
        assert_eq!(labels, ["hardness = 1 MPa, pressure = 5 Pa", "hardness = 1 MPa, pressure = 6 Pa"]);
    }

    #[test]
    fn loads_of_a_constant_ratio_are_geometric() {
        let table = |loads: &[f64]| {
            let rows = loads.iter().map(|&load| Row { load, ..Row::default() }).collect();
            SweepTable { rows, settings: None, against: PRESSURE }
        };
        for loads in [&[1e4, 1e5, 1e6][..], &[1e5, 2e5, 5e5, 1e6], &[1.0, 2.0, 4.0, 1.0, 2.0, 4.0]] {
            assert!(table(loads).is_geometric(), "{loads:?}");
        }
        for loads in [&[1e4, 1e5][..], &[1.0, 2.0, 3.0, 4.0], &[2.0, 3.0, 4.0], &[0.0, 1.0, 2.0], &[3.0]] {
            assert!(!table(loads).is_geometric(), "{loads:?}");
        }
    }
}
