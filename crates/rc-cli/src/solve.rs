//! `rc solve`: one contact problem, from scene to files.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rc_core::{Field, Grid};
use rc_fractal::moments_of_grid;
use rc_kernel::PeriodicLove;
use rc_solver::{
    Certificate, Control, GaussSeidelError, GaussSeidelParams, LevelInfo, MeshPressure, Observables, Solution,
    SolveError, Status, solve_gauss_seidel, solve_uniform,
};

use crate::args::SolveArgs;
use crate::coarsen::{averaged, check_factor};
use crate::error::CliError;
use crate::output::{self, Staged};
use crate::picture::{ContactPicture, save_png};
use crate::progress::Progress;
use crate::resolve::{self, ContactProblem};
use crate::scene::{Method, RunKeys, Scene, SurfaceKeys};
use crate::summary::Summary;
use crate::surface::{HEIGHTS_FILE, Heights, SurfaceProblem};
use crate::{memory, npy, report, scene_file};

/// Where the run without arguments writes.
const EXAMPLE_FOLDER: &str = "rc-result";

/// A solved problem with what its files and its summary need.
struct Solved {
    solution: Solution,
    /// The solver's error, when the solution is only the best pressure it found.
    failure: Option<String>,
    heights: Heights,
    h_max: f64,
    wall: Duration,
}

/// Runs `rc solve`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(crate) fn run(args: SolveArgs) -> Result<(), CliError> {
    let scene = scene_of(args)?;
    let started = Instant::now();
    let surface = resolve::surface(scene.surface)?;
    let contact = resolve::contact(scene.contact, surface.cell.side())?;
    let threads = resolve::start_threads(scene.run.threads)?;
    execute(&surface, &contact, &scene.run, threads, started)
}

/// Solves, writes and prints.
fn execute(
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    run: &RunKeys,
    threads: usize,
    started: Instant,
) -> Result<(), CliError> {
    if let Some(folder) = &run.out {
        output::check_folder(folder)?;
    }
    let solved = solve(surface, contact, run, started)?;
    let summary = summarise(&solved, surface, contact, threads);
    if let Some(folder) = &run.out {
        write_results(folder, &solved, &summary, contact, surface.cell.side())?;
    }
    print_summary(&summary, surface, contact, run)?;
    match solved.failure {
        None => Ok(()),
        Some(message) if run.out.is_some() => {
            Err(CliError::NotConverged(format!("{message}; the results are written and marked not_converged")))
        }
        Some(message) => Err(CliError::NotConverged(message)),
    }
}

/// The scene of the command line; without any argument the embedded example, into its folder.
fn scene_of(args: SolveArgs) -> Result<Scene, CliError> {
    if args.scene_file.is_some() || !args.scene.is_empty() {
        return resolve::layers(args.scene_file.as_deref(), args.scene);
    }
    output::tell(&format!(
        "No scene given: solving the embedded example (the paper's surface, N = 64, σ0/E* = 8.9e-4), writing to \
         {EXAMPLE_FOLDER}/"
    ));
    let run = RunKeys { out: Some(PathBuf::from(EXAMPLE_FOLDER)), ..RunKeys::default() };
    Ok(Scene { run, ..scene_file::example() })
}

fn solve(
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    run: &RunKeys,
    started: Instant,
) -> Result<Solved, CliError> {
    let progress = Progress::new(run.quiet);
    progress.say("heights");
    let heights = surface.heights()?;
    if let Some(spec) = contact.keys.output_grid {
        check_factor(heights.field.grid(), spec)?;
    }
    let result = match contact.method {
        Method::GaussSeidel => by_gauss_seidel(&heights.field, contact, &progress)?,
        Method::Adaptive | Method::Uniform => {
            solve_uniform(&heights.field, contact.kernel(), contact.control, &contact.params, &progress)
        }
    };
    let wall = started.elapsed();
    let (solution, failure) = match result {
        Ok(solution) => (solution, None),
        Err(SolveError::NotConverged { grid, iterations, certificate, solution }) => {
            (*solution, Some(not_converged(grid, iterations, &certificate, contact.params.tolerance)))
        }
        Err(error) => return Err(in_si(&error, surface.cell.side(), contact)),
    };
    let h_max = heights.field.max();
    Ok(Solved { solution, failure, heights, h_max, wall })
}

