//! The page of a sweep: curves with their errors, contact maps of its rows, and the rows.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::frames::Frames;
use super::page::{Page, Text, Tile, made};
use super::{percolation, sweep_command};
use crate::curves::columns::{PRESSURE, QUANTITIES, Quantity, SWEPT, bar_of};
use crate::curves::means::{AtLoad, Mean};
use crate::curves::sealing::Sealing;
use crate::curves::table::{Row, SweepTable};
use crate::curves::text::cell;
use crate::curves::theory::{PerssonLine, persson};
use crate::error::CliError;
use crate::text;
use rc_core::quantity::{Scale, count, digits, engineering};
use rc_sweep::WarningCode;

/// The data of a page of a sweep, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Curves {
    scenes: Vec<SceneCurves>,
    /// What the quantities are drawn against: `pressure`, `speed` or `time`.
    against: &'static str,
    /// Whether the loads have a constant ratio, so that logarithmic axes show them evenly.
    geometric: bool,
    persson: Vec<PerssonLine>,
    frames: Option<Frames>,
    /// Sentence about the contact maps.
    frames_note: String,
    means: Option<Table>,
    heads: Vec<&'static str>,
    rows: Vec<Vec<String>>,
    note: String,
    /// Sentences about the pressures or areas at which the film closes, for a sweep with flows.
    sealing: Vec<String>,
}

