//! Limits that end a solve early: a time limit, or Ctrl-C.
//!
//! The results up to then are written and marked.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::error::INTERRUPTED;
use crate::scene::time_limit::TimeLimit;
use crate::terminal;

/// Whether Ctrl-C was pressed or a job system asked the process to end.
static IS_INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Why a solve ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reason {
    Interrupted,
    TimeLimit(TimeLimit),
}

/// The limits of a solve.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Stop {
    limit: Option<(Instant, TimeLimit)>,
}

impl Stop {
    /// Ends a solve when interrupted, or when `limit` has passed since `started`.
    pub(crate) fn at(started: Instant, limit: Option<TimeLimit>) -> Self {
        Self { limit: limit.and_then(|limit| Some((started.checked_add(limit.0)?, limit))) }
    }

    /// Why the solve has to end now; `None` if it may go on.
    pub(crate) fn reason(&self) -> Option<Reason> {
        if IS_INTERRUPTED.load(Ordering::Relaxed) {
            return Some(Reason::Interrupted);
        }
        self.limit.filter(|(end, _)| Instant::now() >= *end).map(|(_, limit)| Reason::TimeLimit(limit))
    }
}

/// Starts to listen for interrupts.
///
/// The first interrupt ends the solve with its results up to then. The second ends the process.
pub(crate) fn listen() {
    let handler = || {
        if IS_INTERRUPTED.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
        terminal::tell("interrupted: finishing with the results so far; press Ctrl-C again to stop at once");
    };
    // Without a handler an interrupt ends the process at once, and no file is half-written.
    let _ = ctrlc::set_handler(handler);
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_limit_is_reached_and_none_never_is() {
        let limit = |seconds| Some(TimeLimit(Duration::from_secs(seconds)));
        let earlier = Instant::now().checked_sub(Duration::from_secs(2)).expect("the machine runs longer than that");
        assert_eq!(Stop::at(earlier, limit(1)).reason(), limit(1).map(Reason::TimeLimit));
        assert_eq!(Stop::at(earlier, limit(1000)).reason(), None);
        assert_eq!(Stop::at(earlier, None).reason(), None);
    }
}
