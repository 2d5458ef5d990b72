//! Rounds that end early because the observer wants to stop.
//!
//! A round takes several applications of L, which are seconds each on large grids. The observer is therefore asked
//! before each of them.

use rc_core::Observer;

use crate::descent::state::Descent;

/// The observer wants to stop, and the round has ended early.
///
/// The pressure may have taken a step that was not projected. [`Descent::admit`] makes it a start again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stopped;

/// Ends a round if the observer wants to stop.
pub(crate) fn unless_stopped(observer: &dyn Observer) -> Result<(), Stopped> {
    if observer.should_stop() { Err(Stopped) } else { Ok(()) }
}

impl Descent<'_> {
    /// Makes the pressure of an unfinished round admissible: no tension, nothing above the hardness, the whole load.
    ///
    /// The gap does not follow.
    pub(crate) fn admit(&mut self) {
        if self.info.iterations == 0 {
            return;
        }
        let bounds = self.problem.bounds;
        self.pressure.update(|p| *p = p.clamp(0.0, bounds.hardness));
        // With a hardness, the fresh gap restores the load.
        if !bounds.is_limited() {
            self.project_to_load();
        }
    }
}
