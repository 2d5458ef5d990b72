//! An observer that stops all ranks at once.

use rc_comm::Ranks;
use rc_core::{Event, Observer, Snapshot};

/// The observer of this rank. A solve stops on all ranks if one of them wants to stop.
pub(super) struct AgreedStop<'a> {
    pub(super) observer: &'a dyn Observer,
    pub(super) ranks: &'a Ranks,
}

impl Observer for AgreedStop<'_> {
    fn notify(&self, event: &Event) {
        self.observer.notify(event);
    }

    fn look(&self, pressure: &Snapshot<'_>) {
        self.observer.look(pressure);
    }

    fn should_stop(&self) -> bool {
        self.ranks.any(self.observer.should_stop())
    }
}
