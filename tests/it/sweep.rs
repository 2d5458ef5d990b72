//! Sweeps and means over generated surfaces, without the command line.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rc_core::{Elasticity, Grid, HeightSource, PeriodicCell, Units};
use rc_fractal::{Moments, Normalisation, SpectrumError, SpectrumParams, Surface};
use rc_kernel::Spectral;
use rc_solver::{Method, SolveParams};
use rc_sweep::{
    Cells, ControlKind, Ensemble, EnsemblePlan, PlannedSurface, RunError, Shard, SurfaceError, Sweep, SweepPlan,
    SweptContact, SweptSurface, WantedMean, Workers, to_json,
};
use serde_json::{Value, json};

const SIDE: f64 = 1e-2;
const E_STAR: f64 = 5e8;
const RMS: f64 = 13e-6;
const WORKERS: Workers = Workers { threads: 2, at_once: 2 };

fn units() -> Units {
    let cell = PeriodicCell::new(SIDE).expect("a cell");
    Units::new(cell, Elasticity::from_e_star(E_STAR).expect("a solid"))
}

fn contact() -> SweptContact {
    SweptContact::new(units())
}

/// A random surface of 8 waves with the rms height of the command line's default.
fn generated(seed: u64, side: usize) -> Result<SweptSurface, SpectrumError> {
    let params = SpectrumParams {
        normalisation: Normalisation::RmsHeight(units().length(RMS)),
        ..SpectrumParams::paper(8, seed)
    };
    let surface = Surface::new(&params)?;
    let Moments { rms_height, rms_slope, .. } = surface.moments();
    let heights = HeightSource::shared(Arc::new(surface), Grid::square(side).expect("a grid"));
    Ok(SweptSurface { heights, rms_height, rms_slope })
}

/// The plan of `loads` on the surfaces of the seeds 1 and 2.
fn plan(control: ControlKind, loads: &[f64]) -> SweepPlan {
    let surface = |seed| PlannedSurface {
        seed: Some(seed),
        surface: json!({ "waves": 8, "rms": RMS, "seed": seed }),
        contact: json!({ "cell": SIDE, "e_star": E_STAR }),
        loads: loads.to_vec(),
        ..PlannedSurface::default()
    };
    SweepPlan::new(control, vec![surface(1), surface(2)])
}

/// The rows of a new sweep in `folder`, on `side` elements per side.
fn swept(plan: SweepPlan, side: usize, contact: &SweptContact, folder: &Path) -> Vec<Cells> {
    let sweep = Sweep::start(plan, Shard::WHOLE, folder, false).expect("a sweep");
    let made = AtomicUsize::new(0);
    let make = |surface: &PlannedSurface| {
        made.fetch_add(1, Ordering::Relaxed);
        generated(surface.seed.unwrap_or_default(), side)
    };
    // One worker, since two may ask for two surfaces in turns.
    sweep.solve_surfaces(contact, make, Workers { at_once: 1, ..WORKERS }).expect("a table");
    assert_eq!(made.into_inner(), 2, "a surface is made once for all its loads");
    sweep.kept().rows().values().cloned().collect()
}

fn number(cells: &Cells, key: &str) -> f64 {
    cells[key].as_f64().unwrap_or_else(|| panic!("{key} is {}", cells[key]))
}

/// The scene of this file's surfaces on the command line, with more words.
fn by_command_line(words: &str, out: &Path) {
    let scene = format!("rc sweep --quiet --waves 8 --cell {SIDE} --rms {RMS} --e-star {E_STAR} {words} --out");
    let words = scene.split(' ').map(Into::into).chain([out.as_os_str().to_owned()]);
    rc_cli::run_words(words).unwrap_or_else(|error| panic!("{scene}: {error}"));
}

#[test]
fn area_and_penetration_rise_with_the_load() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let pressures = [1e4, 1e5, 1e6];
    let rows = swept(plan(ControlKind::Pressure, &pressures), 64, &contact(), &dir.path().join("s"));
    assert_eq!(rows.len(), 6);
    for (i, row) in rows.iter().enumerate() {
        assert_eq!((row["seed"].as_u64(), row["status"].as_str()), (Some(1 + i as u64 / 3), Some("converged")));
        // The load is restored after each iteration, up to rounding.
        let pressure = number(row, "mean_pressure");
        assert!((pressure / pressures[i % 3] - 1.0).abs() < 1e-9, "{pressure} Pa in row {i}");
    }
    for seed in rows.chunks(3) {
        for (light, heavy) in seed.iter().zip(&seed[1..]) {
            for key in ["area_fraction", "penetration"] {
                let values = [light, heavy].map(|row| number(row, key));
                assert!(0.0 < values[0] && values[0] < values[1], "{key}: {values:?}");
            }
        }
    }
    assert_ne!(rows[0]["area_fraction"], rows[3]["area_fraction"], "two seeds are two surfaces");
}

