//! What an implementation gives.

/// Exchange of bytes between ranks, which call the same functions in the same order.
///
/// A rank that is lost ends the others: functions do not return then. (An implementation aborts the run with a message,
/// or unwinds with a [`crate::LostRank`].) All are called by one thread at a time, not always the same one.
pub trait Communicator: Send + Sync {
    /// This rank, from 0 on.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Waits for all ranks.
    fn barrier(&self);

    /// What each rank gives, in the order of ranks.
    fn all_gather(&self, mine: &[u8]) -> Vec<Vec<u8>>;

    /// Sends bytes to some ranks, at most once to each and not to itself, and receives from those in `from`, in their
    /// order. They send to this rank in the same call.
    fn exchange(&self, outgoing: Vec<(usize, Vec<u8>)>, from: &[usize]) -> Vec<Vec<u8>>;
}
