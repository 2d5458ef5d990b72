//! The storage from which a solve goes on.

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