/// A table of text.
#[derive(Clone, Debug, Serialize)]
struct Table {
    heads: Vec<&'static str>,
    rows: Vec<Vec<String>>,
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

/// The quantities at one load by their names, and their errors by the names with `_error`.
type Point = BTreeMap<String, f64>;

/// The page of the sweep in `folder`.
///
/// # Errors
/// [`CliError::Input`] when `sweep.csv` does not have the format of a sweep, has no rows, or fields cannot be read.
pub(super) fn page(folder: &Path) -> Result<Page<Curves>, CliError> {
    let table = SweepTable::read(folder)?;
    let (rows, settings) = (&table.rows, table.settings.as_ref());
    let (status, good) = status(rows, settings);
    let text = settings.and_then(|settings| serde_json::to_string_pretty(settings).ok());
    let files = text.map(|text| Text { title: "Settings of the sweep", text }).into_iter().collect();
    Ok(Page {
        title: format!("Sweep: {}", folder.file_name().unwrap_or(folder.as_os_str()).display()),
        subtitle: subtitle(&table),
        status,
        good,
        warnings: warnings(rows),
        tiles: tiles(&table),
        commands: settings.map_or_else(Vec::new, sweep_command::commands),
        files,
        made: made(),
        kind: "sweep",
        body: body(folder, &table)?,
    })
}

/// Whether keys of the scenes were varied, of which some change the surface and others the contact.
fn is_varied(rows: &[Row]) -> bool {
    rows.iter().any(|row| row.label != row.scene)
}

fn subtitle(table: &SweepTable) -> String {
    let n = |what| count(table.surfaces().len(), what);
    let (rows, control) = (count(table.rows.len(), "row"), &table.rows[0].control);
    if table.against == PRESSURE {
        format!("{rows} on {}, at prescribed {control}s", n(if is_varied(&table.rows) { "problem" } else { "surface" }))
    } else {
        format!("{rows} in {}, at several {control}s", n("curve"))
    }
}

/// One line for each code of a warning, with the number of its rows.
fn warnings(rows: &[Row]) -> Vec<String> {
    let has = |row: &&Row, code: WarningCode| row.warnings.split(' ').any(|found| found == code.name());
    let told = |code: WarningCode| {
        let n = rows.iter().filter(|row| has(row, code)).count();
        (n > 0).then(|| format!("{code}: {} ({n} of {})", code.meaning(), count(rows.len(), "row")))
    };
    WarningCode::ALL.into_iter().filter_map(told).collect()
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

impl SceneCurves {
    fn of(rows: &[Row]) -> Self {
        let of_row = |row: &Row| point(|quantity| quantity.of(&row.cells));
        let of_mean = |at: &AtLoad<'_>| point(|quantity| at.mean(quantity).map(|mean| [mean.value, mean.error()]));
        let seeds = rows.chunk_by(|a, b| a.seed == b.seed).map(|rows| rows.iter().map(of_row).collect());
        Self {
            name: rows.first().map(|row| row.label.clone()).unwrap_or_default(),
            seeds: seeds.collect(),
            mean: AtLoad::of_all_seeds(rows).iter().map(of_mean).collect(),
        }
    }
}

/// The point with value and error of each quantity that has them.
fn point(of: impl Fn(Quantity) -> Option<[f64; 2]>) -> Point {
    let mut point = Point::new();
    for quantity in [PRESSURE].into_iter().chain(SWEPT).chain(QUANTITIES) {
        if let Some([value, error]) = of(quantity) {
            point.insert(quantity.name.to_owned(), value);
            point.insert(format!("{}_error", quantity.name), error);
        }
    }
    point
}

fn tiles(table: &SweepTable) -> Vec<Tile> {
    let (rows, against) = (&table.rows, table.against);
    let range = |key: &str| {
        let values = rows.iter().filter_map(|row| row.number(key));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let from_to = |key: &str, unit| {
        let (low, high) = range(key);
        let scale = Scale::of(high, unit);
        format!("{} – {} {}", digits(low / scale.factor, 3), digits(high / scale.factor, 3), scale.unit())
    };
    let (low, high) = range("area_fraction");
    let seconds: f64 = rows.iter().filter_map(|row| row.number("wall_seconds")).sum();
    let (least, most) = range("friction");
    let friction = (most >= least).then(|| format!("{} – {}", digits(least, 3), digits(most, 3)));
    let friction = friction.map(|value| Tile { name: "friction", value });
    let tiles = vec![
        Tile { name: "rows", value: rows.len().to_string() },
        Tile { name: against.words, value: from_to(against.key(), against.unit) },
        Tile { name: "contact area", value: format!("{} – {} %", digits(100.0 * low, 3), digits(100.0 * high, 3)) },
        Tile { name: "penetration", value: from_to("penetration", "m") },
        Tile { name: "time of all rows", value: format!("{} s", digits(seconds, 3)) },
    ];
    tiles.into_iter().chain(friction).collect()
}

fn body(folder: &Path, table: &SweepTable) -> Result<Curves, CliError> {
    let (frames, frames_note) = Frames::of(table)?;
    let scenes: Vec<SceneCurves> = table.scenes().into_iter().map(SceneCurves::of).collect();
    let several = scenes.len() > 1;
    let flows = table.rows.iter().filter_map(|row| {
        let key = (row.scene.clone(), row.seed);
        Some((key, row.number("area_fraction")?, [row.number("permeance_x")?, row.number("permeance_y")?]))
    });
    let sealing = match Sealing::read(folder)? {
        Some(sealing) => sealing.lines().lines().map(sentence).collect(),
        None => percolation::note(flows.collect()).into_iter().collect(),
    };
    let name = if is_varied(&table.rows) { "variation" } else { "scene" };
    let mut heads = if several { vec![name] } else { Vec::new() };
    let against = (table.against != PRESSURE).then_some(table.against);
    heads.push("seed");
    heads.extend(against.map(|quantity| quantity.words));
    heads.extend(["mean pressure", "penetration", "contact area (%)", "mean gap"]);
    heads.extend(has_stiffness(&table.rows).then_some("stiffness"));
    heads.extend(MORE.into_iter().filter(|column| column.is_in(&table.rows)).map(|column| column.head));
    heads.push("status");
    let persson = persson(table);
    Ok(Curves {
        sealing,
        against: table.against.name,
        geometric: table.is_geometric(),
        means: means(table, name),
        heads,
        rows: table.rows.iter().map(|row| cells(row, several, &table.rows)).collect(),
        note: note(&scenes, !persson.is_empty()),
        scenes,
        persson,
        frames,
        frames_note,
    })
}

/// A line of the command as a sentence.
fn sentence(line: &str) -> String {
    let mut letters = line.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}

fn note(scenes: &[SceneCurves], has_theory: bool) -> String {
    let bars = if scenes.iter().any(|scene| scene.seeds.len() > 1) {
        "Thin lines are single surfaces. Thick lines with dots are means over the surfaces, at loads that all surfaces have. The bar \
         of a mean is the root of the sum of the squares of its standard error and of the mean error bar of the mesh."
    } else {
        "Bars are the error bars of the mesh."
    };
    let theory = if has_theory {
        " Persson's theory is erf(σ0 √2/(E* h')) for an elastic half-space, with the rms slope h' and without a fit."
    } else {
        ""
    };
    let few = scenes.iter().map(|scene| scene.seeds.len()).filter(|n| *n > 1).min().map_or_else(String::new, of_few);
    format!(
        "{bars}{few}{theory} Penetration is counted from first touch. Linear axes begin at zero, but logarithmic ones do not."
    )
}

/// A caution about the standard errors of at least two surfaces; empty for many.
fn of_few(n: usize) -> String {
    // Student's distribution of n - 1 degrees of freedom from -1 to 1. It is 68 % for a normal distribution.
    let Some(percent) = [50, 58, 61, 63].get(n - 2) else { return String::new() };
    format!(
        " A standard error of {n} surfaces is itself uncertain: the true mean is within it in {percent} % of all cases \
         (Student), not in 68 %."
    )
}

/// Means over the seeds with their standard errors; `None` if each scene has one seed.
fn means(table: &SweepTable, name: &'static str) -> Option<Table> {
    let scenes = table.scenes();
    let several = scenes.len() > 1;
    let all: Vec<AtLoad<'_>> = scenes.into_iter().flat_map(AtLoad::all).collect();
    if all.iter().all(|at| at.rows.len() < 2) {
        return None;
    }
    let has = |quantity: &Quantity| all.iter().any(|at| at.mean(*quantity).is_some());
    let mut quantities = QUANTITIES;
    // A friction is what its sweep is made for, so it is not the last of a wide table.
    quantities.sort_by_key(|quantity| quantity.name != "friction");
    let shown: Vec<Quantity> = [PRESSURE].into_iter().chain(SWEPT).chain(quantities).filter(has).collect();
    let mut heads = if several { vec![name] } else { Vec::new() };
    heads.push("surfaces");
    heads.extend(shown.iter().map(|quantity| quantity.words));
    let row = |at: &AtLoad<'_>| {
        let text =
            |quantity: &Quantity| at.mean(*quantity).map_or_else(|| "–".to_owned(), |mean: Mean| cell(quantity, mean));
        let label = several.then(|| at.rows[0].label.clone());
        let values = shown.iter().map(text);
        label.into_iter().chain([at.rows.len().to_string()]).chain(values).collect()
    };
    Some(Table { heads, rows: all.iter().map(row).collect() })
}

/// Whether rows have a stiffness. A solid that creeps has none.
fn has_stiffness(rows: &[Row]) -> bool {
    rows.iter().any(|row| row.cells.contains_key("contact_stiffness"))
}

/// The cells of a row.
fn cells(row: &Row, several: bool, all: &[Row]) -> Vec<String> {
    let of = |key: &str, unit| row.number(key).map_or_else(|| "–".to_owned(), |value| engineering(value, unit));
    let [area, error] = ["area_fraction", "area_fraction_error"].map(|key| 100.0 * row.number(key).unwrap_or(0.0));
    let mut cells = if several { vec![row.label.clone()] } else { Vec::new() };
    cells.push(row.seed.map_or_else(|| "–".to_owned(), |seed| seed.to_string()));
    cells.extend(SWEPT.iter().any(|one| one.name == row.control).then(|| row.load_in_words()));
    cells.extend([
        of("mean_pressure", "Pa"),
        of("penetration", "m"),
        text::with_error(area, error),
        of("mean_gap", "m"),
    ]);
    let stiffness =
        || row.number("contact_stiffness").map_or_else(|| "infinite".to_owned(), |k| engineering(k, "Pa/m"));
    cells.extend(has_stiffness(all).then(stiffness));
    cells.extend(MORE.iter().filter(|column| column.is_in(all)).map(|column| column.cell(row)));
    cells.push(row.status.replace('_', " "));
    cells
}

/// A column of the table that only some sweeps have.
struct Column {
    head: &'static str,
    key: &'static str,
}

const MORE: [Column; 7] = [
    Column { head: "friction", key: "friction" },
    Column { head: "least dp/dσ0", key: "least_pressure_rise" },
    Column { head: "conductance (W/(m² K) or S/m²)", key: "conductance" },
    Column { head: "permeance along x (m³)", key: "permeance_x" },
    Column { head: "permeance along y (m³)", key: "permeance_y" },
    Column { head: "flow along x (m³/s)", key: "flow_x" },
    Column { head: "flow along y (m³/s)", key: "flow_y" },
];

impl Column {
    fn is_in(&self, rows: &[Row]) -> bool {
        rows.iter().any(|row| row.number(self.key).is_some())
    }

    /// The number with its bar.
    fn cell(&self, row: &Row) -> String {
        let Some(value) = row.number(self.key) else { return "–".to_owned() };
        let bar = bar_of(&row.cells, self.key);
        if let (Some(bar), "friction") = (bar, self.key) {
            return text::coefficient(value, bar);
        }
        bar.map_or_else(|| digits(value, 4), |bar| format!("{} ± {}", digits(value, 4), digits(bar, 1)))
    }
}
