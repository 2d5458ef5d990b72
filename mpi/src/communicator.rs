//! The communicator of MPI.

use mpi::Count;
use mpi::datatype::PartitionMut;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator as _, CommunicatorCollectives as _, Destination as _, Source as _};
use rc_comm::Communicator;

/// Maximum number of bytes of a message, since counts of MPI are numbers of 31 bits.
const LARGEST: usize = 1 << 30;

/// All processes of the run.
///
/// An error of MPI ends all of them with a message, which is MPI's default.
pub(crate) struct World {
    rank: usize,
    size: usize,
}

impl World {
    /// The world. MPI must be initialised for calls of one thread at a time.
    pub(crate) fn new() -> Self {
        let world = SimpleCommunicator::world();
        Self { rank: world.rank() as usize, size: world.size() as usize }
    }

    /// The lengths of the contributions of all ranks.
    fn lengths(len: usize, size: usize) -> Vec<usize> {
        let mut lengths = vec![0_u64; size];
        SimpleCommunicator::world().all_gather_into(&(len as u64), &mut lengths[..]);
        lengths.into_iter().map(|len| len as usize).collect()
    }
}

impl Communicator for World {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn barrier(&self) {
        SimpleCommunicator::world().barrier();
    }

    fn all_gather(&self, mine: &[u8]) -> Vec<Vec<u8>> {
        let lengths = Self::lengths(mine.len(), self.size);
        let mut all: Vec<Vec<u8>> = lengths.iter().map(|&len| Vec::with_capacity(len)).collect();
        let longest = lengths.iter().copied().max().unwrap_or(0);
        let piece = LARGEST / self.size;
        for first in (0..longest).step_by(piece) {
            let of_piece = |len: usize| first.min(len)..(first + piece).min(len);
            let counts: Vec<Count> = lengths.iter().map(|&len| of_piece(len).len() as Count).collect();
            let ends = counts.iter().scan(0, |end: &mut Count, &count| {
                *end += count;
                Some(*end)
            });
            let starts: Vec<Count> = std::iter::once(0).chain(ends).take(self.size).collect();
            let mut pieces = vec![0; counts.iter().map(|&count| count as usize).sum()];
            let mut parts = PartitionMut::new(&mut pieces[..], &counts[..], &starts[..]);
            SimpleCommunicator::world().all_gather_varcount_into(&mine[of_piece(mine.len())], &mut parts);
            for ((all, &start), &count) in all.iter_mut().zip(&starts).zip(&counts) {
                all.extend_from_slice(&pieces[start as usize..][..count as usize]);
            }
        }
        all
    }

    fn exchange(&self, outgoing: Vec<(usize, Vec<u8>)>, from: &[usize]) -> Vec<Vec<u8>> {
        let world = SimpleCommunicator::world();
        // A message that is shorter than the largest size is the last one.
        let pieces = outgoing.iter().flat_map(|(to, bytes)| {
            let n = bytes.len() / LARGEST + 1;
            (0..n).map(move |i| (*to, &bytes[i * LARGEST..((i + 1) * LARGEST).min(bytes.len())]))
        });
        mpi::request::scope(|scope| {
            let sent: Vec<_> =
                pieces.map(|(to, piece)| world.process_at_rank(to as i32).immediate_send(scope, piece)).collect();
            let receive = |&from: &usize| {
                let mut all = Vec::new();
                loop {
                    let (piece, _) = world.process_at_rank(from as i32).receive_vec::<u8>();
                    let is_last = piece.len() < LARGEST;
                    if is_last && all.is_empty() {
                        return piece;
                    }
                    all.extend_from_slice(&piece);
                    if is_last {
                        return all;
                    }
                }
            };
            let received = from.iter().map(receive).collect();
            for request in sent {
                request.wait_without_status();
            }
            received
        })
    }
}
