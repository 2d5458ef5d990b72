//! Exchange of values between the ranks of one solve.
//!
//! A solve over ranks runs the same program on each of them. Every rank holds and computes all small data, bit by bit
//! the same. Large vectors are divided between the ranks.
//!
//! - [`Communicator`] is the trait that an implementation provides. Ranks are threads of one process ([`run_threads`]),
//!   or processes of MPI (crate `rc-mpi`).
//! - [`Ranks`] is the interface for a solver. It exchanges values instead of bytes, adds in one order for any number of
//!   ranks, and counts the bytes.
//!
//! Without a communicator a process is alone, and nothing is copied.
//!
//! ```
//! use rc_comm::{Ranks, run_threads};
//!
//! // Four ranks add up numbers in the order of ranks, and get the same bits as one process.
//! let add = |ranks: &Ranks| ranks.fold([0.0], |[sum]| [sum + 0.1 * (ranks.rank() + 1) as f64]);
//! let sums = run_threads(4, |ranks| add(&ranks))?;
//! let alone = (1..=4).fold(0.0, |sum, i| sum + 0.1 * f64::from(i));
//! assert!(sums.iter().all(|[sum]| sum.to_bits() == f64::to_bits(alone)));
//! # Ok::<(), rc_comm::LostRank>(())
//! ```

mod communicator;
mod lost;
mod packed;
mod ranks;
mod threads;

pub use communicator::Communicator;
pub use lost::LostRank;
pub use packed::Packed;
pub use ranks::{Ranks, Traffic};
pub use threads::run_threads;
