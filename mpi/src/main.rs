//! `rc-mpi`: one contact problem over the ranks of MPI.
//!
//! `mpirun -n 4 rc-mpi solve …` takes the flags of `rc solve` and writes the same files. The digits do not depend on
//! the number of ranks.

mod alike;
mod communicator;

use std::io::Write as _;

use mpi::Threading;
use mpi::traits::Communicator as _;
use rc_comm::Ranks;

use communicator::World;

/// Exit code of bad input. The exit code of results that could not be written follows.
const BAD_INPUT: u8 = 2;
const NOT_WRITTEN: u8 = 4;

fn main() {
    // Calls of MPI come from one thread at a time.
    let started = mpi::initialize_with_threading(Threading::Serialized);
    let code = match &started {
        Some((_, granted)) if *granted >= Threading::Serialized => solve(),
        _ => {
            tell(
                "error: MPI: this library allows calls from the main thread only; use one built with MPI_THREAD_SERIALIZED",
            );
            BAD_INPUT
        }
    };
    if let (NOT_WRITTEN, Some((universe, _))) = (code, &started) {
        // The other ranks may be waiting for the rank that could not write.
        universe.world().abort(code.into());
    }
    // MPI has to end here. `exit` would not end it.
    drop(started);
    std::process::exit(code.into());
}

fn solve() -> u8 {
    let ranks = Ranks::new(Box::new(World::new()));
    if let Err(message) = alike::check(&ranks) {
        if ranks.rank() == 0 {
            tell(&format!("error: {message}"));
        }
        return BAD_INPUT;
    }
    let code = rc_cli::solve::main_over_ranks(std::env::args_os(), &ranks);
    if code == 0 && std::env::var_os("RC_TRAFFIC").is_some() {
        let traffic = ranks.traffic();
        tell(&format!("rank {}: {} messages, {} bytes sent", ranks.rank(), traffic.messages, traffic.bytes));
    }
    code
}

fn tell(text: &str) {
    // If standard error is closed, there is no other place for the message.
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
