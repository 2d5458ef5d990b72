//! `cargo xtask bench`: run time of the solver against its error.

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use rc_core::{Field, Grid, Kernel, Silent};
use rc_fractal::{SpectrumParams, Surface};
use rc_kernel::{Love, Spectral};
use rc_solver::{Control, Observables, SolveParams, solve_uniform};

use crate::figures::{Table, number};
use crate::repository;

/// Mean pressure σ0/E* of the paper's Fig. 6.
const MEAN_PRESSURE: f64 = 8.9e-4;

/// Times uniform solves of the paper's surface over grids, kernels and tolerances, and prints the run time beside the error.
///
/// The error of area and rms pressure is against the limit of fine grids, extrapolated from the two finest grids of each kernel at the
/// tightest tolerance; the two kernels have the same limit, so the distance between their limits tells how good it is. Run it on an
/// idle machine.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Elements per side, coarsest first, each twice the one before.
    #[arg(long, value_delimiter = ',', default_value = "256,512,1024,2048")]
    grids: Vec<usize>,
    /// Relative tolerances, tightest last.
    #[arg(long, value_delimiter = ',', default_value = "1e-4,1e-6,1e-8")]
    tolerances: Vec<f64>,
    /// Number of waves N of the surface.
    #[arg(long, default_value_t = 64)]
    waves: usize,
    /// Seed of the surface.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Solves of each case, of which the fastest counts.
    #[arg(long, default_value_t = 3)]
    repeats: usize,
    /// Folder for `bench.csv`.
    #[arg(long, value_name = "DIR", default_value_os_t = repository::root().join("figures"), hide_default_value = true)]
    out: PathBuf,
    /// Also saves the heights of each grid here, as heights-2048.npy for instance (cell side 1), so that other programs can be timed on the same surface.
    #[arg(long, value_name = "DIR")]
    peer_heights: Option<PathBuf>,
}

/// One case: what was solved, how long it took, what came out.
#[derive(Clone, Copy, Debug)]
struct Case {
    kernel: &'static str,
    grid: usize,
    tolerance: f64,
    seconds: f64,
    iterations: usize,
    complementarity: f64,
    penetration_error: f64,
    area_cells: f64,
    area: f64,
    rms_pressure: f64,
}

/// Area fraction and rms pressure in the limit of fine grids.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Limit {
    area: f64,
    rms_pressure: f64,
}

