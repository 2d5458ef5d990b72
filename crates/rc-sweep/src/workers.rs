//! Parallel solution of rows: distribution of rows and threads to workers.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::content::Cells;
use crate::error::SweepError;
use crate::row_solver::{RowError, RowSolver, RunError, Workers};

/// A function that stores a finished row.
type Keep<'a, R> = dyn Fn(&R, Cells) -> Result<(), SweepError> + Sync + 'a;

/// Solves the rows `todo`, and passes each finished row to `keep`.
///
/// After a failure no more rows are begun. A refused row is omitted. Rows are solved in parallel as far as memory
/// allows. For small surfaces this is faster than all threads on one row, and for large ones it is not slower
/// (docs/constants.md).
///
/// # Errors
/// The first error of a row, where failures take precedence. The caller sets the counts of [`RunError::Refused`].
pub(crate) fn run<R: Sync, S: RowSolver<R>>(
    todo: &[R],
    solver: &S,
    workers: Workers,
    keep: &Keep<'_, R>,
) -> Result<(), RunError<S::Error>> {
    let n_workers = workers.at_once.min(workers.threads).min(todo.len()).max(1);
    let pools = share(workers.threads, n_workers).map(|n| pool(n.get()));
    let pools: Vec<rayon::ThreadPool> = pools.collect::<Result<_, SweepError>>()?;
    let work = Work { todo, solver, keep, next: AtomicUsize::new(0), stop: AtomicBool::new(false) };
    let results: Vec<Result<(), RunError<S::Error>>> = std::thread::scope(|scope| {
        let work = &work;
        let running: Vec<_> = pools.iter().map(|pool| scope.spawn(move || pool.install(|| work.run()))).collect();
        running.into_iter().map(join).collect()
    });
    let (refused, others): (Vec<_>, Vec<_>) =
        results.into_iter().partition(|result| matches!(result, Err(RunError::Refused { .. })));
    others.into_iter().chain(refused).collect()
}

/// The result of a worker. A panic of the worker continues here.
fn join<T>(worker: std::thread::ScopedJoinHandle<'_, T>) -> T {
    worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Numbers of threads of the workers, as equal as possible, with all threads in use.
fn share(threads: usize, n_workers: usize) -> impl Iterator<Item = NonZeroUsize> {
    let part = move |i| threads / n_workers + usize::from(i < threads % n_workers);
    (0..n_workers).map(move |i| NonZeroUsize::new(part(i)).unwrap_or(NonZeroUsize::MIN))
}

fn pool(threads: usize) -> Result<rayon::ThreadPool, SweepError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|cause| SweepError::Threads { threads, cause: cause.to_string() })
}

/// Data that the workers share.
struct Work<'a, R, S> {
    todo: &'a [R],
    solver: &'a S,
    keep: &'a Keep<'a, R>,
    next: AtomicUsize,
    stop: AtomicBool,
}

impl<R, S: RowSolver<R>> Work<'_, R, S> {
    /// Takes rows until there are no more rows, or a row failed.
    fn run(&self) -> Result<(), RunError<S::Error>> {
        let mut refused = Ok(());
        while !self.stop.load(Ordering::Relaxed) && !self.solver.should_stop() {
            let Some(row) = self.todo.get(self.next.fetch_add(1, Ordering::Relaxed)) else { break };
            let result = match self.solver.solve(row) {
                Ok(cells) => (self.keep)(row, cells).map_err(RunError::from),
                Err(RowError::Refused(error)) => {
                    refused = refused.and(Err(RunError::Refused { error, missing: 0, kept: 0 }));
                    continue;
                }
                Err(RowError::Failed(error)) => Err(RunError::Failed(error)),
            };
            if result.is_err() {
                self.stop.store(true, Ordering::Relaxed);
                return result;
            }
            self.solver.row_kept();
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
