//! The trait that an implementation of ranks provides.

/// Exchange of bytes between ranks.
///
/// All ranks call the same functions in the same order. When a rank is lost, the others end too, and functions do not
/// return. An implementation then aborts the run with a message, or unwinds with a [`crate::LostRank`]. Functions are
/// called by one thread at a time, but not always by the same one.
pub trait Communicator: Send + Sync {
    /// Number of this rank, from 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Waits until all ranks have called it.
    fn barrier(&self);

    /// Returns the bytes of each rank, in the order of ranks.
    fn all_gather(&self, mine: &[u8]) -> Vec<Vec<u8>>;

    /// Sends bytes to some ranks, and receives bytes from the ranks in `from`.
    ///
    /// `outgoing` has at most one message for each other rank, and no message to itself. The result is in the order of
    /// `from`. Those ranks send to this rank in the same call.
    fn exchange(&self, outgoing: Vec<(usize, Vec<u8>)>, from: &[usize]) -> Vec<Vec<u8>>;
}
