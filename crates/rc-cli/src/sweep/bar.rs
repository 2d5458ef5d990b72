//! The progress of a sweep, on standard error, for people at a terminal.

use std::io::IsTerminal as _;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Shows how many rows are done and how long the others will take, and vanishes at the end.
#[derive(Clone, Debug)]
pub(super) struct RowBar(ProgressBar);

impl RowBar {
    /// A bar with `done` of `n` rows done already; nothing when standard error is no terminal, or `quiet`.
    pub(super) fn new(done: usize, n: usize, quiet: bool) -> Self {
        let hidden = quiet || !std::io::stderr().is_terminal();
        let target = if hidden { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(4) };
        let bar = ProgressBar::with_draw_target(Some(n as u64), target).with_position(done as u64);
        // A template that does not parse would be seen in the first run; the default bar stands in for it.
        if let Ok(style) = ProgressStyle::with_template("{pos}/{len} rows [{bar:30}] {elapsed}, {eta} to go") {
            bar.set_style(style.progress_chars("=> "));
        }
        // Rows of an earlier run say nothing about the speed of this one.
        bar.reset_eta();
        bar.enable_steady_tick(std::time::Duration::from_millis(500));
        Self(bar)
    }

    /// One more row is done.
    pub(super) fn one_more(&self) {
        if self.0.length().is_some_and(|n| n <= self.0.position()) {
            // How many there will be is not known.
            self.0.inc_length(1);
        }
        self.0.inc(1);
    }

    /// Takes the bar off the terminal.
    pub(super) fn clear(&self) {
        self.0.finish_and_clear();
    }
}
