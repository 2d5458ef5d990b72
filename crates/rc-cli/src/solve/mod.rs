//! `rc solve`: one contact problem, from scene to files.

mod area_error;
mod dry_run;
mod found;
mod method;
mod refusal;
mod result_files;
mod summarise;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use self::found::Found;
use self::method::Choice;
use self::summarise::summarise;
use crate::args::SolveArgs;
use crate::coarsen::check_factor;
use crate::error::CliError;
use crate::output;
use crate::progress::Progress;
use crate::resolve::{self, ContactProblem};
use crate::scene::{RunKeys, Scene};
use crate::stop::{self, Reason, Stop};
use crate::surface::{LoadedSurface, SurfaceProblem};
use crate::watch::Watch;
use crate::{report, scene_file};
use rc_sweep::Summary;
use rc_sweep::files;

/// Where the run without arguments writes.
const EXAMPLE_FOLDER: &str = "rc-result";

/// A solved problem with what its files and its summary need.
pub(crate) struct Solved<'a> {
    found: Found<'a>,
    /// Why it was solved by this method.
    reason: String,
    surface: &'a LoadedSurface,
    contact: &'a ContactProblem,
    /// λ in m.
    side: f64,
    wall: Duration,
}

impl<'a> Solved<'a> {
    /// Solves; `side` is λ in m, `started` the moment from which `wall_seconds` counts. Folder and memory limit of `run` are
    /// respected, nothing is written.
    ///
    /// # Errors
    /// [`CliError::Input`]; a solution that did not converge is none, see [`Solved::failure`].
    pub(crate) fn new(
        surface: &'a LoadedSurface,
        contact: &'a ContactProblem,
        side: f64,
        run: &RunKeys,
        started: Instant,
        progress: &Progress,
    ) -> Result<Self, CliError> {
        if let Some(spec) = contact.keys.output_grid {
            check_factor(surface.grid, spec)?;
        }
        let Choice { plan, reason } = method::choose(surface, contact, side, run)?;
        let found = Found::by(plan, surface, contact, side, progress)?;
        let wall = started.elapsed();
        Ok(Self { found, reason, surface, contact, side, wall })
    }

    /// What is to be said of a solution that did not reach the tolerance.
    pub(crate) fn failure(&self) -> Option<&str> {
        self.found.failure.as_deref()
    }

    /// Estimated error of the contact area over it.
    fn relative_area_error(&self) -> f64 {
        self.found.contact_area(self.contact).relative_error()
    }

    /// The summary in SI; `threads` is what it says of them.
    pub(crate) fn summary(&self, threads: usize) -> Summary {
        summarise(self, threads)
    }

    /// Writes the result folder.
    ///
    /// # Errors
    /// [`CliError::Write`].
    pub(crate) fn write(&self, folder: &Path, summary: &Summary) -> Result<(), CliError> {
        Ok(result_files::write(folder, self, summary)?)
    }
}

/// Runs `rc solve`.
///
/// # Errors
/// [`CliError`] of every kind.
pub(crate) fn run(args: SolveArgs) -> Result<(), CliError> {
    let (dry_run, watch) = (args.dry_run, args.watch);
    if dry_run && watch {
        return Err(CliError::input("watch: a dry run has nothing to be seen; leave one of the two away"));
    }
    let scene = scene_of(args)?;
    if watch && scene.run.out.is_none() {
        return Err(CliError::input("watch: the picture is in the folder of the results; name it with --out"));
    }
    let started = Instant::now();
    if let Some(wanted) = scene.contact.area_error {
        if dry_run {
            return Err(CliError::input("dry_run: what area_error will choose is not known before; give grid instead"));
        }
        return area_error::run(scene, wanted, watch, started);
    }
    let surface = resolve::surface(scene.surface)?;
    let contact = resolve::contact(scene.contact, surface.cell.side(), surface.elements_per_wave())?;
    let threads = resolve::start_threads(scene.run.threads)?;
    stop::listen();
    if dry_run {
        return dry_run::run(&surface, &contact, &scene.run, threads);
    }
    execute(&surface, &contact, &scene.run, watch, threads, started)
}