#[expect(clippy::print_stdout, reason = "the result of the command")]
pub(crate) fn run(args: &Args) -> Result<()> {
    let surface = Surface::new(&SpectrumParams::paper(args.waves, args.seed))?;
    let heights: Vec<Field> =
        args.grids.iter().map(|&n| Ok(surface.sample_on(Grid::square(n)?)?)).collect::<Result<_>>()?;
    if let Some(folder) = &args.peer_heights {
        save_heights(folder, &heights)?;
    }
    let mut cases = Vec::new();
    for kernel in [&Love as &dyn Kernel, &Spectral] {
        for &tolerance in &args.tolerances {
            for field in &heights {
                cases.push(time(field, kernel, tolerance, args.repeats)?);
            }
        }
    }
    let table = table(&cases);
    print!("{}", table.aligned());
    for (kernel, limit) in limits(&cases) {
        println!("limit of {kernel}: area {:.6}, rms pressure {:.6e}", limit.area, limit.rms_pressure);
    }
    fs::create_dir_all(&args.out)
        .with_context(|| format!("could not make {}; give another --out", args.out.display()))?;
    let file = args.out.join("bench.csv");
    fs::write(&file, &table.csv).with_context(|| format!("could not write {}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}

fn save_heights(folder: &std::path::Path, heights: &[Field]) -> Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("could not make {}", folder.display()))?;
    for field in heights {
        let file = folder.join(format!("heights-{}.npy", field.grid().nx()));
        rc_cli::npy::write(&file, field, 1.0).with_context(|| format!("could not write {}", file.display()))?;
    }
    Ok(())
}

/// Solves `repeats` times from a cold start; the time of the fastest.
fn time(heights: &Field, kernel: &dyn Kernel, tolerance: f64, repeats: usize) -> Result<Case> {
    let params = SolveParams { tolerance, ..SolveParams::certified() };
    let mut seconds = f64::INFINITY;
    let mut last = None;
    for _ in 0..repeats.max(1) {
        let start = Instant::now();
        last = Some(solve_uniform(heights, kernel, Control::MeanPressure(MEAN_PRESSURE), &params, &Silent)?);
        seconds = seconds.min(start.elapsed().as_secs_f64());
    }
    let solution = last.context("at least one repeat")?;
    let observables = Observables::of(&solution, kernel);
    Ok(Case {
        kernel: kernel.name(),
        grid: heights.grid().nx(),
        tolerance,
        seconds,
        iterations: solution.info.fine_iterations(),
        complementarity: solution.info.certificate.complementarity,
        penetration_error: solution.info.certificate.penetration,
        area_cells: observables.area.cells,
        area: observables.area.fraction,
        rms_pressure: observables.rms_pressure,
    })
}

/// The limits by kernel: Richardson extrapolation from the two finest grids at the tightest tolerance.
fn limits(cases: &[Case]) -> Vec<(&'static str, Limit)> {
    let tightest = cases.iter().map(|case| case.tolerance).fold(f64::INFINITY, f64::min);
    let by_kernel = cases.chunk_by(|a, b| a.kernel == b.kernel);
    let limit = |cases: &[Case]| {
        let mut best: Vec<&Case> = cases.iter().filter(|case| case.tolerance <= tightest).collect();
        best.sort_by_key(|case| case.grid);
        let fine = *best.last()?;
        // One grid has nothing to extrapolate with: it is its own limit.
        let coarse = best.len().checked_sub(2).map_or(fine, |second| best[second]);
        let limit = Limit {
            // Counting converges at first order, the rms pressure at second.
            area: richardson(coarse.area_cells, fine.area_cells, 1),
            rms_pressure: richardson(coarse.rms_pressure, fine.rms_pressure, 2),
        };
        Some((fine.kernel, limit))
    };
    by_kernel.filter_map(limit).collect()
}

/// The limit of a quantity with an error ~ h^`order`, from its values at h = 2 and h = 1.
fn richardson(coarse: f64, fine: f64, order: i32) -> f64 {
    fine + (fine - coarse) / (2.0_f64.powi(order) - 1.0)
}

fn table(cases: &[Case]) -> Table {
    // Errors of the certificate, then errors relative to the limit of fine grids.
    let header = [
        "kernel",
        "grid",
        "tolerance",
        "seconds",
        "iterations",
        "complementarity",
        "penetration",
        "area_cells",
        "area",
        "rms_pressure",
        "area_cells_error",
        "area_error",
        "rms_pressure_error",
    ];
    let limits = limits(cases);
    let row = |case: &Case| {
        let limit = limits.iter().find(|(kernel, _)| *kernel == case.kernel).map(|(_, limit)| limit);
        let error = |value: f64, of: fn(&Limit) -> f64| limit.map_or(f64::NAN, |limit| value / of(limit) - 1.0);
        vec![
            case.kernel.to_owned(),
            case.grid.to_string(),
            format!("{:e}", case.tolerance),
            format!("{:.3}", case.seconds),
            case.iterations.to_string(),
            format!("{:.1e}", case.complementarity),
            format!("{:.1e}", case.penetration_error),
            number(case.area_cells),
            number(case.area),
            number(case.rms_pressure),
            format!("{:+.1e}", error(case.area_cells, |limit| limit.area)),
            format!("{:+.1e}", error(case.area, |limit| limit.area)),
            format!("{:+.1e}", error(case.rms_pressure, |limit| limit.rms_pressure)),
        ]
    };
    Table::new("bench", &header, cases.iter().map(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extrapolation_is_exact_for_an_error_of_its_order() {
        for order in [1, 2] {
            let value = |h: f64| 0.07 + 0.01 * h.powi(order);
            let limit = richardson(value(0.5), value(0.25), order);
            assert!((limit - 0.07).abs() < 1e-15, "order {order}: {limit}");
        }
    }

    #[test]
    fn a_small_benchmark_has_errors_that_fall_with_the_grid() {
        let surface = Surface::new(&SpectrumParams::paper(8, 1)).expect("the paper's surface");
        let sample = |n| surface.sample_on(Grid::square(n).expect("a grid")).expect("a resolved surface");
        let solve = |n| time(&sample(n), &Love, 1e-6, 1).expect("a solved case");
        let cases = [32, 64, 128].map(solve);
        let limit = limits(&cases)[0].1;
        let error = |case: &Case| (case.rms_pressure / limit.rms_pressure - 1.0).abs();
        assert!(error(&cases[0]) > error(&cases[1]) && error(&cases[1]) > error(&cases[2]), "{cases:?}, {limit:?}");
        assert_eq!(table(&cases).csv.lines().count(), 4);
    }
}
