//! The command `rc solve`, in units of every size.
//!
//! Results must be the same as in units of λ and E*, and files must be complete.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow};
use rc_core::{Field, Grid};
use rc_figures::Preset;
use rc_heights::npy;
use serde_json::Value;

use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};

/// Runs the program `rc` with these arguments.
///
/// An error has the exit code and the text.
pub type RunRc = fn(&[String]) -> Result<(), Refusal>;

/// Allowed relative difference. Units change the rounding of the input, and thereby the path of the iteration.
const SAME: f64 = 1e-6;

/// A tolerance so tight that the path of the iteration makes no difference.
const TOLERANCE: &str = "1e-8";

/// Rms height of the scene in units of λ. Its load in units of E* follows.
const RMS: f64 = 1e-3;
const LOAD: f64 = 1e-3;

/// The units and sizes of one run.
#[derive(Clone, Copy, Debug)]
struct Units {
    /// λ (m).
    cell: f64,
    /// E* (Pa).
    e_star: f64,
    /// Rms height over λ.
    rms: f64,
}

const PLAIN: Units = Units { cell: 1.0, e_star: 1.0, rms: RMS };

/// A name, and a result divided by units of λ, E* and the rms height. The result is the same for all units.
type Quantity = (&'static str, fn(&ResultFolder, Units) -> f64);

const QUANTITIES: [Quantity; 8] = [
    ("area", |result, _| result.number("area_fraction")),
    ("counted area", |result, _| result.number("area_fraction_cells")),
    ("penetration", |result, units| result.number("penetration") / units.cell / units.rms),
    ("mean gap", |result, units| result.number("mean_gap") / units.cell / units.rms),
    ("rms pressure", |result, units| result.number("rms_pressure") / units.e_star / units.rms),
    ("greatest pressure", |result, units| result.number("max_pressure") / units.e_star / units.rms),
    ("stiffness", |result, units| result.number("contact_stiffness") / units.e_star * units.cell),
    ("energy", |result, units| result.number("elastic_energy") / units.e_star / units.cell.powi(3) / units.rms.powi(2)),
];

pub(crate) fn rows(preset: Preset, rc: RunRc) -> Result<Vec<Row>> {
    let mut rows = Rows::of("rc solve");
    let place = tempfile::tempdir().context("a temporary folder")?;
    units(&mut rows, preset, place.path(), rc)?;
    files(&mut rows, place.path(), rc)?;
    refusals(&mut rows, place.path(), rc);
    Ok(rows.finish())
}

/// A refusal of `rc`: exit code and text.
pub type Refusal = (u8, String);

/// Runs `rc` with these arguments. A panic becomes the exit code 101.
fn run(rc: RunRc, words: &[String]) -> Result<(), Refusal> {
    guarded(|| Ok(rc(words))).unwrap_or_else(|panic| Err((101, panic.to_string())))
}

/// The files of a result folder.
struct ResultFolder {
    summary: Value,
    pressure: Field,
    gap: Field,
}

impl ResultFolder {
    fn read(folder: &Path) -> Result<Self> {
        let text = fs::read_to_string(folder.join("summary.json")).context("no summary.json")?;
        let field = |name: &str| npy::read(&folder.join(name)).with_context(|| format!("no {name}"));
        let summary = serde_json::from_str(&text).context("summary.json")?;
        Ok(Self { summary, pressure: field("pressure.npy")?, gap: field("gap.npy")? })
    }

    /// A number of the summary; NaN if the summary does not have it.
    fn number(&self, name: &str) -> f64 {
        self.summary.get(name).and_then(Value::as_f64).unwrap_or(f64::NAN)
    }
}

/// Runs `rc solve` with these arguments and reads the result folder `folder`.
fn solved(rc: RunRc, words: &[String], folder: &Path) -> Result<ResultFolder, Refusal> {
    run(rc, words)?;
    ResultFolder::read(folder).map_err(|error| (0, format!("{error:#}")))
}

fn solve(rc: RunRc, units: Units, method: &str, folder: &Path) -> Result<ResultFolder, Refusal> {
    let words =
        ["solve", "--waves", "8", "--grid", "128", "--seed", "1", "--quiet", "--tolerance", TOLERANCE, "--method"];
    let keys = [
        ("--cell", units.cell),
        ("--e-star", units.e_star),
        ("--rms", units.rms * units.cell),
        // The load is proportional to the heights, so that the contact is the same.
        ("--pressure", LOAD / RMS * units.rms * units.e_star),
    ];
    let numbers = keys.iter().flat_map(|(key, value)| [(*key).to_owned(), format!("{value:e}")]);
    let ends = [method.to_owned(), "--out".to_owned(), folder.display().to_string()];
    solved(rc, &words.map(str::to_owned).into_iter().chain(ends).chain(numbers).collect::<Vec<_>>(), folder)
}

fn units(rows: &mut Rows, preset: Preset, place: &Path, rc: RunRc) -> Result<()> {
    let full = preset == Preset::Full;
    let cells = [1e-9, 1e-6, 1e-3, 1e3].map(|cell| Units { cell, ..PLAIN });
    let moduli = [1.0, 1e3, 1e9, 1e11, 1e13].map(|e_star| Units { e_star, cell: 1e-2, ..PLAIN });
    let heights = [1e-15, 1e-12, 1e-9, 1e-6, 1e-2, 1e-1].map(|rms| Units { rms, cell: 1e-2, e_star: 1e9 });
    let corners = [Units { cell: 1e-9, e_star: 1e13, rms: 1e-15 }, Units { cell: 1e3, e_star: 1.0, rms: 1e-1 }];
    let all: Vec<Units> = cells.into_iter().chain(moduli).chain(heights).chain(corners).collect();
    for method in ["uniform", "adaptive"] {
        let reference = solve(rc, PLAIN, method, &place.join("reference"));
        let reference = reference.map_err(|(code, text)| anyhow!("exit code {code}: {text}"))?;
        for units in all.iter().step_by(if full { 1 } else { 4 }) {
            let Units { cell, e_star, rms } = *units;
            let scene = format!("{method} λ = {cell:.0e} m E* = {e_star:.0e} Pa rms = {rms:.0e} λ");
            let result = match solve(rc, *units, method, &place.join("result")) {
                Ok(result) => result,
                Err((code, text)) => {
                    rows.holds(&scene, "solved", "exit code 0", format!("{code}: {text}"), false);
                    continue;
                }
            };
            rows.holds(&scene, "solved", "exit code 0", "0", true);
            let n_bad = bad_values(&result.pressure, 0.0) + bad_values(&result.gap, -2e-6 * 20.0 * rms * cell);
            rows.at_most(&scene, "values in files not finite or negative", n_bad as f64, 0.0);
            let differences = QUANTITIES.map(|(_, of)| (of(&result, *units) / of(&reference, PLAIN) - 1.0).abs());
            let worst = (0..QUANTITIES.len()).max_by(|&a, &b| differences[a].total_cmp(&differences[b])).unwrap_or(0);
            let scene = format!("{scene} ({} differs most)", QUANTITIES[worst].0);
            rows.at_most(&scene, "as in units of λ and E*", differences[worst], SAME);
        }
    }
    Ok(())
}

/// Number of values that are not finite, or below `min`.
fn bad_values(field: &Field, min: f64) -> usize {
    field.values().iter().filter(|value| !(value.is_finite() && **value >= min)).count()
}

/// Height maps that are hard to solve or that have no solution.
fn files(rows: &mut Rows, place: &Path, rc: RunRc) -> Result<()> {
    let rough = rough(8, 0.8, 1, 64)?;
    let single = Field::from_fn(Grid::square(1)?, |_| 3e-4);
    let flat = "2: all heights are";
    // Name, heights, pressure, and the expected status or exit code.
    let maps = [
        ("all heights equal", mapped(&rough, |_| 0.25), "1e-3", flat),
        ("all heights zero", mapped(&rough, |_| 0.0), "1e-3", flat),
        ("a map of one element", single, "1e-3", flat),
        ("heights that are denormal", mapped(&rough, |h| h * 1e-308), "1e-3", "2: heights: their range"),
        ("heights of 1e-125 m", mapped(&rough, |h| h * 1e-122), "1e-125", "converged"),
        // Pressures have no significant digits for such heights, and `rc` must say so.
        ("a load 1e22 times the heights", mapped(&rough, |h| h * 1e-22), "1e-3", "3: not converged"),
        ("heights on a pedestal of 1e8 rms", mapped(&rough, |h| h + 1e5), "1e-3", "converged"),
    ];
    for (name, heights, pressure, expected) in maps {
        let file = place.join("map.npy");
        npy::write(&file, &heights, 1.0).context("a height map")?;
        let found = match solve_map(rc, &file, pressure, &place.join("of-map")) {
            Ok(result) => result.summary.get("status").and_then(Value::as_str).unwrap_or("none").to_owned(),
            Err((code, text)) => format!("{code}: {}", text.replace(&format!("{}: ", file.display()), "")),
        };
        rows.holds(name, "status", expected, &found, found.starts_with(expected));
    }
    Ok(())
}

fn solve_map(rc: RunRc, file: &Path, pressure: &str, folder: &Path) -> Result<ResultFolder, Refusal> {
    let (file, out) = (file.display().to_string(), folder.display().to_string());
    let units = ["--cell", "1", "--e-star", "1", "--pressure", pressure];
    let words = ["solve", "--heights", &file, "--quiet", "--out", &out].into_iter().chain(units);
    solved(rc, &words.map(str::to_owned).collect::<Vec<_>>(), folder)
}

/// Scenes that cannot be solved must give exit code 2 and one line.
fn refusals(rows: &mut Rows, place: &Path, rc: RunRc) {
    let cases: [(&str, &[&str]); 9] = [
        ("a cell of zero", &["--cell", "0", "--pressure", "1"]),
        ("an infinite modulus", &["--e-star", "inf", "--pressure", "1"]),
        ("a modulus that underflows", &["--e-star", "1e-330", "--pressure", "1"]),
        ("a load of NaN", &["--pressure", "nan"]),
        ("a negative load", &["--pressure", "-1"]),
        ("a load that is zero in units of E*", &["--e-star", "1e300", "--pressure", "1e-300"]),
        ("a load that overflows in units of E*", &["--e-star", "1e-200", "--pressure", "1e200"]),
        ("a penetration beyond full contact", &["--penetration", "1"]),
        ("a tolerance below rounding", &["--pressure", "1", "--tolerance", "1e-20"]),
    ];
    let out = place.join("refused");
    for (name, more) in cases {
        let words = ["solve", "--waves", "4", "--grid", "64", "--quiet", "--out"].map(str::to_owned);
        let words =
            words.into_iter().chain([out.display().to_string()]).chain(more.iter().map(|word| (*word).to_owned()));
        let found = run(rc, &words.collect::<Vec<_>>());
        let one_line = |text: &str| text.trim().lines().count() == 1;
        let refused = matches!(&found, Err((2, text)) if one_line(text));
        let said = found.map_or_else(|(code, text)| format!("{code}: {text}"), |()| "solved".to_owned());
        rows.holds(name, "refused", "exit code 2 and one line", said, refused && !out.exists());
    }
}
