//! The progress bar of a solve, on standard error if that is a terminal.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rc_core::{Event, Observer, Snapshot};

use super::stop::{Reason, Stop};
use super::watch::Watch;

/// Length of the bar in steps. The bar shows the fall of the error.
const STEPS: u64 = 1000;

/// Shows level, iteration and error of a running solve, and vanishes at its end.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    stop: Stop,
    watch: Option<Watch>,
}

impl Progress {
    /// A bar on a terminal, which is hidden with `quiet` or without a terminal.
    #[must_use]
    pub(crate) fn new(quiet: bool) -> Self {
        let hidden = quiet || !std::io::stderr().is_terminal();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(10) };
        let bar = ProgressBar::with_draw_target(Some(STEPS), target);
        // A template that does not parse would be noticed in the first run. The default bar then takes its place.
        if let Ok(style) = ProgressStyle::with_template("{prefix} [{bar:20}] {msg}") {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar, stop: Stop::default(), watch: None }
    }

    /// The progress with `stop`, which ends the solve early.
    #[must_use]
    pub(crate) fn until(self, stop: Stop) -> Self {
        // `Self` has a destructor, so its fields cannot be moved.
        let mut progress = self;
        progress.stop = stop;
        progress
    }

    /// The progress with `watch`, which draws the solve.
    #[must_use]
    pub(crate) fn watched_by(self, watch: Option<Watch>) -> Self {
        let mut progress = self;
        progress.watch = watch;
        progress
    }

    /// Why the solve had to end; `None` if it did not have to.
    pub(crate) fn stopped(&self) -> Option<Reason> {
        self.stop.reason()
    }

    /// Does `work`, which may print, without the bar.
    pub(crate) fn hidden<T>(&self, work: impl FnOnce() -> T) -> T {
        self.bar.suspend(work)
    }

    /// Shows what is done before the first level.
    pub(crate) fn say(&self, what: &'static str) {
        self.bar.set_message(what);
    }
}

impl Observer for Progress {
    fn notify(&self, event: &Event) {
        match *event {
            Event::Level { grid, level, n_levels } => {
                self.bar.set_prefix(format!("level {}/{n_levels}, {grid}", level + 1));
                self.bar.set_position(0);
            }
            Event::Iteration { iteration, error, tolerance, .. } => {
                self.bar.set_position((fallen(error, tolerance) * STEPS as f64) as u64);
                self.bar.set_message(format!("iteration {iteration}, error {error:.0e}, tolerance {tolerance:.0e}"));
            }
            _ => {}
        }
    }

    fn look(&self, pressure: &Snapshot<'_>) {
        if let Some(watch) = &self.watch {
            watch.look(pressure);
        }
    }

    fn should_stop(&self) -> bool {
        self.stop.reason().is_some()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// The fraction of the way from 1 to `tolerance` that the error has fallen.
///
/// The way is in orders of magnitude.
fn fallen(error: f64, tolerance: f64) -> f64 {
    if error > 0.0 && tolerance < 1.0 { (error.ln() / tolerance.ln()).clamp(0.0, 1.0) } else { 0.0 }
}
