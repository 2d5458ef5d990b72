//! Pools of worker threads.
//!
//! Each running call has a pool, which is kept for the next call.

use std::sync::{Mutex, PoisonError};

use rayon::{ThreadPool, ThreadPoolBuilder};

/// Idle pools, each with its process and the requested number of threads.
///
/// The number is 0 for all cores. A child process after a fork has the list but not the threads, so it starts pools of
/// its own.
static IDLE: Mutex<Vec<(u32, usize, ThreadPool)>> = Mutex::new(Vec::new());

/// A pool that becomes idle again when it is dropped.
pub(crate) struct Pool {
    key: (u32, usize),
    pool: Option<ThreadPool>,
}

impl Pool {
    /// A pool of `threads` threads, 0 for all cores. Two calls at once get two pools.
    pub(crate) fn take(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let key = (std::process::id(), threads);
        let mut idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner);
        let found = idle.iter().position(|(process, threads, _)| (*process, *threads) == key);
        let found = found.map(|at| idle.swap_remove(at).2);
        drop(idle);
        let pool = found.map_or_else(|| ThreadPoolBuilder::new().num_threads(threads).build(), Ok)?;
        Ok(Self { key, pool: Some(pool) })
    }

    /// The threads of the pool.
    pub(crate) fn threads(&self) -> &ThreadPool {
        self.pool.as_ref().expect("it is there until it is dropped")
    }

    /// Gives the pool up. Its threads end when their work is done.
    pub(crate) fn leave(mut self) {
        self.pool = None;
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if let Some(pool) = self.pool.take() {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).push((self.key.0, self.key.1, pool));
        }
    }
}
