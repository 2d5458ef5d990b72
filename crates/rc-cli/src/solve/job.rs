//! One run of `rc solve`, from the resolved scene to its files.

use std::time::Instant;

use rc_comm::Ranks;
use rc_sweep::memory::Budget;
use rc_sweep::{Summary, Warning};

use super::checked::CheckedScene;
use super::solved::Solved;
use super::{dry_run, sliding_note};
use crate::error::CliError;
use crate::export::zarr;
use crate::files::kind::Kind;
use crate::files::names::GROUP;
use crate::run::progress::Progress;
use crate::run::stop::{Reason, Stop};
use crate::run::threads;
use crate::run::together::together;
use crate::run::watch::Watch;
use crate::scene::keys::{RunKeys, Scene};
use crate::warnings::shown;
use crate::{terminal, text};

/// What is printed where `elements` has no effect, because the method was chosen.
const NO_ELEMENTS: &str = "note: the method has no elements but those of the grid, so there is no elements.csv\n";

/// A resolved scene, and how it is run.
#[derive(Clone, Debug)]
pub(super) struct Job {
    pub(super) scene: CheckedScene,
    pub(super) run: RunKeys,
    /// Number of worker threads of the process.
    threads: usize,
    /// Whether the solve is drawn while it runs.
    watch: bool,
    /// Whether ranks write the fields together, as a Zarr group.
    zarr: bool,
    /// Time from which `wall_seconds` counts.
    started: Instant,
}

