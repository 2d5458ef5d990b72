//! Rows side by side: who solves which with how many threads.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::bar::RowBar;
use super::journal::Journal;
use super::plan::Plan;
use super::row::{self, LatestSurface};
use crate::budget::Budget;
use crate::error::CliError;
use crate::stop::Stop;

/// The journal as workers and the handler of interrupts share it. Every row in it is whole, so a worker that panicked leaves
/// it usable.
pub(super) fn locked(journal: &Mutex<Journal>) -> MutexGuard<'_, Journal> {
    journal.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Solves the rows `todo` of `plan` on `threads` threads and keeps each as it is done. After a failure no row is begun; a row whose load
/// is impossible is left out.
///
/// Rows are solved side by side as far as memory allows. That is faster than all threads on one row for small surfaces, and
/// no slower for large ones (docs/sweeps.md).
///
/// # Errors
/// The first [`CliError`] of a row, failures first.
pub(super) fn run(
    plan: &Plan,
    todo: &[usize],
    threads: usize,
    journal: &Mutex<Journal>,
    bar: &RowBar,
) -> Result<(), CliError> {
    let n_workers = n_workers(plan, todo.len(), threads);
    let work = Work {
        plan,
        todo,
        threads,
        journal,
        bar,
        next: AtomicUsize::new(0),
        stop: AtomicBool::new(false),
        limit: Stop::at(Instant::now(), plan.run.time_limit),
        surfaces: LatestSurface::default(),
    };
    let pools: Vec<rayon::ThreadPool> =
        share(threads, n_workers).map(|n| pool(n.get())).collect::<Result<_, CliError>>()?;
    let results: Vec<Result<(), CliError>> = std::thread::scope(|scope| {
        let work = &work;
        let running: Vec<_> = pools.iter().map(|pool| scope.spawn(move || pool.install(|| work.run()))).collect();
        running.into_iter().map(join).collect()
    });
    let (refused, others): (Vec<_>, Vec<_>) = results.into_iter().partition(|r| matches!(r, Err(CliError::Input(_))));
    others.into_iter().chain(refused).collect()
}

/// The result of a worker; a panic goes on here.
fn join<T>(worker: std::thread::ScopedJoinHandle<'_, T>) -> T {
    worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn n_workers(plan: &Plan, n_rows: usize, threads: usize) -> usize {
    let greatest = plan.surfaces.iter().map(|surface| surface.problem.most_elements()).fold(0.0, f64::max);
    Budget::new(plan.run.memory_limit).solves_at_once(greatest).min(threads).min(n_rows).max(1)
}

/// Threads of each worker: all of them, in parts as equal as can be.
fn share(threads: usize, n_workers: usize) -> impl Iterator<Item = NonZeroUsize> {
    let part = move |i| threads / n_workers + usize::from(i < threads % n_workers);
    (0..n_workers).map(move |i| NonZeroUsize::new(part(i)).unwrap_or(NonZeroUsize::MIN))
}

fn pool(threads: usize) -> Result<rayon::ThreadPool, CliError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|cause| CliError::input(format_args!("threads: {cause}")))
}

/// What the workers share.
struct Work<'a> {
    plan: &'a Plan,
    todo: &'a [usize],
    threads: usize,
    journal: &'a Mutex<Journal>,
    bar: &'a RowBar,
    next: AtomicUsize,
    stop: AtomicBool,
    /// Rows that have begun are finished.
    limit: Stop,
    surfaces: LatestSurface,
}

impl Work<'_> {
    /// Takes rows until there are none, or a row failed.
    fn run(&self) -> Result<(), CliError> {
        let mut refused = Ok(());
        while !self.stop.load(Ordering::Relaxed) && self.limit.reason().is_none() {
            let Some(&index) = self.todo.get(self.next.fetch_add(1, Ordering::Relaxed)) else { break };
            let kept = self
                .plan
                .row(index)
                .and_then(|row| row::solve(self.plan, &row, &self.surfaces, self.threads))
                .and_then(|cells| locked(self.journal).append(index, cells));
            match kept {
                Ok(()) => self.bar.one_more(),
                // A load that this surface cannot carry says nothing about the others.
                Err(CliError::Input(_)) => refused = refused.and(kept),
                Err(_) => {
                    self.stop.store(true, Ordering::Relaxed);
                    return kept;
                }
            }
        }
        refused
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_thread_is_used_once() {
        for (threads, n_workers, expected) in [(2, 2, &[1, 1][..]), (7, 3, &[3, 2, 2]), (4, 1, &[4]), (1, 1, &[1])] {
            let parts: Vec<usize> = share(threads, n_workers).map(NonZeroUsize::get).collect();
            assert_eq!(parts, expected);
        }
    }
}
