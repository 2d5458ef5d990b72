//! How an observer sees the pressure of a mesh.

use rc_core::{Grid, Observer, Snapshot};

/// A mesh whose pressures can be shown on a uniform grid.
pub(crate) trait Shown {
    /// Lets the observer look at the pressure on the elements; nothing is computed unless it does.
    fn show(&self, pressure: &[f64], observer: &dyn Observer);
}

impl Shown for Grid {
    fn show(&self, pressure: &[f64], observer: &dyn Observer) {
        observer.look(&Snapshot::new(*self, &|take| take(pressure)));
    }
}
