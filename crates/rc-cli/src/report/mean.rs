//! The page of a mean over realisations (`rc sweep --error-of-mean`).
//!
//! It has means with error bars, and their levels.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::command::{flags, quoted};
use super::page::{Command, Page, Text, Tile, WITHOUT_FILES, made};
use crate::error::CliError;
use crate::sweep::MEAN_FILE;
use crate::text::with_error;
use rc_core::quantity::{Scale, digits, engineering};

/// A mean under one load, as in `mean.json`. A number that is not finite is null there.
#[derive(Clone, Debug, Deserialize)]
struct Estimate {
    status: String,
    mean_of: String,
    control: String,
    control_value: f64,
    mean: f64,
    standard_error: f64,
    grid_error: Option<f64>,
    relative_error: Option<f64>,
    wanted_error: f64,
    cost: f64,
    cost_of_plain_mean: Option<f64>,
    levels: Vec<Level>,
}

#[derive(Clone, Debug, Deserialize)]
struct Level {
    grid: usize,
    coarser_grid: Option<usize>,
    first_seed: u64,
    realisations: usize,
    mean: f64,
    variance: f64,
    cost: f64,
}

/// The data of a page of a mean, without those of all pages.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Body {
    quantity: Named,
    load: Named,
    means: Vec<Curve>,
    heads: [&'static str; 7],
    rows: Vec<[String; 7]>,
    level_heads: [&'static str; 6],
    note: &'static str,
}

/// A quantity with its unit, for an axis.
#[derive(Clone, Debug, Serialize)]
struct Named {
    label: String,
    unit: &'static str,
}

/// The points and the table of the levels of one mean.
#[derive(Clone, Debug, Serialize)]
struct Curve {
    /// Text of the load.
    name: String,
    load: f64,
    mean: f64,
    error: f64,
    grids: Vec<usize>,
    variances: Vec<f64>,
    costs: Vec<f64>,
    levels: Vec<[String; 6]>,
}

/// The page of the mean in `folder`, whose journal has `settings`.
///
/// # Errors
/// [`CliError::Input`] when `mean.json` does not exist yet, or when it does not have the format of `rc sweep`.
pub(super) fn page(folder: &Path, settings: &Value) -> Result<Page<Body>, CliError> {
    let means = read(folder)?;
    let (first, open) = (&means[0], means.iter().filter(|mean| mean.status != "converged").count());
    let status = if open == 0 { "converged".to_owned() } else { format!("{open} not converged") };
    let files = serde_json::to_string_pretty(settings).ok();
    Ok(Page {
        title: format!("Mean: {}", folder.file_name().unwrap_or(folder.as_os_str()).display()),
        subtitle: format!("Mean of {} over realisations, at prescribed {}s", first.mean_of, first.control),
        status,
        good: open == 0,
        warnings: Vec::new(),
        tiles: tiles(&means),
        commands: vec![command(settings, first)],
        files: files.map(|text| Text { title: "Settings of the sweep", text }).into_iter().collect(),
        made: made(),
        kind: "mean",
        body: body(&means),
    })
}

fn read(folder: &Path) -> Result<Vec<Estimate>, CliError> {
    let path = folder.join(MEAN_FILE);
    if !path.exists() {
        let message = format!("has no {MEAN_FILE} yet: the mean is not finished; run its rc sweep again with --resume");
        return Err(CliError::in_file(folder, message));
    }
    let text = fs::read_to_string(&path).map_err(|cause| CliError::in_file(&path, cause))?;
    let means: Vec<Estimate> = serde_json::from_str(&text)
        .map_err(|cause| CliError::in_file(&path, format_args!("not the means of rc sweep: {cause}")))?;
    if means.iter().any(|mean| mean.levels.is_empty()) || means.is_empty() {
        return Err(CliError::in_file(&path, "not the means of rc sweep: a mean or its levels are missing"));
    }
    Ok(means)
}

impl Estimate {
    fn unit(&self) -> &'static str {
        match self.mean_of.as_str() {
            "penetration" | "mean_gap" | "contact_perimeter" | "h_max" => "m",
            "mean_pressure" | "rms_pressure_corrected" => "Pa",
            "contact_stiffness" => "Pa/m",
            "elastic_energy" => "J",
            _ => "",
        }
    }

    fn load_unit(&self) -> &'static str {
        if self.control == "pressure" { "Pa" } else { "m" }
    }

    fn load(&self) -> String {
        engineering(self.control_value, self.load_unit())
    }

    /// Error of statistics and grid together.
    fn error(&self) -> f64 {
        self.standard_error.hypot(self.grid_error.unwrap_or(0.0))
    }

    fn realisations(&self) -> usize {
        self.levels.iter().map(|level| level.realisations).sum()
    }

    /// The mean with its error bar.
    fn text(&self) -> String {
        if self.unit().is_empty() {
            return with_error(self.mean, self.error());
        }
        let scale = Scale::of(self.mean.abs(), self.unit());
        format!("{} {}", with_error(self.mean / scale.factor, self.error() / scale.factor), scale.unit())
    }

    fn row(&self) -> [String; 7] {
        let part = |error: f64| format!("{} %", digits(100.0 * error / self.mean.abs(), 2));
        [
            self.load(),
            self.text(),
            part(self.error()),
            part(self.standard_error),
            self.grid_error.map_or_else(|| "one grid".to_owned(), part),
            self.realisations().to_string(),
            self.status.replace('_', " "),
        ]
    }
}

