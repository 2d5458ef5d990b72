//! `rc solve` itself, in units of every size: results must be those in units of λ and E*, and files must be whole.

use std::path::Path;

use anyhow::{Context, Result, anyhow};
use clap::Parser as _;
use rc_cli::args::Cli;
use rc_cli::result::ResultFolder;
use rc_core::{Field, Grid};

use super::heights::{mapped, rough};
use super::row::{Row, Rows, guarded};
use crate::figures::Preset;

/// Units change the rounding of the input, and with it the way of the iteration.
const SAME: f64 = 1e-6;

/// So that the way makes no difference.
const TOLERANCE: &str = "1e-8";

/// Rms height and load of the scene in units of λ and E*.
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

/// A result in units of λ, E* and the rms height, so that it is the same for all units.
type Quantity = (&'static str, fn(&ResultFolder, Units) -> f64);

const QUANTITIES: [Quantity; 8] = [
    ("area", |result, _| result.summary.area_fraction),
    ("counted area", |result, _| result.summary.area_fraction_cells),
    ("penetration", |result, units| result.summary.penetration / units.cell / units.rms),
    ("mean gap", |result, units| result.summary.mean_gap / units.cell / units.rms),
    ("rms pressure", |result, units| result.summary.rms_pressure / units.e_star / units.rms),
    ("greatest pressure", |result, units| result.summary.max_pressure / units.e_star / units.rms),
    ("stiffness", |result, units| result.summary.contact_stiffness.unwrap_or(f64::NAN) / units.e_star * units.cell),
    ("energy", |result, units| result.summary.elastic_energy / units.e_star / units.cell.powi(3) / units.rms.powi(2)),
];

pub(crate) fn rows(preset: Preset) -> Result<Vec<Row>> {
    let mut rows = Rows::of("rc solve");
    let place = tempfile::tempdir().context("a temporary folder")?;
    units(&mut rows, preset, place.path())?;
    files(&mut rows, place.path())?;
    refusals(&mut rows, place.path());
    Ok(rows.finish())
}

/// Runs `rc` with these words; the exit code of a refusal with its text.
fn rc(words: &[String]) -> Result<(), (u8, String)> {
    let run = || {
        let cli = Cli::try_parse_from([&["rc".to_owned()], words].concat())
            .map_err(|error| anyhow!("{error}").context("2"))?;
        rc_cli::run(cli).map_err(|error| {
            let code = error.exit_code().to_string();
            anyhow!("{error}").context(code)
        })
    };
    guarded(run).map_err(|error| {
        let code = error.to_string().parse().unwrap_or(101);
        (code, error.root_cause().to_string())
    })
}

fn solve(units: Units, method: &str, folder: &Path) -> Result<ResultFolder, (u8, String)> {
    let words = [
        "solve",
        "--waves",
        "8",
        "--grid",
        "128",
        "--seed",
        "1",
        "--quiet",
        "--tolerance",
        TOLERANCE,
        "--method",
        method,
    ];
    let keys = [
        ("--cell", units.cell),
        ("--e-star", units.e_star),
        ("--rms", units.rms * units.cell),
        // In proportion to the heights, so that the contact is the same.
        ("--pressure", LOAD / RMS * units.rms * units.e_star),
    ];
    let numbers = keys.iter().flat_map(|(key, value)| [(*key).to_owned(), format!("{value:e}")]);
    let out = ["--out".to_owned(), folder.display().to_string()];
    rc(&words.map(str::to_owned).into_iter().chain(numbers).chain(out).collect::<Vec<_>>())?;
    ResultFolder::read(folder).map_err(|error| (error.exit_code(), error.to_string()))
}

fn units(rows: &mut Rows, preset: Preset, place: &Path) -> Result<()> {
    let full = preset == Preset::Full;
    let cells = [1e-9, 1e-6, 1e-3, 1e3].map(|cell| Units { cell, ..PLAIN });
    let moduli = [1.0, 1e3, 1e9, 1e11, 1e13].map(|e_star| Units { e_star, cell: 1e-2, ..PLAIN });
    let heights = [1e-15, 1e-12, 1e-9, 1e-6, 1e-2, 1e-1].map(|rms| Units { rms, cell: 1e-2, e_star: 1e9 });
    let corners = [Units { cell: 1e-9, e_star: 1e13, rms: 1e-15 }, Units { cell: 1e3, e_star: 1.0, rms: 1e-1 }];
    let all: Vec<Units> = cells.into_iter().chain(moduli).chain(heights).chain(corners).collect();
    for method in ["uniform", "adaptive"] {
        let reference = solve(PLAIN, method, &place.join("reference"));
        let reference = reference.map_err(|(code, text)| anyhow!("exit code {code}: {text}"))?;
        for units in all.iter().step_by(if full { 1 } else { 4 }) {
            let Units { cell, e_star, rms } = *units;
            let scene = format!("{method} λ = {cell:.0e} m E* = {e_star:.0e} Pa rms = {rms:.0e} λ");
            let result = match solve(*units, method, &place.join("result")) {
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

/// Values that are not finite, or below `least`.
fn bad_values(field: &Field, least: f64) -> usize {
    field.values().iter().filter(|value| !(value.is_finite() && **value >= least)).count()
}

/// Height maps that are hard to solve, or none at all.
fn files(rows: &mut Rows, place: &Path) -> Result<()> {
    let rough = rough(8, 0.8, 1, 64)?;
    let single = Field::from_fn(Grid::square(1)?, |_| 3e-4);
    let flat = "2: all heights are";
    // Name, heights, pressure, status or exit code.
    let maps = [
        ("all heights equal", mapped(&rough, |_| 0.25), "1e-3", flat),
        ("all heights zero", mapped(&rough, |_| 0.0), "1e-3", flat),
        ("a map of one element", single, "1e-3", flat),
        ("heights that are denormal", mapped(&rough, |h| h * 1e-308), "1e-3", "2: heights: their range"),
        ("heights of 1e-125 m", mapped(&rough, |h| h * 1e-122), "1e-125", "converged"),
        // Pressures have no digits left for such heights, which must be said.
        ("a load 1e22 times the heights", mapped(&rough, |h| h * 1e-22), "1e-3", "3: not converged"),
        ("heights on a pedestal of 1e8 rms", mapped(&rough, |h| h + 1e5), "1e-3", "converged"),
    ];
    for (name, heights, pressure, expected) in maps {
        let file = place.join("map.npy");
        rc_cli::npy::write(&file, &heights, 1.0).context("a height map")?;
        let found = match solve_map(&file, pressure, &place.join("of-map")) {
            Ok(result) => result.summary.status,
            Err((code, text)) => format!("{code}: {}", text.replace(&format!("{}: ", file.display()), "")),
        };
        rows.holds(name, "status", expected, &found, found.starts_with(expected));
    }
    Ok(())
}

fn solve_map(file: &Path, pressure: &str, folder: &Path) -> Result<ResultFolder, (u8, String)> {
    let (file, folder_name) = (file.display().to_string(), folder.display().to_string());
    let words = [
        "solve",
        "--heights",
        &file,
        "--cell",
        "1",
        "--e-star",
        "1",
        "--pressure",
        pressure,
        "--quiet",
        "--out",
        &folder_name,
    ];
    rc(&words.map(str::to_owned))?;
    ResultFolder::read(folder).map_err(|error| (error.exit_code(), error.to_string()))
}

/// What is no problem: exit code 2 and one line, whatever the numbers are.
fn refusals(rows: &mut Rows, place: &Path) {
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
        let found = rc(&words.collect::<Vec<_>>());
        let one_line = |text: &str| text.trim().lines().count() == 1;
        let refused = matches!(&found, Err((2, text)) if one_line(text));
        let said = found.map_or_else(|(code, text)| format!("{code}: {text}"), |()| "solved".to_owned());
        rows.holds(name, "refused", "exit code 2 and one line", said, refused && !out.exists());
    }
}
