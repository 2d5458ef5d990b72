//! Ranks that are threads of one process.

use std::any::Any;
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::communicator::Communicator;
use crate::lost::LostRank;
use crate::ranks::Ranks;

/// Bytes of the stack of a rank, as many as for a main thread.
const STACK: usize = 8 << 20;

/// A rank that is a thread, with a channel from and to each rank.
struct ThreadRank {
    rank: usize,
    to: Vec<Mutex<Sender<Vec<u8>>>>,
    from: Vec<Mutex<Receiver<Vec<u8>>>>,
}

/// Runs `work` on `size` ranks, each a thread, and returns the results in their order.
///
/// # Errors
/// [`LostRank`] when `work` panics on a rank. The other ranks end too.
pub fn run_threads<T: Send>(size: usize, work: impl Fn(Ranks) -> T + Sync) -> Result<Vec<T>, LostRank> {
    let work = &work;
    let results: Vec<thread::Result<T>> = thread::scope(|scope| {
        let spawn = |rank: ThreadRank| {
            let builder = thread::Builder::new().stack_size(STACK);
            builder.spawn_scoped(scope, move || {
                // The channels close when the closure ends, also by a panic.
                panic::catch_unwind(AssertUnwindSafe(move || work(Ranks::new(Box::new(rank)))))
            })
        };
        let threads: Vec<_> = connected(size.max(1)).into_iter().map(spawn).collect();
        let join = |thread: std::io::Result<thread::ScopedJoinHandle<'_, thread::Result<T>>>| match thread {
            Ok(thread) => thread.join().and_then(|result| result),
            Err(error) => Err(Box::new(error) as Box<dyn Any + Send>),
        };
        threads.into_iter().map(join).collect()
    });
    // The rank that ended first has a cause other than `LostRank`.
    let ended = |result: &thread::Result<T>| result.as_ref().is_err_and(|cause| !cause.is::<LostRank>());
    match results.iter().position(ended).or_else(|| results.iter().position(Result::is_err)) {
        Some(rank) => Err(LostRank { rank, size }),
        None => Ok(results.into_iter().flatten().collect()),
    }
}

/// Creates ranks with channels between them.
fn connected(size: usize) -> Vec<ThreadRank> {
    let mut ranks: Vec<ThreadRank> =
        (0..size).map(|rank| ThreadRank { rank, to: Vec::new(), from: Vec::new() }).collect();
    for from in 0..size {
        for to in 0..size {
            let (sender, receiver) = channel();
            ranks[from].to.push(Mutex::new(sender));
            ranks[to].from.push(Mutex::new(receiver));
        }
    }
    ranks
}

impl ThreadRank {
    fn send(&self, to: usize, bytes: Vec<u8>) {
        let sender = self.to[to].lock().unwrap_or_else(PoisonError::into_inner);
        if sender.send(bytes).is_err() {
            self.end(to);
        }
    }

    fn receive(&self, from: usize) -> Vec<u8> {
        let receiver = self.from[from].lock().unwrap_or_else(PoisonError::into_inner);
        receiver.recv().unwrap_or_else(|_| self.end(from))
    }

    /// Unwinds to [`run_threads`] without a message. The rank that ended first has printed one.
    fn end(&self, rank: usize) -> ! {
        panic::resume_unwind(Box::new(LostRank { rank, size: self.size() }))
    }
}

impl Communicator for ThreadRank {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.to.len()
    }

    fn barrier(&self) {
        self.all_gather(&[]);
    }

    fn all_gather(&self, mine: &[u8]) -> Vec<Vec<u8>> {
        for to in 0..self.size() {
            self.send(to, mine.to_vec());
        }
        (0..self.size()).map(|from| self.receive(from)).collect()
    }

    fn exchange(&self, outgoing: Vec<(usize, Vec<u8>)>, from: &[usize]) -> Vec<Vec<u8>> {
        for (to, bytes) in outgoing {
            self.send(to, bytes);
        }
        from.iter().map(|&from| self.receive(from)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packed::Packed;

    /// Numbers whose sum depends on the order of summation.
    fn number(i: usize) -> f64 {
        (i as f64 + 0.3).sin() * 10_f64.powi((i % 7) as i32 - 3)
    }

    #[test]
    fn sums_do_not_depend_on_the_number_of_ranks() {
        let add = |[sum]: [f64; 1], range: std::ops::Range<usize>| [range.fold(sum, |sum, i| sum + number(i))];
        let [expected] = add([0.25], 0..1000);
        let other_order = (0..1000).rev().fold(0.25, |sum, i| sum + number(i));
        assert_ne!(expected.to_bits(), other_order.to_bits(), "the numbers show their order");
        for size in [1, 2, 3, 7] {
            let sums = run_threads(size, |ranks| {
                let own = 1000 * ranks.rank() / size..1000 * (ranks.rank() + 1) / size;
                ranks.fold([0.25], |sum| add(sum, own))
            });
            let sums = sums.expect("all ranks end");
            assert_eq!(sums.len(), size);
            assert!(sums.iter().all(|[sum]| sum.to_bits() == expected.to_bits()), "{size} ranks: {sums:?}");
        }
    }

    #[test]
    fn values_arrive_in_the_order_of_ranks() {
        let gathered = run_threads(3, |ranks| {
            let mine: Vec<f32> = (0..ranks.rank()).map(|i| i as f32 + 0.5).collect();
            (ranks.concatenate(mine), ranks.maximum(-(ranks.rank() as f64), f64::NEG_INFINITY), ranks.traffic())
        });
        for (rank, (values, maximum, traffic)) in gathered.expect("all ranks end").into_iter().enumerate() {
            assert_eq!(values, [0.5, 0.5, 1.5]);
            assert!(maximum.abs() < 1e-12);
            assert_eq!((traffic.messages, traffic.bytes), (4, 2 * (4 * rank as u64 + 8)));
        }
    }

    #[test]
    fn every_rank_gets_what_the_others_send_to_it() {
        let received = run_threads(4, |ranks| {
            let message = |to: usize| {
                let mut bytes = Vec::new();
                u64::pack(&vec![10 * ranks.rank() as u64 + to as u64; to], &mut bytes);
                bytes
            };
            ranks.exchange_all((0..4).map(message).collect())
        });
        for (rank, received) in received.expect("all ranks end").into_iter().enumerate() {
            for (from, bytes) in received.iter().enumerate() {
                assert_eq!(u64::unpack_all(bytes), vec![10 * from as u64 + rank as u64; rank], "{from} to {rank}");
            }
        }
    }

    #[test]
    fn a_rank_that_ends_early_ends_the_others_and_is_named() {
        let result = run_threads(3, |ranks| {
            if ranks.rank() == 1 {
                panic::resume_unwind(Box::new("no memory"));
            }
            ranks.fold([0.0], |sum| sum)
        });
        assert_eq!(result, Err(LostRank { rank: 1, size: 3 }));
        assert_eq!(
            result.expect_err("it has ended").to_string(),
            "rank 1 of 3 has ended early, and the others with it"
        );
    }
}
