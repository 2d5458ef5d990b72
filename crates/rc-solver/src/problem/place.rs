//! Where a problem is solved: the ranks that share it, and the storage from which it goes on.

use std::sync::Arc;

use rc_comm::Ranks;

/// Storage that outlives the process, usually a file.
///
/// If several ranks share a solve, the first rank writes and all ranks read.
pub trait Checkpoint: Send + Sync {
    /// Reads `len` of the stored bytes, from `offset` on.
    ///
    /// `None` if there are fewer, or if nothing is stored.
    fn read(&self, offset: u64, len: usize) -> Option<Vec<u8>>;

    /// Stores these pieces, one after the other, and drops all earlier bytes.
    ///
    /// The checkpoint must report a failure itself. The solve continues.
    fn replace(&self, pieces: &mut dyn Iterator<Item = Vec<u8>>);
}

/// The place where a problem is solved.
#[derive(Clone, Default)]
pub(crate) struct Place {
    /// Ranks that the mesh is dealt among.
    pub(crate) ranks: Ranks,
    /// Storage for the start of each level, if a solve is to be continued.
    pub(crate) checkpoint: Option<Arc<dyn Checkpoint>>,
}

impl Place {
    /// Whether several ranks share the problem.
    pub(crate) fn is_shared(&self) -> bool {
        self.ranks.size() > 1
    }
}
