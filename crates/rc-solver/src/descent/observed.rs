//! How an observer looks at the pressure on a mesh.

use rc_core::{Grid, Observer, Snapshot};

use crate::descent::values::Values;

/// A mesh whose pressures an observer can see on a uniform grid.
pub(crate) trait ObservedMesh {
    /// Lets the observer look at the pressure on the elements.
    ///
    /// Nothing is computed unless it looks.
    fn show_pressure(&self, pressure: &Values, observer: &dyn Observer);
}

impl ObservedMesh for Grid {
    fn show_pressure(&self, pressure: &Values, observer: &dyn Observer) {
        observer.look(&Snapshot::new(*self, &|take| take(&pressure.all())));
    }
}
