//! The interface of a solver to a communicator.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::communicator::Communicator;
use crate::packed::Packed;

/// The ranks of one solve, or this process alone.
#[derive(Clone, Default)]
pub struct Ranks(Option<Arc<Counted>>);

/// A communicator with counts of messages and bytes.
struct Counted {
    communicator: Box<dyn Communicator>,
    messages: AtomicU64,
    bytes: AtomicU64,
}

/// Number of messages and bytes that this rank has sent so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Messages, each to one other rank.
    pub messages: u64,
    /// Bytes of these messages.
    pub bytes: u64,
}

impl Ranks {
    /// Ranks that consist of this process alone.
    #[must_use]
    pub fn alone() -> Self {
        Self(None)
    }

    /// The ranks of a communicator. A communicator of one rank is a process alone.
    #[must_use]
    pub fn new(communicator: Box<dyn Communicator>) -> Self {
        if communicator.size() <= 1 {
            return Self(None);
        }
        Self(Some(Arc::new(Counted { communicator, messages: AtomicU64::new(0), bytes: AtomicU64::new(0) })))
    }

    /// Whether this process is alone.
    #[must_use]
    pub fn are_alone(&self) -> bool {
        self.0.is_none()
    }

    /// Number of this rank, from 0.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.0.as_ref().map_or(0, |ranks| ranks.communicator.rank())
    }

    /// Number of ranks.
    #[must_use]
    pub fn size(&self) -> usize {
        self.0.as_ref().map_or(1, |ranks| ranks.communicator.size())
    }

    /// The messages and bytes that this rank has sent so far.
    #[must_use]
    pub fn traffic(&self) -> Traffic {
        self.0.as_ref().map_or(Traffic::default(), |ranks| Traffic {
            messages: ranks.messages.load(Ordering::Relaxed),
            bytes: ranks.bytes.load(Ordering::Relaxed),
        })
    }

    /// Waits until all ranks have called it.
    pub fn barrier(&self) {
        if let Some(ranks) = &self.0 {
            ranks.communicator.barrier();
        }
    }

    /// Returns the values of each rank, in the order of ranks.
    #[must_use]
    pub fn all_gather<T: Packed>(&self, mine: &[T]) -> Vec<Vec<T>> {
        match &self.0 {
            None => vec![mine.to_vec()],
            Some(ranks) => {
                let mut bytes = Vec::new();
                T::pack(mine, &mut bytes);
                let others = ranks.communicator.size() as u64 - 1;
                ranks.count(others, others * bytes.len() as u64);
                ranks.communicator.all_gather(&bytes).iter().map(|bytes| T::unpack_all(bytes)).collect()
            }
        }
    }

    /// Returns the values of all ranks in one vector, in the order of ranks.
    #[must_use]
    pub fn concatenate<T: Packed>(&self, mine: Vec<T>) -> Vec<T> {
        if self.are_alone() { mine } else { self.all_gather(&mine).concat() }
    }

    /// Sends bytes to some other ranks, and receives bytes from the ranks in `from`.
    ///
    /// The result is in the order of `from`. Those ranks send to this rank in the same call.
    #[must_use]
    pub fn exchange(&self, outgoing: Vec<(usize, Vec<u8>)>, from: &[usize]) -> Vec<Vec<u8>> {
        match &self.0 {
            None => Vec::new(),
            Some(ranks) => {
                ranks.count(outgoing.len() as u64, outgoing.iter().map(|(_, bytes)| bytes.len() as u64).sum());
                ranks.communicator.exchange(outgoing, from)
            }
        }
    }

    /// Sends one message to every rank, and returns the messages to this rank.
    ///
    /// `outgoing[rank]` is the message to `rank`. Item `rank` of the result is its message to this rank. Both include
    /// this rank itself.
    #[must_use]
    pub fn exchange_all(&self, mut outgoing: Vec<Vec<u8>>) -> Vec<Vec<u8>> {
        if self.are_alone() {
            return outgoing;
        }
        let (rank, size) = (self.rank(), self.size());
        outgoing.resize_with(size, Vec::new);
        let own = std::mem::take(&mut outgoing[rank]);
        let others: Vec<usize> = (0..size).filter(|&other| other != rank).collect();
        let outgoing = outgoing.into_iter().enumerate().filter(|&(other, _)| other != rank).collect();
        let mut received = self.exchange(outgoing, &others);
        received.insert(rank, own);
        received
    }

    /// Continues a sum from rank to rank, and returns the result on all ranks.
    ///
    /// Rank 0 begins with `start`. On each rank `add` adds the summands of the rank to the sum so far. The order of
    /// summands is the order of ranks, so the rounding is the same as on a single rank.
    #[must_use]
    pub fn fold<const N: usize>(&self, start: [f64; N], add: impl FnOnce([f64; N]) -> [f64; N]) -> [f64; N] {
        if self.are_alone() {
            return add(start);
        }
        let (rank, last) = (self.rank(), self.size() - 1);
        let so_far = match rank {
            0 => start,
            _ => first_of(&self.exchange(Vec::new(), &[rank - 1])).unwrap_or(start),
        };
        let sum = add(so_far);
        let mut bytes = Vec::new();
        f64::pack(&sum, &mut bytes);
        if rank < last {
            let _ = self.exchange(vec![(rank + 1, bytes)], &[]);
            // The last rank has the complete sum.
            return first_of(&self.exchange(Vec::new(), &[last])).unwrap_or(sum);
        }
        let _ = self.exchange((0..last).map(|other| (other, bytes.clone())).collect(), &[]);
        sum
    }

    /// Maximum of `at_least` and the values of all ranks. NaN values are ignored.
    #[must_use]
    pub fn maximum(&self, mine: f64, at_least: f64) -> f64 {
        if self.are_alone() {
            return at_least.max(mine);
        }
        self.all_gather(&[mine]).concat().into_iter().fold(at_least, f64::max)
    }

    /// Sum of the numbers `mine` of all ranks.
    #[must_use]
    pub fn count(&self, mine: usize) -> usize {
        if self.are_alone() {
            return mine;
        }
        self.all_gather(&[mine as u64]).concat().into_iter().sum::<u64>() as usize
    }

    /// Minimum of the numbers `mine` of all ranks.
    #[must_use]
    pub fn minimum(&self, mine: u64) -> u64 {
        if self.are_alone() {
            return mine;
        }
        self.all_gather(&[mine]).concat().into_iter().fold(mine, u64::min)
    }

    /// Whether `mine` is true on any rank.
    #[must_use]
    pub fn any(&self, mine: bool) -> bool {
        self.count(usize::from(mine)) > 0
    }
}

/// The values of the first message.
fn first_of<const N: usize>(messages: &[Vec<u8>]) -> Option<[f64; N]> {
    messages.first().and_then(|bytes| f64::unpack_all(bytes).try_into().ok())
}

impl Counted {
    fn count(&self, messages: u64, bytes: u64) {
        self.messages.fetch_add(messages, Ordering::Relaxed);
        self.bytes.fetch_add(bytes, Ordering::Relaxed);
    }
}

impl std::fmt::Debug for Ranks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "rank {} of {}", self.rank(), self.size())
    }
}
