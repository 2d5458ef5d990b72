//! The error for a rank that has ended.

use thiserror::Error;

/// A rank has ended before the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("rank {rank} of {size} has ended early, and the others with it")]
pub struct LostRank {
    /// The rank that has ended.
    pub rank: usize,
    /// Number of ranks.
    pub size: usize,
}