/// The paper's procedure. What only it refuses is bad input; the rest is as for the other methods.
fn by_gauss_seidel(
    heights: &Field,
    contact: &ContactProblem,
    progress: &Progress,
) -> Result<Result<Solution, SolveError>, CliError> {
    let periodic = PeriodicLove::new();
    let coefficient = |dx: f64, dy: f64, half_side: f64| periodic.coefficient(dx, dy, half_side);
    let params = GaussSeidelParams { tolerance: contact.params.tolerance, ..GaussSeidelParams::paper() };
    match solve_gauss_seidel(heights, contact.kernel(), &coefficient, contact.control, &params, progress) {
        Ok(solution) => Ok(Ok(solution)),
        Err(GaussSeidelError::Solve(error)) => Ok(Err(error)),
        Err(other) => Err(CliError::input(format_args!("method gauss-seidel: {other}"))),
    }
}

fn not_converged(grid: Grid, iterations: usize, certificate: &Certificate, tolerance: f64) -> String {
    format!("not converged to {tolerance:e} on {grid} elements after {iterations} iterations: {certificate}")
}

/// The solver's refusal of its input, in the user's units.
fn in_si(error: &SolveError, side: f64, contact: &ContactProblem) -> CliError {
    match error {
        SolveError::Penetration { value, full_contact } => CliError::input(format_args!(
            "penetration: must be above 0 and below that of full contact, {:.6e} m, not {:.6e} m; beyond it the penetration \
             no longer determines the pressure, so give --pressure",
            full_contact * side,
            value * side
        )),
        SolveError::MeanPressure { value } => CliError::input(format_args!(
            "pressure: must be positive and finite (Pa), not {}",
            value * contact.elasticity.e_star()
        )),
        SolveError::Tolerance { value, smallest } => {
            CliError::input(format_args!("tolerance: must be between {smallest:e} and 1, not {value:e}"))
        }
        other => CliError::input(other),
    }
}

fn summarise(solved: &Solved, surface: &SurfaceProblem, contact: &ContactProblem, threads: usize) -> Summary {
    let (e_star, side) = (contact.elasticity.e_star(), surface.cell.side());
    let Solution { info, pressure, status, elements, .. } = &solved.solution;
    let observables = Observables::of(&solved.solution, contact.kernel());
    let grid = pressure.grid();
    let stiffness = observables.contact_stiffness * e_star / side;
    // Not before: the time to the certified solution does not include what the solution does not need.
    let moments = solved.heights.moments.unwrap_or_else(|| moments_of_grid(&solved.heights.field));
    let text = |text: &str| text.to_owned();
    Summary {
        status: text(match (&solved.failure, status) {
            (Some(_), _) => "not_converged",
            (None, Status::Converged) => "converged",
            (None, Status::FullContact) => "full_contact",
        }),
        control: text(match contact.control {
            Control::MeanPressure(_) => "pressure",
            Control::Penetration(_) => "penetration",
        }),
        kernel: text(contact.kernel().name()),
        method: text(match contact.method {
            Method::GaussSeidel => "gauss-seidel",
            Method::Adaptive | Method::Uniform => "uniform",
        }),
        grid: [grid.nx(), grid.ny()],
        elements: elements.as_ref().map_or(grid.len(), |elements| elements.mesh.len()),
        levels: info.levels.len(),
        mean_pressure: info.mean_pressure * e_star,
        penetration: info.penetration * side,
        penetration_full_contact: info.penetration_full_contact * side,
        area_fraction: observables.area.fraction,
        area_fraction_cells: observables.area.cells,
        area_fraction_error: observables.area.error,
        rms_pressure: observables.rms_pressure * e_star,
        max_pressure: observables.max_pressure * e_star,
        mean_gap: observables.mean_gap * side,
        contact_stiffness: Some(stiffness).filter(|value| value.is_finite()),
        elastic_energy: observables.elastic_energy * e_star * side.powi(3),
        rms_height: moments.rms_height * side,
        rms_slope: moments.rms_slope,
        h_max: solved.h_max * side,
        complementarity_error: info.certificate.complementarity,
        penetration_error: info.certificate.penetration,
        load_error: info.certificate.load,
        iterations: info.levels.last().map_or(0, |level: &LevelInfo| level.iterations),
        operator_applications: info.fine_operator_applications(),
        wall_seconds: solved.wall.as_secs_f64(),
        peak_memory_bytes: memory::peak(),
        threads,
        version: text(env!("CARGO_PKG_VERSION")),
    }
}

