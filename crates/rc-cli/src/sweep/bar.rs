//! The progress bar of a sweep, on standard error if that is a terminal.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar with the number of finished rows and the expected time of the others.
///
/// It vanishes at the end.
#[derive(Clone, Debug)]
pub(super) struct RowBar(ProgressBar);

impl RowBar {
    /// A bar of `n` rows, of which `done` are finished.
    ///
    /// It is hidden with `quiet` or without a terminal.
    pub(super) fn new(done: usize, n: usize, quiet: bool) -> Self {
        let hidden = quiet || !std::io::stderr().is_terminal();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(4) };
        let bar = ProgressBar::with_draw_target(Some(n as u64), target).with_position(done as u64);
        // A template that does not parse would be noticed in the first run. The default bar then takes its place.
        if let Ok(style) = ProgressStyle::with_template("{pos}/{len} rows [{bar:30}] {elapsed}, {eta} to go") {
            bar.set_style(style.progress_chars("=> "));
        }
        // Rows of an earlier run do not tell the speed of this one.
        bar.reset_eta();
        bar.enable_steady_tick(std::time::Duration::from_millis(500));
        Self(bar)
    }

    /// Counts one more finished row.
    pub(super) fn one_more(&self) {
        if self.0.length().is_some_and(|n| n <= self.0.position()) {
            // The total number of rows is not known.
            self.0.inc_length(1);
        }
        self.0.inc(1);
    }

    /// Removes the bar from the terminal.
    pub(super) fn clear(&self) {
        self.0.finish_and_clear();
    }
}