/// What tells of a solve, draws it, and ends it early.
fn observer(
    run: &RunKeys,
    watch: bool,
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    started: Instant,
) -> Progress {
    let folder = run.out.as_deref().filter(|_| watch);
    let watch = folder.map(|folder| Watch::new(folder, contact.elasticity.e_star(), surface.cell.side()));
    Progress::new(run.quiet).until(Stop::at(started, run.time_limit)).watched_by(watch)
}

/// Solves, writes and prints.
fn execute(
    surface: &SurfaceProblem,
    contact: &ContactProblem,
    run: &RunKeys,
    watch: bool,
    threads: usize,
    started: Instant,
) -> Result<(), CliError> {
    if let Some(folder) = &run.out {
        files::check_folder(folder)?;
    }
    let progress = observer(run, watch, surface, contact, started);
    progress.say("heights");
    let loaded = surface.load()?;
    let solved = Solved::new(&loaded, contact, surface.cell.side(), run, started, &progress)?;
    finish(&solved, surface, run, threads, progress)
}

/// Writes and prints.
fn finish(
    solved: &Solved<'_>,
    surface: &SurfaceProblem,
    run: &RunKeys,
    threads: usize,
    progress: Progress,
) -> Result<(), CliError> {
    let stopped = progress.stopped();
    let summary = solved.summary(threads);
    if let Some(folder) = &run.out {
        solved.write(folder, &summary)?;
    }
    // The bar goes before anything is printed, the picture of --watch not before the result is there.
    drop(progress);
    print_summary(&summary, surface, solved.contact, run)?;
    let Some(message) = solved.failure() else { return Ok(()) };
    let written = if run.out.is_some() { "; the results are written and marked not_converged" } else { "" };
    Err(match stopped {
        Some(Reason::Interrupted) => CliError::Interrupted(format!("interrupted: {message}{written}")),
        Some(Reason::TimeLimit(limit)) => {
            CliError::NotConverged(format!("time_limit: {limit} were not enough: {message}{written}"))
        }
        None => CliError::NotConverged(format!("{message}{written}")),
    })
}

/// The scene of the command line; without any argument the embedded example, into its folder.
fn scene_of(args: SolveArgs) -> Result<Scene, CliError> {
    if args.scene_file.is_some() || !args.scene.is_empty() {
        return resolve::layers(args.scene_file.as_deref(), args.scene);
    }
    if args.dry_run {
        return Ok(scene_file::example());
    }
    output::tell(&format!(
        "No scene given: solving the embedded example (the paper's surface, N = 64, σ0/E* = 8.9e-4), writing to \
         {EXAMPLE_FOLDER}/"
    ));
    let run = RunKeys { out: Some(PathBuf::from(EXAMPLE_FOLDER)), ..RunKeys::default() };
    Ok(Scene { run, ..scene_file::example() })
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
            let text = report::solved(summary, surface.cell.sides(), contact.elasticity.e_star());
            output::print(&(text + &report::written(run.out.as_deref())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rc_sweep::Summary;

    #[test]
    fn what_did_not_converge_is_written_and_marked() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let scene = scene_file::parse("waves = 8\ngrid = 64\npressure = 1e5").expect("a scene");
        let surface = resolve::surface(scene.surface).expect("a surface");
        let mut contact = resolve::contact(scene.contact, surface.cell.side(), None).expect("a contact");
        contact.params.max_iterations = 1;
        let run = RunKeys { out: Some(dir.path().join("r")), quiet: true, ..RunKeys::default() };
        let error = execute(&surface, &contact, &run, false, 1, Instant::now()).expect_err("one iteration is too few");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains("complementarity error"), "no residuals: {error}");
        let text = std::fs::read_to_string(dir.path().join("r/summary.json")).expect("a summary");
        let summary: Summary = serde_json::from_str(&text).expect("valid JSON");
        assert_eq!(summary.status, "not_converged");
        assert!(dir.path().join("r/pressure.npy").is_file(), "the best pressure is written");
    }
}