fn print_summary(
    summary: &Summary,
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    run: &RunKeys,
) -> Result<(), CliError> {
    match (run.quiet, run.json) {
        (true, _) => Ok(()),
        (false, true) => output::print(&summary.to_json()),
        (false, false) => {
            let text = report::solved(summary, surface.cell.side(), contact.elasticity.e_star());
            output::print(&(text + &report::written(run.out.as_deref())))
        }
    }
}

/// Writes the result folder; `side` is λ in m.
fn write_results(
    folder: &Path,
    solved: &Solved,
    summary: &Summary,
    contact: &ContactProblem,
    side: f64,
) -> Result<(), CliError> {
    let Solution { pressure, gap, .. } = &solved.solution;
    let e_star = contact.elasticity.e_star();
    let mut staged = Staged::new(folder)?;
    let mut add_field = |name: &str, field: &Field, factor: f64| match contact.keys.output_grid {
        None => staged.add(name, |path| npy::write(path, field, factor)),
        Some(spec) => staged.add(name, |path| npy::write(path, &averaged(field, spec), factor)),
    };
    add_field("pressure.npy", pressure, e_star)?;
    add_field("gap.npy", gap, side)?;
    if let Some(heights) = &solved.heights.as_read {
        staged.add(HEIGHTS_FILE, |path| npy::write(path, heights, 1.0))?;
    }
    if let Some(elements) = &solved.solution.elements {
        staged.add("elements.csv", |path| write_elements(path, elements, side, e_star))?;
    }
    let picture = ContactPicture { pressure, pressure_unit: e_star, side };
    staged.add("contact.png", |path| save_png(&picture, path))?;
    staged.add_text("scene.toml", &scene_text(&solved.heights.keys, contact))?;
    staged.add_text("summary.json", &summary.to_json())?;
    staged.commit()
}

/// Centre (m), side (m) and pressure (Pa) of each element, as `elements.csv`.
fn write_elements(path: &Path, elements: &MeshPressure, side: f64, e_star: f64) -> Result<(), csv::Error> {
    let mut out = csv::Writer::from_path(path)?;
    out.write_record(["x", "y", "size", "pressure"])?;
    for (element, pressure) in elements.mesh.elements().zip(&elements.pressure) {
        out.serialize((element.x * side, element.y * side, element.side * side, pressure * e_star))?;
    }
    out.flush()?;
    Ok(())
}

/// The scene as it was solved: every key that determines the result.
fn scene_text(surface: &SurfaceKeys, contact: &ContactProblem) -> String {
    let [surface, contact] = [scene_file::to_toml(surface), scene_file::to_toml(&contact.keys)];
    format!("# The scene as it was solved: `rc solve scene.toml` repeats the result.\n\n{surface}\n{contact}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::Summary;

    #[test]
    fn what_did_not_converge_is_written_and_marked() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let scene = scene_file::parse("waves = 8\ngrid = 64\npressure = 1e5").expect("a scene");
        let surface = resolve::surface(scene.surface).expect("a surface");
        let mut contact = resolve::contact(scene.contact, surface.cell.side()).expect("a contact");
        contact.params.max_iterations = 1;
        let run = RunKeys { out: Some(dir.path().join("r")), quiet: true, ..RunKeys::default() };
        let error = execute(&surface, &contact, &run, 1, Instant::now()).expect_err("one iteration is too few");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains("complementarity error"), "no residuals: {error}");
        let text = std::fs::read_to_string(dir.path().join("r/summary.json")).expect("a summary");
        let summary: Summary = serde_json::from_str(&text).expect("valid JSON");
        assert_eq!(summary.status, "not_converged");
        assert!(dir.path().join("r/pressure.npy").is_file(), "the best pressure is written");
    }
}