#[test]
fn rows_are_those_of_the_command_line_bit_for_bit() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let spectral = SweptContact { kernel: Some(Arc::new(Spectral)), ..contact() };
    let adaptive = SweptContact { params: contact().params.by(Method::Adaptive), ..contact() };
    let cases = [
        ("pressures", ControlKind::Pressure, [1e4, 1e5, 1e6], 64, "", contact()),
        ("penetrations", ControlKind::Penetration, [1e-6, 5e-6, 1e-5], 64, " --kernel spectral", spectral),
        ("pressures", ControlKind::Pressure, [1e4, 2e4, 1e5], 256, " --method adaptive", adaptive),
    ];
    for (i, (flag, control, loads, side, words, contact)) in cases.into_iter().enumerate() {
        let [here, there] = [format!("here-{i}"), format!("there-{i}")].map(|name| dir.path().join(name));
        let rows = swept(plan(control, &loads), side, &contact, &here);
        let list: Vec<String> = loads.iter().map(f64::to_string).collect();
        by_command_line(&format!("--seeds 1..2 --grid {side} --{flag} {}{words}", list.join(",")), &there);
        let journal = std::fs::read_to_string(there.join("sweep.jsonl")).expect("the journal of rc sweep");
        let lines = journal.lines().skip(1).map(|line| serde_json::from_str::<Value>(line).expect("a line"));
        let mut expected: Vec<Value> = lines.collect();
        expected.sort_by_key(|line| line["row"].as_u64());
        assert_eq!((rows.len(), expected.len()), (6, 6));
        for (cells, line) in rows.iter().zip(&expected) {
            let line = line["cells"].as_object().expect("cells");
            assert_eq!(cells.keys().collect::<Vec<_>>(), line.keys().collect::<Vec<_>>(), "columns");
            for (key, value) in cells {
                // Time, memory and threads are those of the process, and only the command line doubts its input.
                if !["wall_seconds", "peak_memory_bytes", "threads", "warnings"].contains(&key.as_str()) {
                    assert_eq!(value, &line[key], "{key} of case {i}");
                }
            }
        }
    }
}

#[test]
fn a_row_that_did_not_converge_is_kept_and_marked() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let contact = SweptContact { params: SolveParams { max_iterations: 1, ..contact().params }, ..contact() };
    let rows = swept(plan(ControlKind::Pressure, &[1e5]), 64, &contact, &dir.path().join("s"));
    assert!(rows.iter().all(|row| row["status"] == "not_converged"), "{rows:?}");
}

#[test]
fn a_refused_load_and_a_surface_that_cannot_be_made_cost_their_rows_only() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let folder = dir.path().join("s");
    // The second penetration is beyond full contact.
    let plan = plan(ControlKind::Penetration, &[1e-6, 1e-2]);
    let sweep = Sweep::start(plan.clone(), Shard::WHOLE, &folder, false).expect("a sweep");
    let make = |surface: &PlannedSurface| match surface.seed {
        Some(1) => generated(1, 64).map_err(|error| error.to_string()),
        _ => Err("no such seed".to_owned()),
    };
    let alone = Workers { threads: 1, at_once: 1 };
    let error = sweep.solve_surfaces(&contact(), make, alone).expect_err("a row is refused");
    let RunError::Refused { error: SurfaceError::Contact { row, .. }, missing: 3, kept: 1 } = &error else {
        panic!("{error:?}")
    };
    assert_eq!(row, "row 2 (seed 1, penetration 1e-2)");
    drop(sweep);
    // What was made in vain is made again, and the row from before is kept.
    let sweep = Sweep::start(plan.clone(), Shard::WHOLE, &folder, true).expect("the sweep continues");
    let make = |_: &PlannedSurface| generated(2, 64);
    let error = sweep.solve_surfaces(&contact(), make, alone).expect_err("two rows are refused");
    assert!(matches!(error, RunError::Refused { missing: 2, kept: 2, .. }), "{error:?}");
    // Fields are for callers who write them.
    let with_fields = SweepPlan { keeps_fields: true, ..plan };
    let sweep = Sweep::start(with_fields, Shard::WHOLE, &dir.path().join("f"), false).expect("a sweep");
    let error = sweep.solve_surfaces(&contact(), make, alone).expect_err("no fields");
    assert!(matches!(error, RunError::Failed(SurfaceError::NoFields)), "{error:?}");
}

#[test]
fn the_mean_is_that_of_the_command_line_bit_for_bit() {
    let dir = tempfile::tempdir().expect("a temporary folder");
    let there = dir.path().join("there");
    by_command_line("--grid 128 --pressures 100000 --error-of-mean 20%", &there);
    let surface = PlannedSurface { loads: vec![1e5], ..PlannedSurface::default() };
    let plan = EnsemblePlan { control: ControlKind::Pressure, surface, sides: vec![64, 128], first_seed: 1 };
    let ensemble = Ensemble::start(plan, &dir.path().join("here"), false).expect("an ensemble");
    let wanted = WantedMean { quantity: "area_fraction".to_owned(), error: 0.2 };
    let means = ensemble.solve_surfaces(&wanted, &contact(), |row| generated(row.seed, row.side), WORKERS);
    let means = to_json(&means.expect("means"));
    let expected = std::fs::read_to_string(there.join("mean.json")).expect("the means of rc sweep");
    assert_eq!(means, expected);
}