impl Job {
    /// Starts the threads and checks `scene`.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn new(scene: Scene, watch: bool) -> Result<Self, CliError> {
        let Scene { surface, contact, run } = scene;
        let started = Instant::now();
        // A file of waves is read with these threads.
        let threads = threads::start(run.threads)?;
        let scene = CheckedScene::new(surface, contact)?;
        Ok(Self { scene, run, threads, watch, zarr: false, started })
    }

    /// Prints an estimate of the cost of the job.
    ///
    /// # Errors
    /// [`CliError::Input`].
    pub(super) fn dry_run(&self) -> Result<(), CliError> {
        let (kernel, surface) = (self.scene.contact.kernel()?, self.scene.surface.load_within(self.budget())?);
        let problem = self.scene.problem(&surface, &*kernel, self.budget());
        together(self.ranks(), self.doubt(&problem.warnings()))?;
        dry_run::run(&problem, self.threads, &self.run)
    }

    /// The job with fields that the ranks write together, as a Zarr group.
    ///
    /// # Errors
    /// [`CliError::Input`] without a folder, with a coarser grid for the output, and where a folder is in the way.
    pub(super) fn with_zarr(self) -> Result<Self, CliError> {
        let Some(folder) = &self.run.out else {
            return Err(CliError::input("zarr: the group is in the folder of the results; name it with --out"));
        };
        if self.scene.contact.keys.output_grid.is_some() {
            return Err(CliError::input("output_grid: the group of --zarr has the whole grid; omit one of the two"));
        }
        zarr::check_place(&folder.join(GROUP))?;
        Ok(Self { zarr: true, ..self })
    }

    /// The memory that the job may use.
    fn budget(&self) -> Budget {
        Budget::new(self.run.memory_limit)
    }

    /// Solves, writes and prints.
    ///
    /// # Errors
    /// [`CliError`] of every kind.
    pub(super) fn execute(&self) -> Result<(), CliError> {
        let ranks = self.ranks();
        if let Some(folder) = &self.run.out {
            let checked = if ranks.rank() == 0 { Kind::Result.check_out(folder) } else { Ok(()) };
            together(ranks, checked)?;
        }
        let progress = self.progress();
        progress.say("heights");
        let kernel = self.scene.contact.kernel()?;
        let surface = together(ranks, self.scene.surface.load_within(self.budget()))?;
        let problem = self.scene.problem(&surface, &*kernel, self.budget());
        progress.hidden(|| together(ranks, self.doubt(&problem.warnings())))?;
        let solved = self.scene.solve(problem, self.started, &progress)?;
        self.finish(&solved, progress)
    }

    /// Prints what is doubtful before the solve, or refuses it with `--strict`.
    fn doubt(&self, warnings: &[Warning]) -> Result<(), CliError> {
        shown::refuse(warnings, self.run.strict, "; nothing was solved or written")?;
        if self.ranks().rank() == 0 {
            shown::tell(warnings, &self.run);
        }
        Ok(())
    }

    /// The ranks that solve the problem together.
    fn ranks(&self) -> &Ranks {
        &self.scene.contact.place.ranks
    }

    /// The observer that shows the solve, draws it, and ends it early.
    fn progress(&self) -> Progress {
        let folder = self.run.out.as_deref().filter(|_| self.watch);
        let units = self.scene.contact.units;
        let watch = folder.map(|folder| Watch::new(folder, units.elasticity().e_star(), units.cell().side()));
        Progress::new(self.run.quiet || self.ranks().rank() > 0)
            .until(Stop::at(self.started, self.run.time_limit))
            .watched_by(watch)
    }

    /// Writes and prints the result.
    fn finish(&self, solved: &Solved<'_>, progress: Progress) -> Result<(), CliError> {
        let stopped = progress.stopped();
        let summary = solved.summary(self.threads);
        if let Some(folder) = &self.run.out {
            if self.zarr {
                solved.write_shared(folder, &summary)?;
            } else {
                solved.write(folder, &summary)?;
            }
        }
        // The bar must vanish before anything is printed. The picture of --watch must stay until the result exists.
        drop(progress);
        self.print(&summary, solved.has_elements())?;
        // Warnings from before the solve are first in the summary, and are printed already.
        let late = &summary.warnings[solved.n_early_warnings()..];
        if self.ranks().rank() == 0 {
            shown::tell(late, &self.run);
        }
        let written = if self.run.out.is_some() { "; the results are written" } else { "" };
        let doubted = together(self.ranks(), shown::refuse(late, self.run.strict, written));
        let Some(failure) = solved.failure() else { return doubted };
        let written = if self.run.out.is_some() { "; the results are written and marked not_converged" } else { "" };
        Err(match stopped {
            Some(Reason::Interrupted) => CliError::Interrupted(format!("interrupted: {}{written}", failure.what)),
            Some(Reason::TimeLimit(limit)) => CliError::NotConverged(format!(
                "time_limit: {limit} was not enough: {}; give a longer time limit or a larger tolerance{written}",
                failure.what
            )),
            None => CliError::NotConverged(format!("{failure}{written}")),
        })
    }

    /// Prints the summary, on the first rank only.
    fn print(&self, summary: &Summary, has_elements: bool) -> Result<(), CliError> {
        if self.ranks().rank() > 0 {
            return Ok(());
        }
        match (self.run.json, self.run.quiet) {
            (true, _) => terminal::print(&summary.to_json()),
            (false, true) => Ok(()),
            (false, false) => {
                let units = self.scene.contact.units;
                let keys = &self.scene.contact.keys;
                let text = text::solved(summary, units.cell().sides(), units.elasticity().e_star(), keys);
                let is_lost = self.scene.contact.keys.elements && !has_elements;
                let note = if is_lost { NO_ELEMENTS } else { "" };
                let of_shear = self.scene.contact.shear.as_ref().and_then(|shear| shear.note.clone());
                for note in sliding_note::of(summary, &self.scene.contact).into_iter().chain(of_shear) {
                    terminal::tell(&note);
                }
                terminal::print(&(text + note + &text::written(self.run.out.as_deref())))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::file;

    #[test]
    fn what_did_not_converge_is_written_and_marked() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let scene = file::parse("waves = 8\ngrid = 64\npressure = 1e5").expect("a scene");
        let run = RunKeys { out: Some(dir.path().join("r")), quiet: true, ..RunKeys::default() };
        let mut job = Job::new(Scene { run, ..scene }, false).expect("a job");
        job.scene.contact.params.max_iterations = 1;
        let error = job.execute().expect_err("one iteration is too few");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains("complementarity error"), "no residuals: {error}");
        let text = std::fs::read_to_string(dir.path().join("r/summary.json")).expect("a summary");
        let summary: Summary = serde_json::from_str(&text).expect("valid JSON");
        assert_eq!(summary.status, "not_converged");
        assert!(dir.path().join("r/pressure.npy").is_file(), "the best pressure is written");
    }
}