impl Curve {
    fn of(mean: &Estimate) -> Self {
        let total: f64 = mean.levels.iter().map(|level| level.cost * level.realisations as f64).sum();
        Self {
            name: mean.load(),
            load: mean.control_value,
            mean: mean.mean,
            error: mean.error(),
            grids: mean.levels.iter().map(|level| level.grid).collect(),
            variances: mean.levels.iter().map(|level| level.variance).collect(),
            costs: mean.levels.iter().map(|level| level.cost).collect(),
            levels: mean.levels.iter().map(|level| level.row(mean.unit(), total)).collect(),
        }
    }
}

impl Level {
    /// Cells of the level's line in the table; `total` is the cost of all levels.
    fn row(&self, unit: &'static str, total: f64) -> [String; 6] {
        let seeds = format!("{} – {}", self.first_seed, self.first_seed + (self.realisations as u64).saturating_sub(1));
        [
            self.coarser_grid.map_or_else(|| self.grid.to_string(), |coarser| format!("{} minus {coarser}", self.grid)),
            format!("{} (seeds {seeds})", self.realisations),
            in_unit(self.mean, unit),
            in_unit(self.variance.sqrt(), unit),
            digits(self.cost, 3),
            format!("{} %", digits(100.0 * self.cost * self.realisations as f64 / total, 2)),
        ]
    }
}

/// Four digits; with a decimal prefix where there is a unit.
fn in_unit(value: f64, unit: &'static str) -> String {
    if unit.is_empty() { digits(value, 4) } else { engineering(value, unit) }
}

fn tiles(means: &[Estimate]) -> Vec<Tile> {
    let percent = |part: f64| format!("{} %", digits(100.0 * part, 2));
    let largest = means.iter().map(|mean| mean.relative_error.unwrap_or(f64::INFINITY)).fold(0.0, f64::max);
    let [cost, plain] =
        [|mean: &Estimate| mean.cost, |mean: &Estimate| mean.cost_of_plain_mean.unwrap_or(f64::INFINITY)]
            .map(|of| means.iter().map(of).sum::<f64>());
    let value = match means {
        [one] => Tile { name: "mean", value: one.text() },
        several => Tile { name: "loads", value: several.len().to_string() },
    };
    vec![
        value,
        Tile { name: "largest relative error", value: percent(largest) },
        Tile { name: "wanted error", value: percent(means[0].wanted_error) },
        Tile { name: "realisations", value: means.iter().map(Estimate::realisations).sum::<usize>().to_string() },
        Tile { name: "cost, relative to the finest grid alone", value: percent(cost / plain) },
    ]
}

fn body(means: &[Estimate]) -> Body {
    let first = &means[0];
    Body {
        quantity: Named { label: format!("mean {}", first.mean_of.replace('_', " ")), unit: first.unit() },
        load: Named { label: first.control.clone(), unit: first.load_unit() },
        means: means.iter().map(Curve::of).collect(),
        heads: ["load", "mean", "total error", "statistical error", "grid error", "realisations", "status"],
        rows: means.iter().map(Estimate::row).collect(),
        level_heads: ["grid", "realisations", "mean", "standard deviation", "cost of each", "share of the cost"],
        note: "A mean is the sum over its levels: the coarsest grid, and the differences from each grid to the next coarser one. The \
               square of its error is the sum of the squares of two errors: the standard error, and the error of the finest grid. Costs are elements times \
               applications of the operator.",
    }
}

/// The command line that computes the means again.
fn command(settings: &Value, mean: &Estimate) -> Command {
    let list =
        |values: &Value| values.as_array().into_iter().flatten().map(Value::to_string).collect::<Vec<_>>().join(",");
    let surface = &settings["surfaces"][0];
    let (ensemble, control) = (&settings["ensemble"], settings["control"].as_str().unwrap_or("pressure"));
    // On one grid, it is among the keys of the surface.
    let grids = ensemble["grids"].as_array().filter(|grids| grids.len() > 1);
    let grid = grids.and_then(|grids| grids.last()).map_or_else(String::new, |grid| format!(" --grid {grid}"));
    let text = format!(
        "rc sweep{}{} --{control}s {} --seed {}{grid} --error-of-mean {} --mean-of {} --out again",
        flags(&surface["surface"]),
        flags(&surface["contact"]),
        list(&surface["loads"]),
        ensemble["first_seed"],
        mean.wanted_error,
        quoted(&mean.mean_of),
    );
    Command { note: WITHOUT_FILES.to_owned(), text }
}
