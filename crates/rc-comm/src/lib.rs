//! How the ranks of one solve exchange values.
//!
//! A solve over ranks runs the same program on each of them. What is small is known to all and computed by all, bit by
//! bit alike; large vectors are divided. [`Communicator`] is what an implementation has to give: ranks that are threads
//! of one process ([`run_threads`]), or processes of MPI (crate `rc-mpi`). [`Ranks`] is what a solver uses: values
//! instead of bytes, sums in one order for any number of ranks, and a count of the bytes. Without a communicator a
//! process is alone, and nothing is copied.
//!
//! ```
//! use rc_comm::{Ranks, run_threads};
//!
//! // Four ranks add up numbers in the order of ranks, as one would.
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
